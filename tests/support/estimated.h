#pragma once
#include "floe/assess/estimate.h"
#include "scene_motion.h"

namespace floe::test {

/// A reduced motion with the estimate of its error.
struct Estimated {
  History history;
  assess::Estimate estimate;
};

inline Estimated move_and_estimate(const std::string& text, Formulation formulation, double seconds = 100) {
  const scene::Scene scene = scene::parse_scene(text, "scene");
  Estimated all{{assembly::build(scene, formulation, PETSC_COMM_WORLD, true), {}, {}, {}, {}}, {}};
  const scene::Motion& motion = scene.motion;
  const assembly::Model& model = all.history.model;
  assess::KeptMotion kept(model);
  solve::Integration how{motion.end, motion.step, motion.spectral_radius, motion.tolerance};
  how.kinks = assembly::kinks_of(scene, motion.end);
  all.history.report = solve::simulate(*model.system, how, model.U, model.V, [&](const solve::Instant& at) {
    store(all.history, at.t, at.U, at.V);
    kept.keep(at);
  });
  all.estimate = assess::estimate_error(model, kept, seconds);
  return all;
}

/// Relative error of a probe as a vector, as `floe compare` shows it and the estimate means it.
inline double vector_error(const History& a, const History& b, const std::string& probe) {
  double difference = 0, size = 0;
  for (const auto& [name, values] : a.columns) {
    if (name.substr(0, name.rfind('.')) != probe) continue;
    for (std::size_t i = 0; i < a.t.size(); ++i) {
      const double reference = b.at(name, a.t[i]);
      difference += std::pow(values[i] - reference, 2);
      size += reference * reference;
    }
  }
  return std::sqrt(difference / size);
}

}  // namespace floe::test
