#include <catch2/catch.hpp>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;

// A ground that shakes by s(t) is a ground that stands and a slide driven by s(t), seen from the slide.

namespace {

History shaken(const std::string& ground, const std::string& joint, Formulation formulation) {
  return move(fill(R"yaml(
$ground
bodies:
  mast:
    mesh: {line: {from: [0, 0, 0], to: [0.2, 0.3, 1], elements: 6}}
    section: {shape: rectangle, width: 0.03, height: 0.02, orientation: [0, 1, 0]}
    material: {E: 2e9, nu: 0.3, rho: 1000}
    frame: {type: clamped, at: start}
    reduction: {modes: 4}
joints: {foot: {$joint, between: [ground, mast.start]}}
motion: {end: 0.4, step: 1e-3}
probes: {tip: {at: mast.end, quantity: deflection}}
)yaml",
                   {{"ground", ground}, {"joint", joint}}),
              formulation);
}

}  // namespace

TEST_CASE("ground acceleration: a mast on a moving ground, and on a driven slide") {
  const std::string shaking = "ground: {acceleration: [\"4*cos(20*t)\", \"8*cos(20*t)\", 0]}",
                    slide = "type: driven_slide, axis: [1, 2, 0], position: \"sqrt(80)/400*(1 - cos(20*t))\"";
  for (const Formulation formulation : {Formulation::vm_md, Formulation::nlffr}) {
    const History ground = shaken(shaking, "type: fixed", formulation), driven = shaken("", slide, formulation);
    for (const char* axis : {"tip.x", "tip.y", "tip.z"}) CHECK(relative_error(ground, driven, axis) < 1e-4);
    CHECK(*std::max_element(ground["tip.y"].begin(), ground["tip.y"].end()) > 5e-3);
  }
}

// x.. = g(t) - a(t)
TEST_CASE("time-dependent gravity and ground acceleration: a falling body, in the plane, in all formulations") {
  const std::string text = R"yaml(
gravity: [0, "-9*cos(3*t)"]
ground: {acceleration: ["-8*sin(2*t)", 0]}
bodies:
  bar:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}
    section: {EA: 1e6, EI: 1e3, rhoA: 1}
    reduction: {modes: 2}
motion: {end: 1, step: 2e-3}
probes: {bar: {at: bar.middle}}
)yaml";
  for (const Formulation formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
    const History at = move(text, formulation);
    for (std::size_t i = 0; i < at.t.size(); ++i) {
      const double t = at.t[i];
      CHECK(at["bar.y"][i] == Approx(-(1 - std::cos(3 * t))).margin(2e-5));
      CHECK(at["bar.x"][i] == Approx(4 * t - 2 * std::sin(2 * t)).margin(2e-5));
    }
  }
}
