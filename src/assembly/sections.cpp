#include "sections.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "floe/error.h"

namespace floe::assembly {
namespace {

[[noreturn]] void refuse(const Probe& probe, const std::string& what) {
  throw InputError(fmt::format("{}.at: {}", probe.where.text(), what));
}

/// The sides are those of one line that runs through the node.
bool continues(const std::vector<BeamSide>& sides) { return sides.size() == 2 && sides[0].after != sides[1].after; }

std::vector<int> joints_on(const Plan& plan, int body, const BodyPart& part) {
  std::vector<int> joints;
  for (std::size_t j = 0; j < plan.joints.size(); ++j)
    for (const Anchor& place : plan.joints[j])
      if (place.body == body && part.has(place)) joints.push_back(static_cast<int>(j));
  return joints;
}

}  // namespace

std::vector<ChosenSide> chosen_sides(const Plan& plan, std::size_t p) {
  const Probe& probe = plan.scene.probes[p];
  const auto& [place, toward] = plan.probes[p];
  const PlannedBody& body = plan.bodies[place.body];
  if (place.nodes.size() > 1)
    refuse(probe, fmt::format("is a place of {} nodes of body {}; expected one node of a beam", place.nodes.size(),
                              body.spec.name));
  std::vector<BeamSide> sides = beam_sides(body.structure, place.nodes.empty() ? place.node : place.nodes.front());
  if (sides.empty()) refuse(probe, fmt::format("no beam of body {} has a node there", body.spec.name));
  if (std::any_of(sides.begin(), sides.end(), [](const BeamSide& side) { return side.middle; }))
    refuse(probe, "is the middle of an element of second order; expected one of its ends");
  if (probe.toward) {
    const Eigen::Vector3d way = toward.x - place.x;
    const auto along = [&](const BeamSide& side) { return side.away.normalized().dot(way); };
    return {{*std::max_element(sides.begin(), sides.end(),
                               [&](const BeamSide& a, const BeamSide& b) { return along(a) < along(b); })}};
  }
  if (sides.size() == 1) return {{std::move(sides[0])}};
  if (continues(sides)) return {{std::move(sides[0]), 0.5}, {std::move(sides[1]), 0.5}};
  refuse(probe, fmt::format("{} elements of beams meet there{}; expected toward: a place that one of them leads to",
                            sides.size(), sides.size() == 2 ? ", whose axes x are opposite" : ""));
}

bool BodyPart::has(const Anchor& place) const {
  const std::vector<AveragingWeight> moved_by = place.moved_by();
  return std::any_of(moved_by.begin(), moved_by.end(),
                     [&](const AveragingWeight& weight) { return nodes[static_cast<std::size_t>(weight.node)] != 0; });
}

BodyPart part_of(const Plan& plan, std::size_t p, const BeamSide& side, const std::vector<int>& undetermined,
                 MPI_Comm system) {
  const Probe& probe = plan.scene.probes[p];
  const int b = plan.probes[p][0].body;
  const std::string& name = plan.bodies[b].spec.name;
  if (!side.separates)
    refuse(probe, fmt::format("a section there does not divide body {}, whose beams form a ring; expected formulation "
                              "cfr",
                              name));
  BodyPart beyond{side.cells, side.nodes}, rest = beyond;
  rest.beyond = false;
  for (std::vector<char>* mask : {&rest.cells, &rest.nodes})
    for (char& one : *mask) one = !one;
  const std::vector<int> there = joints_on(plan, b, beyond), here = joints_on(plan, b, rest);
  for (const int j : there)
    if (std::find(here.begin(), here.end(), j) != here.end())
      refuse(probe, fmt::format("joint {} connects both parts of body {} that a section there divides; expected "
                                "formulation cfr",
                                plan.scene.joints[j].name, name));
  int rank = 0, size = 1, open[2] = {0, 0};
  MPI_Comm_rank(system, &rank);
  MPI_Comm_size(system, &size);
  const auto count = [&](const std::vector<int>& joints) {
    return static_cast<int>(std::count_if(joints.begin(), joints.end(), [&](int j) {
      return std::find(undetermined.begin(), undetermined.end(), j) != undetermined.end();
    }));
  };
  open[0] = count(there), open[1] = count(here);
  MPI_Bcast(open, 2, MPI_INT, size - 1, system);
  if (open[0] > 0 && open[1] > 0) {
    std::vector<std::string> names;
    for (const int j : there) names.push_back(plan.scene.joints[j].name);
    for (const int j : here) names.push_back(plan.scene.joints[j].name);
    refuse(probe,
           fmt::format("the forces there are statically indeterminate in this model: the constraints of joints "
                       "{} are redundant; expected joints that release the redundant constraints, or formulation "
                       "nlffr or cfr, where flexible bodies determine them",
                       fmt::join(names, ", ")));
  }
  if (open[0] > 0) return rest;
  return open[1] > 0 || there.size() <= here.size() ? beyond : rest;
}

std::string without_damping(const Plan& plan, std::size_t p) {
  const Body& body = plan.bodies[plan.probes[p][0].body].spec;
  if (body.damping.mass == 0 && body.damping.modal.empty()) return "";
  return fmt::format("probe {}: the forces of {} of body {} along the part beyond the section are not counted",
                     plan.scene.probes[p].name, body.damping.mass != 0 ? "damping.mass" : "damping.modal", body.name);
}

}  // namespace floe::assembly
