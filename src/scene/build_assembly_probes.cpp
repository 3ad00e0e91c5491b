#include <cmath>

#include "build_assembly.h"
#include "floe/scene/places.h"

namespace floe::scene {

void Assembly::add_probes(Model& model, const Eigen::VectorXd& q) {
  for (std::size_t p = 0; p < prepared_.probes.size(); ++p) {
    const Probe& spec = prepared_.scene.probes[p];
    const PreparedPlace& place = prepared_.probes[p][0];
    ModelProbe probe{spec.name, spec.quantity, marker(place), {}, {}, {}, Eigen::Vector3d::Zero()};
    if (spec.quantity == Probe::Quantity::deflection && place.body >= 0 && !compact(place.body) &&
        formulation_ == Formulation::cfr) {
      const PreparedBody& body = prepared_.bodies[place.body];
      if (body.frame.kind == fem::ReferenceFrame::Kind::mean_axis)
        throw InputError(spec.where.text() + ": deflection from mean axes is not known in formulation cfr");
      for (const PreparedPlace& node : body.frame_places)
        probe.frame.push_back(marker({place.body, node.node, node.x}));
    }
    if (spec.quantity == Probe::Quantity::deflection && place.body >= 0 && compact(place.body))
      if (probe.marker.S.size() == 0 ||
          probe.marker.S.cwiseAbs().maxCoeff() * std::sqrt(reduced_[place.body].body.inertia.m) < 1e-9)
        model.warnings.push_back(never_deflects(spec, prepared_.bodies[place.body].spec));
    if (spec.relative_to) probe.relative_to = marker(prepared_.probes[p][1]);
    if (owner_) {
      probe.start = pose_at(probe.marker, q);
      if (probe.relative_to) probe.start_relative = pose_at(*probe.relative_to, q);
    }
    model.probes.push_back(std::move(probe));
  }
}

}  // namespace floe::scene
