#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "damping_axes.h"
#include "floe/dynamics/floating_body.h"
#include "floe/plan/hold_by_joint.h"
#include "floe/reference/corotational_beam.h"
#include "full_order_modes.h"
#include "planar_assembly.h"

// damping.mass of planar bodies in several frames; damping.mass and damping.modal of corotational ones.
namespace floe::assembly {

using dynamics::MovingAxes;
using dynamics::RelativeDamping;
using petsc::check;

namespace {

body::Elasticity no_elasticity(Eigen::Index k) { return {Eigen::MatrixXd::Zero(k, k), Eigen::MatrixXd(0, k), {}}; }

}  // namespace

void PlanarAssembly::add_damping_axes() {
  damped_ = damped_wholes(plan_, formulation_ == Formulation::cfr, std::vector<bool>(slots_.size(), false));
  for (DampedWhole& whole : damped_) {
    if (whole.fixed) continue;
    coordinates_.belongs_to("damping of body " + plan_.bodies[whole.bodies.front()].spec.name);
    add_axes(whole);
    if (formulation_ != Formulation::cfr || !has_modal_damping(plan_.bodies[whole.bodies.front()].spec)) continue;
    whole.modal = full_order_modal_damping(plan_, whole.bodies.front(), {}, coordinates_);
    whole.alpha = std::max(whole.alpha, min_mass_damping(*whole.modal));
  }
}

void PlanarAssembly::add_axes(WholeAxes& axes) {
  axes.f.position = coordinates_.add_shared(3), axes.f.rotation = axes.f.position + 2;
  coordinates_.add_angle(axes.f.rotation, true);
  axes.multipliers = coordinates_.add_shared(3, true);
}

void PlanarAssembly::add_body_axes() {
  if (formulation_ != Formulation::cfr) return;
  const auto by_places = [&](std::size_t p) {
    return !plan_.probe_frames[p].empty() ||
           plan_.bodies[plan_.probes[p][0].body].frame.kind != fem::ReferenceFrame::Kind::mean_axis;
  };
  for (int b = 0; b < static_cast<int>(slots_.size()); ++b) {
    if (compact(b) || !needs_frame_axes(plan_, b, by_places)) continue;
    coordinates_.belongs_to("axes of body " + plan_.bodies[b].spec.name);
    add_axes(body_axes_.emplace(b, frame_axes(plan_, b)).first->second);
  }
}

/// Places the axes where their rows put them, with the velocity that these have.
void PlanarAssembly::start_body_axes(Model& model) {
  const dynamics::System layout(coordinates_, {});
  for (const auto& [b, axes] : body_axes_) {
    const PlannedBody& body = plan_.bodies[b];
    const std::vector<int> own = axes.f.coordinates();
    AxesTerms rows = conditions(
        axes, 3, [&](int part) { return corotational_masses(part); },
        [&, &whole = axes](int part) { return constrained_places(whole, part); });
    Eigen::VectorXd q, v;
    layout.gather(model.U, q);
    q(own) << mesh_axes_at_start(body).R.head<2>(), body.pose[2] - body.frame_angle;
    place_axes(axes, rows, "body " + body.spec.name, nullptr, q, coordinates_.comm());
    const Eigen::VectorXd start = q(own);
    set_shared(own, {start.begin(), start.end()}, model.U);
    layout.gather(model.V, v);
    const Eigen::VectorXd rate = rates_of(axes, rows, q, v, coordinates_.comm());
    set_shared(own, {rate.begin(), rate.end()}, model.V);
    for (auto& term : rows) terms_.push_back(std::move(term));
  }
}

/// The axes of a node of a corotational body.
MovingAxes PlanarAssembly::node_axes(int b, int first, const Eigen::Vector3d& x) const {
  const PlannedBody& body = plan_.bodies[b];
  MovingAxes axes{first, first + 2};
  axes.origin.head<2>() = undeformed_place(body, x);
  axes.angle = body.pose[2];
  return axes;
}

/// Halves of its elements.
std::vector<CarriedMass> PlanarAssembly::corotational_masses(int b) const {
  const PlannedBody& body = plan_.bodies[b];
  const fem::Structure& s = body.structure;
  const Eigen::Matrix3d A0 = undeformed_axes(body);
  std::vector<CarriedMass> all;
  for (const auto& cell : s.mesh.cells) {
    const auto& section = std::get<fem::BeamSection>(s.sections[cell.part]);
    const Eigen::Vector3d ends[2] = {s.mesh.positions[cell.place[0]], s.mesh.positions[cell.place[1]]},
                          along = ends[1] - ends[0];
    for (const int i : {0, 1}) {
      const Eigen::Vector2d arm = (i == 0 ? 1 : -1) * (0.5 - 0.5 / std::sqrt(3.0)) * along.head<2>();
      body::Inertia half(2, 0);
      half.add(body::MassPoint{section.rhoA * along.norm() / 2, arm, Eigen::MatrixXd(2, 0)});
      all.push_back({node_axes(b, slots_[b].nodes->of_local_node(cell.nodes()[i]), ends[i]),
                     {},
                     half,
                     undeformed_origin(body) + A0 * ends[i],
                     A0});
    }
  }
  return all;
}

CarriedMass PlanarAssembly::add_mass(const DampedWhole& whole, int b, const std::vector<int>& elastic,
                                     const body::Inertia& inertia) {
  const PlannedBody& body = plan_.bodies[b];
  const MovingAxes axes{slots_[b].frame, slots_[b].frame + 2};
  std::vector<int> coordinates = axes.coordinates();
  coordinates.insert(coordinates.end(), elastic.begin(), elastic.end());
  terms_.push_back(std::make_unique<RelativeDamping>(
      std::make_unique<dynamics::FloatingBody>(coordinates, body::planar(inertia), no_elasticity(inertia.S.cols())),
      std::vector<MovingAxes>{axes}, whole.axes(), whole.alpha));
  return {axes, elastic, inertia, undeformed_origin(body), undeformed_axes(body)};
}

CarriedMass PlanarAssembly::add_element_mass(const DampedWhole& whole, int b, const fem::Mesh::Cell& cell) {
  const PlannedBody& body = plan_.bodies[b];
  const fem::Structure& s = body.structure;
  const std::vector<int> dofs = s.cell_dofs(cell);
  std::vector<int> elastic;
  std::vector<Eigen::Index> kept;
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    if (std::binary_search(body.frame.conditions.begin(), body.frame.conditions.end(), s.global_dof(dofs[i]))) continue;
    kept.push_back(static_cast<Eigen::Index>(i));
    elastic.push_back(slots_[b].nodes->of_local_node(dofs[i] / 3) + dofs[i] % 3);
  }
  const auto n = static_cast<Eigen::Index>(dofs.size());
  return add_mass(whole, b, elastic, fem::inertia(s.maps(cell), Eigen::MatrixXd::Identity(n, n)(Eigen::all, kept)));
}

void PlanarAssembly::add_corotational_mass(const DampedWhole& whole, int b, const fem::Mesh::Cell& cell) {
  const PlannedBody& body = plan_.bodies[b];
  const fem::Structure& s = body.structure;
  const auto& section = std::get<fem::BeamSection>(s.sections[cell.part]);
  const Eigen::Vector3d ends[2] = {s.mesh.positions[cell.place[0]], s.mesh.positions[cell.place[1]]};
  std::vector<MovingAxes> nodes;
  std::vector<int> coordinates;
  for (const int i : {0, 1}) {
    nodes.push_back(node_axes(b, slots_[b].nodes->of_local_node(cell.nodes()[i]), ends[i]));
    for (int coordinate : nodes.back().coordinates()) coordinates.push_back(coordinate);
  }
  terms_.push_back(std::make_unique<RelativeDamping>(
      std::make_unique<reference::CorotationalBeamMass>(
          coordinates, undeformed_place(body, ends[0]), undeformed_place(body, ends[1]),
          reference::CorotationalBeam::Properties{section.EA, section.EI, section.rhoA, section.rhoI, 0, section.GA}),
      nodes, whole.axes(), whole.alpha));
}

std::vector<CarriedMass> PlanarAssembly::add_masses(const DampedWhole& whole, int b) {
  std::vector<CarriedMass> all;
  if (compact(b)) {
    std::vector<int> elastic(static_cast<std::size_t>(reduced_[b].body.coordinates()));
    std::iota(elastic.begin(), elastic.end(), slots_[b].elastic);
    if (owner_) all.push_back(add_mass(whole, b, elastic, reduced_[b].body.inertia));
    return all;
  }
  const auto& cells = plan_.bodies[b].structure.mesh.cells;
  if (formulation_ == Formulation::cfr) {
    for (const fem::Mesh::Cell& cell : cells) add_corotational_mass(whole, b, cell);
    return corotational_masses(b);
  }
  for (const fem::Mesh::Cell& cell : cells) all.push_back(add_element_mass(whole, b, cell));
  return all;
}

std::vector<ConstrainedPlace> PlanarAssembly::constrained_places(const WholeAxes& whole, int b) {
  const PlannedBody& body = plan_.bodies[b];
  const Slot& slot = slots_[b];
  const fem::Conditions& constrained = whole.constrained[whole.place_in(b)];
  const Eigen::Matrix3d A0 = undeformed_axes(body);
  std::map<PetscInt, std::vector<int>> of_node;
  for (PetscInt dof : constrained) of_node[dof / 3].push_back(static_cast<int>(dof % 3));
  std::vector<ConstrainedPlace> all;
  for (const auto& [node, dofs] : of_node) {
    ConstrainedPlace place;
    place.axes.position = slot.frame, place.axes.rotation = slot.frame + 2;
    place.dofs = dofs, place.X = undeformed_origin(body), place.A0 = A0;
    if (compact(b)) {
      Anchor at;
      at.body = b, at.node = node;
      const body::PlaceMap map = place_map(plan_, reduced_[b], at);
      for (Eigen::Index i = 0; i < map.S.cols(); ++i) place.elastic.push_back(slot.elastic + static_cast<int>(i));
      place.x.setZero(), place.S.setZero(3, map.S.cols()), place.psi = place.S;
      place.x.head<2>() = map.x.head<2>(), place.S.topRows<2>() = map.S.topRows<2>(), place.psi.row(2) = map.psi.row(0);
      if (owner_) all.push_back(std::move(place));
      continue;
    }
    const PetscInt local = node - body.structure.mesh.first_node;
    if (local < 0 || local >= body.structure.mesh.owned_nodes) continue;
    const Eigen::Vector3d x = body.structure.mesh.positions[local];
    const int first = slot.nodes->of_local_node(static_cast<int>(local));
    if (formulation_ == Formulation::cfr) {
      place.axes = node_axes(b, first, x);
      place.X = undeformed_origin(body) + A0 * x;
      place.x.setZero();
    } else {
      place.x = x, place.S.setZero(3, 3), place.psi.setZero(3, 3);
      for (int d = 0; d < 3; ++d) {
        place.elastic.push_back(first + d);
        if (std::binary_search(body.frame.conditions.begin(), body.frame.conditions.end(), 3 * node + d)) continue;
        (d < 2 ? place.S(d, d) : place.psi(2, 2)) = 1;
      }
    }
    all.push_back(std::move(place));
  }
  return all;
}

void PlanarAssembly::add_damping(const DampedWhole& whole, Model& model) {
  auto rows = conditions(
      whole, 3, [&](int b) { return add_masses(whole, b); }, [&](int b) { return constrained_places(whole, b); });
  if (whole.fixed) return;
  start_damping(whole, rows, model);
  for (auto& term : rows) terms_.push_back(std::move(term));
}

void PlanarAssembly::start_damping(const DampedWhole& whole,
                                   std::vector<std::unique_ptr<dynamics::AccompanyingAxes>>& rows, Model& model) {
  const InitialSpec& initial = plan_.bodies[whole.bodies.front()].spec.initial;
  const std::vector<int> own = whole.f.coordinates();
  const double base[3] = {initial.position[0], initial.position[1], initial.angle};
  set_shared(own, {base, base + 3}, model.U);
  const dynamics::System layout(coordinates_, {});
  Eigen::VectorXd q, v;
  layout.gather(model.U, q), layout.gather(model.V, v);
  begin_at(rows, q);
  const Eigen::VectorXd rate = rates_of(whole, rows, q, v, coordinates_.comm());
  set_shared(own, {rate.begin(), rate.end()}, model.V);
  if (!whole.modal) return;
  const int b = whole.bodies.front();
  const PlannedBody& body = plan_.bodies[b];
  auto more = modal_rows(
      whole, body,
      [&](int node) { return node_axes(b, slots_[b].nodes->of_local_node(node), body.structure.mesh.positions[node]); },
      terms_);
  layout.gather(model.V, v);
  const Eigen::VectorXd rates = begin_modal(whole, more, q, v, coordinates_.comm());
  std::vector<int> y(static_cast<std::size_t>(rates.size()));
  std::iota(y.begin(), y.end(), whole.modal->y);
  set_shared(y, {rates.begin(), rates.end()}, model.V);
  for (auto& term : more) terms_.push_back(std::move(term));
}

void PlanarAssembly::set_shared(const std::vector<int>& local, const std::vector<double>& values, Vec into) const {
  for (std::size_t i = 0; i < local.size() && owner_; ++i)
    check(VecSetValue(into, coordinates_.global()[local[i]], values[i], INSERT_VALUES));
  check(VecAssemblyBegin(into));
  check(VecAssemblyEnd(into));
}

}  // namespace floe::assembly
