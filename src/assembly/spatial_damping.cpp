#include <algorithm>

#include "floe/dynamics/damping.h"
#include "floe/dynamics/spatial_body.h"
#include "floe/math/rotation.h"
#include "full_order_modes.h"
#include "spatial_assembly.h"

// damping.mass of spatial bodies in several frames; damping.mass and damping.modal of corotational ones.
namespace floe::assembly {

using dynamics::MovingAxes;
using dynamics::RelativeDamping;
using petsc::check;

namespace {

std::unique_ptr<dynamics::SpatialBody> mass_of(const MovingAxes& axes, const std::vector<int>& elastic,
                                               const body::Inertia& inertia) {
  std::vector<int> coordinates = axes.coordinates();
  coordinates.insert(coordinates.end(), elastic.begin(), elastic.end());
  const auto k = static_cast<Eigen::Index>(elastic.size());
  return std::make_unique<dynamics::SpatialBody>(
      coordinates, axes.attitude, body::spatial(inertia),
      body::Elasticity{Eigen::MatrixXd::Zero(k, k), Eigen::MatrixXd(0, k), {}});
}

}  // namespace

void SpatialAssembly::add_damping_axes() {
  std::vector<bool> still;
  for (const Slot& slot : slots_) still.push_back(slot.still);
  damped_ = damped_wholes(plan_, formulation_ == Formulation::cfr, still);
  for (DampedWhole& whole : damped_) {
    if (whole.fixed) continue;
    const Body& spec = plan_.bodies[whole.bodies.front()].spec;
    coordinates_.belongs_to("damping of body " + spec.name);
    add_axes(whole);
    const Point& r = spec.initial.rotation;
    axes_attitudes_.back().second->base = math::quaternion({r[0], r[1], r[2]});
    if (!corotated(whole.bodies.front()) || !has_modal_damping(spec)) continue;
    whole.modal = full_order_modal_damping(plan_, whole.bodies.front(), {}, coordinates_);
    whole.alpha = std::max(whole.alpha, min_mass_damping(*whole.modal));
  }
}

std::vector<CarriedMass> SpatialAssembly::add_masses(const DampedWhole& whole, int b) {
  const PlannedBody& body = plan_.bodies[b];
  const Slot& slot = slots_[b];
  std::vector<CarriedMass> all;
  const auto add = [&](const MovingAxes& axes, const std::vector<int>& elastic, const body::Inertia& in,
                       const Eigen::Vector3d& x) {
    if (slot.still) {
      if (!elastic.empty())
        terms_.push_back(
            std::make_unique<dynamics::LinearDamping>(elastic, whole.alpha * (in.M[0][0] + in.M[1][1] + in.M[2][2])));
      return;
    }
    terms_.push_back(std::make_unique<RelativeDamping>(mass_of(axes, elastic, in), std::vector<MovingAxes>{axes},
                                                       whole.axes(), whole.alpha));
    all.push_back({axes, elastic, in, body.origin + body.axes * x, body.axes});
  };
  if (slot.corotated) {
    for (const CarriedMass& mass : corotated_masses(b))
      add(mass.axes, {}, mass.inertia, body.axes.transpose() * (mass.X - body.origin));
    return all;
  }
  const MovingAxes frame{slot.frame, slot.frame + 3, slot.attitude};
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  if (compact(b)) {
    std::vector<int> elastic;
    for (int i = 0; i < reduced_[b].body.coordinates(); ++i) elastic.push_back(slot.elastic + i);
    if (owner_) add(frame, elastic, reduced_[b].body.inertia, none);
    return all;
  }
  for (const fem::Mesh::Cell& cell : body.structure.mesh.cells) {
    const reference::FreeDofs free = reference::free_dofs(body.structure, constrained(b), cell, *slot.nodes);
    add(frame, free.coordinates, fem::inertia(body.structure.maps(cell), free.V), none);
  }
  return all;
}

std::vector<ConstrainedPlace> SpatialAssembly::constrained_places(const WholeAxes& whole, int b) {
  const PlannedBody& body = plan_.bodies[b];
  const Slot& slot = slots_[b];
  std::map<PetscInt, std::vector<int>> of_node;
  for (PetscInt dof : whole.constrained[whole.place_in(b)]) of_node[dof / 6].push_back(static_cast<int>(dof % 6));
  std::vector<ConstrainedPlace> all;
  for (const auto& [node, dofs] : of_node) {
    ConstrainedPlace place;
    place.axes = {slot.frame, slot.frame + 3, slot.attitude};
    place.x.setZero(), place.dofs = dofs, place.X = body.origin, place.A0 = body.axes;
    if (compact(b)) {
      Anchor at;
      at.body = b, at.node = node;
      const body::PlaceMap map = place_map(plan_, reduced_[b], at);
      for (Eigen::Index i = 0; i < map.S.cols(); ++i) place.elastic.push_back(slot.elastic + static_cast<int>(i));
      place.x = map.x, place.S = map.S, place.psi = map.psi;
      if (owner_) all.push_back(std::move(place));
      continue;
    }
    const PetscInt local = node - body.structure.mesh.first_node;
    if (local < 0 || local >= body.structure.mesh.owned_nodes) continue;
    place.x = body.structure.mesh.positions[local];
    place.S.setZero(3, slot.corotated ? 0 : 6), place.psi = place.S;
    if (slot.corotated) {
      const dynamics::SpatialMarker at = slot.corotated->place(node);
      place.axes = {at.coordinates[0], at.coordinates[3], at.attitude};
      place.X += body.axes * place.x;
      place.x.setZero();
    }
    for (int d = 0; d < 6 && !slot.corotated; ++d) {
      place.elastic.push_back(slot.nodes->of_local_node(static_cast<int>(local)) + d);
      if (!std::binary_search(constrained(b).begin(), constrained(b).end(), 6 * node + d))
        (d < 3 ? place.S(d, d) : place.psi(d - 3, d)) = 1;
    }
    all.push_back(std::move(place));
  }
  return all;
}

void SpatialAssembly::add_damping(const DampedWhole& whole, Model& model) {
  auto rows = conditions(
      whole, 6, [&](int b) { return add_masses(whole, b); }, [&](int b) { return constrained_places(whole, b); });
  if (whole.fixed) return;
  const dynamics::System layout(coordinates_, {});
  Eigen::VectorXd v;
  layout.gather(model.V, v);
  begin_at(rows, start_);
  set_shared(whole.f.position, rates_of(whole, rows, start_, v, coordinates_.comm()), model.V);
  if (whole.modal) {
    const int b = whole.bodies.front();
    const PlannedBody& body = plan_.bodies[b];
    auto more = modal_rows(
        whole, body,
        [&](int node) {
          const dynamics::SpatialMarker at = slots_[b].corotated->place(body.structure.mesh.first_node + node);
          return MovingAxes{at.coordinates[0], at.coordinates[3], at.attitude};
        },
        terms_);
    layout.gather(model.V, v);
    set_shared(whole.modal->y, begin_modal(whole, more, start_, v, coordinates_.comm()), model.V);
    for (auto& term : more) terms_.push_back(std::move(term));
  }
  for (auto& term : rows) terms_.push_back(std::move(term));
}

}  // namespace floe::assembly
