#include <catch2/catch.hpp>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;
using Catch::Contains;

namespace {

constexpr double pi = 3.14159265358979323846;

/// Cranks of 0.5 m, 1 kg/m, on a rod of 2 m, 2 kg/m, which they keep horizontal; `first` is the first crank's joint.
/// They point to (x, y).
std::string cranks(const std::string& first, const std::string& more = "", double x = 0.3, double y = 0.4) {
  const auto ends = [&](double at) { return fmt::format("from: [{0}, 0], to: [{1:.17g}, {2:.17g}]", at, at + x, y); };
  return fill(R"yaml(
gravity: [0, -9.81]
bodies:
  c1: {rigid: true, mesh: {line: {$c1, elements: 2}}, section: $s}
  c2: {rigid: true, mesh: {line: {$c2, elements: 2}}, section: $s}
  c3: {rigid: true, mesh: {line: {$c3, elements: 2}}, section: $s}
  rod: {rigid: true, mesh: {line: {$rod, elements: 2}}, section: {EA: 1e6, EI: 10, rhoA: 2}}
joints:
  a: {$first, between: [ground, c1.start]}
  b: {type: revolute, between: [ground, c2.start]}
  c: {type: revolute, between: [ground, c3.start]}
  d: {type: revolute, between: [c1.end, rod.start]}
  e: {type: revolute, between: [c2.end, rod.middle]}
  f: {type: revolute, between: [c3.end, rod.end]}
motion: {end: 2, step: 1e-3}
probes:
  end: {at: rod.end, quantity: position}
  angle: {joint: a, quantity: angle}
  rate: {joint: a, quantity: rate}
$more
)yaml",
              {{"first", first},
               {"s", "{EA: 1e6, EI: 10, rhoA: 1}"},
               {"more", more},
               {"c1", ends(0)},
               {"c2", ends(1)},
               {"c3", ends(2)},
               {"rod", fmt::format("from: [{0:.17g}, {1:.17g}], to: [{2:.17g}, {1:.17g}]", x, y, 2 + x)}});
}

}  // namespace

// Of the 12 rows of six hinges one depends on the others: 12 coordinates have 1 freedom. With
// I = 3 rho L^3/3 + m L^2 = 1.125 kg m2 and g (3 m_c L/2 + m L) = 2.375 g: I w^2/2 + 2.375 g sin(a) = const.
TEST_CASE("planar redundant: three parallel cranks move as one pendulum") {
  const History at = move(cranks("type: revolute"), Formulation::vm_md);
  const double start = std::asin(0.8), last = static_cast<double>(at["angle.value"].size());
  REQUIRE(last > 100);
  double least = 0;
  for (std::size_t i = 0; i < at["angle.value"].size(); ++i) {
    const double angle = start + at["angle.value"][i], rate = at["rate.value"][i];
    CHECK(1.125 / 2 * rate * rate == Approx(2.375 * 9.81 * (std::sin(start) - std::sin(angle))).margin(2e-3));
    CHECK(at["end.x"][i] == Approx(2 + 0.5 * std::cos(angle)).margin(1e-9));
    CHECK(at["end.y"][i] == Approx(0.5 * std::sin(angle)).margin(1e-9));
    least = std::min(least, at["angle.value"][i]);
  }
  CHECK(least == Approx(-pi - 2 * start).epsilon(1e-3));  // swings through to the other side
}

TEST_CASE("planar redundant: driven cranks pass the positions in which two would be singular") {
  const History at = move(cranks("type: driven, angle: \"t^2\""), Formulation::vm_md);
  const double angle = std::asin(0.8) + 4;
  CHECK(at["end.x"].back() == Approx(2 + 0.5 * std::cos(angle)).margin(1e-8));
  CHECK(at["end.y"].back() == Approx(0.5 * std::sin(angle)).margin(1e-8));
}

// s = g sin(slope) t^2/2 along [3, -4]/5.
TEST_CASE("planar redundant: a slider on two guides on one line") {
  const std::string scene = R"yaml(
gravity: [0, -9.81]
bodies: {s: {rigid: true, mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}, section: {EA: 1e6, EI: 10, rhoA: 2}}}
joints:
  a: {type: prismatic, between: [ground, s.start], axis: [3, -4]}
  b: {type: prismatic, between: [ground, s.end], axis: $axis}
motion: {end: 1, step: 2e-3}
probes: {end: {at: s.end, quantity: position}}
)yaml";
  const double s = 9.81 * 0.8 / 2;
  const History at = move(fill(scene, {{"axis", "[3, -4]"}}), Formulation::vm_md);
  CHECK(at["end.x"].back() == Approx(1 + 0.6 * s).epsilon(1e-9));
  CHECK(at["end.y"].back() == Approx(-0.8 * s).epsilon(1e-9));
  const History crossed = move(fill(scene, {{"axis", "[3, -3]"}}), Formulation::vm_md);  // stuck
  CHECK(std::abs(crossed["end.y"].back()) < 1e-9);
}

// Two degrees from the position in which two cranks alone are singular, and cranks of a twentieth of the rod.
TEST_CASE("planar redundant: cranks almost in line with their rod, and short ones") {
  for (const auto& [length, angle] : {std::pair(0.5, 0.035), std::pair(0.1, 0.17)}) {
    const std::string scene =
        cranks("type: driven, angle: \"t\"", "", length * std::cos(angle), length * std::sin(angle));
    const History at = move(scene, Formulation::vm_md);
    CHECK(at["end.x"].back() == Approx(2 + length * std::cos(angle + 2)).margin(1e-8));
    CHECK(at["end.y"].back() == Approx(length * std::sin(angle + 2)).margin(1e-8));
    CHECK_THAT(fault_of_motion(
                   cranks("type: revolute", "  r: {joint: f}", length * std::cos(angle), length * std::sin(angle))),
               Contains("statically indeterminate"));
  }
}

TEST_CASE("planar redundant: what is not determined is refused") {
  CHECK_THAT(fault_of_motion(cranks("type: revolute", "  r: {joint: f}")),
             Contains("probes.r.joint") && Contains("statically indeterminate") && Contains("a, b, c, d, e, f"));
  CHECK_THAT(fault_of_motion(cranks("type: revolute", "events: {u: {at: 0.5, unlock: f}}")),
             Contains("joint f is redundant with other joints, and an event unlocks it"));
}

// The middle of Watt's linkage departs from its guide by the fifth power of its motion only, and then is stuck.
TEST_CASE("planar redundant: a guide along the straight part of Watt's curve does not follow from the linkage") {
  CHECK_THROWS_WITH(move(R"yaml(
bodies:
  c1: {rigid: true, mesh: {line: {from: [0, 0.5], to: [2, 0.5], elements: 2}}, section: {EA: 1e6, EI: 10, rhoA: 1}}
  cp: {rigid: true, mesh: {line: {from: [2, 0.5], to: [2, -0.5], elements: 2}}, section: {EA: 1e6, EI: 10, rhoA: 1}}
  c2: {rigid: true, mesh: {line: {from: [2, -0.5], to: [4, -0.5], elements: 2}}, section: {EA: 1e6, EI: 10, rhoA: 1}}
  slider: {rigid: true, mesh: {line: {from: [2, 0], to: [2, 0.2], elements: 2}}, section: {EA: 1e6, EI: 10, rhoA: 1}}
joints:
  a: {type: revolute, between: [ground, c1.start]}
  b: {type: revolute, between: [c1.end, cp.start]}
  c: {type: revolute, between: [cp.end, c2.start]}
  d: {type: revolute, between: [c2.end, ground]}
  g: {type: prismatic, axis: [0, 1], between: [ground, slider.start]}
  h: {type: revolute, between: [slider.start, {body: cp, node: [2, 0]}]}
motion: {end: 0.1, step: 1e-2}
probes: {s: {at: slider.start, quantity: position}}
gravity: [0, -2]
)yaml",
                         Formulation::vm_md),
                    Contains("redundant or contradictory constraints"));
}
