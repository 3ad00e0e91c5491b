#include <catch2/catch.hpp>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;

namespace {

/// A square plate of side 1, D = E h^3 / 12 (1 - nu^2), nu = 0.3, under supports of its edges.
std::string plate(const std::string& supports, const std::string& more = "", const std::string& side = "1",
                  const std::string& elements = "16") {
  return fill(R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [$side, 0, 0], across: [0, $side, 0], elements: [$n, $n], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 1e10, nu: 0.3, rho: 1000}
    reduction: {modes: 6, derivatives: all}
joints:
$supports
$more
)yaml",
              {{"supports", supports}, {"more", more}, {"side", side}, {"n", elements}});
}

std::string support(const std::string& place, const std::string& hold) {
  return "  " + (place.find('{') == 0 ? std::string("node") : place.substr(6)) +
         ": {type: support, between: [ground, " + place + "], hold: [" + hold + "]}\n";
}

const std::string lateral = support("plate.left", "z") + support("plate.right", "z") + support("plate.bottom", "z") +
                            support("plate.top", "z"),
                  centre = support("{body: plate, node: [0.5, 0.5, 0]}", "x, y") +
                           "  side: {type: support, between: [ground, {body: plate, node: [1, 0.5, 0]}], hold: [y]}\n",
                  immovable = support("plate.left", "x, z") + support("plate.right", "x, z") +
                              support("plate.bottom", "y, z") + support("plate.top", "y, z"),
                  quarter = support("plate.left", "x, z") + support("plate.bottom", "y, z") +
                            support("plate.right", "x, ry, rz") + support("plate.top", "y, rx, rz");

const double D = 1e10 * 1e-6 / (12 * 0.91), unit = std::sqrt(D / (1000 * 0.01));

}  // namespace

// Navier: omega_mn = pi^2 (m^2 + n^2) sqrt(D / rho h) / a^2.
TEST_CASE("supports: edges that are supported laterally only, Navier's plate") {
  const std::vector<double> omega = omega_of(plate(lateral + centre));
  const double pi2 = M_PI * M_PI * unit;
  CHECK(omega[0] == Approx(2 * pi2).epsilon(5e-3));
  CHECK(omega[1] == Approx(5 * pi2).epsilon(1e-2));
  CHECK(omega[2] == Approx(5 * pi2).epsilon(1e-2));
  CHECK(omega[3] == Approx(8 * pi2).epsilon(1e-2));
}

// Levy: two opposite edges simply supported, the others free, nu = 0.3: 9.6314, 16.1348 (Leissa 1973).
TEST_CASE("supports: two opposite edges, Levy's plate") {
  const std::vector<double> omega = omega_of(plate(support("plate.left", "z") + support("plate.right", "z") + centre));
  CHECK(omega[0] == Approx(9.6314 * unit).epsilon(5e-3));
  CHECK(omega[1] == Approx(16.1348 * unit).epsilon(5e-3));
}

// Conditions of symmetry: a quarter of the plate has the modes (1, 1), (1, 3), (3, 1) of the whole one.
TEST_CASE("supports: a quarter of a plate under conditions of symmetry") {
  const std::vector<double> omega = omega_of(plate(quarter, "", "0.5", "8"));
  const double pi2 = M_PI * M_PI * unit;
  CHECK(omega[0] == Approx(2 * pi2).epsilon(5e-3));
  CHECK(omega[1] == Approx(10 * pi2).epsilon(2e-2));
  CHECK(omega[2] == Approx(10 * pi2).epsilon(2e-2));
}

// Edges immovable normally and free along themselves: one mode sin sin has U = 1/2 k1 W^2 + 1/4 k3 W^4 with
// k3 / k1 = ((3/8) (1 - nu^2) + (3/4) (1 + nu)) / h^2 (REFERENCE, Chu and Herrmann); the same in equilibrium under the
// load sin sin, of which a pressure q has the part 16 q / pi^2: W with k1 W + k3 W^3 = p.
TEST_CASE("supports: large deflections of a plate with edges that are immovable normally and free along themselves") {
  const double h = 0.01, k1 = 4 * std::pow(M_PI, 4) * D, k3 = k1 * (0.375 * 0.91 + 0.75 * 1.3) / (h * h);
  const double W = h, q = M_PI * M_PI / 16 * (k1 * W + k3 * W * W * W);
  const auto loaded = [&](const std::string& supports, const std::string& side, const std::string& n,
                          Formulation formulation) {
    const std::string half = side == "1" ? "0.5" : side;
    const History at =
        rest(plate(supports,
                   "loads: {p: {type: distributed, body: plate, force: [0, 0, \"" + number(q) +
                       "*t\"]}}\nprobes: {w: {at: {body: plate, node: [" + half + ", " + half + ", 0]}}}\n",
                   side, n),
             formulation, 4);
    return at["w.z"][0];
  };
  const double whole = loaded(immovable, "1", "16", Formulation::nlffr);
  CHECK(whole == Approx(W).epsilon(0.05));  // one mode of the uniform load
  CHECK(loaded(quarter, "0.5", "8", Formulation::nlffr) == Approx(whole).epsilon(1e-3));
  CHECK(loaded(immovable, "1", "16", Formulation::vm_md) == Approx(whole).epsilon(0.02));
  CHECK(loaded(quarter, "0.5", "8", Formulation::cfr) == Approx(whole).epsilon(1e-2));
  // edges that move in their plane are softer
  CHECK(loaded(lateral + centre, "1", "16", Formulation::nlffr) > 1.2 * whole);
}

TEST_CASE("supports: refused where the body can still move, and where they cannot act") {
  const auto refused = [](const std::string& text, Formulation formulation = Formulation::vm_md) {
    try {
      assembly::build(scene::parse_scene(text + "motion: {end: 1, step: 0.1}\n", "scene"), formulation,
                      PETSC_COMM_WORLD);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(refused(plate(lateral)), Catch::Contains("its body can still move as a whole"));
  std::string floating = plate(lateral + centre);
  floating.insert(floating.find("    reduction:"), "    frame: mean-axis\n");
  CHECK_THAT(refused(floating), Catch::Contains("has a frame of its own, and supports hold bodies without one"));
  CHECK_THAT(refused(plate(support("plate.left", "z, u"))),
             Catch::Contains("contains \"u\"; expected x, y, z, rx, ry, rz"));
  CHECK_THAT(refused(plate("  s: {type: support, between: [plate.left, plate.right], hold: [z]}\n")),
             Catch::Contains("expected the ground and a place of a body"));
  CHECK_THAT(refused(plate(lateral + centre, "events: {off: {unlock: left, at: 1}}\n")),
             Catch::Contains("events.off.unlock: is \"left\", a support"));
}

namespace {

/// A plate with one clamped edge, a hinged one that meets it and one that moves in its plane, under loads of all kinds.
std::string on_edges(const std::string& more) {
  return plate(
      support("plate.left", "x, y, z, rx, ry, rz") + support("plate.bottom", "x, y, z") + support("plate.right", "z"),
      "gravity: [0, 0, -$g]\nloads:\n"
      "  p: {type: pressure, body: plate, pressure: \"2*t - 40*c.z\", follower: false}\n"
      "  f: {type: force, at: {body: plate, node: [0.75, 0.5, 0]}, force: [3, 1, \"2 + t\"]}\n"
      "  m: {type: moment, at: {body: plate, node: [0.5, 0.75, 0]}, moment: [$m, \"2*$m\", 0]}\n"
      "probes:\n  c: {at: {body: plate, node: [0.5, 0.5, 0]}}\n"
      "  fl: {joint: left}\n  ml: {joint: left, quantity: moment}\n"
      "  fb: {joint: bottom}\n  mb: {joint: bottom, quantity: moment}\n"
      "  fr: {joint: right}\n  mr: {joint: right, quantity: moment}\n" +
          more,
      "1", "8");
}

Eigen::Vector3d vector_of(const History& at, const std::string& probe, std::size_t i) {
  return {at[probe + ".x"][i], at[probe + ".y"][i], at[probe + ".z"][i]};
}

}  // namespace

// The sum of all reactions and loads vanishes, to round-off in forces; in moments about the undeformed places to second
// order in the deflection (1e-5 of the side).
TEST_CASE("supports: reactions of clamped, hinged and sliding edges balance the loads") {
  const std::vector<std::pair<std::string, Eigen::Vector3d>> edges{
      {"l", {0, 0.5, 0}}, {"b", {0.5, 0, 0}}, {"r", {1, 0.5, 0}}};
  std::map<std::string, double> left;
  for (const auto formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::lffr, Formulation::cfr}) {
    INFO(scene::name_of(formulation));
    const double moment = formulation == Formulation::lffr ? 0 : 0.1;  // it rotates with its node, to second order
    const History at = rest(fill(on_edges(""), {{"g", "0.3"}, {"m", number(moment)}}), formulation);
    const double p = 2 - 40 * at["c.z"][0], mass = 10;
    Eigen::Vector3d f(3, 1, 3 + p - mass * 0.3), m(moment, 2 * moment, 0);
    m += Eigen::Vector3d(0.5, 0.5, 0).cross(Eigen::Vector3d(0, 0, p - mass * 0.3));
    m += Eigen::Vector3d(0.75, 0.5, 0).cross(Eigen::Vector3d(3, 1, 3));
    for (const auto& [edge, centre] : edges) {
      f += vector_of(at, "f" + edge, 0);
      m += vector_of(at, "m" + edge, 0) + centre.cross(vector_of(at, "f" + edge, 0));
    }
    const double size = vector_of(at, "fl", 0).norm();
    CHECK(size > 0.3);
    CHECK(std::abs(at["fr.x"][0]) < 1e-9 * size);  // it slides
    CHECK(f.norm() < (formulation == Formulation::cfr ? 1e-8 : 1e-10) * size);
    CHECK(m.norm() < (formulation == Formulation::lffr ? 1e-10 : 1e-3) * size);
    left[scene::name_of(formulation)] = at["fl.z"][0];
  }
  CHECK(left.at("cfr") == Approx(left.at("nlffr")).epsilon(0.1));
  CHECK(left.at("vm+md") == Approx(left.at("nlffr")).epsilon(0.05));
}

// What a clamp of its own rows, in a frame that moves, exerts in motion, inertia included: another way to the same.
TEST_CASE("supports: the reaction of a clamped edge in motion is that of a fixed joint") {
  const std::string rest = R"yaml(
loads: {f: {type: force, at: {body: plate, node: [1, 0.75, 0]}, force: [5, 2, "1e-3*(1 - cos(60*t))"]}}
probes:
  f: {joint: left}
  m: {joint: left, quantity: moment, axes: $axes}
  u: {at: {body: plate, node: [1, 0.5, 0]}}
motion: {end: 0.1, step: 1e-3}
)yaml";
  const std::string fixed = "  left: {type: fixed, between: [ground, plate.left]}\n",
                    reversed = "  left: {type: support, between: [plate.left, ground], hold: [x, y, z, rx, ry, rz]}\n";
  for (const auto formulation : {Formulation::vm_md, Formulation::nlffr}) {
    INFO(scene::name_of(formulation));
    const auto moved = [&](const std::string& joints) {
      return move(fill(plate(joints, fill(rest, {{"axes", "joint"}}), "1", "4"), {}), formulation);
    };
    const History rows = moved(fixed), held = moved(support("plate.left", "x, y, z, rx, ry, rz")),
                  ground = moved(reversed);
    const double tolerance = formulation == Formulation::nlffr ? 1e-4 : 0.02;
    for (const std::string column : {"u.z", "f.z", "m.y"}) CHECK(relative_error(held, rows, column) < tolerance);
    for (const std::string column : {"f.z", "m.y"})
      CHECK(held[column].back() == Approx(-ground[column].back()).epsilon(1e-9));
  }
}

// Nodes in common count in equal parts, in whatever order the joints are; those of a clamp for the clamp alone.
TEST_CASE("supports: reactions where edges meet do not depend on the order of joints and the formulation") {
  const std::string edge[] = {support("plate.left", "z"), support("plate.right", "z"), support("plate.bottom", "z"),
                              support("plate.top", "z")},
                    clamp = "  left: {type: fixed, between: [ground, plate.left]}\n";
  const auto reactions = [&](const std::string& joints, Formulation formulation) {
    const bool all = joints.find("right:") != std::string::npos;
    const History at = rest(plate(joints, std::string("loads: {p: {type: pressure, body: plate, pressure: 1}}\n"
                                                      "probes: {left: {joint: left}, bottom: {joint: bottom}, ") +
                                              (all ? "right: {joint: right}, " : "") + "top: {joint: top}}\n"),
                            formulation);
    return Eigen::Vector4d(at["left.z"][0], all ? at["right.z"][0] : 0, at["bottom.z"][0], at["top.z"][0]);
  };
  for (const auto formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
    INFO(scene::name_of(formulation));
    const Eigen::Vector4d one = reactions(edge[0] + edge[1] + edge[2] + edge[3] + centre, formulation),
                          other = reactions(edge[3] + edge[0] + edge[2] + edge[1] + centre, formulation);
    CHECK((one + Eigen::Vector4d::Constant(0.25)).norm() < 1e-3);  // a square
    CHECK((one - other).norm() < 1e-9);
  }
  const Eigen::Vector4d whole = reactions(clamp + edge[2] + edge[3], Formulation::nlffr);
  CHECK(std::abs(whole[0]) > 0.1);
  CHECK((reactions(clamp + edge[2] + edge[3], Formulation::vm_md) - whole).norm() < 1e-3);
  CHECK((reactions(edge[3] + edge[2] + clamp, Formulation::cfr) - whole).norm() < 0.01);
}

// What a support shares with a clamp that an event releases is the support's, before and after.
TEST_CASE("supports: a released edge has no reaction, also at a node that a support holds") {
  const History at =
      move(plate("  left: {type: fixed, between: [ground, plate.left]}\n" + support("plate.bottom", "z") +
                     "  right: {type: fixed, between: [ground, plate.right]}\n",
                 "loads: {p: {type: pressure, body: plate, pressure: \"1e3*smooth(t, 0, 0.02)\"}}\n"
                 "events: {e: {unlock: left, at: 0.02}}\n"
                 "probes: {left: {joint: left}, moment: {joint: left, quantity: moment}, bottom: {joint: "
                 "bottom}}\nmotion: {end: 0.03, step: 1e-3}\n",
                 "1", "4"),
           Formulation::cfr);
  CHECK(std::abs(at["left.z"].back()) < 1e-9);
  CHECK(std::abs(at["moment.x"].back()) < 1e-9);
  CHECK(std::abs(at["bottom.z"].back()) > 1);
}
