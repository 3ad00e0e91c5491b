#include <algorithm>
#include <cmath>
#include <iterator>

#include "floe/dynamics/fixed_frame_body.h"
#include "floe/dynamics/spatial_force.h"
#include "floe/math/rotation.h"
#include "floe/plan/weight.h"
#include "spatial_assembly.h"

namespace floe::assembly {

using dynamics::SpatialForce;
using dynamics::SpatialMarker;
using dynamics::SpatialPose;
using dynamics::Wrench;
using reference::Density;

SpatialMarker SpatialAssembly::marker(const Anchor& place) {
  if (place.ground()) return SpatialMarker::ground(place.x);
  const PlannedBody& body = plan_.bodies[place.body];
  const Slot& slot = slots_[place.body];
  SpatialMarker at;
  if (slot.corotated && !sees_) return SpatialMarker::ground(Eigen::Vector3d::Zero());
  if (slot.corotated) {
    const MeanAxes* mean = find_mean(place);
    if (!mean) return corotated_parts(place).front().first;
    at.coordinates = mean->axes.f.coordinates();
    at.attitude = mean->axes.f.attitude;
    return at;
  }
  at.attitude = slot.attitude;
  at.origin = body.place;
  at.axes = body.attitude;
  at.x0 = place.x;
  if (compact(place.body)) {
    at.coordinates = coordinates_of(place.body);
    if (plan_.bodies[place.body].spec.rigid) return at;
    const body::PlaceMap map = place_map(plan_, reduced_[place.body], place);
    at.x0 = map.x;
    at.S = map.S, at.psi = map.psi, at.H = map.H;
    if (place.rigid_arm())
      at.arm = place.averaging_weights.front().lead;
    else
      at.Q = map.Q, at.Q.factor();
    return at;
  }
  if (!sees_) return SpatialMarker::ground(Eigen::Vector3d::Zero());  // its term lives on the last rank
  const Eigen::Index n = static_cast<Eigen::Index>(place.averaging_weights.size());
  for (int i = 0; i < 6 && !slot.still; ++i) at.coordinates.push_back(slot.frame + i);
  at.S = at.psi = Eigen::Matrix3Xd::Zero(3, 6 * n), at.H = place.H;
  const auto holds = [&](PetscInt dof) {
    return std::binary_search(constrained(place.body).begin(), constrained(place.body).end(), dof);
  };
  std::vector<Eigen::MatrixXd> Q;
  for (Eigen::Index i = 0; i < n; ++i) {
    const AveragingWeight& weight = place.averaging_weights[i];
    for (int d = 0; d < 6; ++d) {
      at.coordinates.push_back(slot.nodes->of_node(weight.node) + d);
      if (holds(6 * weight.node + d)) continue;
      if (d < 3) {
        at.S(d, 6 * i + d) = weight.share;
        at.psi.col(6 * i + d) = weight.turn.col(d);
        continue;
      }
      at.psi.col(6 * i + d) = weight.rotation.col(d - 3);
      at.S.col(6 * i + d) = weight.arm.col(d - 3);
    }
    if (place.rigid_arm()) at.arm = weight.lead;
    if (place.rigid_arm() || weight.lead.isZero(0)) continue;
    if (Q.empty()) Q.assign(3, Eigen::MatrixXd::Zero(6 * n, 6 * n));
    Eigen::Matrix3d free = Eigen::Matrix3d::Identity();
    for (int d = 0; d < 3; ++d) free(d, d) = holds(6 * weight.node + 3 + d) ? 0 : 1;
    for (int a = 0; a < 3; ++a)
      Q[a].block<3, 3>(6 * i + 3, 6 * i + 3) = free * math::arm_form(Eigen::Vector3d::Unit(a), weight.lead) * free;
  }
  at.Q = std::move(Q);
  return at;
}

SpatialPose SpatialAssembly::start_of(const SpatialMarker& marker) const {
  const Eigen::Index n = static_cast<Eigen::Index>(marker.coordinates.size());
  Eigen::VectorXd q(n), none = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) q[i] = start_[marker.coordinates[i]];
  SpatialPose at;
  dynamics::pose(marker, q, none, none, at);
  return at;
}

SpatialMarker SpatialAssembly::density_marker(int b, const body::Inertia& inertia) const {
  SpatialMarker marker;
  marker.attitude = slots_[b].attitude;
  marker.coordinates = coordinates_of(b);
  marker.mass = inertia.m;
  marker.x0 = inertia.s0;
  marker.S = inertia.S, marker.Q = inertia.Q, marker.Q.factor();
  marker.psi = Eigen::Matrix3Xd::Zero(3, inertia.S.cols());
  return marker;
}

/// A force density, in world axes or in those of the body.
std::vector<std::unique_ptr<dynamics::Term>> SpatialAssembly::density_terms(
    int b, Density density, const std::function<Eigen::Vector3d(double)>& force, bool of_body, bool conservative,
    const BodyPart* part) {
  std::vector<std::unique_ptr<dynamics::Term>> terms;
  const reference::CellsOfPart cells = part ? &part->cells : nullptr;
  const PlannedBody& body = plan_.bodies[b];
  if (slots_[b].still) {
    const Eigen::Matrix3d A = of_body ? body.axes.transpose() : body.attitude.transpose();
    const auto add = [&](std::vector<int> coordinates, const body::Inertia& inertia) {
      auto term = std::make_unique<dynamics::DeadForce>(
          std::move(coordinates), inertia.S, [A, force](double t) -> Eigen::VectorXd { return A * force(t); },
          inertia.Q);
      term->conservative = conservative;
      terms.push_back(std::move(term));
    };
    if (compact(b)) {
      const body::FlexibleBody& reduced = reduced_[b].body;
      if (owner_ && reduced.coordinates() > 0)
        add(coordinates_of(b), density == Density::mass ? reduced.inertia : reduced.line);
      return terms;
    }
    for (std::size_t c = 0; c < body.structure.mesh.cells.size(); ++c) {
      const fem::Mesh::Cell& cell = body.structure.mesh.cells[c];
      if (!reference::counts(cells, c)) continue;
      const reference::FreeDofs free = reference::free_dofs(body.structure, constrained(b), cell, *slots_[b].nodes);
      if (free.coordinates.empty()) continue;
      add(free.coordinates, reference::density_inertia(body.structure, cell, density, free.V));
    }
    return terms;
  }
  std::vector<SpatialMarker> markers;
  if (slots_[b].corotated)
    markers = slots_[b].corotated->density(density, cells);
  else if (!compact(b))
    markers = reference::spatial_density_markers(body.structure, constrained(b), *slots_[b].nodes, frame_of(b), density,
                                                 cells);
  else if (owner_ && part)
    markers.push_back(density_marker(b, density == Density::mass ? part->masses.mass : part->masses.line));
  else if (owner_)
    markers.push_back(density_marker(b, density == Density::mass ? reduced_[b].body.inertia : reduced_[b].body.line));
  const bool other = of_body && slots_[b].corotated;
  const Eigen::Matrix3d A = of_body && !other ? Eigen::Matrix3d(body.axes.transpose()) : Eigen::Matrix3d::Identity();
  const auto wrench = [A, force](double t) {
    Wrench w = Wrench::Zero();
    w.head<3>() = A * force(t);
    return w;
  };
  for (SpatialMarker& marker : markers) {
    auto term = other ? std::make_unique<SpatialForce>(std::move(marker), wrench, body_axes_.at(b).f)
                      : std::make_unique<SpatialForce>(std::move(marker), wrench,
                                                       of_body ? SpatialForce::Axes::body : SpatialForce::Axes::world);
    term->conservative = conservative;
    terms.push_back(std::move(term));
  }
  return terms;
}

void SpatialAssembly::add_gravity(int b, const BodyPart* part) {
  const Weight weight(plan_.scene);
  if (weight.none()) return;
  const auto fixed = [g = weight(0)](double) { return g; };
  std::ranges::move(weight.constant() ? density_terms(b, Density::mass, fixed, false, true, part)
                                      : density_terms(b, Density::mass, weight, false, false, part),
                    std::back_inserter(terms_));
}

void SpatialAssembly::add_load(std::size_t l, const BodyPart* part) {
  const Load& load = plan_.scene.loads[l];
  const auto formulas = state_formulas_.find(l);
  if (!load.joint.empty() || (load.has_sensors() && formulas == state_formulas_.end())) return;  // add_state_loads
  const auto of_value = [&](const std::function<Eigen::Vector3d(double)>& value) { return load_terms(l, value, part); };
  for (auto& term : terms_of_load(load, load.has_sensors() ? formulas->second : StateFormulas{}, of_value)) {
    if (!load.spread()) load_terms_.emplace(l, term.get());
    terms_.push_back(std::move(term));
  }
}

std::vector<std::unique_ptr<dynamics::Term>> SpatialAssembly::load_terms(
    std::size_t l, const std::function<Eigen::Vector3d(double)>& value, const BodyPart* part) {
  const Load& load = plan_.scene.loads[l];
  const int b = plan_.loads[l].body;
  if (load.kind == Load::Kind::pressure)
    return pressure_terms(
        load, b, [value](double t) { return value(t)[0]; }, part);
  if (load.kind == Load::Kind::distributed)
    return density_terms(b, Density::line, value, load.axes == Load::Axes::body, false, part);
  std::vector<std::unique_ptr<dynamics::Term>> terms;
  for (const LoadPart& at : parts_of_load(plan_, l))
    std::ranges::move(load_terms(load, at, value), std::back_inserter(terms));
  return terms;
}

std::vector<std::unique_ptr<dynamics::Term>> SpatialAssembly::load_terms(
    const Load& load, const LoadPart& part, const std::function<Eigen::Vector3d(double)>& value) {
  const Anchor& place = part.at;
  const PlannedBody& body = plan_.bodies[place.body];
  const bool of_body = load.axes == Load::Axes::body, rotations = load.kind == Load::Kind::moment;
  std::vector<std::unique_ptr<dynamics::Term>> terms;
  std::vector<std::pair<SpatialMarker, double>> parts;
  const bool corotated = slots_[place.body].corotated != nullptr, other = of_body && corotated;
  if (corotated && load.axes != Load::Axes::place && !(rotations && find_mean(place))) {
    if (owner_) parts = corotated_parts(place);
  } else if (SpatialMarker at = marker(place); owner_ && !at.coordinates.empty()) {
    parts.emplace_back(std::move(at), 1.);
  }
  for (auto& [at, share] : parts) {
    const Eigen::Matrix3d A =
        part.size * (rotations ? share : 1.) *
        (of_body && !other ? Eigen::Matrix3d(body.axes.transpose()) : Eigen::Matrix3d::Identity());
    at.D0 = body.axes.transpose();  // axes of a place are those of the mesh, carried by its nodes
    const auto wrench = [A, value, first = rotations ? 3 : 0](double t) {
      Wrench w = Wrench::Zero();
      w.segment<3>(first) = A * value(t);
      return w;
    };
    if (other)
      terms.push_back(std::make_unique<SpatialForce>(std::move(at), wrench, body_axes_.at(place.body).f));
    else
      terms.push_back(std::make_unique<SpatialForce>(std::move(at), wrench,
                                                     of_body                          ? SpatialForce::Axes::body
                                                     : load.axes == Load::Axes::place ? SpatialForce::Axes::place
                                                                                      : SpatialForce::Axes::world));
  }
  return terms;
}

}  // namespace floe::assembly
