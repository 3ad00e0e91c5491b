#include <cmath>

#include "floe/scene/places.h"
#include "planar_assembly.h"

namespace floe::assembly {

Eigen::Vector2d PlanarAssembly::in_mesh_axes(const Anchor& place) const {
  const PlannedBody& body = plan_.bodies[place.body];
  return body.frame_origin + turn(body.frame_angle) * place.x.head<2>();
}

void PlanarAssembly::add_probes(Model& model, const Eigen::VectorXd& q) {
  for (std::size_t p = 0; p < plan_.probes.size(); ++p) {
    const Probe& spec = plan_.scene.probes[p];
    const Anchor place = spec.quantity == Probe::Quantity::formula ? Anchor{} : plan_.probes[p][0];
    ModelProbe probe{spec.name, spec.quantity, marker(place), {}, {}, {}, Eigen::Vector3d::Zero()};
    const std::vector<Anchor>& chord = plan_.chords[p];
    for (const Anchor& node : chord) probe.frame.push_back(marker(node));
    if (!chord.empty()) {
      const Eigen::Vector2d from = in_mesh_axes(chord[0]), along = in_mesh_axes(chord[1]) - from;
      probe.at_rest = turn(-std::atan2(along.y(), along.x())) * (in_mesh_axes(place) - from);
    }
    if (spec.quantity == Probe::Quantity::deflection && place.body >= 0 && !compact(place.body) &&
        formulation_ == Formulation::cfr && chord.empty()) {
      const PlannedBody& body = plan_.bodies[place.body];
      if (body.frame.kind == fem::ReferenceFrame::Kind::mean_axis)
        throw InputError(spec.where.text() +
                         ": deflection relative to a mean-axis frame is not available in formulation cfr");
      for (const Anchor& node : body.frame_places) probe.frame.push_back(marker({place.body, node.node, node.x}));
      probe.at_rest = turn(-probe.frame[0].angle0) * (probe.marker.x - probe.frame[0].x);
    }
    if (spec.quantity == Probe::Quantity::deflection && place.body >= 0 && compact(place.body) && chord.empty())
      if (probe.marker.S.size() == 0 ||
          probe.marker.S.cwiseAbs().maxCoeff() * std::sqrt(reduced_[place.body].body.inertia.m) < 1e-9)
        model.warnings.push_back(never_deflects(spec, plan_.bodies[place.body].spec));
    probe.unit = spec.unit;
    probe.connections = measured(connections_, plan_.scene, spec);
    if (spec.relative_to) probe.relative_to = marker(plan_.probes[p][1]);
    if (owner_) {
      probe.start = pose_at(probe.marker, q);
      if (probe.relative_to) probe.start_relative = pose_at(*probe.relative_to, q);
    }
    model.probes.push_back(std::move(probe));
  }
}

}  // namespace floe::assembly
