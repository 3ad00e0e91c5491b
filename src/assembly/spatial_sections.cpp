#include <fmt/format.h>

#include <iterator>

#include "floe/dynamics/spatial_body.h"
#include "floe/error.h"
#include "spatial_assembly.h"

namespace floe::assembly {

/// Inertia, weight, distributed loads and pressures of a part of a body.
std::vector<std::shared_ptr<const dynamics::Term>> SpatialAssembly::terms_of(int b, const BodyPart& part) {
  const PlannedBody& body = plan_.bodies[b];
  const Slot& slot = slots_[b];
  std::vector<std::unique_ptr<dynamics::Term>> all;
  std::swap(all, terms_);
  if (slot.corotated) {
    terms_ = slot.corotated->terms_of(&part.cells, body.spec.damping.stiffness);
  } else if (!compact(b)) {
    terms_ = reference::spatial_inertia_terms(body.structure, constrained(b), *slot.nodes, frame_of(b), &part.cells);
  } else if (owner_) {
    const Eigen::Index k = reduced_[b].body.coordinates();
    terms_.push_back(std::make_unique<dynamics::SpatialBody>(
        coordinates_of(b), slot.attitude, body::spatial(part.masses.mass),
        body::Elasticity{Eigen::MatrixXd::Zero(k, k), Eigen::MatrixXd(0, k), {}}));
  }
  add_gravity(b, &part);
  for (std::size_t l = 0; l < plan_.loads.size(); ++l)
    if (plan_.loads[l].body == b && plan_.scene.loads[l].spread()) add_load(l, &part);
  std::swap(all, terms_);
  return {std::make_move_iterator(all.begin()), std::make_move_iterator(all.end())};
}

std::vector<ModelSection> SpatialAssembly::sections(std::size_t p, Model& model) {
  const int b = plan_.probes[p][0].body;
  const Slot& slot = slots_[b];
  if (slot.still)
    throw InputError(fmt::format(
        "{}.at: section forces of body {} are not available in reduced and floating-frame models, because it has "
        "supports; expected other joints instead of supports (fixed, revolute, spherical, ...), or formulation cfr",
        plan_.scene.probes[p].where.text(), plan_.bodies[b].spec.name));
  std::vector<ModelSection> all;
  for (const ChosenSide& chosen : chosen_sides(plan_, p)) {
    const BeamSide& side = chosen.side;
    ModelSection& section = all.emplace_back();
    section.factor = side.after ? -chosen.weight : chosen.weight;
    section.axes = side.axes;
    if (slot.corotated) {
      BodyPart element;
      element.cells.assign(side.cells.size(), 0);
      if (side.cell >= 0) {
        element.cells[static_cast<std::size_t>(side.cell)] = 1;
        const dynamics::SpatialMarker at = slot.corotated->place(side.by);
        section.cut.frame = at.coordinates.front(), section.cut.attitude = at.attitude;
      }
      if (owner_) section.origin = slot.corotated->nodes().of_node(side.by);
      section.cut.own = terms_of(b, element);
      continue;
    }
    BodyPart part = part_of(plan_, p, side, undetermined_, comm_of(plan_, formulation_));
    if (!part.beyond) section.factor = -section.factor;
    if (compact(b)) part.masses = reduction::part_masses(plan_.bodies[b].structure, *reduced_[b].basis, part.cells);
    section.cut.frame = section.origin = slot.frame, section.cut.attitude = slot.attitude;
    section.cut.own = terms_of(b, part);
    if (!owner_) continue;
    for (const auto& [l, term] : load_terms_)
      if (plan_.loads[l].body == b && part.has(plan_.loads[l])) section.cut.shared.push_back(term);
    for (const auto& [j, connections] : connections_)
      for (const Anchor& at : plan_.joints[j])
        if (at.body == b && part.has(at))
          section.cut.shared.insert(section.cut.shared.end(), connections.begin(), connections.end());
  }
  if (std::string words = without_damping(plan_, p); !words.empty()) model.warnings.push_back(std::move(words));
  return all;
}

}  // namespace floe::assembly
