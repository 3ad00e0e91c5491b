// Stresses, membrane forces and bending moments of shells, as probes: closed forms, published tables and CalculiX.
#include <catch2/catch.hpp>
#include <functional>

#include "building.h"
#include "estimated.h"
#include "spatial_scenes.h"

using namespace floe;
using namespace floe::test;
using namespace floe::testing;
using Catch::Matchers::Contains;

namespace {

constexpr double pi = 3.14159265358979323846;

/// A clamped strip, nu = 0, under a force and a moment at its end.
const char* strip = R"yaml(
bodies:
  strip:
    mesh: {plate: {origin: [0, 0, 0], along: [1, 0, 0], across: [0, 0.3, 0], elements: [8, 3], cells: $cells}}
    section: {thickness: 0.01}
    material: {E: 7e10, nu: 0, rho: 2700}
    reduction: {modes: 4, attachment: all}
joints:
  clamp: {type: fixed, between: [ground, strip.left]}
loads:
  pull: {type: force, at: strip.right, force: [$pull, 0, 0]}
  end: {type: moment, at: strip.right, moment: $moment}
motion: {end: 0.1, step: 1e-3}
probes:
  top: {at: {body: strip, node: $node}, quantity: stress, surface: top}
  bottom: {at: {body: strip, node: $node}, quantity: stress, surface: bottom}
  across: {at: {body: strip, node: $node}, quantity: stress, surface: top, axis: [0, 1, 0]}
  oblique: {at: {body: strip, node: $node}, quantity: principal_stress, surface: top, axis: [1, 1, 0]}
  mises: {at: {body: strip, node: $node}, quantity: von_mises_stress, surface: top}
  diagonal: {at: {body: strip, node: $node}, quantity: stress, surface: top, axis: [1, 1, 0]}
  diagonal_mises: {at: {body: strip, node: $node}, quantity: von_mises_stress, surface: top, axis: [1, 1, 0]}
  n: {at: {body: strip, node: $node}, quantity: membrane_force}
  m: {at: {body: strip, node: $node}, quantity: bending_moment}
)yaml";

/// Square plate of side 1 under a pressure of 1, clamped at its edges, D = 1, nu = 0.3.
std::string clamped_plate(int n, int modes, const char* more) {
  return fill(R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 1, 0], elements: [$n, $n], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 10920000, nu: 0.3, rho: 100}
    reduction: {modes: $modes$more}
joints:
  a: {type: fixed, between: [ground, plate.left]}
  b: {type: fixed, between: [ground, plate.right]}
  c: {type: fixed, between: [ground, plate.bottom]}
  d: {type: fixed, between: [ground, plate.top]}
loads: {p: {type: pressure, body: plate, pressure: 1e-4}}
motion: {end: 1, step: 0.1}
probes:
  centre: {at: {body: plate, node: [0.5, 0.5, 0]}, quantity: bending_moment}
  edge: {at: {body: plate, node: [1, 0.5, 0]}, quantity: bending_moment}
  inner: {at: {body: plate, node: [0.75, 0.5, 0]}, quantity: bending_moment}
)yaml",
              {{"n", std::to_string(n)}, {"modes", std::to_string(modes)}, {"more", more}});
}

}  // namespace

TEST_CASE("stresses of a strip under end force and moment: N / h + 6 M / h^2", "[verification]") {
  for (const char* cells : {"quadrilaterals", "triangles"})
    for (const char* node : {"[0.5, 0.1, 0]", "[0.5, 0, 0]", "[1, 0.3, 0]", "[0.125, 0.2, 0]"})
      for (const auto formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
        INFO(cells << " " << node << " " << scene::name_of(formulation));
        const History at = rest(
            fill(strip, {{"cells", cells}, {"node", node}, {"pull", "3"}, {"moment", "[0, -0.06, 0]"}}), formulation);
        const double pull = 10 / 0.01, bend = 6 * 0.2 / 1e-4;
        // a moment about -y stretches the bottom
        const double tolerance = 2e-3 * bend;
        CHECK(at["top.xx"].back() == Approx(pull - bend).margin(tolerance));
        CHECK(at["bottom.xx"].back() == Approx(pull + bend).margin(tolerance));
        CHECK(std::abs(at["top.yy"].back()) < tolerance);
        CHECK(at["across.yy"].back() == Approx(pull - bend).margin(tolerance));
        CHECK(at["oblique.second"].back() == Approx(pull - bend).margin(tolerance));
        CHECK(at["mises.mises"].back() == Approx(bend - pull).margin(tolerance));
        CHECK(at["diagonal.xx"].back() == Approx((pull - bend) / 2).margin(tolerance));
        CHECK(at["diagonal_mises.mises"].back() == Approx(bend - pull).margin(tolerance));
        CHECK(at["n.xx"].back() == Approx(10).epsilon(2e-3));
        CHECK(at["m.xx"].back() == Approx(-0.2).epsilon(2e-3));
      }
}

TEST_CASE(
    "stresses of a twisted strip: shear of 6 M_xy / h^2, M_xy = T / 2 b, along the axes, none along the diagonals",
    "[verification]") {
  for (const char* cells : {"quadrilaterals", "triangles"}) {
    INFO(cells);
    const History at =
        rest(fill(strip, {{"cells", cells}, {"node", "[0.5, 0.1, 0]"}, {"pull", "0"}, {"moment", "[0.06, 0, 0]"}}),
             Formulation::lffr);
    const double M = 0.06 / (2 * 0.3), shear = 6 * M / 1e-4, tolerance = 5e-3 * shear;
    CHECK(at["m.xy"].back() == Approx(-M).epsilon(5e-3));
    CHECK(at["top.xy"].back() == Approx(-shear).margin(tolerance));
    CHECK(std::abs(at["top.xx"].back()) < tolerance);
    CHECK(at["diagonal.xx"].back() == Approx(-shear).margin(tolerance));
    CHECK(at["diagonal.yy"].back() == Approx(shear).margin(tolerance));
    CHECK(std::abs(at["diagonal.xy"].back()) < tolerance);
    CHECK(at["oblique.first"].back() == Approx(shear).margin(tolerance));
    CHECK(at["mises.mises"].back() == Approx(std::sqrt(3) * shear).epsilon(5e-3));
    CHECK(at["diagonal_mises.mises"].back() == Approx(std::sqrt(3) * shear).epsilon(5e-3));
  }
}

TEST_CASE("moments of a clamped square plate under pressure", "[verification]") {
  // Timoshenko & Woinowsky-Krieger, Theory of plates and shells, table 35: 0.0231 and -0.0513 q a^2
  const double q = 1e-4;
  const History coarse = rest(clamped_plate(16, 3, ""), Formulation::nlffr),
                fine = rest(clamped_plate(24, 3, ""), Formulation::nlffr);
  const double middle = std::abs(fine["centre.xx"].back()), edge = std::abs(fine["edge.xx"].back());
  CHECK(middle == Approx(0.0231 * q).epsilon(0.01));
  CHECK(fine["centre.yy"].back() == Approx(fine["centre.xx"].back()).epsilon(1e-6));
  CHECK(edge == Approx(0.0513 * q).epsilon(0.02));
  CHECK(std::abs(coarse["centre.xx"].back()) == Approx(0.0231 * q).epsilon(0.015));
  CHECK(std::abs(coarse["edge.xx"].back()) == Approx(0.0513 * q).epsilon(0.06));
}

TEST_CASE("stresses of a reduced plate converge to those of the full-order model", "[verification]") {
  const History full = rest(clamped_plate(12, 3, ""), Formulation::nlffr);
  const auto error = [&](int modes) {
    const History reduced = rest(clamped_plate(12, modes, ", derivatives: none"), Formulation::vm_md);
    return std::abs(reduced["centre.xx"].back() / full["centre.xx"].back() - 1);
  };
  const double few = error(5), more = error(20);
  CHECK(few < 0.25);
  CHECK(more < 0.5 * few);
}

TEST_CASE("stresses of a reduced plate in motion: the estimate of their error", "[verification]") {
  const std::string text = fill(R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.5, 0], elements: [12, 6], cells: quadrilaterals}}
    section: {thickness: 0.005}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 4}
joints: {clamp: {type: fixed, between: [ground, plate.left]}}
loads: {p: {type: pressure, body: plate, pressure: "20*sin(30*t)"}}
motion: {end: 0.4, step: 1e-3}
probes:
  root: {at: {body: plate, node: [0, 0.25, 0]}, quantity: stress, surface: top}
  inner: {at: {body: plate, node: [0.5, 0.25, 0]}, quantity: stress, surface: top}
)yaml",
                                {});
  const Estimated reduced = move_and_estimate(text, Formulation::vm_md);
  REQUIRE(reduced.estimate.none == "");
  const History full = move(text, Formulation::nlffr);
  for (std::size_t p = 0; p < 2; ++p) {
    const std::string& name = reduced.history.model.probes[p].name;
    const double error = vector_error(reduced.history, full, name), estimate = reduced.estimate.probes[p];
    INFO(fmt::format("{}: error {:.3g}, estimate {:.3g}", name, error, estimate));
    CHECK(error < 0.1);
    CHECK(estimate > 0.5 * error);
    CHECK(estimate < 2 * error);
  }
}

TEST_CASE("stresses of a cantilever plate as CalculiX has them", "[verification]") {
  // 2 x 1 x 0.02, E = 7e10, nu = 0.3, clamped at x = 0, pressure 1000 upwards; CalculiX 2.20, 16 x 8 S8R, top
  struct Point {
    const char* node;
    double xx, yy;
  };
  const std::string text = R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [2, 0, 0], across: [0, 1, 0], elements: [32, 16], cells: quadrilaterals}}
    section: {thickness: 0.02}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 3}
joints: {clamp: {type: fixed, between: [ground, plate.left]}}
loads: {p: {type: pressure, body: plate, pressure: 1000}}
motion: {end: 1, step: 0.1}
probes:
  s: {at: {body: plate, node: $node}, quantity: stress, surface: top}
)yaml";
  for (const Point& at : {Point{"[0.5, 0.5, 0]", -1.655e7, -3.21757e6}, Point{"[0.5, 0.25, 0]", -1.67569e7, -2.25842e6},
                          Point{"[1, 0.5, 0]", -7.41959e6, -269128}, Point{"[0.25, 0.5, 0]", -2.31851e7, -6.6691e6}}) {
    INFO(at.node);
    const History found = rest(fill(text, {{"node", at.node}}), Formulation::lffr);
    CHECK(found["s.xx"].back() == Approx(at.xx).epsilon(0.01));
    CHECK(found["s.yy"].back() == Approx(at.yy).margin(0.02 * std::abs(at.xx)));
  }
}

TEST_CASE("hoop force of a cylinder under pressure: p R", "[verification]") {
  // 48 flat facets around, or 16 of second order; free of supports but for one node
  const auto deck = [](bool second) {
    const int around = second ? 32 : 48, along = second ? 8 : 6, step = second ? 2 : 1;
    std::string nodes = "*NODE\n",
                elements = second ? "*ELEMENT, TYPE=S8R, ELSET=skin\n" : "*ELEMENT, TYPE=S4, ELSET=skin\n";
    const auto node = [&](int i, int j) { return 1 + (i % around) + around * j; };
    for (int j = 0; j <= along; ++j)
      for (int i = 0; i < around; ++i)
        if (!second || i % 2 == 0 || j % 2 == 0)
          nodes += fmt::format("{}, {:.15g}, {:.15g}, {:.15g}\n", node(i, j), std::cos(2 * pi * i / around),
                               std::sin(2 * pi * i / around), 1.2 * j / along);
    int number = 0;
    for (int j = 0; j < along; j += step)
      for (int i = 0; i < around; i += step) {
        elements += fmt::format("{}, {}, {}, {}, {}", ++number, node(i, j), node(i + step, j), node(i + step, j + step),
                                node(i, j + step));
        if (second)
          elements +=
              fmt::format(", {}, {}, {}, {}", node(i + 1, j), node(i + 2, j + 1), node(i + 1, j + 2), node(i, j + 1));
        elements += "\n";
      }
    return nodes + elements + "*NSET, NSET=held\n1\n*MATERIAL, NAME=m\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n" +
           "*SHELL SECTION, ELSET=skin, MATERIAL=m\n0.01\n";
  };
  for (const bool second : {false, true}) {
    INFO(second);
    const Scratch scratch;
    const std::string path = (scratch.path / "part.inp").string();
    write_text(path, deck(second));
    const History at = rest(fill(R"yaml(
bodies: {tube: {mesh: {file: {path: $path}}, frame: {type: clamped, at: held}, reduction: {modes: 2}}}
joints: {hold: {type: fixed, between: [ground, tube.held]}}
loads: {p: {type: pressure, body: tube, pressure: 1e4}}
motion: {end: 1, step: 0.1}
probes:
  n: {at: {body: tube, node: [-1, 0, 0.6]}, quantity: membrane_force, axis: [0, 1, 0]}
  s: {at: {body: tube, node: [-1, 0, 0.6]}, quantity: von_mises_stress, surface: middle}
)yaml",
                                 {{"path", path}}),
                            Formulation::lffr);
    CHECK(at["n.xx"].back() == Approx(1e4).epsilon(second ? 2e-3 : 4e-3));
    CHECK(std::abs(at["n.yy"].back()) < 50);
    CHECK(at["s.mises"].back() == Approx(1e6).epsilon(0.01));
  }
}

TEST_CASE("stresses at places without shells", "[verification]") {
  const std::string beam = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 4}}
    section: {shape: rectangle, width: 0.05, height: 0.02, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 2}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
motion: {end: 1, step: 0.1}
probes: {s: {at: beam.middle, quantity: stress}}
)yaml";
  CHECK_THAT(complaint(beam, Formulation::vm_md), Contains("probes.s.at: no shell of body beam has a node there"));
}
