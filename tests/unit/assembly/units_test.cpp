#include <catch2/catch.hpp>

#include "scene_motion.h"

// A scene in other units of length and time is the same scene: nothing may compare numbers of different units, nor a
// number with one that has none.

using namespace floe;
using namespace floe::test;
using scene::Formulation;

namespace {

/// Two beams, hinged, on a driven hub. @param l, s  how many new units a metre and a second are
std::string arm(double l, double s) {
  const auto number = [](double x) { return fmt::format("{:.17g}", x); };
  return fill(R"yaml(
parameters: {l: $l, s: $s}
gravity: [0, 0, -9.81*l/s^2]
bodies:
  arm:
    mesh: {polyline: {points: [[0, 0, 0], [0.8*l, 0, 0], [l, 0.2*l, 0.1*l]], elements: [3, 2]}}
    section: {shape: rectangle, width: 0.02*l, height: 0.03*l, orientation: [0, 1, 0.3]}
    material: {E: 2e9/(l*s^2), nu: 0.3, rho: 1000/l^3}
    frame: {type: clamped, at: start}
    reduction: {modes: 2, derivatives: all}
  hand:
    mesh: {line: {from: [l, 0.2*l, 0.1*l], to: [1.3*l, 0.2*l, 0.1*l], elements: 2}}
    section: {shape: rectangle, width: 0.02*l, height: 0.03*l, orientation: [0, 1, 0.3]}
    material: {E: 2e9/(l*s^2), nu: 0.3, rho: 1000/l^3}
    reduction: {modes: 2, derivatives: all}
joints:
  hub: {type: driven, between: [ground, arm.start], axis: [0, 0, 1], angle: "2*(1 - cos(3*t/s))"}
  wrist: {type: revolute, between: [arm.end, hand.start], axis: [0, 1, 0]}
motion: {end: 0.01*s, step: 1e-3*s}
probes: {end: {at: hand.end, quantity: displacement}}
)yaml",
              {{"l", number(l)}, {"s", number(s)}});
}

/// A beam between two rods, the second a million times as heavy, in the plane.
std::string chain(double l) {
  return fill(R"yaml(
parameters: {l: $l}
gravity: [0, -l]
bodies:
  light: {rigid: true, mesh: {line: {from: [0, 0], to: [l, 0], elements: 1}}, section: {rhoA: 1}}
  beam:
    mesh: {line: {from: [l, 0], to: [2*l, 0], elements: 4}}
    section: {EA: 1e4*l^2, EI: l^4, rhoA: 1}
    reduction: {modes: 2}
  heavy: {rigid: true, mesh: {line: {from: [2*l, 0], to: [3*l, 0], elements: 1}}, section: {rhoA: 1e6}}
joints:
  root: {type: revolute, between: [ground, light.start]}
  hinge: {type: revolute, between: [light.end, beam.start]}
  weld: {type: fixed, between: [beam.end, heavy.start]}
motion: {end: 0.1, step: 0.01}
probes: {end: {at: heavy.end, quantity: displacement}}
)yaml",
              {{"l", fmt::format("{:.17g}", l)}});
}

/// Displacements of the end over l.
std::vector<double> path_of(const std::string& scene, double l, Formulation formulation) {
  std::vector<double> all;
  const History history = move(scene, formulation);
  for (const auto& [name, values] : history.columns)
    for (const double value : values) all.push_back(value / l);
  return all;
}

std::vector<double> path(double l, double s, Formulation formulation) { return path_of(arm(l, s), l, formulation); }

double greatest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference = std::max(difference, std::abs(a[i] - b[i])), size = std::max(size, std::abs(b[i]));
  return difference / size;
}

}  // namespace

// Sparse factors compare entries of one unit.
TEST_CASE("a scene of full order moves alike in any units") {
  const std::vector<double> known = path(1, 1, Formulation::nlffr);
  CHECK(greatest_difference(path(1, 1e-9, Formulation::nlffr), known) < 1e-9);
  CHECK(greatest_difference(path(1e-6, 1, Formulation::nlffr), known) < 1e-9);
  CHECK(greatest_difference(path(1e9, 1e4, Formulation::nlffr), known) < 1e-9);
}

// Responses to forces and to moments are compared as forces; roots of element stiffnesses weigh displacements and
// rotations alike.
TEST_CASE("a reduced scene moves alike in any units") {
  const std::vector<double> known = path(1, 1, Formulation::vm_md);
  CHECK(greatest_difference(path(1, 1e-9, Formulation::vm_md), known) < 1e-9);
  CHECK(greatest_difference(path(1, 1e9, Formulation::vm_md), known) < 1e-9);
  CHECK(greatest_difference(path(1e-6, 1, Formulation::vm_md), known) < 1e-9);
  CHECK(greatest_difference(path(1e9, 1e4, Formulation::vm_md), known) < 1e-9);
}

// Rows of constraints and of momentum are scaled before the initial accelerations are solved for.
TEST_CASE("rods of very different masses fall alike in any unit of length") {
  for (const auto formulation : {Formulation::vm_md, Formulation::nlffr}) {
    const std::vector<double> known = path_of(chain(1), 1, formulation);
    for (const double l : {1e-9, 1e-3, 1e9}) {
      INFO(l);
      CHECK(greatest_difference(path_of(chain(l), l, formulation), known) < 1e-7);
    }
  }
}
