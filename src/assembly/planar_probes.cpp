#include <cmath>

#include "floe/scene/places.h"
#include "floe/scene/sensors.h"
#include "planar_assembly.h"
#include "probe_sources.h"

namespace floe::assembly {

Eigen::Vector2d PlanarAssembly::in_mesh_axes(const Anchor& place) const {
  const PlannedBody& body = plan_.bodies[place.body];
  return body.frame_origin + rotation_matrix(body.frame_angle) * place.x.head<2>();
}

dynamics::Marker PlanarAssembly::with_mesh_axes(const Anchor& place) {
  dynamics::Marker at = marker(place);
  if (place.body >= 0) at.angle0 -= plan_.bodies[place.body].frame_angle;
  return at;
}

std::optional<FrameByPlaces> PlanarAssembly::frame_of_deflection(std::size_t p) {
  const Anchor& probe = plan_.probes[p][0];
  std::vector<Anchor> places = plan_.probe_frames[p];
  if (plan_.scene.probes[p].quantity != Probe::Quantity::deflection || probe.body < 0) return std::nullopt;
  const PlannedBody& body = plan_.bodies[probe.body];
  const FrameKind kind = body.frame.kind;
  if (places.empty() && (compact(probe.body) || formulation_ != Formulation::cfr)) return std::nullopt;
  if (places.empty() && kind == FrameKind::mean_axis) return std::nullopt;  // body_axes_
  if (places.empty())
    for (const Anchor& node : body.frame_places) places.push_back({probe.body, node.node, node.x});
  FrameByPlaces frame{kind, {}, {}};
  for (const Anchor& place : places) {
    const Body& part = plan_.bodies[place.body].spec;
    dynamics::Marker at = marker(place);
    frame.undeformed.push_back(in_mesh_axes(place));
    if (kind == FrameKind::mean_axis) {  // the mesh of a part is one line of one section
      const auto end = [&](int i) -> Eigen::Vector2d {
        const Point& x = part.mesh.points[part.mesh.segments[0][i]];
        return {x[0], x[1]};
      };
      frame.undeformed.back() = (end(0) + end(1)) / 2;
      frame.gyration = (end(1) - end(0)).squaredNorm() / 12;
      if (part.rotary_inertia && part.section.rhoA > 0) frame.gyration += part.section.rhoI / part.section.rhoA;
      at.x = rotation_matrix(-plan_.bodies[place.body].frame_angle) *
             (frame.undeformed.back() - plan_.bodies[place.body].frame_origin);
      at.S.resize(2, 0), at.psi.resize(0);
      at.coordinates.resize(std::min<std::size_t>(at.coordinates.size(), 3));
    }
    frame.places.push_back(std::move(at));
  }
  Eigen::Vector2d origin = frame.undeformed.front(), along = frame.undeformed.back() - origin;
  if (kind == FrameKind::mean_axis) {
    origin.setZero();
    for (const Eigen::Vector2d& X : frame.undeformed) origin += X / static_cast<double>(places.size());
  }
  if (kind != FrameKind::pinned) along = Eigen::Vector2d::UnitX();  // the axes of the mesh
  frame.of_probe = rotation_matrix(-std::atan2(along.y(), along.x())) * (in_mesh_axes(probe) - origin);
  return frame;
}

dynamics::Marker PlanarAssembly::axes_of_joint(std::size_t j, const Eigen::VectorXd& q) const {
  const Joint& joint = plan_.scene.joints[j];
  const int side = joint.first.ground() ? 1 : 0;
  dynamics::Marker at = joint_places_[j][side];
  if (!sees_) return at;
  if (joint.kind == Joint::Kind::prismatic)
    at.angle0 += std::atan2(joint.axis[1], joint.axis[0]) - pose_at(at, q)[2];
  else
    at.angle0 -= plan_.bodies[plan_.joints[j][side].body].frame_angle;
  return at;
}

void PlanarAssembly::add_probes(Model& model, const Eigen::VectorXd& q) {
  for (std::size_t p = 0; p < plan_.probes.size(); ++p) {
    const Probe& spec = plan_.scene.probes[p];
    const Anchor place = has_place(spec) ? plan_.probes[p][0] : Anchor{};
    ModelProbe probe{spec.name, spec.quantity, marker(place), {}, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    probe.frame = frame_of_deflection(p);
    if (spec.quantity == Probe::Quantity::deflection && place.body >= 0 && compact(place.body) && !probe.frame)
      if (probe.marker.S.size() == 0 ||
          probe.marker.S.cwiseAbs().maxCoeff() * std::sqrt(reduced_[place.body].body.inertia.m) < 1e-9)
        model.warnings.push_back(never_deflects(spec, plan_.bodies[place.body].spec));
    probe.unit = spec.unit;
    probe.terms = terms_of_body(body_terms_, plan_, spec.body);
    if (spec.quantity == Probe::Quantity::drive || spec.quantity == Probe::Quantity::power) {
      const std::size_t j = joint_index(plan_.scene, spec.joint);
      probe.drive = driven_coordinate(plan_, j, spec);
      probe.other = joint_places_[j][0], probe.marker = joint_places_[j][1];
      if (owner_) probe.start_relative = pose_at(*probe.other, q);
    }
    probe.connections = measured(connections_, plan_.scene, spec);
    if (spec.relative_to) probe.relative_to = with_mesh_axes(plan_.probes[p][1]);
    if (spec.joint_axes) probe.relative_to = axes_of_joint(joint_index(plan_.scene, spec.joint), q);
    if (const auto axes = body_axes_.find(place.body);
        spec.quantity == Probe::Quantity::deflection && axes != body_axes_.end() && !probe.frame) {
      probe.relative_to = dynamics::Marker::ground({0, 0});
      probe.relative_to->coordinates = axes->second.f.coordinates();
      probe.relative_to->framed = true;
      probe.undeformed = in_mesh_axes(place);
    }
    if (sees_) {
      probe.start = pose_at(probe.marker, q);
      if (probe.relative_to) probe.start_relative = pose_at(*probe.relative_to, q);
    }
    model.probes.push_back(std::move(probe));
  }
}

}  // namespace floe::assembly
