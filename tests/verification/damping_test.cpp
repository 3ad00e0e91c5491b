#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// L = EI = rhoA = 1, hinged, plucked into its first mode with an amplitude that is linear: omega = pi^2.
History plucked(Formulation formulation, const std::string& damping) {
  return move(fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 16}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    reduction: {modes: 3, derivatives: all}
    damping: {$damping}
    initial: {deformation: [0, "1e-5*sin(pi*x)"]}
joints:
  left: {type: revolute, between: [ground, beam.start]}
  right: {type: revolute, between: [ground, beam.end]}
motion: {end: 2, step: 1e-3, spectral_radius: 0.99}
probes: {middle: {at: beam.middle}}
)yaml",
                   {{"damping", damping}}),
              formulation);
}

/// L = EI = rhoA = 1, clamped at the left by a joint and let go from the shape of a tip force 1e-3 that has grown
/// slowly: the first mode, almost alone.
History let_go(const std::string& frame) {
  return move(fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 12}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    frame: $frame
    reduction: {modes: 1, derivatives: none, attachment: none}
    damping: {modal: [0.02]}
joints: {root: {type: fixed, between: [ground, beam.start]}}
loads: {pull: {type: force, at: beam.end, force: [0, "t < 0.5 ? 1e-3 : 0"]}}
motion: {end: 10, step: 5e-3, spectral_radius: 0.99}
probes: {tip: {at: beam.end}}
)yaml",
                   {{"frame", frame}}),
              Formulation::vm_md);
}

/// ln(x_0 / x_n) / sqrt((n pi)^2 + ln^2) over the extremes of `x` from t = 1 on: the ratio of a decaying oscillation.
double ratio_of_decay(const std::vector<double>& t, const std::vector<double>& x) {
  std::vector<double> extremes;
  for (std::size_t i = 1; i + 1 < x.size(); ++i)
    if (t[i] > 1 && std::abs(x[i]) > std::abs(x[i - 1]) && std::abs(x[i]) >= std::abs(x[i + 1]))
      extremes.push_back(std::abs(x[i]));
  REQUIRE(extremes.size() > 4);
  const double logarithm = std::log(extremes.front() / extremes.back());
  return logarithm / std::hypot(logarithm, M_PI * double(extremes.size() - 1));
}

/// x(t)/x(0) = e^(-z w t) (cos wd t + z w/wd sin wd t), wd = w sqrt(1 - z^2).
void check_decay(const History& at, double ratio) {
  const double w = M_PI * M_PI, wd = w * std::sqrt(1 - ratio * ratio);
  double worst = 0;
  for (std::size_t i = 0; i < at.t.size(); ++i) {
    const double t = at.t[i];
    const double x = std::exp(-ratio * w * t) * (std::cos(wd * t) + ratio * w / wd * std::sin(wd * t));
    worst = std::max(worst, std::abs((at["middle.y"][i] + 1e-5) / 1e-5 - x));
  }
  CHECK(worst < 5e-4);
}

}  // namespace

TEST_CASE("damping: decay of one mode, modal") { check_decay(plucked(Formulation::vm_md, "modal: [0.03]"), 0.03); }

TEST_CASE("damping: other modes' ratios leave the first alone") {
  check_decay(plucked(Formulation::vm_md, "modal: [0, 0.5, 0.5]"), 0);
}

// A mode of the body as its joints hold it has the frame's rigid motion in it, another one in each frame.
TEST_CASE("damping: a mode's ratio is the same in every frame") {
  for (const std::string frame : {"{type: clamped, at: start}", "pinned", "mean-axis"}) {
    INFO(frame);
    const History tip = let_go(frame);
    CHECK(ratio_of_decay(tip.t, tip["tip.y"]) == Approx(0.02).epsilon(0.01));
  }
}

// alpha M + beta K: z = alpha / (2 w) + beta w / 2.
TEST_CASE("damping: decay of one mode, Rayleigh") {
  const double w = M_PI * M_PI;
  for (const Formulation formulation : {Formulation::vm_md, Formulation::vm, Formulation::nlffr}) {
    INFO(name_of(formulation));
    check_decay(plucked(formulation, "mass: 0.4"), 0.4 / (2 * w));
    check_decay(plucked(formulation, "stiffness: 0.005"), 0.005 * w / 2);
  }
}
