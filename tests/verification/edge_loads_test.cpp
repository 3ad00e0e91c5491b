#include <catch2/catch.hpp>

#include "floe/assembly/reduced_bodies_file.h"
#include "shell_decks.h"
#include "space_twin.h"

using namespace floe;
using namespace floe::test;

namespace {

/// A strip along x, clamped at its left edge, nu = 0: E h^3 / 12 = 1000/12 per width, L = 1, b = 0.2.
std::string strip(const std::string& loads, const std::string& probes, const std::string& more = "") {
  return fill(R"yaml(
bodies:
  strip:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.2, 0], elements: [20, 4], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 1e9, nu: 0, rho: 1000}
    strains: second_order
    reduction: {modes: 3, attachment: all}
    $more
joints: {clamp: {type: fixed, between: [ground, strip.left]}}
loads: {$loads}
motion: {end: 1, step: 0.5}
probes: {$probes}
)yaml",
              {{"loads", loads}, {"probes", probes}, {"more", more}});
}

const std::string tip = "tip: {at: strip.right, quantity: displacement}, turn: {at: strip.right, quantity: rotation}";
constexpr double EI = 1e9 * 0.2 * 1e-6 / 12;

}  // namespace

TEST_CASE("edge loads: a force and a moment per length bend a strip as their resultants") {
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    const History force =
        rest(strip("q: {type: force, at: strip.right, per: length, force: [0, 0, 0.01]}", tip), formulation);
    CHECK(force["tip.z"][0] == Approx(0.002 / (3 * EI)).epsilon(1e-3));  // F L^3 / 3 EI, F = 0.01 b
    const History moment =
        rest(strip("m: {type: moment, at: strip.right, per: length, moment: [0, -0.01, 0]}", tip), formulation);
    CHECK(moment["tip.z"][0] == Approx(0.002 / (2 * EI)).epsilon(1e-3));  // M L^2 / 2 EI
    CHECK(moment["turn.ry"][0] == Approx(-0.002 / EI).epsilon(1e-3));
  }
}

TEST_CASE("edge loads: in formulation cfr, too") {
  const std::string corner = "tip: {at: strip.p2, quantity: displacement}";
  const std::string force = "q: {type: force, at: strip.right, per: length, force: [0, 0, 0.01]}",
                    moment = "m: {type: moment, at: strip.right, per: length, moment: [0, -0.01, 0]}";
  CHECK(rest(strip(force, corner), Formulation::cfr)["tip.z"][0] == Approx(0.002 / (3 * EI)).epsilon(1e-3));
  CHECK(rest(strip(moment, corner), Formulation::cfr)["tip.z"][0] == Approx(0.002 / (2 * EI)).epsilon(1e-3));
}

TEST_CASE("edge loads: a shape that changes its sign has a moment and no force") {
  // n(y) = n0 (y - b/2) / (b/2): the strip bends in its plane by M = n0 b^2 / 6 about z, v = - M L^2 / (2 E I_z)
  const double n0 = 1e3, M = n0 * 0.04 / 6, EIz = 1e9 * 0.01 * std::pow(0.2, 3) / 12;
  const std::string text =
      strip("n: {type: force, at: strip.right, per: length, force: [1e3, 0, 0], shape: \"10*(y - 0.1)\"}", tip);
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    const History at = rest(text, formulation);
    CHECK(at["tip.y"][0] == Approx(-M / (2 * EIz)).epsilon(0.01));
    CHECK(std::abs(at["tip.x"][0]) < 1e-3 * std::abs(at["tip.y"][0]));
    CHECK(std::abs(at["tip.z"][0]) < 1e-9);
  }
}

// M(x) = - m b sin(2 pi x) / (2 pi): w(L) = - m b / (4 pi^2 EI). As one rigid motion of the area it would be a third.
TEST_CASE("area loads: a moment per area with a shape bends a strip as its integral") {
  const Deck deck(shells("S4", 20, 4, 0.01, "*ELASTIC\n1e9, 0\n*DENSITY\n1000\n",
                         [](double u, double v) { return Eigen::Vector3d(u, 0.2 * v, 0); }) +
                  "*NSET, NSET=all, GENERATE\n1, 105\n");
  const std::string text = fill(R"yaml(
bodies: {strip: {mesh: {file: {path: $path}}, reduction: {modes: 3, attachment: all}}}
joints: {clamp: {type: fixed, between: [ground, strip.left]}}
loads: {m: {type: moment, at: strip.all, per: area, moment: [0, -0.01, 0], shape: "cos(2*pi*x)"}}
probes: {tip: {at: strip.right, quantity: displacement}}
)yaml",
                                {{"path", deck.path()}});
  for (const Formulation formulation : {Formulation::nlffr, Formulation::cfr, Formulation::vm_md})
    CHECK(rest(text, formulation)["tip.z"][0] == Approx(-0.002 / (4 * M_PI * M_PI * EI)).epsilon(0.02));
}

/// A strip whose normal is y, clamped, under moments about its normal and about its edge: at the edge, or at a hub that
/// a joint fixes to its mean.
std::string bent_twice(double in_plane, double across, bool hub) {
  return fill(R"yaml(
bodies:
  strip:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0, 0.05], elements: [40, 2], cells: quadrilaterals}}
    section: {thickness: 0.002}
    material: {E: 2e11, nu: 0.3, rho: 8000}
    reduction: {modes: 2, attachment: all}
  hub:
    rigid: true
    mesh: {line: {from: [1, 0, 0.025], to: [1.1, 0, 0.025], elements: 1}}
    section: {shape: rectangle, width: 0.02, height: 0.02, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
joints:
  clamp: {type: fixed, between: [ground, strip.left]}
  weld: {type: fixed, edges: mean, between: [strip.right, hub.start]}
loads: {bend: {type: moment, at: $at, moment: [0, $in_plane, $across]}}
probes: {turn: {at: $at, quantity: rotation}}
)yaml",
              {{"in_plane", fmt::format("{}", in_plane)},
               {"across", fmt::format("{}", across)},
               {"at", hub ? "hub.start" : "strip.right"}});
}

// Dead moments My, Mz at the end: torque My theta_z(x) - Mz theta_y(x) along the tangent, theta linear in x: the end
// twists by (My theta_z - Mz theta_y) L / 2 GJ. Edges whose rotation is of first order in displacements twist it by
// twice as much; theta_z that of a strip between E h^3 / 12 and E h^3 / 12 (1 - nu^2).
TEST_CASE("edge loads: moments about the normal and the edge of a strip twist it as a dead moment's torque does") {
  const double GJ = 2e11 / 2.6 * 0.05 * 8e-9 / 3;  // of shells of first order, without edge layers
  for (const bool hub : {false, true}) {
    const std::string small = bent_twice(1, 0.002, hub), large = bent_twice(7, 0.01, hub);  // 0.6 of the critical one
    const History exact = rest(large, Formulation::cfr);
    for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md, Formulation::cfr}) {
      INFO(hub << ' ' << name_of(formulation));
      const History at = rest(small, formulation);
      const double torque = (1 * at["turn.rz"][0] - 0.002 * at["turn.ry"][0]) / 2;
      CHECK(at["turn.rx"][0] == Approx(torque / GJ).epsilon(0.005));
      const History far = rest(large, formulation, 4);
      CHECK(far["turn.rx"][0] == Approx(exact["turn.rx"][0]).epsilon(0.005));
      CHECK(far["turn.rz"][0] == Approx(exact["turn.rz"][0]).epsilon(0.005));
    }
  }
  const Scratch scratch;
  const std::string text = bent_twice(7, 0.01, true), path = (scratch.path / "strip.h5").string();
  std::vector<std::string> warnings;
  assembly::reduce_body(scene::parse_scene(text, "scene"), "strip", PETSC_COMM_WORLD, path, true, warnings);
  std::string other = text;
  const std::size_t begin = other.find("  strip:"), end = other.find("  hub:");
  other.replace(begin, end - begin, "  strip: {reduced: " + path + "}\n");
  const History mesh = rest(text, Formulation::vm_md), file = rest(other, Formulation::vm_md);
  CHECK(file["turn.rx"][0] == Approx(mesh["turn.rx"][0]).epsilon(1e-6));
}

TEST_CASE("edge loads: a triangular line load has the resultant of its shape") {
  const History line =
      rest(strip("q: {type: force, at: strip.right, per: length, force: [0, 0, 0.02], shape: \"5*y\"}", tip),
           Formulation::nlffr);
  CHECK(line["tip.z"][0] == Approx(0.002 / (3 * EI)).epsilon(1e-3));
}

TEST_CASE("edge loads: per length of what is no edge, and per area of an edge, are refused") {
  const auto refused = [](const std::string& load) {
    try {
      rest(strip(load, tip), Formulation::nlffr);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(refused("q: {type: force, at: strip.p2, per: length, force: [0, 0, 1]}"),
             Catch::Contains("is per length, and its place is no edge and no area of the mesh"));
  CHECK_THAT(refused("q: {type: force, at: strip.right, per: area, force: [0, 0, 1]}"),
             Catch::Contains("is per area, and its place consists of edges"));
  CHECK_THAT(refused("q: {type: force, at: strip.right, force: [0, 0, 1], shape: y}"),
             Catch::Contains("shape: is given without per"));
  CHECK_THAT(refused("q: {type: force, at: strip.right, per: length, force: [0, 0, 1], shape: \"x - 1\"}"),
             Catch::Contains("shape: is zero at all nodes of the place"));
}

TEST_CASE("follower forces in the plane: a cantilever under a force that stays normal to its end") {
  // The angle psi at the end satisfies psi(0) = 0, psi'' = -(F/EI) cos(psi - psi_L): for a follower force normal to the
  // end, integrated in tests/verification/references
  const std::string text = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 40}}
    section: {EA: 1e6, EI: 1, rhoA: 1, rhoI: 0}
    frame: clamped
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, 2], axes: $axes}}
motion: {end: 1, step: 0.5}
probes: {tip: {at: beam.end, quantity: displacement}, turn: {at: beam.end, quantity: rotation}}
)yaml";
  const History follower = rest(fill(text, {{"axes", "place"}}), Formulation::cfr, 4);
  // shooting backwards from the end: theta'' = -F cos(theta), theta(0) = theta_end, theta'(0) = 0 in axes of the end
  double angle = 0, rate = 0, x = 0, y = 0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {  // midpoint rule along s from the end; angle against the end's axis
    const double h = 1. / n, mid = angle + 0.5 * h * rate, mid_rate = rate - 0.5 * h * 2 * std::cos(angle);
    x += h * std::cos(mid), y += h * std::sin(mid);
    rate -= h * 2 * std::cos(mid);
    angle += h * mid_rate;
  }
  const double end = -angle;  // the clamp stands at angle 0
  const double X = x * std::cos(end) - y * std::sin(end), Y = x * std::sin(end) + y * std::cos(end);
  CHECK(follower["turn.angle"][0] == Approx(end).epsilon(1e-3));
  CHECK(follower["tip.x"][0] == Approx(X - 1).epsilon(2e-3));
  CHECK(follower["tip.y"][0] == Approx(Y).epsilon(2e-3));
  const History dead = rest(fill(text, {{"axes", "world"}}), Formulation::cfr, 4);
  CHECK(std::abs(dead["tip.y"][0] - Y) > 0.02);
}
