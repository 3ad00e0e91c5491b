#include <cmath>

#include "floe/scene/places.h"
#include "planar_assembly.h"

namespace floe::assembly {

void PlanarAssembly::add_probes(Model& model, const Eigen::VectorXd& q) {
  for (std::size_t p = 0; p < plan_.probes.size(); ++p) {
    const Probe& spec = plan_.scene.probes[p];
    const Anchor& place = plan_.probes[p][0];
    ModelProbe probe{spec.name, spec.quantity, marker(place), {}, {}, {}, Eigen::Vector3d::Zero()};
    if (spec.quantity == Probe::Quantity::deflection && place.body >= 0 && !compact(place.body) &&
        formulation_ == Formulation::cfr) {
      const PlannedBody& body = plan_.bodies[place.body];
      if (body.frame.kind == fem::ReferenceFrame::Kind::mean_axis)
        throw InputError(spec.where.text() +
                         ": deflection relative to a mean-axis frame is not available in formulation cfr");
      for (const Anchor& node : body.frame_places) probe.frame.push_back(marker({place.body, node.node, node.x}));
    }
    if (spec.quantity == Probe::Quantity::deflection && place.body >= 0 && compact(place.body))
      if (probe.marker.S.size() == 0 ||
          probe.marker.S.cwiseAbs().maxCoeff() * std::sqrt(reduced_[place.body].body.inertia.m) < 1e-9)
        model.warnings.push_back(never_deflects(spec, plan_.bodies[place.body].spec));
    if (spec.relative_to) probe.relative_to = marker(plan_.probes[p][1]);
    if (owner_) {
      probe.start = pose_at(probe.marker, q);
      if (probe.relative_to) probe.start_relative = pose_at(*probe.relative_to, q);
    }
    model.probes.push_back(std::move(probe));
  }
}

}  // namespace floe::assembly
