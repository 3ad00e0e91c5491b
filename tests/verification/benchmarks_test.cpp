#include <catch2/catch.hpp>
#include <tuple>

#include "shell_decks.h"

using namespace floe;
using namespace floe::test;
using Eigen::Vector3d;

// Published benchmark problems of shells, and a beam that was measured.

namespace {

/// Displacement of the edge `right` along `axis` under a total force along it, clamped at `left`, over the force.
/// Linear.
double compliance(const Deck& deck, char axis, double force) {
  const std::string f = number(force) + "*t";
  const std::string text = fill(
      R"yaml(
bodies: {shell: {mesh: {file: {path: $path}}}}
joints: {root: {type: fixed, between: [ground, shell.left]}}
loads: {end: {type: force, at: shell.right, force: [0, $y, $z]}}
probes: {end: {at: shell.right, quantity: displacement}}
)yaml",
      {{"path", deck.path()}, {"y", axis == 'y' ? "\"" + f + "\"" : "0"}, {"z", axis == 'z' ? "\"" + f + "\"" : "0"}});
  return rest(text, Formulation::lffr)[std::string("end.") + axis].back() / force;
}

/// A strip that curves by 60 degrees with radius 14 to one side and by 150 degrees with radius 46 to the other.
Vector3d hook(double u, double v) {
  const double a = M_PI / 3, first = 14 * a, s = u * (first + 46 * 2.5 * a), b = std::max(0., s - first) / 46,
               c = std::min(s / 14, a);
  return {14 * std::sin(c) + 46 * (std::sin(c) - std::sin(c - b)),
          14 * (1 - std::cos(c)) + 46 * (std::cos(c - b) - std::cos(c)), 20 * v};
}

/// 12 long, 1.1 wide, twisted by 90 degrees.
Vector3d twisted(double u, double v) {
  const double a = u * M_PI / 2, w = 1.1 * (v - 0.5);
  return {12 * u, w * std::cos(a), w * std::sin(a)};
}

}  // namespace

// Thickness 2, width 20, E = 3300, nu = 0.35, unit force across. CalculiX 2.20: C3D20R, 36 x 10 x 2 elements 5.0165,
// 72 x 20 x 2 5.0190; Knight 1997, AIAA J. 35(2), with solids: 4.9352. The response is twist: shells without transverse
// shear do without the edge layers of Saint-Venant's torsion, J = b t^3 / 3 for b t^3 / 3 (1 - 0.63 t / b), 6.3 % less.
TEST_CASE("Raasch's hook: shells with transverse shear, and without") {
  const std::string material = "*ELASTIC\n3300., 0.35\n*DENSITY\n1.\n";
  const auto deflection = [&](const char* type, int n, int m) {
    return compliance(Deck(shells(type, n, m, 2, material, hook)), 'z', 1e-3);
  };
  CHECK(deflection("S8R", 36, 5) == Approx(5.019).epsilon(6e-3));
  CHECK(deflection("S6", 36, 5) == Approx(5.019).epsilon(2.5e-2));
  CHECK(deflection("S4", 36, 6) == Approx(5.019 * (1 - 0.063)).epsilon(1e-2));
  CHECK(deflection("S3", 36, 6) == Approx(5.019 * (1 - 0.063)).epsilon(1e-2));
}

// MacNeal and Harder 1985, Finite Elem. Anal. Des. 1, 3-20: thickness 0.32, E = 29e6, nu = 0.22, unit forces;
// CalculiX 2.20 (C3D20R, 48 x 8 x 2): 0.0017532 and 0.0054217.
TEST_CASE("twisted beam of MacNeal and Harder") {
  const std::string material = "*ELASTIC\n29e6, 0.22\n*DENSITY\n1.\n";
  const auto [type, n, m, tolerance] = GENERATE(std::tuple("S4", 24, 4, 6e-3), std::tuple("S3", 12, 2, 7e-3),
                                                std::tuple("S8R", 12, 2, 2e-3), std::tuple("S6", 12, 2, 3e-3));
  CAPTURE(type);
  const Deck deck(shells(type, n, m, 0.32, material, twisted));
  const double y = compliance(deck, 'y', 1e-3), z = compliance(deck, 'z', 1e-3);
  CHECK(y == Approx(0.001754).epsilon(tolerance));
  CHECK(z == Approx(0.005424).epsilon(tolerance));
}

// The same, 100 times thinner; Simo, Fox and Rifai 1989, Comput. Methods Appl. Mech. Eng. 73, 53-92: unit forces of
// 1e-6. Quadrilaterals of four nodes are warped here: with 12 by 2 a corner is 22 thicknesses off the plane of the
// other three; triangles are flat, the surface is not.
TEST_CASE("twisted beam, thin") {
  const auto [type, n, m, tolerance] =
      GENERATE(std::tuple("S8R", 24, 4, 5e-3), std::tuple("S4", 24, 4, 6e-3), std::tuple("S4", 12, 2, 2e-2),
               std::tuple("S3", 24, 4, 1.5e-2), std::tuple("S3", 12, 2, 2e-2));
  CAPTURE(type, n);
  const Deck deck(shells(type, n, m, 0.0032, "*ELASTIC\n29e6, 0.22\n*DENSITY\n1.\n", twisted));
  CHECK(compliance(deck, 'y', 1e-8) * 1e-6 == Approx(0.001294).epsilon(tolerance));
  CHECK(compliance(deck, 'z', 1e-8) * 1e-6 == Approx(0.005256).epsilon(tolerance));
}

// z = 2 x y on a unit square, thickness 1/1000, E = 2e11, nu = 0.3, clamped at x = -1/2, weight of 8 N/m3: elements
// along the straight lines of the surface are warped. CalculiX 2.20, S8R, 16 x 16 and 32 x 32: -4.904e-5, -4.925e-5.
TEST_CASE("hyperbolic paraboloid of warped quadrilaterals") {
  const int n = GENERATE(8, 16);
  const auto formulation = GENERATE(Formulation::lffr, Formulation::nlffr, Formulation::cfr);
  CAPTURE(n, static_cast<int>(formulation));
  const Deck deck(shells("S4", n, n, 1e-3, "*ELASTIC\n2e11, 0.3\n*DENSITY\n1.\n",
                         [](double u, double v) { return Vector3d(u - 0.5, v - 0.5, 2 * (u - 0.5) * (v - 0.5)); }));
  const std::string text = fill(R"yaml(
bodies: {shell: {mesh: {file: {path: $path}}}}
gravity: [0, 0, "-8*t"]
joints: {root: {type: fixed, between: [ground, shell.left]}}
probes: {middle: {at: {body: shell, node: [0.5, 0, 0]}, quantity: displacement}}
)yaml",
                                {{"path", deck.path()}});
  CHECK(rest(text, formulation)["middle.z"].back() == Approx(-4.925e-5).epsilon(1e-2));
}

// MacNeal and Harder 1985: R = 25, length 50, 80 degrees, thickness 0.25, E = 4.32e8, nu = 0, 90 per area, diaphragms
// at its ends; a quarter of it, small deflections.
TEST_CASE("Scordelis-Lo roof") {
  const auto [type, n] = GENERATE(std::pair("S3", 8), std::pair("S4", 8), std::pair("S8R", 4));
  const auto formulation = GENERATE(Formulation::lffr, Formulation::nlffr, Formulation::cfr);
  CAPTURE(type, static_cast<int>(formulation));
  const auto roof = [](double u, double v) {
    const double a = v * 40 * M_PI / 180;
    return Vector3d(25 * u, 25 * std::sin(a), 25 * std::cos(a) - 25);
  };
  const Deck deck(shells(type, n, n, 0.25, "*ELASTIC\n4.32e8, 0\n*DENSITY\n360.\n", roof));
  const Vector3d edge = roof(1, 1);
  const std::string text = fill(R"yaml(
bodies: {roof: {mesh: {file: {path: $path}}}}
gravity: [0, 0, "-1e-3*t"]
joints:
  end: {type: support, between: [ground, roof.left], hold: [y, z]}
  middle: {type: support, between: [ground, roof.right], hold: [x, ry, rz]}
  crown: {type: support, between: [ground, roof.bottom], hold: [y, rx, rz]}
probes: {edge: {at: {body: roof, node: [25, $y, $z]}, quantity: displacement}}
)yaml",
                                {{"path", deck.path()}, {"y", number(edge.y())}, {"z", number(edge.z())}});
  // in cfr the weight acts at the nodes as forces alone
  const double tolerance = formulation == Formulation::cfr ? 2e-2 : 1e-2;
  CHECK(-1e3 * rest(text, formulation)["edge.z"].back() == Approx(0.3024).epsilon(tolerance));
}

// MacNeal and Harder 1985: R = 300, length 600, thickness 3, E = 3e6, nu = 0.3, diaphragms at its ends, two opposite
// forces of 1 in the middle; an eighth of it. Deflection: series of Lindberg, Olson and Cowper 1969.
TEST_CASE("pinched cylinder with diaphragms") {
  const auto [type, n, tolerance] =
      GENERATE(std::tuple("S3", 16, 2.5e-2), std::tuple("S4", 16, 1e-2), std::tuple("S8R", 16, 1e-2));
  CAPTURE(type);
  const Deck deck(shells(type, n, n, 3, "*ELASTIC\n3e6, 0.3\n*DENSITY\n1.\n", [](double u, double v) {
    return Vector3d(300 * u, 300 * std::sin(v * M_PI / 2), 300 * std::cos(v * M_PI / 2));
  }));
  const std::string text = fill(R"yaml(
bodies: {cylinder: {mesh: {file: {path: $path}}}}
joints:
  middle: {type: support, between: [ground, cylinder.left], hold: [x, ry, rz]}
  end: {type: support, between: [ground, cylinder.right], hold: [y, z, rx]}
  crown: {type: support, between: [ground, cylinder.bottom], hold: [y, rx, rz]}
  side: {type: support, between: [ground, cylinder.top], hold: [z, rx, ry]}
loads: {pinch: {type: force, at: {body: cylinder, node: [0, 0, 300]}, force: [0, 0, "-0.25*t"]}}
probes: {crown: {at: {body: cylinder, node: [0, 0, 300]}, quantity: displacement}}
)yaml",
                                {{"path", deck.path()}});
  CHECK(-1e5 * rest(text, Formulation::lffr)["crown.z"].back() == Approx(1.8248).epsilon(tolerance));
}

namespace {

/// A quarter of a hemisphere with a hole of 18 degrees, R = 10, under two pairs of forces.
std::string hemisphere(const Deck& deck, double force, int refine = 0) {
  return fill(R"yaml(
bodies: {shell: {mesh: {file: {path: $path, refine: $refine}}}}
joints:
  a: {type: support, between: [ground, shell.left], hold: [y, rx, rz]}
  b: {type: support, between: [ground, shell.right], hold: [x, ry, rz]}
  c: {type: support, between: [ground, {body: shell, node: [10, 0, 0]}], hold: [z]}
loads:
  out: {type: force, at: {body: shell, node: [10, 0, 0]}, force: ["$F/2*t", 0, 0]}
  in: {type: force, at: {body: shell, node: [0, 10, 0]}, force: [0, "-$F/2*t", 0]}
probes:
  out: {at: {body: shell, node: [10, 0, 0]}, quantity: displacement}
  in: {at: {body: shell, node: [0, 10, 0]}, quantity: displacement}
)yaml",
              {{"path", deck.path()}, {"refine", std::to_string(refine)}, {"F", number(force)}});
}

std::string hemisphere_deck(const char* type, int n) {
  return shells(type, n, n, 0.04, "*ELASTIC\n6.825e7, 0.3\n*DENSITY\n1.\n", [](double u, double v) {
    const double a = u * M_PI / 2, b = v * 0.4 * M_PI;
    return Vector3d(10 * std::cos(b) * std::cos(a), 10 * std::cos(b) * std::sin(a), 10 * std::sin(b));
  });
}

}  // namespace

// MacNeal and Harder 1985: thickness 1/250 of the radius, forces of 2. It bends without stretching.
TEST_CASE("hemisphere with a hole of 18 degrees, small deflections") {
  const auto [type, n, tolerance] =
      GENERATE(std::tuple("S3", 8, 4e-2), std::tuple("S3", 16, 2e-2), std::tuple("S4", 8, 4e-2),
               std::tuple("S4", 16, 2e-2), std::tuple("S8R", 8, 2e-2));
  const auto formulation = GENERATE(Formulation::lffr, Formulation::nlffr, Formulation::cfr);
  CAPTURE(type, n, static_cast<int>(formulation));
  const Deck deck(hemisphere_deck(type, n));
  CHECK(100 * rest(hemisphere(deck, 0.02), formulation)["out.x"].back() == Approx(0.094).epsilon(tolerance));
}

// Halved elements are on the sphere: the polyhedron has 0.78 (triangles, once), 0.76 (twice) of the deflection.
TEST_CASE("a refined hemisphere with a hole has the deflection of a finer one") {
  const auto [type, n, refine] = GENERATE(std::tuple("S3", 8, 1), std::tuple("S4", 8, 1), std::tuple("S3", 4, 2));
  CAPTURE(type, refine);
  const auto deflection = [&](int elements, int times) {
    const Deck deck(hemisphere_deck(type, elements));
    return rest(hemisphere(deck, 0.02, times), Formulation::lffr)["out.x"].back();
  };
  CHECK(deflection(n, refine) == Approx(deflection(16, 0)).epsilon(n == 8 ? 1e-3 : 5e-3));
}

// Sze, Liu and Lo 2004, Finite Elem. Anal. Des. 40, 1551-1569, 3.5: R = 10, h = 0.04, E = 6.825e7, nu = 0.3, two pairs
// of forces of 400; a quarter of it.
TEST_CASE("hemisphere with a hole of 18 degrees at large deflections") {
  const auto [n, tolerance] = GENERATE(std::pair(8, 2.5e-2), std::pair(16, 1.5e-2));
  CAPTURE(n);
  const Deck deck(hemisphere_deck("S3", n));
  const History at = rest(hemisphere(deck, 400), Formulation::cfr, 10);
  CHECK(at["out.x"].back() == Approx(4.067).epsilon(tolerance));
  CHECK(at["in.y"].back() == Approx(-8.184).epsilon(tolerance));
}

// Dowell and Traybar 1975, Princeton University: a slender beam under a force at its end, at an angle to its stiff
// axis. Numbers: geometrically exact beams of Exudyn (its test geometricallyExactBeamTest), (stiff, soft) [m].
TEST_CASE("Princeton beam: bending in two directions with torsion") {
  const auto [angle, stiff, soft] =
      GENERATE(std::tuple(15, 0.01061329, 0.04208232), std::tuple(45, 0.00883723, 0.10898794),
               std::tuple(75, 0.00353889, 0.14219437));
  const auto [formulation, frames] = GENERATE(std::pair(Formulation::cfr, 1), std::pair(Formulation::nlffr, 4));
  const double a = angle * M_PI / 180;
  const std::string text = fill(
      R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [0.508, 0, 0], elements: 16}}
    section: {shape: rectangle, width: 3.2024e-3, height: 12.3777e-3, orientation: [0, 1, 0]}
    material: {E: 71.7e9, nu: 0.31, rho: 2700}
    frames: $frames
joints: {root: {type: fixed, between: [ground, beam.start]}}
loads: {end: {type: force, at: beam.end, force: [0, "$y*t", "$z*t"]}}
probes: {end: {at: beam.end, quantity: displacement}}
)yaml",
      {{"frames", std::to_string(frames)}, {"y", number(8.896 * std::sin(a))}, {"z", number(8.896 * std::cos(a))}});
  const History at = rest(text, formulation, 8);
  CAPTURE(angle, frames);
  CHECK(at["end.z"].back() == Approx(stiff).epsilon(8e-3));
  CHECK(at["end.y"].back() == Approx(soft).epsilon(1e-3));
}
