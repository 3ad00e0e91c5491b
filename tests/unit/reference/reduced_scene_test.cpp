#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "floe/assembly/reduced_bodies_file.h"
#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

// A body from its file moves as the body that was meshed, on any number of ranks: the file is made on all of them.
namespace {

const std::string mechanism = R"yaml(
gravity: [0, -9.81]
bodies:
  crank:
    mesh: {line: {from: [0, 0], to: [0.15, 0], elements: 4}}
    section: {EA: 1e6, EI: 200, rhoA: 1}
    reduction: {modes: {count: 2, alone: 2}}
    initial: {angle: pi/2}
  rod:$rod
    initial: {position: [0, 0.15], angle: "-0.5"}
joints:
  axle: {type: driven, between: [ground, crank.start], angle: "10*t*t"}
  pin: {type: revolute, between: [crank.end, rod.start]}
loads:
  wind: {type: distributed, body: rod, force: [0, "5*sin(40*t)"], axes: body}
  push: {type: force, at: {body: rod, node: [0.3, 0.1]}, force: [3, 0]}
  turn: {type: moment, at: rod.end, moment: "2*sin(30*t)"}
motion: {end: 0.2, step: 2e-3}
probes:
  tip: {at: rod.end}
  bend: {at: {body: rod, node: [0.2, 0.1]}, quantity: deflection}
  knee: {at: rod.p2, quantity: velocity}
)yaml";
const std::string rod = R"yaml(
    mesh: {polyline: {points: [[0, 0], [0.1, 0.1], [0.4, 0.1]], elements: [3, 9]}}
    section: {EA: 1e5, EI: 1, rhoA: 0.4, rhoI: 1e-5}
    damping: {stiffness: $beta}
    frame: {type: $frame}
    reduction: {modes: {count: 3, alone: 3}})yaml";

const std::string plate = R"yaml(
gravity: [0, 0, -3]
bodies:
  plate:$plate
joints: {root: {type: fixed, between: [ground, plate.left]}}
loads:
  corner: {type: force, at: plate.p3, force: [0, 0, "600*sin(24*t)"]}
  wind: {type: distributed, body: plate, force: [0, 0, "20*t"]}
motion: {end: 0.1, step: 2e-3}
probes:
  tip: {at: plate.p3}
  edge: {at: plate.right, quantity: rotation}
  node: {at: {body: plate, node: [1, 0.5, 0]}, quantity: velocity}
)yaml";
const std::string meshed_plate = R"yaml(
    mesh: {plate: {along: [2, 0, 0], across: [0, 1, 0], elements: [4, 2]}}
    section: {thickness: 0.02}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    damping: {mass: 0.2}
    reduction: {modes: {count: 4, alone: 4}})yaml";

/// A file name for all ranks; the file goes with the test.
struct File {
  std::string path;
  File() {
    long id = getpid();
    MPI_Bcast(&id, 1, MPI_LONG, 0, PETSC_COMM_WORLD);
    path = (std::filesystem::temp_directory_path() / fmt::format("floe_reduced_scene_{}.h5", id)).string();
  }
  ~File() {
    MPI_Barrier(PETSC_COMM_WORLD);
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

/// The scene with its mesh, and with the body from a file made of it on all ranks.
struct Pair {
  File file;
  std::string meshed, from_file;
  Pair(const std::string& text, const std::string& body, const std::string& mesh) {
    meshed = fill(text, {{body, mesh}});
    std::vector<std::string> warnings;
    assembly::reduce_body(scene::parse_scene(meshed, "scene"), body, PETSC_COMM_WORLD, file.path, true, warnings);
    from_file = fill(text, {{body, "\n    reduced: " + file.path}});
  }
};

double greatest(const std::vector<double>& values) {
  double all = 0;
  for (const double value : values) all = std::max(all, std::abs(value));
  return all;
}

/// Each column within `tolerance` of its greatest value; those that are zero but for round-off, of the others'.
void check_same(const History& a, const History& b, double tolerance) {
  REQUIRE(a.t.size() == b.t.size());
  REQUIRE(a.columns.size() == b.columns.size());
  double all = 0;
  for (const auto& [name, values] : b.columns) all = std::max(all, greatest(values));
  for (const auto& [name, values] : b.columns) {
    INFO(name);
    std::vector<double> off = a[name];
    for (std::size_t i = 0; i < off.size(); ++i) off[i] -= values[i];
    CHECK(greatest(off) <= tolerance * std::max(greatest(values), 1e-4 * all));
  }
}

}  // namespace

TEST_CASE("a mechanism moves with a body from a file as with its mesh") {
  for (const char* frame : {"pinned", "clamped", "mean-axis"}) {
    INFO(frame);
    const Pair scenes(mechanism, "rod", fill(rod, {{"frame", frame}, {"beta", "1e-4"}}));
    for (const Formulation formulation : {Formulation::vm_md, Formulation::vm})
      check_same(move(scenes.from_file, formulation), move(scenes.meshed, formulation), 1e-10);
  }
}

// On joints to the ground alone, which a file has, too.
TEST_CASE("modal damping comes from a file as from the mesh, in every frame") {
  for (const char* frame : {"pinned", "clamped", "mean-axis"}) {
    INFO(frame);
    const Pair scenes(R"yaml(
gravity: [0, -9.81]
bodies:
  rod: $rod
joints: {pin: {type: revolute, between: [ground, rod.start]}}
motion: {end: 0.2, step: 2e-3}
probes: {tip: {at: rod.end}}
)yaml",
                      "rod",
                      fill(R"(
    mesh: {polyline: {points: [[0, 0], [0.1, 0.1], [0.4, 0.1]], elements: [3, 9]}}
    section: {EA: 1e5, EI: 1, rhoA: 0.4, rhoI: 1e-5}
    damping: {modal: [0.01, 0.02]}
    frame: {type: $frame}
    reduction: {modes: 3})",
                           {{"frame", frame}}));
    check_same(move(scenes.from_file, Formulation::vm_md), move(scenes.meshed, Formulation::vm_md), 1e-10);
  }
}

TEST_CASE("a plate that the ground holds moves from its file as with its mesh") {
  const Pair scenes(plate, "plate", meshed_plate);
  for (const Formulation formulation : {Formulation::vm_md, Formulation::vm})
    check_same(move(scenes.from_file, formulation), move(scenes.meshed, formulation), 1e-10);
}

// With the constant C = beta K the last extreme is a third of this.
TEST_CASE("Kelvin-Voigt damping of a large deflection comes from a file as from the mesh") {
  const Pair scenes(R"yaml(
bodies:
  beam: $beam
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "t < 1 ? 2*(1 - cos(pi*t))/2 : 0"]}}
motion: {end: 1.5, step: 5e-3}
probes: {tip: {at: beam.end}}
)yaml",
                    "beam", R"(
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 2e4, EI: 1.67, rhoA: 0.16}
    damping: {stiffness: 1e-3, mass: 0.1, modal: [0.01, 0.01]}
    reduction: {modes: 3, derivatives: all})");
  check_same(move(scenes.from_file, Formulation::vm_md), move(scenes.meshed, Formulation::vm_md), 1e-9);
}

TEST_CASE("a file made on all ranks moves as the mesh does on one") {
  const Pair scenes(plate, "plate", meshed_plate);
  History alone{
      assembly::build(scene::parse_scene(scenes.meshed, "scene"), Formulation::vm_md, PETSC_COMM_SELF), {}, {}, {}, {}};
  solve::simulate(*alone.model.system, {0.1, 2e-3, 0.8, {}, "motion_"}, alone.model.U, alone.model.V,
                  [&](const solve::Instant& at) { store(alone, at.t, at.U, at.V); });
  check_same(move(scenes.from_file, Formulation::vm_md), alone, 1e-9);
}

TEST_CASE("lffr of a body from a file is the linear body, beside bodies of full order") {
  const Pair arm(mechanism, "rod", fill(rod, {{"frame", "pinned"}, {"beta", "0"}}));
  const History linear = move(arm.from_file, Formulation::lffr), full = move(arm.meshed, Formulation::lffr);
  CHECK(linear.model.coordinates < full.model.coordinates);
  CHECK(relative_error(linear, full, "tip.x") < 0.01);
  CHECK(relative_error(linear, full, "bend.y") < 0.03);
  const Pair constrained(plate, "plate", meshed_plate);
  CHECK(relative_error(move(constrained.from_file, Formulation::lffr), move(constrained.meshed, Formulation::lffr),
                       "tip.z") < 0.05);
}

TEST_CASE("formulations of full order name the body that has no mesh") {
  const Pair scenes(plate, "plate", meshed_plate);
  for (const Formulation formulation : {Formulation::nlffr, Formulation::cfr})
    CHECK_THROWS_WITH(history_of(scenes.from_file, formulation),
                      Catch::Contains("bodies.plate.reduced: has no mesh, but formulation " +
                                      scene::name_of(formulation) + " needs one; expected vm+md, vm or lffr"));
}

TEST_CASE("frequencies of a body from a file are those of its mesh, and derivatives beside it are chosen by count") {
  const Pair constrained(plate, "plate", meshed_plate);
  const auto omega = [](const std::string& text) {
    return assembly::body_modes(scene::parse_scene(text, "scene"), PETSC_COMM_WORLD).at(0).omega;
  };
  const std::vector<double> file = omega(constrained.from_file), mesh = omega(constrained.meshed);
  REQUIRE(file.size() == mesh.size());
  for (std::size_t i = 0; i < file.size(); ++i) CHECK(file[i] == Approx(mesh[i]).epsilon(1e-10));
  const Pair arm(mechanism, "rod", fill(rod, {{"frame", "pinned"}, {"beta", "1e-4"}}));
  std::string chosen = arm.from_file;
  chosen.replace(chosen.find("alone: 2}"), 9, "alone: 2}, derivatives: 1");
  CHECK(history_of(chosen, Formulation::vm_md).model.bodies.at(0).columns <
        history_of(arm.from_file, Formulation::vm_md).model.bodies.at(0).columns);
}
