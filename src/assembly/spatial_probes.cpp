#include <numeric>

#include "floe/math/rotation.h"
#include "floe/scene/places.h"
#include "floe/scene/sensors.h"
#include "probe_sources.h"
#include "spatial_assembly.h"

namespace floe::assembly {

using dynamics::SpatialMarker;
using Eigen::Vector3d;

namespace {

Vector3d vector(const Point& p) { return {p[0], p[1], p[2]}; }

/// Of a part of a split body, in mesh axes.
struct MassCentre {
  Vector3d at;
  double mass;              ///< [kg], of lines relative to the others
  Eigen::Matrix3d moments;  ///< second ones, about it, over the mass [m2]
};

MassCentre mass_centre_of_piece(const PlannedBody& part, const body::Inertia& mass) {
  return {part.origin + part.axes * mass.s0 / mass.m, mass.m,
          part.axes * (mass.C0 / mass.m - mass.s0 * mass.s0.transpose() / (mass.m * mass.m)) * part.axes.transpose()};
}

MassCentre mass_centre(const Body& part) {
  const Vector3d a = vector(part.mesh.points[part.mesh.segments[0][0]]),
                 b = vector(part.mesh.points[part.mesh.segments[0][1]]), along = (b - a).normalized();
  MassCentre centre{(a + b) / 2, 1, (b - a) * (b - a).transpose() / 12};  // parts of one length
  const auto* beam = std::get_if<fem::SpatialBeam>(&part.parts.front().section);
  if (!beam || beam->section.rhoA == 0) return centre;
  const Vector3d z = along.cross(beam->orientation).normalized();
  centre.at += beam->section.centroid[0] * z.cross(along) + beam->section.centroid[1] * z;
  centre.moments += (beam->section.rhoIy + beam->section.rhoIz) / (2 * beam->section.rhoA) * along * along.transpose();
  return centre;
}

/// Axes of a joint that its force is given in, at the start. @param W  Plan::joint_axes  @param mesh  the axes of the
/// mesh
Eigen::Matrix3d axes_along(const Joint& joint, const Eigen::Matrix3d& W, const Eigen::Matrix3d& mesh) {
  using Kind = Joint::Kind;
  switch (joint.kind) {
    case Kind::universal:
    case Kind::bushing:
      return W;
    case Kind::fixed:
    case Kind::spherical:
    case Kind::distance:
    case Kind::support:
      return mesh;
    default:
      break;
  }
  if (joint.kind == Kind::spring && !joint.axis_given) return mesh;
  Eigen::Matrix3d axes;
  axes.col(2) = W.col(2);
  const Eigen::Index first = mesh.col(0).cross(W.col(2)).norm() > 1e-6 ? 0 : 1;
  axes.col(1) = W.col(2).cross(mesh.col(first)).normalized();
  axes.col(0) = axes.col(1).cross(W.col(2));
  return axes;
}

}  // namespace

SpatialMarker SpatialAssembly::axes_of_joint(int j) {
  const Joint& joint = plan_.scene.joints[j];
  const Anchor& place = plan_.joints[j][joint.first.ground() ? 1 : 0];
  SpatialMarker at = marker(place);
  if (!sees_) return at;
  const PlannedBody& body = plan_.bodies[place.body];
  at.D0 = at.D0 * start_of(at).D.transpose() *
          axes_along(joint, plan_.joint_axes[j], body.attitude * body.axes.transpose());
  return at;
}

SpatialFrameByPlaces SpatialAssembly::whole_frame(const std::vector<Anchor>& places, const Anchor& probe) {
  const auto in_mesh_axes = [&](const Anchor& place) {
    return Vector3d(plan_.bodies[place.body].origin + plan_.bodies[place.body].axes * place.x);
  };
  SpatialFrameByPlaces frame{plan_.bodies[probe.body].frame.kind, {}, {}};
  Vector3d origin = Vector3d::Zero();
  for (const Anchor& place : places) {
    const PlannedBody& part = plan_.bodies[place.body];
    SpatialMarker at = marker(place);
    at.D0 = part.axes.transpose();
    frame.undeformed.push_back(in_mesh_axes(place));
    if (frame.kind == FrameKind::mean_axis) {
      const MassCentre centre =
          part.spec.mesh.piece ? mass_centre_of_piece(part, rigid(part).body.inertia) : mass_centre(part.spec);
      frame.undeformed.back() = centre.at;
      frame.masses.push_back(centre.mass), frame.moments.push_back(centre.mass * centre.moments);
      at.x0 = part.axes.transpose() * (centre.at - part.origin);
      at.S = at.psi = Eigen::Matrix3Xd::Zero(3, 0);
      at.coordinates.resize(std::min<std::size_t>(at.coordinates.size(), 6));
      origin += centre.mass * centre.at;
    }
    frame.places.push_back(std::move(at));
  }
  if (frame.kind != FrameKind::mean_axis) origin = frame.undeformed.front();
  if (frame.kind == FrameKind::mean_axis) origin /= std::accumulate(frame.masses.begin(), frame.masses.end(), 0.);
  frame.of_probe = in_mesh_axes(probe) - origin;
  return frame;
}

void SpatialAssembly::add_probes(Model& model) {
  for (std::size_t p = 0; p < plan_.probes.size(); ++p) {
    const Probe& spec = plan_.scene.probes[p];
    const Anchor place = has_place(spec) ? plan_.probes[p][0] : Anchor{};
    SpatialProbe probe{marker(place), {}};
    DrivenCoordinate drive;
    if (spec.quantity == Probe::Quantity::drive || spec.quantity == Probe::Quantity::power) {
      const std::size_t j = joint_index(plan_.scene, spec.joint);
      drive = driven_coordinate(plan_, j, spec);
      probe.other = placed_[j].places[0], probe.marker = placed_[j].places[1];
      if (owner_) probe.other->D0 = probe.other->D0 * start_of(*probe.other).D.transpose();
    }
    const int b = place.body;
    const std::vector<Anchor> whole = places_of_frame(p);
    if (spec.quantity == Probe::Quantity::deflection && b >= 0 && compact(b) && whole.empty())
      if (probe.marker.S.size() == 0 ||
          probe.marker.S.cwiseAbs().maxCoeff() * std::sqrt(reduced_[b].body.inertia.m) < 1e-9)
        model.warnings.push_back(never_deflects(spec, plan_.bodies[b].spec));
    if (b >= 0) probe.mesh = plan_.bodies[b].axes;
    if (!whole.empty()) probe.frame = whole_frame(whole, place);
    if (spec.relative_to) probe.relative_to = marker(plan_.probes[p][1]);
    if (sees_) {
      for (SpatialMarker* at : {&probe.marker, probe.relative_to ? &*probe.relative_to : nullptr})
        if (at) at->D0 = at->D0 * start_of(*at).D.transpose();
      probe.start = start_of(probe.marker).p;
      if (probe.relative_to) probe.start -= start_of(*probe.relative_to).p;
    }
    if (spec.quantity == Probe::Quantity::deflection && b >= 0 && corotated(b) && whole.empty()) {
      const dynamics::MovingAxes& f = body_axes_.at(b).f;
      probe.relative_to.emplace().coordinates = f.coordinates();
      probe.relative_to->attitude = f.attitude;
      probe.undeformed = plan_.bodies[b].origin + plan_.bodies[b].axes * place.x;
    }
    if (spec.joint_axes) probe.relative_to = axes_of_joint(static_cast<int>(joint_index(plan_.scene, spec.joint)));
    if (spec.of_section()) probe.marker.D0.setIdentity();  // the body's axes, as the place rotates
    model.probes.push_back({spec.name,
                            spec.quantity,
                            {},
                            {},
                            Vector3d::Zero(),
                            Vector3d::Zero(),
                            std::move(probe),
                            measured(connections_, plan_.scene, spec),
                            {},
                            spec.unit});
    model.probes.back().drive = drive;
    model.probes.back().terms = terms_of_body(body_terms_, plan_, spec.body);
    if (spec.of_shell()) model.probes.back().shell = shell_point(p);
  }
}

}  // namespace floe::assembly
