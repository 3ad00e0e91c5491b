#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "floe/assembly/reduced_bodies_file.h"
#include "space_twin.h"
#include "spatial_scenes.h"

using namespace floe;
using namespace floe::test;

namespace {

/// A free plate of 1 m x 0.5 m and 10 kg that spins about x with w under a pressure along its normal, z at the start.
History free_plate(const std::string& follower, const std::string& rigid) {
  return move(fill(R"yaml(
bodies:
  plate:
    rigid: $rigid
    mesh: {plate: {origin: [-0.5, -0.25, 0], along: [1, 0, 0], across: [0, 0.5, 0], elements: [4, 2]}}
    section: {thickness: 0.02}
    material: {E: 2e11, nu: 0.3, rho: 1000}
    reduction: {modes: 2}
    initial: {angular_velocity: [3, 0, 0]}
loads: {p: {type: pressure, body: plate, pressure: 40, follower: $follower}}
motion: {end: 1, step: 2e-3}
probes: {plate: {at: {body: plate, node: [0, 0, 0]}}}
)yaml",
                   {{"follower", follower}, {"rigid", rigid}}),
              Formulation::vm_md);
}

/// The plate of static_plate_test: clamped all around, under 100 E h^4 / a^4.
double deflection(const std::string& load, Formulation formulation) {
  return rest(fill(R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 1, 0], elements: [8, 8], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 1e7, nu: 0.3, rho: 1}
    reduction: {modes: {count: 16, alone: 16}}
joints:
  l: {type: fixed, between: [ground, plate.left]}
  r: {type: fixed, between: [ground, plate.right]}
  b: {type: fixed, between: [ground, plate.bottom]}
  t: {type: fixed, between: [ground, plate.top]}
loads: {pressure: {body: plate, $load}}
probes: {centre: {at: {body: plate, node: [0.5, 0.5, 0]}}}
)yaml",
                   {{"load", load}}),
              formulation, 4)["centre.z"]
      .back();
}

/// A flap that is spun up under pressure and swings by a tenth of its length.
std::string flap(const std::string& follower, const std::string& modes) {
  return fill(R"yaml(
bodies:
  flap:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.6, 0], elements: [5, 3], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 8e9, nu: 0.3, rho: 1000}
    frame: {type: clamped, at: left}
    reduction: {modes: $modes, derivatives: all}
joints: {hinge: {type: driven, between: [ground, flap.left], axis: [0, 1, 0], speed: "20*t"}}
loads: {p: {type: pressure, body: flap, pressure: "600*t", follower: $follower}}
motion: {end: 0.6, step: 4e-3}
probes: {tip: {at: flap.p3, quantity: deflection}}
)yaml",
              {{"follower", follower}, {"modes", modes}});
}

}  // namespace

// v. = a (0, -sin wt, cos wt) where it follows, a (0, 0, 1) where it does not; a = p A / m = 2, w = 3.
TEST_CASE("pressure: the resultant on a free body, following or dead") {
  for (const std::string rigid : {"true", "false"}) {
    const History follower = free_plate("true", rigid), dead = free_plate("false", rigid);
    for (std::size_t i = 0; i < dead.t.size(); ++i) {
      const double t = dead.t[i], a = 2, w = 3, s = std::sin(w * t), c = std::cos(w * t);
      const Eigen::Vector3d with(0, a / (w * w) * (s - w * t), a / (w * w) * (1 - c)), without(0, 0, a * t * t / 2);
      CHECK((vector_at(follower, "plate", i) - with).norm() < 2e-5);
      CHECK((vector_at(dead, "plate", i) - without).norm() < 2e-5);
    }
  }
}

TEST_CASE("pressure: a clamped plate in equilibrium, dead as the load per area, following with a small difference") {
  const std::string dead = "type: pressure, pressure: \"10*t\", follower: false",
                    follower = "type: pressure, pressure: \"10*t\"";
  const double loaded = deflection("type: distributed, force: [0, 0, \"10*t\"]", Formulation::nlffr);
  CHECK(deflection(dead, Formulation::nlffr) == Approx(loaded).epsilon(1e-9));
  const double full = deflection(follower, Formulation::nlffr);
  CHECK(std::abs(full / loaded - 1) < 2e-3);  // slopes of 0.03, squared
  CHECK(std::abs(full / loaded - 1) > 1e-8);
  const double reduced = deflection(follower, Formulation::vm_md);
  CHECK(reduced == Approx(full).epsilon(0.02));  // 16 modes; of the dead load, too
  CHECK(reduced / deflection(dead, Formulation::vm_md) - 1 == Approx(full / loaded - 1).epsilon(0.05));
}

// Six modes are too few for a swing of a tenth of the length; ten follow it.
TEST_CASE("pressure: a flap that is spun up, reduced and full-order, following and dead") {
  std::array<History, 2> full{move(flap("true", "6"), Formulation::nlffr),
                              move(flap("false", "6"), Formulation::nlffr)};
  CHECK(apart(full[0], full[1], "tip") > 0.05);
  for (int i : {0, 1}) {
    const std::string follower = i == 0 ? "true" : "false";
    const double coarse = apart(move(flap(follower, "6"), Formulation::vm_md), full[i], "tip"),
                 fine = apart(move(flap(follower, "10"), Formulation::vm_md), full[i], "tip");
    CHECK(fine < 0.01);
    CHECK(fine < coarse);
  }
}

TEST_CASE("pressure: a body from its file moves as with its mesh, following and dead, by parts and in formulation vm") {
  const Scratch scratch;
  const std::string path = (scratch.path / "flap.h5").string();
  std::vector<std::string> warnings;
  assembly::reduce_body(scene::parse_scene(flap("true", "6"), "scene"), "flap", PETSC_COMM_WORLD, path, true, warnings);
  for (const std::string follower : {"true", "false"}) {
    std::string text = flap(follower, "6");
    const std::size_t begin = text.find("  flap:"), end = text.find("joints:");
    text.replace(begin, end - begin, "  flap: {reduced: " + path + "}\n");
    for (const Formulation formulation : {Formulation::vm_md, Formulation::vm}) {
      std::string meshed = flap(follower, "{count: 6, alone: 6}");
      const History file = move(text, formulation), mesh = move(meshed, formulation);
      CHECK(apart(file, mesh, "tip") < 1e-6);
    }
  }
  std::string wrong = flap("true", "6");
  wrong.replace(wrong.find("  flap:"), wrong.find("joints:") - wrong.find("  flap:"),
                "  flap: {reduced: " + path + "}\n");
  wrong.insert(wrong.find("pressure: \"600*t\""), "part: skin, ");
  CHECK_THROWS_WITH(move(wrong, Formulation::vm_md), Catch::Contains("flap has no part \"skin\"; expected one of "));
}

// Elements whose thicknesses at the corners differ are parts of their own, all of the property's name.
TEST_CASE("pressure: on all parts of a deck that have the name") {
  const Scratch scratch;
  std::string deck = "BEGIN BULK\nMAT1,1,7.+10,,0.3,2700.\nPSHELL,1,1,0.01,1,,1\n";
  for (int i = 0; i <= 4; ++i)
    for (int j = 0; j < 2; ++j) deck += fmt::format("GRID,{},,{},{},0.\n", 2 * i + j + 1, 0.25 * i, 0.5 * j);
  for (int i = 0; i < 4; ++i) {
    const double start = 0.01 + 0.002 * i, end = start + 0.002;
    deck += fmt::format("CQUAD4,{},1,{},{},{},{}\n,,,{},{},{},{}\n", i + 1, 2 * i + 1, 2 * i + 3, 2 * i + 4, 2 * i + 2,
                        start, end, end, start);
  }
  deck += "SPC1,1,123456,1,2\nENDDATA\n";
  write_text((scratch.path / "plate.bdf").string(), deck);
  const auto force = [&](const std::string& part) {
    const History at = rest(fill(R"yaml(
bodies: {b: {mesh: {file: {path: $path}}, reduction: {modes: 3}}}
joints: {root: {type: fixed, between: [ground, b.SPC1]}}
loads: {p: {type: pressure, body: b, $part pressure: 10}}
motion: {end: 1, step: 0.1}
probes: {f: {joint: root}}
)yaml",
                                 {{"path", (scratch.path / "plate.bdf").string()}, {"part", part}}),
                            Formulation::lffr);
    return at["f.z"].back();
  };
  CHECK(force("") == Approx(-5).epsilon(1e-6));
  CHECK(force("part: PSHELL1,") == Approx(-5).epsilon(1e-6));
}
