#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// L = 10, EI = 1e3, EA = 4.8e4, rhoA = 1, rhoI = 1/48; hinge; root moment 0 -> 80 -> 0 over 5 s.
History arm(Formulation formulation, const std::string& end, const std::string& reduction = "{modes: 3}",
            const std::string& elements = "10", const std::string& step = "5e-3") {
  return move(fill(R"yaml(
bodies:
  arm:
    mesh: {line: {from: [0, 0], to: [10, 0], elements: $elements}}
    section: {EA: 4.8e4, EI: 1e3, rhoA: 1, rhoI: 1/48}
    frame: pinned
    reduction: $reduction
joints: {hinge: {type: revolute, between: [ground, arm.start]}}
loads: {drive: {type: moment, at: arm.start, moment: "80*triangle(t, 2.5, 2.5)"}}
motion: {end: $end, step: $step}
probes: {tip: {at: arm.end, quantity: position}}
)yaml",
                   {{"elements", elements}, {"step", step}, {"end", end}, {"reduction", reduction}}),
              formulation);
}

void check_tip(const History& at, double x1, double y1, double x2, double y2) {
  CHECK(at.at("tip.x", 2.5) == Approx(x1).margin(0.002));
  CHECK(at.at("tip.y", 2.5) == Approx(y1).margin(0.002));
  CHECK(at.at("tip.x", 5) == Approx(x2).margin(0.002));
  CHECK(at.at("tip.y", 5) == Approx(y2).margin(0.002));
}

double greatest_tip_error(const History& a, const History& b) {
  double greatest = 0;
  for (std::size_t i = 0; i < a.t.size(); ++i)
    greatest = std::max(greatest, std::hypot(a["tip.x"][i] - b["tip.x"][i], a["tip.y"][i] - b["tip.y"][i]));
  return greatest;
}

}  // namespace

// Independent converged computations: geometrically exact, von Karman and linear in the pinned frame.
TEST_CASE("moment arm: tip in the full-order formulations") {
  check_tip(arm(Formulation::cfr, "5", "{modes: 3}", "20"), 9.7245, 2.1598, .6959, 9.9782);
  check_tip(arm(Formulation::nlffr, "5"), 9.7247, 2.1600, .6962, 9.9782);
  check_tip(arm(Formulation::lffr, "5"), 9.7675, 2.1470, .7226, 9.9765);
}

// Work of the moment: independent converged computation. Afterwards nothing acts; the scheme loses what it damps.
TEST_CASE("moment arm: energy after the load, and its conservation") {
  const History at = arm(Formulation::nlffr, "10");
  const auto total = [&](std::size_t i) { return at.energy[i].kinetic + at.energy[i].elastic; };
  std::size_t after = 0;
  while (at.t[after] < 5 + 1e-9) ++after;
  CHECK(total(after) == Approx(59.9527).epsilon(1e-4));
  for (std::size_t i = after; i < at.t.size(); ++i) CHECK(total(i) == Approx(total(after)).epsilon(1e-4));
}

// Greatest distance of the tip to t = 10 from the full model of the same mesh: independent computations with modes of
// the pinned frame gave 0.163 (9 modes), 0.0019 (3 with 6 derivatives), 0.0008 (4 bending modes with 10) and 0.065
// (linear). The fourth mode of the frame is axial; of the arm on its hinge the first four bend.
TEST_CASE("moment arm: three modes with their derivatives are better than nine modes") {
  const History full = arm(Formulation::nlffr, "10");
  const auto error = [&](Formulation formulation, const std::string& reduction) {
    return greatest_tip_error(arm(formulation, "10", reduction), full);
  };
  CHECK(error(Formulation::vm, "{modes: {count: 9, of: frame, alone: 9}}") == Approx(0.163).epsilon(0.1));
  CHECK(error(Formulation::vm_md, "{modes: {count: 3, of: frame}, derivatives: all}") < 1.5 * 0.0019);
  CHECK(error(Formulation::vm_md, "{modes: {count: 3, of: joints}, derivatives: all, attachment: all}") < 1.5 * 0.0019);
  CHECK(error(Formulation::vm_md, "{modes: {count: 4, of: joints}, derivatives: all}") < 1.5 * 0.0008);
  CHECK(error(Formulation::lffr, "{modes: 3}") == Approx(0.065).epsilon(0.1));
}
