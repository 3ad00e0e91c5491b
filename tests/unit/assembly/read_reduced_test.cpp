#include <catch2/catch.hpp>

#include "floe/assembly/reduced_bodies_file.h"
#include "spatial_scene.h"

using namespace floe;
using Faults = std::vector<std::string>;

namespace {

const std::string beam =
    "bodies: {b: {mesh: {line: {from: [0, 0], to: [2, 0], elements: 4}}, section: {EA: 1e4, EI: 1, "
    "rhoA: 1}, reduction: {modes: 2}}}\n";
const std::string plate = testing::one_body(testing::plate, testing::thickness + testing::metal,
                                            "joints: {j: {type: fixed, between: [ground, b.left]}}\n");

/// Files of a beam in the plane and a plate in space, beside the scene.
struct Files {
  testing::Folder folder;
  Files() {
    std::vector<std::string> warnings;
    for (const auto& [name, text] : {std::pair("beam.h5", beam), std::pair("plate.h5", plate)})
      assembly::reduce_body(scene::parse_scene(text, "s.yaml"), "b", PETSC_COMM_WORLD, folder.path / name, true,
                            warnings);
  }
  /// Faults of a scene of these lines, their file names without folders.
  Faults faults(const std::string& text, scene::Formulation formulation = scene::Formulation::vm_md) const {
    Faults all;
    try {
      assembly::build(scene::parse_scene(text, (folder.path / "s.yaml").string()), formulation, PETSC_COMM_WORLD);
    } catch (const InputError& error) {
      all = error.faults();
    }
    const std::string here = folder.path.string() + "/";
    for (std::string& fault : all)
      for (std::size_t at = fault.find(here); at != std::string::npos; at = fault.find(here))
        fault.erase(at, here.size());
    return all;
  }
};

const std::string motion = "motion: {end: 1, step: 0.1}\n";

}  // namespace

TEST_CASE("a body from a file is read, relative to the scene's folder, in the dimension of the file") {
  const Files files;
  const auto read = [&](const std::string& name) {
    return scene::parse_scene("bodies: {b: {reduced: " + name + "}}\n", (files.folder.path / "s.yaml").string());
  };
  CHECK(read("beam.h5").dimension == 2);
  CHECK(read("plate.h5").dimension == 3);
  CHECK(read("plate.h5").bodies.at(0).reduced->file->nodes == 15);
  CHECK(read("../" + files.folder.path.filename().string() + "/beam.h5").bodies.at(0).reduced->file->name == "b");
}

TEST_CASE("keys beside a reduced body are refused, each where it stands") {
  const Files files;
  const Faults found = files.faults(
      "bodies:\n  b:\n    reduced: beam.h5\n    rigid: false\n    frame: pinned\n    mesh: 1\n"
      "    section: {A: 1}\n    damping: {mass: 1}\n    reduction: {modes: 3}\n");
  CHECK(found.at(0) ==
        "s.yaml:4:12: bodies.b.rigid: does not apply together with reduced; expected this key only with a mesh");
  CHECK(found.size() == 6);
  CHECK(files.faults("bodies: {b: {reduced: beam.h5, initial: {angle: 1, deformation: [0, x]}}}\n") ==
        Faults{"s.yaml:1:65: bodies.b.initial.deformation: does not apply to a body from a file; expected this key "
               "only with "
               "a mesh"});
  CHECK(files.faults("bodies: {b: {reduced: plate.h5, initial: {angle: 1}}}\n") ==
        Faults{"s.yaml:1:50: bodies.b.initial.angle: does not apply here; expected this key only in planar scenes"});
  CHECK(files.faults("bodies: {b: {reduced: plate.h5, initial: {rotation: [0, 0, 1]}}}\n").empty());
}

TEST_CASE("a file that is missing or of another kind is one fault at its key") {
  const Files files;
  CHECK(files.faults("bodies: {b: {reduced: bem.h5}}\nprobes: {p: {at: b.tip}}\n") ==
        Faults{"s.yaml:1:23: bodies.b.reduced: there is no file \"bem.h5\"; expected a file written by `floe reduce`, "
               "relative to the folder of the scene"});
  CHECK(files.faults("bodies: {b: {reduced: ''}}\n") ==
        Faults{"s.yaml:1:23: bodies.b.reduced: is empty; expected a file written by `floe reduce`"});
  CHECK(files.faults("bodies: {b: {reduced: [1]}}\n").size() == 1);
  files.folder.write("text.h5", "no HDF5");
  const Faults found = files.faults("bodies: {b: {reduced: text.h5}}\n");
  CHECK(found.size() == 1);
  CHECK(
      found.at(0).starts_with("s.yaml:1:23: bodies.b.reduced: reduced body 'text.h5': expected a complete HDF5 file"));
  CHECK(files.faults("bodies: {a: {reduced: beam.h5}, b: {reduced: plate.h5}}\n") ==
        Faults{"s.yaml:1:23: bodies.a.reduced: \"beam.h5\" contains a planar body, and the scene is spatial; "
               "expected bodies that are all planar, or all spatial"});
}

TEST_CASE("places of a reduced body are those of its file, or nodes of its shapes") {
  const Files files;
  const std::string constrained =
      "bodies: {b: {reduced: plate.h5}}\njoints: {j: {type: fixed, between: [ground, b.left]}}\n";
  CHECK(files.faults(constrained + "probes: {p: {at: b.p2}, q: {at: {body: b, node: [1, 0.5, 0]}}}\n").empty());
  CHECK(files.faults(constrained + "probes: {p: {at: b.rigth}}\n") ==
        Faults{"s.yaml:3:18: probes.p.at: b has no place \"rigth\"; expected one of bottom, centre, left, p1, p2, p3, "
               "p4, right, "
               "top, or coordinates; did you mean \"right\"?"});
  CHECK(files.faults(constrained + "probes: {p: {at: {body: b, node: [1, 0.4, 0]}}}\n") ==
        Faults{"s.yaml:3:14: probes.p.at: no node of b at (1, 0.4, 0); the nearest node is at (1, 0.5, 0)"});
  CHECK(files.faults("bodies: {b: {reduced: beam.h5}}\njoints: {j: {type: revolute, between: [b.end, b.end]}}\n") ==
        Faults{"s.yaml:2:10: joints.j: connects a place with itself; expected two different places"});
  CHECK(files
            .faults("bodies: {b: {reduced: beam.h5}}\njoints: {j: {type: revolute, between: [{body: ground, node: [1, "
                    "0]}, b.end]}}\n")
            .at(0)
            .find("are 1 apart at the start") != std::string::npos);
}

TEST_CASE("nodes by coordinates need the shapes in the file") {
  const Files files;
  const std::string path = (files.folder.path / "beam.h5").string();
  output::write_reduced_body(PETSC_COMM_WORLD, path, output::read_reduced_body(PETSC_COMM_WORLD, path), true);
  CHECK(files.faults("bodies: {b: {reduced: beam.h5}}\nprobes: {p: {at: {body: b, node: [1, 0]}}, q: {at: b.end}}\n") ==
        Faults{"s.yaml:2:14: probes.p.at: refers to a node by coordinates, and \"beam.h5\" has no shapes with "
               "coordinates; expected "
               "one of end, middle, start"});
}

TEST_CASE("a reduced body in space floats, is clamped where it was held, and also where it moves") {
  const Files files;
  const std::string body = "bodies: {b: {reduced: plate.h5}}\n";
  CHECK(files.faults(body).empty());
  CHECK(files
            .faults(body + "joints: {j: {type: fixed, between: [ground, b.left]}, k: {type: fixed, between: [b.p3, "
                           "ground]}}\n")
            .empty());
}

TEST_CASE("a body from a file that is held otherwise than its modes is reported with both lists") {
  const Files files;
  const auto warnings = [&](const std::string& body, const std::string& joints) {
    const std::string path = (files.folder.path / (body + ".h5")).string();
    return assembly::build(scene::parse_scene("bodies: {b: {reduced: " + path + "}, o: {rigid: {mass: 1, " +
                                                  (body == "beam" ? "centre: [2, 0], inertia: 1"
                                                                  : "centre: [0, 0, 0], inertia: [1, 1, 1]") +
                                                  "}}}\njoints: {" + joints + "}\n",
                                              "s.yaml"),
                           scene::Formulation::vm_md, PETSC_COMM_WORLD)
        .warnings;
  };
  const auto line = [&](const std::string& body, const std::string& of_modes, const std::string& of_scene) {
    return std::vector{"body b: the modes in " + (files.folder.path / (body + ".h5")).string() +
                       " are constrained by " + of_modes + ", the body in this scene by " + of_scene +
                       ": it can be much too stiff; reduce it with the joints of this scene"};
  };
  CHECK(warnings("plate", "j: {type: fixed, between: [b.left, ground]}").empty());
  CHECK(warnings("plate", "j: {type: driven, between: [ground, b.left], axis: [0, 0, 1], angle: t}").empty());
  CHECK(warnings("plate", "") == line("plate", "fixed at left", "nothing"));
  CHECK(warnings("plate", "j: {type: revolute, axis: [0, 1, 0], between: [ground, b.left]}") ==
        line("plate", "fixed at left", "revolute about y at left"));
  CHECK(warnings("plate", "j: {type: fixed, between: [ground, b.left]}, k: {type: fixed, between: [b.p3, ground]}")
            .back() == line("plate", "fixed at left", "fixed at left, fixed at p3").front());
  CHECK(warnings("beam", "").empty());
  CHECK(warnings("beam", "j: {type: fixed, between: [b.end, o.centre]}").empty());
  CHECK(warnings("beam", "j: {type: fixed, between: [ground, {body: b, node: [0, 0]}]}") ==
        line("beam", "nothing", "fixed at (0, 0)"));
}

TEST_CASE("a body from a file that another body hinges at its clamped frame is held as its modes") {
  const Files files;
  const std::string path = (files.folder.path / "hinged.h5").string();
  const auto scene_of = [](const std::string& body, const std::string& axis) {
    return scene::parse_scene(
        "bodies: {b: {" + body +
            "}, o: {rigid: {mass: 1, centre: [0, 0.5, 0], inertia: [1, 1, 1]}}}\njoints: {j: {type: "
            "revolute, axis: [" +
            axis + "], between: [o.centre, b.left]}}\n",
        "s.yaml");
  };
  std::vector<std::string> ignored;
  assembly::reduce_body(scene_of("mesh: {plate: {along: [1, 0, 0], across: [0, 1, 0], elements: [2, 2]}}, section: "
                                 "{thickness: 0.01}, material: {E: 7e10, nu: 0.3, rho: 2700}, frame: {type: clamped, "
                                 "at: left}, reduction: {modes: 2}",
                                 "0, 1, 0"),
                        "b", PETSC_COMM_WORLD, path, true, ignored);
  const auto warnings = [&](const std::string& axis) {
    return assembly::build(scene_of("reduced: " + path, axis), scene::Formulation::vm_md, PETSC_COMM_WORLD).warnings;
  };
  CHECK(warnings("0, 1, 0").empty());
  CHECK(warnings("1, 0, 0").size() == 1);
}

TEST_CASE("a body that is reduced already is not reduced again") {
  const Files files;
  std::vector<std::string> warnings;
  const scene::Scene scene =
      scene::parse_scene("bodies: {b: {reduced: beam.h5}}\n", (files.folder.path / "s.yaml").string());
  CHECK_THROWS_WITH(assembly::reduce_body(scene, "", PETSC_COMM_WORLD, files.folder.path / "again.h5", true, warnings),
                    Catch::EndsWith("bodies.b.reduced: is reduced already; expected a body with a mesh"));
}

TEST_CASE("a body that is reduced under supports or split into frames is reported") {
  const testing::Folder folder;
  const std::string path = (folder.path / "b.h5").string(), held = R"yaml(
joints:
  j: {type: support, between: [ground, b.left], hold: [x, y, z]}
  k: {type: support, between: [ground, b.right], hold: [z]}
)yaml";
  std::vector<std::string> warnings;
  assembly::reduce_body(
      scene::parse_scene(
          testing::one_body(testing::plate, testing::thickness + testing::metal + "    frames: 2\n", held), "s.yaml"),
      "b", PETSC_COMM_WORLD, path, true, warnings);
  REQUIRE(warnings.size() == 2);
  CHECK(warnings[0] == "body b: frames: 2 is not used: the file has the whole body in one frame");
  CHECK(warnings[1] ==
        "body b: its basis vectors satisfy its supports (j, k), which scenes that use the file cannot have");
  CHECK_THROWS_WITH(assembly::build(scene::parse_scene("bodies: {b: {reduced: " + path + "}}\n" + held, "s.yaml"),
                                    scene::Formulation::vm_md, PETSC_COMM_WORLD),
                    Catch::Contains("supports hold bodies with a mesh, and body b comes from a file"));
}

TEST_CASE("the vm of a file needs its modes before its derivatives") {
  const Files files;
  const std::string path = (files.folder.path / "beam.h5").string();
  output::ReducedBodyFile file = output::read_reduced_body(PETSC_COMM_WORLD, path);
  std::swap(file.columns.front(), file.columns.back());
  output::write_reduced_body(PETSC_COMM_WORLD, path, file, true);
  const std::string text = "bodies: {b: {reduced: beam.h5}}\n" + motion;
  CHECK(files.faults(text).empty());
  CHECK(files.faults(text, scene::Formulation::vm).at(0).find("a derivative precedes a mode") != std::string::npos);
}

TEST_CASE("another body of the scene does not hold the one that is reduced") {
  const auto first = [](const std::string& rest) {
    const testing::Folder folder;
    std::vector<std::string> warnings;
    return assembly::reduce_body(scene::parse_scene(rest, "s.yaml"), "b", PETSC_COMM_WORLD, folder.path / "b.h5", true,
                                 warnings)
        .omega.at(0);
  };
  const std::string two =
      beam.substr(0, beam.size() - 2) +
      ", c: {mesh: {line: {from: [2, 0], to: [3, 0], elements: 2}}, section: {EA: 1, EI: 1, rhoA: 1}}}\n";
  const double pi_over_length_squared = 2.4674;  // hinged at both ends: omega = (pi/L)^2 sqrt(EI/rhoA)
  CHECK(first(two + "joints: {j: {type: fixed, between: [b.end, c.start]} }\n") >
        1.5 * pi_over_length_squared);  // as if alone: free at both ends, 4.730^2/L^2
  CHECK(first(beam + "joints: {j: {type: revolute, between: [b.end, ground]}, k: {type: revolute, between: [b.start, "
                     "ground]}}\n") == Approx(pi_over_length_squared).epsilon(0.01));
}

// Hinged at both ends, immovable: u_ij' = -v_i' v_j' + its mean, v_i = sin(i pi x / L), omega_i ~ i^2. With s_n =
// sin(n pi x / L) and c = pi / L, theta_11 = -c s_2 / 4, theta_12 = -c (s_1 + s_3 / 3), theta_13 = -3/2 c (s_2 / 2 +
// s_4 / 4), theta_23 = -3 c (s_1 + s_5 / 5); of theta_13 only s_4 is new, theta_22 = -c s_4 / 2 adds nothing after it.
TEST_CASE("derivatives that are chosen by count are those with the greatest interaction under equal forces") {
  const testing::Folder folder;
  std::vector<std::string> warnings;
  const std::string text =
      "bodies: {b: {mesh: {line: {from: [0, 0], to: [2, 0], elements: 32}}, section: {EA: 1e6, EI: 1, rhoA: 1}, "
      "reduction: {modes: 3, derivatives: 4}}}\n"
      "joints: {j: {type: revolute, between: [b.end, ground]}, k: {type: revolute, between: [b.start, ground]}}\n";
  const output::ReducedBodyFile file = assembly::reduce_body(scene::parse_scene(text, "s.yaml"), "b", PETSC_COMM_WORLD,
                                                             folder.path / "b.h5", true, warnings);
  std::vector<std::string> chosen;
  std::vector<double> interaction;
  for (const output::ReducedColumn& column : file.columns)
    if (column.kind == "derivative") chosen.push_back(column.label), interaction.push_back(column.interaction);
  CHECK(chosen == std::vector<std::string>{"derivative 1,1", "derivative 1,2", "derivative 1,3", "derivative 2,3"});
  const double first = 0.5 * 0.25, second = std::sqrt(1 + 1. / 9) / 16, third = 1.5 / 4 / 81,
               fourth = 3 * std::sqrt(0.1 * 0.1 + 0.3 * 0.3 + 0.2 * 0.2) / (16 * 81);
  REQUIRE(interaction.size() == 4);
  CHECK(interaction[0] == 1);
  CHECK(interaction[1] == Approx(second / first).epsilon(0.03));
  CHECK(interaction[2] == Approx(third / first).epsilon(0.03));
  CHECK(interaction[3] == Approx(fourth / first).epsilon(0.03));
  CHECK(output::describe(file).find("interaction") != std::string::npos);
}
