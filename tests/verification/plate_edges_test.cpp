#include <catch2/catch.hpp>

#include "estimated.h"
#include "space_twin.h"

using namespace floe;
using namespace floe::test;

// Square plates of side 1, D = 1, mass 1 per area, nu = 0.3, their edges clamped (C), hinged (S) or free (F): on the
// ground, or on a rigid body that the ground holds.

namespace {

constexpr double nu = 0.3, pi = 3.14159265358979323846;
const std::array<std::string, 4> sides{"left", "right", "bottom", "top"};

struct Plate {
  std::string edges;  ///< a letter for each of `sides`; M: hinged, its nodes constrained one by one on the ground
  int elements = 8, modes = 6;
  bool on_body = false;
  double pressure = 1e-4;
  std::string initial = {}, motion = {};
};
constexpr double thickness = 0.01;

std::string scene_of(const Plate& plate) {
  const std::array<std::string, 4> middles{"[0, 0.5, 0]", "[1, 0.5, 0]", "[0.5, 0, 0]", "[0.5, 1, 0]"};
  std::string joints = "post: {type: fixed, between: [ground, hub.end]}, ";
  for (std::size_t i = 0; i < 4; ++i) {
    if (plate.edges[i] == 'F') continue;
    joints += fmt::format("{}: {{type: {}, between: [{}, plate.{}]{}}}, ", sides[i],
                          plate.edges[i] == 'C' ? "fixed" : "revolute",
                          plate.on_body ? "{body: hub, node: " + middles[i] + "}" : "ground", sides[i],
                          plate.edges[i] == 'M' ? ", edges: mean" : "");
  }
  return fill(R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 1, 0], elements: [$n, $n], cells: quadrilaterals}}
    section: {thickness: $h}
    material: {E: $E, nu: 0.3, rho: $rho}
    reduction: {modes: $modes}
    initial: {$initial}
  hub:
    rigid: true
    mesh: {line: {from: [-0.2, 0.25, 0], to: [0, 0.25, 0], elements: 1}}
    section: {shape: rectangle, width: 0.5, height: 0.5, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: 1000}
joints: {$joints}
loads: {p: {type: pressure, body: plate, pressure: $pressure}}
probes: {c: {at: {body: plate, node: [0.5, 0.5, 0]}, quantity: position}, l: {at: {body: plate, node: [0, 0.5, 0]}}}
$motion
)yaml",
              {{"n", std::to_string(plate.elements)},
               {"h", number(thickness)},
               {"E", number(12 * (1 - nu * nu) / std::pow(thickness, 3))},
               {"rho", number(1 / thickness)},
               {"modes", std::to_string(plate.modes)},
               {"initial", plate.initial},
               {"joints", joints},
               {"pressure", number(plate.pressure)},
               {"motion", plate.motion}});
}

/// Deflection of the centre under a pressure of 1 by Levy's series (Timoshenko & Woinowsky-Krieger, Theory of Plates
/// and Shells, art. 28-48): left and right edges hinged, w = sum Y_m(y) sin(m pi x), Y = 4/(m pi)^5 + A ch + B a y sh +
/// C sh + D a y ch with a = m pi, four conditions at y = -1/2, 1/2.
double levy(char bottom, char top) {
  double centre = 0;
  for (int m = 1; m < 60; m += 2) {
    const double a = m * pi, load = 4 / std::pow(a, 5), norm = std::cosh(a / 2);
    Eigen::Matrix4d conditions;
    Eigen::Vector4d right;
    for (int side = 0; side < 2; ++side) {
      const double y = side == 0 ? -0.5 : 0.5, c = std::cosh(a * y) / norm, s = std::sinh(a * y) / norm, z = a * y;
      const Eigen::RowVector4d Y(c, z * s, s, z * c), Y1(s, s + z * c, c, c + z * s),
          Y2(c, 2 * c + z * s, s, 2 * s + z * c), Y3(s, 3 * s + z * c, c, 3 * c + z * s);  // over a, a^2, a^3
      const char edge = side == 0 ? bottom : top;
      conditions.row(2 * side) = edge == 'F' ? Eigen::RowVector4d(Y2 - nu * Y) : Y;
      conditions.row(2 * side + 1) = edge == 'F' ? Eigen::RowVector4d(Y3 - (2 - nu) * Y1) : edge == 'C' ? Y1 : Y2;
      right[2 * side] = edge == 'F' ? nu * load : -load;
      right[2 * side + 1] = 0;
    }
    const Eigen::Vector4d A = conditions.fullPivLu().solve(right);
    centre += (load + A[0] / norm) * std::sin(a / 2);
  }
  return centre;
}

double centre(const Plate& plate, Formulation formulation) {
  return rest(scene_of(plate), formulation)["c.z"][0] / plate.pressure;
}

}  // namespace

// The least frequencies: Leissa, The free vibration of rectangular plates, J. Sound Vib. 31 (1973), nu = 0.3.
TEST_CASE("edges of plates: Levy's and Navier's deflections and Leissa's frequencies, on the ground and on a body") {
  CHECK(levy('S', 'S') == Approx(0.00406235).epsilon(1e-5));  // Navier
  struct Case {
    std::string edges;
    std::array<double, 2> omega;
  };
  for (const Case& at :
       {Case{"SSSS", {19.7392, 49.3480}}, Case{"SSCC", {28.9509, 54.7431}}, Case{"SSCS", {23.6463, 51.6743}},
        Case{"SSCF", {12.6874, 33.0651}}, Case{"SSSF", {11.6845, 27.7563}}, Case{"SSFF", {9.6314, 16.1348}}}) {
    INFO(at.edges);
    const double exact = levy(at.edges[2], at.edges[3]);
    for (const bool on_body : {false, true}) {
      if (on_body && at.edges == "SSCC") continue;  // two rigid pieces would lead each hinged edge: refused
      const double coarse = centre({at.edges, 4, 6, on_body}, Formulation::nlffr),
                   fine = centre({at.edges, 8, 6, on_body}, Formulation::nlffr);
      CHECK((4 * fine - coarse) / 3 == Approx(exact).epsilon(5e-3));
      CHECK(fine == Approx(exact).epsilon(2e-2));
    }
    const std::vector<double> coarse = omega_of(scene_of({at.edges, 4})), fine = omega_of(scene_of({at.edges, 8}));
    for (std::size_t i = 0; i < 2; ++i) CHECK((4 * fine[i] - coarse[i]) / 3 == Approx(at.omega[i]).epsilon(1e-2));
  }
  // nodes constrained one by one, without the slope along the edge: another way to the same limit
  CHECK(centre({"MMMM"}, Formulation::nlffr) == Approx(levy('S', 'S')).epsilon(3e-2));
  CHECK(rest(scene_of({"MMMM"}), Formulation::vm_md)["l.z"][0] == 0);
}

TEST_CASE("edges of plates: 1 to 12 modes follow the full-order model at rest, on the ground and on a body") {
  for (const std::string edges : {"CSSS", "SSSS", "SFSF", "CSFS", "SSFF", "MMMM"})
    for (const bool on_body : {false, true}) {
      if (on_body && edges.find('M') < 4) continue;
      INFO(edges << (on_body ? " on a body" : " on the ground"));
      const double full = centre({edges, 6, 1, on_body}, Formulation::nlffr);
      for (const auto& [modes, tolerance] : {std::pair(1, 0.11), {3, 0.05}, {6, 0.03}, {12, 0.01}}) {
        INFO(modes << " modes");
        CHECK(centre({edges, 6, modes, on_body}, Formulation::vm_md) == Approx(full).epsilon(tolerance));
      }
    }
}

namespace {

/// A plate of 1 thickness released from a shape of an amplitude, over about a period of small oscillations.
std::string released(const std::string& edges, int modes, const std::string& shape, double end, bool on_body = false) {
  return scene_of({edges, 6, modes, on_body, 0, fmt::format("deformation: [0, 0, \"{}\"]", shape),
                   fmt::format("motion: {{end: {}, step: {}}}", end, end / 100)});
}

}  // namespace

TEST_CASE("edges of plates: large oscillations, with estimates, as the full-order model and by Chu and Herrmann") {
  // Four hinged edges that do not move in the plane: amplitude 0.6 thicknesses, frequency 1.1625 times that of small
  // oscillations (Chu & Herrmann, J. Appl. Mech. 23, 1956)
  const std::string shape = "0.006*sin(pi*x)*sin(pi*y)";
  for (const bool on_body : {false, true}) {
    INFO(on_body);
    const double small = 2 * pi * pi;
    const History reduced = move(released("SSSS", 4, shape, 0.3, on_body), Formulation::vm_md);
    const auto crossings = reduced.crossings("c.z");
    REQUIRE(crossings.size() == 2);
    CHECK(pi / (crossings[1] - crossings[0]) / small == Approx(1.1625).epsilon(0.02));
    CHECK(std::abs(reduced["l.z"].back()) < 1e-12);
  }
  // a clamped corner and three hinges, 3 modes
  const std::string bent = "0.03*x^2*(1-x)*sin(pi*y)", text = released("CSSS", 3, bent, 0.25);
  const Estimated reduced = move_and_estimate(text, Formulation::vm_md);
  const History full = move(text, Formulation::nlffr);
  REQUIRE(reduced.estimate.none == "");
  CHECK(*std::min_element(full["c.z"].begin(), full["c.z"].end()) < -0.5 * full["c.z"].front());
  const double error = vector_error(reduced.history, full, "c");
  CHECK(error < 0.05);
  CHECK(reduced.estimate.probes[0] < 0.05);
}

namespace {

/// Half of Scordelis and Lo's roof: radius 25, length 25 of 50, 40 degrees to either side, thickness 0.25.
std::string roof_deck(int n) {
  std::string nodes, cells, corner;
  const auto id = [&](int i, int j) { return 1 + i + (n + 1) * j; };
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double a = (2.0 * i / n - 1) * 40 * pi / 180;
      nodes +=
          fmt::format("{}, {:.17g}, {:.17g}, {:.17g}\n", id(i, j), 25.0 * j / n, 25 * std::sin(a), 25 * std::cos(a));
      if (i < n && j < n)
        cells +=
            fmt::format("{}, {}, {}, {}, {}\n", 1 + i + n * j, id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1));
    }
  return "*NODE\n" + nodes + "*ELEMENT, TYPE=S4, ELSET=skin\n" + cells +
         fmt::format("*NSET, NSET=edge\n{}\n", id(0, n)) +
         "*MATERIAL, NAME=m\n*ELASTIC\n4.32e8, 0\n*DENSITY\n36\n*SHELL SECTION, ELSET=skin, MATERIAL=m\n0.25\n";
}

}  // namespace

// Its diaphragm and its plane of symmetry are constrained node by node; linear bodies deflect in proportion to their
// load.
TEST_CASE("edges of plates: a linear shell supported by the ground is linear") {
  const Scratch folder;
  constexpr int n = 8;
  write_text((folder.path / "roof.inp").string(), roof_deck(n));
  std::string joints;
  for (int i = 0; i <= n; ++i)
    for (const bool symmetry : {false, true}) {
      const double a = (2.0 * i / n - 1) * 40 * pi / 180;
      joints += fmt::format(
          "j{}{}: {{type: {}, between: [ground, {{body: roof, node: [{}, {:.17g}, {:.17g}]}}], axis: [1, 0, 0]}}, ", i,
          symmetry ? "s" : "d", symmetry ? "planar" : "cylindrical", symmetry ? 25 : 0, 25 * std::sin(a),
          25 * std::cos(a));
    }
  const auto deflection = [&](double load, Formulation formulation) {
    return rest(fill(R"yaml(
bodies: {roof: {mesh: {file: {path: $deck}}}}
joints: {$joints}
gravity: [0, 0, $g]
probes: {edge: {at: roof.edge}}
)yaml",
                     {{"deck", (folder.path / "roof.inp").string()}, {"joints", joints}, {"g", number(-10 * load)}}),
                formulation)["edge.z"][0] /
           load;
  };
  const double small = deflection(1e-3, Formulation::lffr);
  CHECK(deflection(1, Formulation::lffr) == Approx(small).epsilon(1e-9));
  CHECK(deflection(1e-4, Formulation::nlffr) == Approx(small).epsilon(1e-3));
}
