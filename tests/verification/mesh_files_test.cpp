#include <catch2/catch.hpp>
#include <fstream>

#include "../../src/app/run.h"
#include "floe/generate/generate.h"
#include "floe/math/rotation.h"
#include "floe/mesh/write_gmsh.h"
#include "spatial_scenes.h"

using namespace floe;
using namespace floe::test;

namespace {

constexpr int na = 8, nb = 4;

std::vector<double> frequencies(const std::string& mesh, const std::string& keys, const std::string& folder) {
  return omega_of(fill(R"yaml(
bodies:
  plate:
    mesh: {$mesh}
    $keys
    reduction: {modes: 6}
joints: {root: {type: fixed, between: [ground, plate.left]}}
)yaml",
                       {{"mesh", mesh}, {"keys", keys}}),
                  folder + "/scene.yaml");
}

mesh::RawMesh plate(bool triangles, double size, int times = 1) {
  generate::Plate plate{{0, 0, 0}, {2 * size, 0, 0}, {0, size, 0}, times * na, times * nb};
  plate.cells = triangles ? generate::ShellCells::triangles : generate::ShellCells::quadrilaterals;
  return generate::plate(PETSC_COMM_SELF, plate);
}

/// The plate as a deck, with labels that have gaps and run backwards.
std::string deck(const mesh::RawMesh& raw) {
  const auto label = [&](PetscInt node) { return std::to_string(10 * (raw.node_count - node)); };
  std::string text = "*NODE\n", left;
  for (PetscInt i = 0; i < raw.node_count; ++i) {
    const auto& x = raw.positions[i];
    text += fmt::format("{}, {:.17g}, {:.17g}, {:.17g}\n", label(i), x[0], x[1], x[2]);
    if (x[0] == 0) left += label(i) + ",\n";
  }
  const int n = mesh::node_count(raw.cells[0].kind);
  text += fmt::format("*ELEMENT, TYPE=S{}, ELSET=skin\n", n);
  for (std::size_t c = 0; c < raw.cells.size(); ++c) {
    text += std::to_string(c + 1);
    for (int i = 0; i < n; ++i) text += ", " + label(raw.cells[c].nodes[i]);
    text += "\n";
  }
  return text + "*NSET, NSET=left\n" + left +
         "*MATERIAL, NAME=metal\n*ELASTIC\n7e10, 0.3\n*DENSITY\n2700\n"
         "*SHELL SECTION, ELSET=skin, MATERIAL=metal\n0.002\n";
}

}  // namespace

TEST_CASE("a plate from a .msh or .inp file has the frequencies of the generated one") {
  const Scratch scratch;
  const std::string folder = scratch.path.string(),
                    keys = "section: {thickness: 0.002}\n    material: {E: 7e10, nu: 0.3, rho: 2700}";
  for (const bool triangles : {true, false}) {
    const std::string cells = triangles ? "triangles" : "quadrilaterals";
    INFO(cells);
    const auto expected = frequencies(
        fmt::format("plate: {{along: [2, 0, 0], across: [0, 1, 0], elements: [{}, {}], cells: {}}}", na, nb, cells),
        keys, folder);
    for (const auto encoding : {mesh::GmshEncoding::ascii, mesh::GmshEncoding::binary}) {
      on_first_rank([&] { mesh::write_gmsh(folder + "/plate.msh", plate(triangles, 1), encoding); });
      const auto found = frequencies("file: {path: plate.msh}",
                                     "parts: {plate: {section: {thickness: 0.002}}}\n    "
                                     "material: {E: 7e10, nu: 0.3, rho: 2700}",
                                     folder);
      for (int i = 0; i < 6; ++i) CHECK(found[i] == Approx(expected[i]).epsilon(1e-9));
    }
    write_text(folder + "/plate.inp", deck(plate(triangles, 1)));
    const auto own = frequencies("file: {path: plate.inp}", "frame: mean-axis", folder);  // the deck's own section
    for (int i = 0; i < 6; ++i) CHECK(own[i] == Approx(expected[i]).epsilon(1e-9));
    write_text(folder + "/plate.inp", deck(plate(triangles, 1000)));  // in millimetres
    const auto scaled = frequencies("file: {path: plate.inp, scale: 1e-3}", keys, folder);
    for (int i = 0; i < 6; ++i) CHECK(scaled[i] == Approx(expected[i]).epsilon(1e-9));
  }
}

TEST_CASE("a mesh file that is refined has the frequencies of the generated mesh of twice as many elements") {
  const Scratch scratch;
  const std::string folder = scratch.path.string(),
                    keys = "section: {thickness: 0.002}\n    material: {E: 7e10, nu: 0.3, rho: 2700}";
  const auto expected = frequencies(
      fmt::format("plate: {{along: [2, 0, 0], across: [0, 1, 0], elements: [{}, {}], cells: quadrilaterals}}", 4 * na,
                  4 * nb),
      keys, folder);
  on_first_rank([&] { mesh::write_gmsh(folder + "/plate.msh", plate(false, 1)); });
  write_text(folder + "/plate.inp", deck(plate(false, 1)));
  for (const char* file : {"plate.msh", "plate.inp"}) {
    const auto found = frequencies(fmt::format("file: {{path: {}, refine: 2}}", file), keys, folder);
    for (int i = 0; i < 6; ++i) CHECK(found[i] == Approx(expected[i]).epsilon(1e-8));
  }
}

// Mesh, load and probes are the same, so every part of the error is.
TEST_CASE("the estimated error of an imported mesh is that of the generated one") {
  const Scratch scratch;
  const std::string folder = scratch.path.string();
  on_first_rank([&] { mesh::write_gmsh(folder + "/plate.msh", plate(false, 1)); });
  const auto estimate = [&](const std::string& mesh) {
    app::RunPlan plan;
    plan.quiet = true, plan.check_range = false, plan.estimate = true;
    const std::string scene = fill(R"yaml(
bodies:
  plate:
    mesh: {$mesh}
    section: {thickness: 0.02}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    strains: von_karman
    reduction: {modes: 3}
joints: {root: {type: fixed, between: [ground, plate.left]}}
loads: {tip: {type: force, at: plate.right, force: [0, 0, "100*sin(20*t)"]}}
motion: {end: 0.05, step: 5e-4}
probes: {tip: {at: plate.right}}
)yaml",
                                   {{"mesh", mesh}});
    return app::run(scene::parse_scene(scene, folder + "/scene.yaml"), Formulation::vm_md, PETSC_COMM_SELF,
                    std::nullopt, plan)
        .summary["estimate"];
  };
  const auto generated = estimate(
      fmt::format("plate: {{along: [2, 0, 0], across: [0, 1, 0], elements: [{}, {}], cells: quadrilaterals}}", na, nb));
  const auto imported = estimate("file: {path: plate.msh}");
  INFO(generated.dump());
  REQUIRE(generated["mesh"].contains("probes"));
  INFO(imported.dump());
  REQUIRE(imported["mesh"].contains("probes"));
  REQUIRE(generated["mesh"]["probes"]["tip"].get<double>() > 5e-4);
  CHECK(imported["mesh"]["by"] == "elements half as long");
  CHECK(imported["mesh"]["probes"]["tip"].get<double>() ==
        Approx(generated["mesh"]["probes"]["tip"].get<double>()).epsilon(1e-6));
}

namespace {

/// The deck's plate with a hub and a tip block: reference nodes that move the edges x = 0 and x = 2 rigidly.
std::string linked_deck(int times = 1) {
  const mesh::RawMesh raw = plate(false, 1, times);
  std::string text = deck(raw), right;
  for (PetscInt i = 0; i < raw.node_count; ++i)
    if (raw.positions[i][0] == 2) right += std::to_string(10 * (raw.node_count - i)) + ",\n";
  return text + "*NODE\n9001, -0.3, 0.4, 0.1\n9002, 2.2, 0.5, 0.05\n*NSET, NSET=right\n" + right +
         "*RIGID BODY, NSET=left, REF NODE=9001\n*RIGID BODY, NSET=right, REF NODE=9002\n";
}

std::string on_hub(const std::string& place, const std::string& more) {
  return fill(R"yaml(
bodies:
  plate:
    mesh: {file: {path: plate.inp}}
    reduction: {modes: 8, attachment: loads}
joints: {root: {type: fixed, between: [ground, {body: plate, $place}]}}
$more
)yaml",
              {{"place", place}, {"more", more}});
}

}  // namespace

TEST_CASE("a plate supported by a hub on rigid links has the frequencies of one with a clamped edge") {
  const Scratch scratch;
  const std::string folder = scratch.path.string();
  std::string text = linked_deck();
  text.erase(text.find("*RIGID BODY, NSET=right"));
  text.replace(text.find("9002, 2.2, 0.5, 0.05\n"), 21, "");
  write_text(folder + "/plate.inp", text);
  const auto constrained = omega_of(on_hub("node: [-0.3, 0.4, 0.1]", ""), folder + "/scene.yaml");
  write_text(folder + "/plate.inp", deck(plate(false, 1)));
  const auto expected = frequencies("file: {path: plate.inp}", "frame: mean-axis", folder);
  for (int i = 0; i < 6; ++i) CHECK(constrained[i] == Approx(expected[i]).epsilon(1e-9));
}

// Where the first node of the file only follows, supports that make K regular have to be looked for elsewhere.
TEST_CASE("a free plate with a hub has the same frequencies whichever edge the hub moves") {
  const Scratch scratch;
  const std::string folder = scratch.path.string();
  std::vector<double> omega[2];
  for (int side : {0, 1}) {
    std::string text = deck(plate(false, 1)), edge;
    const mesh::RawMesh raw = plate(false, 1);
    for (PetscInt i = 0; i < raw.node_count; ++i)
      if (raw.positions[i][0] == 2 * side) edge += std::to_string(10 * (raw.node_count - i)) + ",\n";
    text += fmt::format("*NODE\n9001, {}, 0.4, 0.1\n*NSET, NSET=hub\n{}*RIGID BODY, NSET=hub, REF NODE=9001\n",
                        side ? 2.3 : -0.3, edge);
    write_text(folder + "/plate.inp", text);
    omega[side] =
        omega_of("bodies: {plate: {mesh: {file: {path: plate.inp}}, reduction: {modes: 4}}}\n", folder + "/scene.yaml");
  }
  for (int i = 0; i < 4; ++i) CHECK(omega[0][i] == Approx(omega[1][i]).epsilon(1e-6));
}

// Cantilever with a tip mass as heavy as itself: omega = 1.2479174^2 sqrt(EI / rhoA L^4), a root of
// 1 + cos cosh + x (cos sinh - sin cosh).
TEST_CASE("a deck's point mass, and two on one node") {
  const std::string masses = GENERATE("99, 21\n*MASS, ELSET=tip\n7.8\n", "99, 21\n98, 21\n*MASS, ELSET=tip\n3.9\n");
  const Scratch scratch;
  const std::string folder = scratch.path.string();
  std::string text = "*NODE\n";
  for (int i = 0; i <= 20; ++i) text += fmt::format("{}, {}, 0., 0.\n", i + 1, i / 20.);
  text += "*ELEMENT, TYPE=B31, ELSET=beam\n";
  for (int i = 1; i <= 20; ++i) text += fmt::format("{}, {}, {}\n", i, i, i + 1);
  write_text(folder + "/beam.inp", text + "*ELEMENT, TYPE=MASS, ELSET=tip\n" + masses +
                                       "*NSET, NSET=root\n1\n*MATERIAL, NAME=m\n*ELASTIC\n2e11, 0.3\n*DENSITY\n"
                                       "7800.\n*BEAM SECTION, ELSET=beam, MATERIAL=m, SECTION=RECT\n.02, .05\n"
                                       "0., 0., -1.\n");
  const auto omega = omega_of(
      "bodies: {b: {mesh: {file: {path: beam.inp}}, reduction: {modes: 1}}}\n"
      "joints: {c: {type: fixed, between: [ground, b.root]}}\n",
      folder + "/scene.yaml");
  CHECK(omega[0] == Approx(1.2479174 * 1.2479174 * std::sqrt(2e11 * 0.05 * 8e-6 / 12 / 7.8)).epsilon(1e-3));
}

// The edge between dependent nodes was rigid, and remains so.
TEST_CASE("rigid links hold the edges of a refined mesh as those of a deck with as many elements") {
  const Scratch scratch;
  const std::string folder = scratch.path.string();
  const auto omega = [&](int times, int refine) {
    write_text(folder + "/plate.inp", linked_deck(times));
    std::string scene = on_hub("node: [-0.3, 0.4, 0.1]", "");
    scene.replace(scene.find("plate.inp}"), 10, fmt::format("plate.inp, refine: {}}}", refine));
    return omega_of(scene, folder + "/scene.yaml");
  };
  const auto refined = omega(1, 1), fine = omega(2, 0);
  for (int i = 0; i < 6; ++i) CHECK(refined[i] == Approx(fine[i]).epsilon(1e-8));
}

namespace {

/// A plate of quadrilaterals with a bar along its middle, 20 mm above it; its edge x = 0 follows a hub.
std::string stiffened_plate(int n, int m) {
  const auto grid = [&](int i, int j) { return 1 + i * (m + 1) + j; };
  std::string text = "BEGIN BULK\n";
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j)
      text += fmt::format("GRID,{},,{:.10g},{:.10g},0.0\n", grid(i, j), double(i) / n, 0.3 * j / m);
  int element = 1;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j)
      text += fmt::format("CQUAD4,{},1,{},{},{},{}\n", element++, grid(i, j), grid(i + 1, j), grid(i + 1, j + 1),
                          grid(i, j + 1));
  for (int i = 0; i < n; ++i)
    text += fmt::format("CBAR,{},2,{},{},0.0,0.0,1.0,,\n,,,0.0,0.0,0.02,0.0,0.0,0.02\n", element++, grid(i, m / 2),
                        grid(i + 1, m / 2));
  text += "GRID,9001,,-0.05,0.15,0.0\nRBE2,9002,9001,123456,1";
  for (int j = 1; j <= m; ++j) text += (j % 8 == 4 ? ",\n,," : ",") + std::to_string(grid(0, j));
  return text +
         "\nCONM2,9003,9001,,1.0-3\nPSHELL,1,1,0.001,1,,1\nPBAR,2,1,1.0-4,3.0-9,3.0-9,1.0-9\n"
         "MAT1,1,7.0+10,,0.3,2700.0\nENDDATA\n";
}

}  // namespace

// The nodes of a bar with offsets follow those of the plate, one by one; at the hub they follow the hub.
TEST_CASE("bars with offsets on a refined deck are those of a deck with as many elements") {
  const Scratch scratch;
  const std::string folder = scratch.path.string();
  const auto omega = [&](int n, int m, int refine) {
    write_text(folder + "/plate.bdf", stiffened_plate(n, m));
    return omega_of(
        fmt::format("bodies: {{plate: {{mesh: {{file: {{path: plate.bdf, refine: {}}}}}, reduction: {{modes: 6}}}}}}\n"
                    "joints: {{root: {{type: fixed, between: [ground, {{body: plate, node: [-0.05, 0.15, 0]}}]}}}}\n",
                    refine),
        folder + "/scene.yaml");
  };
  const auto coarse = omega(4, 2, 0), refined = omega(4, 2, 1), fine = omega(8, 4, 0);
  CHECK(std::abs(coarse[0] / fine[0] - 1) > 0.01);
  for (int i = 0; i < 6; ++i) CHECK(refined[i] == Approx(fine[i]).epsilon(1e-7));
}

TEST_CASE("a load on a rigid tip block: full-order, reduced, and at dependent nodes") {
  const Scratch scratch;
  const std::string folder = scratch.path.string();
  write_text(folder + "/plate.inp", linked_deck());
  const auto loaded = [](const std::string& tip) {
    return "loads: {f: {type: force, at: {body: plate, " + tip + "}, force: [0, 0, 0.5*t]}}\n" +
           "probes: {tip: {at: {body: plate, " + tip + "}}}\n";
  };
  const std::string hub = "node: [-0.3, 0.4, 0.1]", block = "node: [2.2, 0.5, 0.05]";
  const auto built = [&](const std::string& text, Formulation formulation) {
    return assembly::build(scene::parse_scene(text, folder + "/scene.yaml"), formulation, PETSC_COMM_WORLD);
  };
  std::map<Formulation, std::vector<double>> at;
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    const assembly::Model model = built(on_hub(hub, loaded(block)), formulation);
    solve::equilibrium(*model.system, 1, model.U, model.V);
    at[formulation] = assembly::probe_values(model, 1, model.U, model.V);
  }
  REQUIRE(at[Formulation::nlffr].size() == 3);
  CHECK(std::abs(at[Formulation::nlffr][2]) > 0.005);
  for (int i : {0, 2}) CHECK(at[Formulation::vm_md][i] == Approx(at[Formulation::nlffr][i]).epsilon(1e-2));
  // A place of the edge that the block moves: its displacement is that of the block's node with the arm between them.
  const std::string both = "loads: {f: {type: force, at: {body: plate, " + block + "}, force: [0, 0, 0.5*t]}}\n" +
                           "probes: {block: {at: {body: plate, " + block +
                           "}}, edge: {at: {body: plate, node: [2, 0.5, 0]}}, " + "turn: {at: {body: plate, " + block +
                           "}, quantity: rotation}}\n";
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    const assembly::Model model = built(on_hub(hub, both), formulation);
    solve::equilibrium(*model.system, 1, model.U, model.V);
    const std::vector<double> found = assembly::probe_values(model, 1, model.U, model.V);
    const Eigen::Vector3d u(found[0], found[1], found[2]), edge(found[3], found[4], found[5]),
        rotation(found[6], found[7], found[8]), arm(2 - 2.2, 0, -0.05);
    CHECK((edge - u - (math::rotation(rotation) * arm - arm)).norm() < 1e-9);
    CHECK(rotation.norm() > 1e-3);
  }
  // The hub of the deck may be named by a node of the edge that it moves.
  const assembly::Model by_edge = built(on_hub("node: [0, 0, 0]", loaded(block)), Formulation::vm_md);
  solve::equilibrium(*by_edge.system, 1, by_edge.U, by_edge.V);
  CHECK(assembly::probe_values(by_edge, 1, by_edge.U, by_edge.V)[2] == Approx(at[Formulation::vm_md][2]).epsilon(1e-6));
}

TEST_CASE("a part of the scene goes before the deck's section of the same name") {
  const Scratch scratch;
  const std::string folder = scratch.path.string();
  write_text(folder + "/plate.inp", deck(plate(true, 1)));
  const auto thin = frequencies("file: {path: plate.inp}", "frame: mean-axis", folder),
             thick = frequencies(
                 "file: {path: plate.inp}",
                 "parts: {skin: {section: {thickness: 0.004}, material: {E: 7e10, nu: 0.3, rho: 2700}}}", folder);
  CHECK(thick[0] == Approx(2 * thin[0]).epsilon(1e-4));  // bending: omega ~ h, but for the rotary inertia
}

// A fold passes the bending moment of one plate to the next and its drilling moment to the bending of the other.
TEST_CASE("a folded plate converges, with triangles and with quadrilaterals, to the same frequencies") {
  const Scratch scratch;
  const auto of = [&](generate::ShellCells cells, int n) {
    generate::Plate floor{{0, 0, 0}, {1, 0, 0}, {0, 0.5, 0}, 2 * n, n}, wall{{1, 0, 0}, {0, 0, 0.7}, {0, 0.5, 0}, n, n};
    floor.cells = wall.cells = cells;
    mesh::write_gmsh((scratch.path / "fold.msh").string(),
                     generate::folded_plates(PETSC_COMM_WORLD, {{"floor", floor}, {"wall", wall}}));
    return omega_of(R"yaml(
bodies:
  fold:
    mesh: {file: {path: fold.msh}}
    parts: {floor: {}, wall: {}}
    section: {thickness: 0.01}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 5}
joints: {root: {type: fixed, between: [ground, fold.floor.left]}}
)yaml",
                    (scratch.path / "scene.yaml").string());
  };
  using generate::ShellCells;
  std::vector<double> limit[2];
  for (const auto cells : {ShellCells::triangles, ShellCells::quadrilaterals}) {
    const auto coarse = of(cells, 4), middle = of(cells, 8), fine = of(cells, 16);
    for (int i = 0; i < 5; ++i) {
      INFO("mode " << i + 1 << ": " << coarse[i] << " " << middle[i] << " " << fine[i]);
      CHECK(std::abs(fine[i] - middle[i]) < 0.55 * std::abs(middle[i] - coarse[i]) + 2e-4 * fine[i]);
      CHECK(std::abs(fine[i] / middle[i] - 1) < 0.01);
    }
    limit[cells == ShellCells::triangles ? 0 : 1] = fine;
  }
  for (int i = 0; i < 5; ++i) CHECK(limit[0][i] == Approx(limit[1][i]).epsilon(5e-3));
}

// Cantilevers of 1 m (E = 2e11, nu = 0.3, rho = 7800, 20 elements) by CalculiX 2.20, which makes bricks of its beams:
// lowest frequencies in Hz of the profile's soft and stiff bending. What is tested is which number of a deck means
// what.
TEST_CASE("beam sections of a deck are read as CalculiX reads them") {
  const Scratch scratch;
  const std::string folder = scratch.path.string();
  const struct {
    const char *profile, *dimensions;
    double soft, stiff;
  } table[] = {{"RECT", ".02, .05", 16.36520, 40.85251},
               {"CIRC", ".02, .02", 14.33615, 14.33615},
               {"BOX", ".04, .08, .004, .006, .004, .006", 43.42801, 81.89007},
               {"PIPE", ".02, .003", 37.28377, 37.28377}};
  for (const auto& row : table) {
    INFO(row.profile);
    std::string text = "*NODE\n";
    for (int i = 0; i <= 20; ++i) text += fmt::format("{}, {}, 0., 0.\n", i + 1, i / 20.);
    text += "*ELEMENT, TYPE=B31, ELSET=beam\n";
    for (int i = 1; i <= 20; ++i) text += fmt::format("{}, {}, {}\n", i, i, i + 1);
    write_text(folder + "/beam.inp", text +
                                         "*NSET, NSET=root\n1\n*MATERIAL, NAME=m\n*ELASTIC\n2e11, 0.3\n"
                                         "*DENSITY\n7800.\n*BEAM SECTION, ELSET=beam, MATERIAL=m, SECTION=" +
                                         row.profile + "\n" + row.dimensions + "\n0., 0., -1.\n");
    const auto omega = omega_of(
        "bodies: {b: {mesh: {file: {path: beam.inp}}, reduction: {modes: 2}}}\n"
        "joints: {c: {type: fixed, between: [ground, b.root]}}\n",
        folder + "/scene.yaml");
    CHECK(omega[0] / (2 * M_PI) == Approx(row.soft).epsilon(1.3e-2));
    CHECK(omega[1] / (2 * M_PI) == Approx(row.stiff).epsilon(1.3e-2));
  }
}
