#include "planar_assembly.h"

namespace floe::assembly {

using dynamics::Marker;

void PlanarAssembly::add_load(std::size_t l, const BodyPart* part) {
  const Load& load = plan_.scene.loads[l];
  const auto formulas = state_formulas_.find(l);
  if (!load.joint.empty() || (load.has_sensors() && formulas == state_formulas_.end())) return;  // add_state_loads
  const auto of_value = [&](const std::function<Eigen::Vector3d(double)>& value) { return load_terms(l, value, part); };
  for (auto& term : terms_of_load(load, load.has_sensors() ? formulas->second : StateFormulas{}, of_value)) {
    if (!load.spread()) load_terms_.emplace(l, term.get());
    terms_.push_back(std::move(term));
  }
}

std::vector<std::unique_ptr<dynamics::Term>> PlanarAssembly::load_terms(
    std::size_t l, const std::function<Eigen::Vector3d(double)>& value, const BodyPart* part) {
  using dynamics::Force;
  const Load& load = plan_.scene.loads[l];
  const Anchor& place = plan_.loads[l];
  const Force::Axes axes = load.axes == Load::Axes::body    ? Force::Axes::body
                           : load.axes == Load::Axes::place ? Force::Axes::place
                                                            : Force::Axes::world;
  const reference::CellsOfPart cells = part ? &part->cells : nullptr;
  std::vector<Marker> markers;
  if (load.kind != Load::Kind::distributed) {
    Marker at = marker(place);
    if (owner_) markers.push_back(std::move(at));
  } else if (compact(place.body)) {
    if (owner_) markers.push_back(density(place.body, part ? part->masses.line : reduced_[place.body].body.line));
  } else if (formulation_ != Formulation::cfr) {
    markers = reference::density_markers(plan_.bodies[place.body].structure, plan_.bodies[place.body].frame.conditions,
                                         *slots_[place.body].nodes, slots_[place.body].frame, reference::Density::line,
                                         cells);
  } else {
    markers =
        reference::corotational_line_markers(plan_.bodies[place.body].structure, *slots_[place.body].nodes, cells);
  }
  std::vector<std::unique_ptr<dynamics::Term>> terms;
  const auto body_axes = body_axes_.find(place.body);
  const bool moment = load.kind == Load::Kind::moment;
  const bool other = axes == Force::Axes::body && body_axes != body_axes_.end();
  for (Marker& at : markers) {
    // Axes of body and place are those of the mesh where they are not rotated.
    const double tilt = axes == Force::Axes::world || other ? 0 : -plan_.bodies[place.body].frame_angle;
    const Eigen::Matrix2d A = rotation_matrix(tilt);
    const auto force = [value, A, moment](double t) {
      const Eigen::Vector3d f = value(t);
      if (moment) return Eigen::Vector3d(0, 0, f[2]);
      return Eigen::Vector3d(A(0, 0) * f[0] + A(0, 1) * f[1], A(1, 0) * f[0] + A(1, 1) * f[1], 0);
    };
    terms.push_back(other ? std::make_unique<Force>(std::move(at), force, body_axes->second.f)
                          : std::make_unique<Force>(std::move(at), force, axes));
  }
  return terms;
}

}  // namespace floe::assembly
