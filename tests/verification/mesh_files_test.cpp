#include <catch2/catch.hpp>
#include <fstream>

#include "floe/mesh/generate.h"
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

mesh::RawMesh plate(bool triangles, double size) {
  mesh::Plate plate{{0, 0, 0}, {2 * size, 0, 0}, {0, size, 0}, na, nb};
  plate.cells = triangles ? mesh::ShellCells::triangles : mesh::ShellCells::quadrilaterals;
  return mesh::plate(PETSC_COMM_WORLD, plate);
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
      mesh::write_gmsh(folder + "/plate.msh", plate(triangles, 1), encoding);
      const auto found = frequencies("file: {path: plate.msh}",
                                     "parts: {plate: {section: {thickness: 0.002}}}\n    "
                                     "material: {E: 7e10, nu: 0.3, rho: 2700}",
                                     folder);
      for (int i = 0; i < 6; ++i) CHECK(found[i] == Approx(expected[i]).epsilon(1e-9));
    }
    std::ofstream(folder + "/plate.inp") << deck(plate(triangles, 1));
    const auto own = frequencies("file: {path: plate.inp}", "frame: mean-axis", folder);  // the deck's own section
    for (int i = 0; i < 6; ++i) CHECK(own[i] == Approx(expected[i]).epsilon(1e-9));
    std::ofstream(folder + "/plate.inp") << deck(plate(triangles, 1000));  // in millimetres
    const auto scaled = frequencies("file: {path: plate.inp, scale: 1e-3}", keys, folder);
    for (int i = 0; i < 6; ++i) CHECK(scaled[i] == Approx(expected[i]).epsilon(1e-9));
  }
}

TEST_CASE("a part of the scene goes before the deck's section of the same name") {
  const Scratch scratch;
  const std::string folder = scratch.path.string();
  std::ofstream(folder + "/plate.inp") << deck(plate(true, 1));
  const auto thin = frequencies("file: {path: plate.inp}", "frame: mean-axis", folder),
             thick = frequencies(
                 "file: {path: plate.inp}",
                 "parts: {skin: {section: {thickness: 0.004}, material: {E: 7e10, nu: 0.3, rho: 2700}}}", folder);
  CHECK(thick[0] == Approx(2 * thin[0]).epsilon(1e-4));  // bending: omega ~ h, but for the rotary inertia
}

// A fold passes the bending moment of one plate to the next and its drilling moment to the bending of the other.
TEST_CASE("a folded plate converges, with triangles and with quadrilaterals, to the same frequencies") {
  const Scratch scratch;
  const auto of = [&](mesh::ShellCells cells, int n) {
    mesh::Plate floor{{0, 0, 0}, {1, 0, 0}, {0, 0.5, 0}, 2 * n, n}, wall{{1, 0, 0}, {0, 0, 0.7}, {0, 0.5, 0}, n, n};
    floor.cells = wall.cells = cells;
    mesh::write_gmsh((scratch.path / "fold.msh").string(),
                     mesh::folded_plates(PETSC_COMM_WORLD, {{"floor", floor}, {"wall", wall}}));
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
  using mesh::ShellCells;
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
