#include <fmt/format.h>

#include <cmath>

#include "validity_seen.h"

namespace floe::assess {
namespace {

/// What drives bodies by formulas of t.
struct Excitation {
  std::string name;  ///< of a load, or the scene's key
  std::string words;
  std::string body;  ///< empty: all
  std::vector<math::Formula> formulas;
};

std::vector<Excitation> excitations(const Scene& scene) {
  std::vector<Excitation> all;
  for (const Load& load : scene.loads) {
    Excitation one{load.name, "load " + load.name, load.spread() ? load.body : load.at.body, {}};
    for (const math::Formula* formula : load.formulas())
      if (!formula->has_sensors()) one.formulas.push_back(*formula);
    all.push_back(std::move(one));
  }
  const auto& g = scene.gravity;
  const auto& a = scene.ground_acceleration;
  all.push_back({"gravity", "gravity", "", {g.begin(), g.end()}});
  all.push_back({"ground.acceleration", "ground.acceleration", "", {a.begin(), a.end()}});
  return all;
}

struct LoadRate {
  Excitation of;
  double omega = 0;  ///< rms rate over rms value
};

/// Those that are something. A formula without a finite rate between the steps has none that can be judged.
std::vector<LoadRate> rates_of_loads(const Scene& scene) {
  constexpr int points = 2000;
  std::vector<LoadRate> all;
  for (Excitation& one : excitations(scene)) {
    double rate = 0, size = 0;
    try {
      for (const math::Formula& formula : one.formulas)
        for (int i = 0; i < points && !formula.constant(); ++i) {
          const double t = scene.motion.end * (i + 0.5) / points;
          rate += std::pow(formula.derivative(t), 2), size += std::pow(formula(t), 2);
        }
    } catch (const math::FormulaError&) {
      continue;
    }
    for (const math::Formula& formula : one.formulas)
      if (formula.constant()) size += points * std::pow(formula(), 2);
    if (rate > 0 && std::isfinite(rate / size)) all.push_back({std::move(one), std::sqrt(rate / size)});
  }
  return all;
}

}  // namespace

void judge_loads(const Scene& scene, const Model& model, std::vector<OutOfRange>& out) {
  for (const LoadRate& load : rates_of_loads(scene))
    for (const BodyReport& body : model.bodies) {
      if ((!load.of.body.empty() && body.name != load.of.body) || body.omega.empty() || body.rigid) continue;
      const double share = load.omega / body.omega.back();
      if (share > 0.5)
        out.push_back({"load", load.of.name, share, 0.5,
                       fmt::format("{}: changes at {:.3g} rad/s, {:.2g} of the highest kept frequency of body {} "
                                   "(limit 0.5); use more modes",
                                   load.of.words, load.omega, share, body.name)});
    }
}

void judge_step(const Scene& scene, const Model& model, const std::vector<Seen>& seen, std::vector<OutOfRange>& out) {
  if (scene.motion.tolerance) return;
  double fastest = 0;
  std::string of;
  for (std::size_t b = 0; b < seen.size(); ++b)
    if (seen[b].size > 0 && std::sqrt(seen[b].rate / seen[b].size) > fastest)
      fastest = std::sqrt(seen[b].rate / seen[b].size), of = "deformations of body " + model.bodies[b].name;
  for (const LoadRate& load : rates_of_loads(scene))
    if (load.omega > fastest) fastest = load.omega, of = load.of.words;
  const double rotation = scene.motion.step * fastest;
  if (rotation > 0.25)
    out.push_back(
        {"step", of, rotation, 0.25,
         fmt::format(
             "motion.step {:.3g} s: only {:.2g} steps per period of the {}, {:.3g} s (limit 25); use at most {:.2g} s",
             scene.motion.step, 2 * M_PI / rotation, of, 2 * M_PI / fastest, 0.25 / fastest)});
}

}  // namespace floe::assess
