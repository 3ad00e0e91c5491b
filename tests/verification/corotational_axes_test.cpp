#include <catch2/catch.hpp>

#include "space_twin.h"

// What corotational bodies have in place of a floating frame: axes of loads and deflections, and those of places of
// several nodes.

using namespace floe;
using namespace floe::test;

namespace {

/// A beam under forces in axes of the body and per length.
std::string planar_beam(const std::string& frame, const std::string& joints) {
  return fill(R"yaml(
bodies:
  b:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 16}}
    section: {EA: 2e6, EI: 200, rhoA: 0.5}
    frame: $frame
    initial: {angular_velocity: 3, position: [0.1, 0.2], angle: 0.4}
joints: {$joints}
loads:
  f: {type: force, at: b.end, force: ["0.4*sin(20*t)", "2*sin(20*t)"], axes: body}
  d: {type: distributed, body: b, force: [0.2, "1*t"], axes: body}
motion: {end: 0.5, step: 2e-3}
probes:
  tip: {at: b.end}
  defl: {at: b.middle, quantity: deflection}
)yaml",
              {{"frame", frame}, {"joints", joints}});
}

std::string spatial_beam(const std::string& frame, const std::string& joints) {
  return fill(R"yaml(
bodies:
  b:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 16}}
    section: {shape: rectangle, width: 0.02, height: 0.03, orientation: [0, 1, 0]}
    material: {E: 2e10, nu: 0.3, rho: 2000}
    frame: $frame
    initial: {angular_velocity: [0.5, 1, 3], rotation: [0.2, -0.4, 0.9]}
joints: {$joints}
loads:
  f: {type: force, at: b.end, force: [2, "20*sin(20*t)", 10], axes: body}
  d: {type: distributed, body: b, force: [0.2, "30*t", 5], axes: body}
  m: {type: moment, at: b.middle, moment: [0, 0.4, "3*sin(30*t)"], axes: body}
motion: {end: 0.3, step: 2e-3}
probes:
  tip: {at: b.end}
  defl: {at: b.middle, quantity: deflection}
)yaml",
              {{"frame", frame}, {"joints", joints}});
}

/// Greatest difference of a component over the greatest size of the probe.
double difference(const History& a, const History& b, const std::vector<std::string>& columns) {
  double worst = 0, size = 0;
  for (const std::string& column : columns)
    for (std::size_t i = 0; i < a.t.size(); ++i) {
      worst = std::max(worst, std::abs(a[column][i] - b[column][i]));
      size = std::max(size, std::abs(b[column][i]));
    }
  return worst / size;
}

}  // namespace

TEST_CASE("cfr axes: loads in axes of the body and deflections, against the full-order model") {
  for (const std::string frame : {"mean-axis", "pinned", "clamped"}) {
    INFO(frame);
    const std::string flat = planar_beam(frame,
                                         frame == "mean-axis" ? "" : "h: {type: revolute, between: [ground, b.start]}"),
                      joint = frame == "mean-axis" ? "" : "h: {type: spherical, between: [ground, b.start]}",
                      space = spatial_beam(frame == "clamped" ? "{type: clamped, at: start}" : frame, joint);
    const History plane = move(flat, Formulation::cfr), exact = move(flat, Formulation::nlffr);
    CHECK(difference(plane, exact, {"tip.x", "tip.y"}) < 2e-3);
    CHECK(difference(plane, exact, {"defl.x", "defl.y"}) < 2e-2);
    const History own = move(space, Formulation::cfr), full = move(space, Formulation::nlffr);
    CHECK(difference(own, full, {"tip.x", "tip.y", "tip.z"}) < 3e-3);
    CHECK(difference(own, full, {"defl.x", "defl.y", "defl.z"}) < 3e-2);
  }
}

// A frame that is clamped at the loaded section rotates with it, at any deflection; a frame that is pinned at the root
// and the tip follows the chord: the equilibrium is that of the dead force that is normal to the final chord.
TEST_CASE("cfr axes: follower forces at large deflections") {
  const auto cantilever = [](const std::string& frame, const std::string& force, const std::string& axes) {
    return fill(R"yaml(
bodies:
  b:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 12}}
    section: {A: 1, Iy: 0.001, Iz: 0.001, J: 0.002, orientation: [0, 1, 0]}
    material: {E: 1e4, G: 4e3, rho: 1}
    frame: $frame
joints: {root: {type: fixed, between: [ground, b.start]}}
loads: {f: {type: force, at: b.end, force: $force, axes: $axes}}
motion: {end: 1, step: 0.1}
probes: {tip: {at: b.end, quantity: position}}
)yaml",
                {{"frame", frame}, {"force", force}, {"axes", axes}});
  };
  const auto tip = [&](const std::string& frame, const std::string& force, const std::string& axes) {
    return vector_at(rest(cantilever(frame, force, axes), Formulation::cfr, 10), "tip", 0);
  };
  const std::string push = "[0, \"12*t\", \"20*t\"]";
  const Eigen::Vector3d by_place = tip("pinned", push, "place");
  CHECK((tip("{type: clamped, at: end}", push, "body") - by_place).norm() < 1e-9);
  CHECK(by_place.x() < 0.8);
  const Eigen::Vector3d by_chord = tip("pinned", "[0, 0, \"30*t\"]", "body");
  const Eigen::Vector3d along = by_chord.normalized(), normal(-along.z(), 0, along.x());
  const std::string dead = "[\"" + number(30 * normal.x()) + "*t\", 0, \"" + number(30 * normal.z()) + "*t\"]";
  CHECK((tip("pinned", dead, "world") - by_chord).norm() < 1e-9);
  CHECK(by_chord.x() < 0.8);
}

// Free flight of a beam that bends far: the deflections from mean axes have no mean and no first moment.
TEST_CASE("cfr axes: deflections from mean axes have neither a mean nor a moment") {
  std::string text = R"yaml(
bodies:
  b:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 8}}
    section: {A: 1, Iy: 0.001, Iz: 0.001, J: 0.002, orientation: [0, 1, 0]}
    material: {E: 1e3, G: 4e2, rho: 1}
    initial: {velocity: [0, 0, 1], angular_velocity: [1, 2, 6], deformation: ["0", "0.1*x*x", "0.2*x*x"]}
motion: {end: 0.4, step: 2e-3}
probes:
)yaml";
  for (int i = 0; i <= 8; ++i)
    text += fmt::format("  p{0}: {{at: {{body: b, node: [{1}, 0, 0]}}, quantity: deflection}}\n", i, i / 8.);
  const History at = move(text, Formulation::cfr);
  double mean = 0, moment = 0, size = 0;
  for (std::size_t step = 0; step < at.t.size(); ++step) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), about = sum;
    for (int i = 0; i <= 8; ++i) {
      const double x = i / 8., h = i == 0 || i == 8 ? 1. / 16 : 1. / 8;
      const Eigen::Vector3d u = vector_at(at, fmt::format("p{}", i), step);
      sum += h * u, about += h * (x - 0.5) * Eigen::Vector3d::UnitX().cross(u);
      size = std::max(size, u.norm());
    }
    mean = std::max(mean, sum.norm()), moment = std::max(moment, about.norm());
  }
  CHECK(size > 0.03);
  CHECK(mean < 0.02 * size);
  CHECK(moment < 0.02 * size);
}

// The axes have no mass: how far they are from where the search ended says nothing beside a search that began there.
TEST_CASE("cfr axes: equilibria under loads that stay") {
  const std::string text = R"yaml(
gravity: [0, -9.81]
bodies:
  b:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 16}}
    section: {A: 6e-4, I: 2e-8}
    material: {E: 7e9, rho: 2700}
    frame: mean-axis
    damping: {modal: [0.01, 0.02]}
joints: {root: {type: fixed, between: [ground, b.start]}}
loads: {tip: {type: force, at: b.end, force: [0, 10]}}
motion: {end: 0.02, step: 1e-3, start: equilibrium}
probes:
  deflection: {at: b.middle, quantity: deflection}
  tip: {at: b.end}
)yaml";
  const History exact = rest(text, Formulation::cfr, 5), full = rest(text, Formulation::nlffr, 5),
                still = move(text, Formulation::cfr);
  CHECK(exact["tip.y"].back() == Approx(10. / (3 * 7e9 * 2e-8) - 2700 * 6e-4 * 9.81 / (8 * 7e9 * 2e-8)).epsilon(1e-3));
  for (const char* probe : {"tip.y", "deflection.y"}) {
    CHECK(full[probe].back() == Approx(exact[probe].back()).epsilon(3e-3));
    for (const double value : still[probe]) CHECK(value == Approx(exact[probe].back()).epsilon(1e-9));
  }
}
