#include <catch2/catch.hpp>

#include "floe/assembly/reduced_bodies_file.h"
#include "space_twin.h"

using namespace floe;
using namespace floe::test;

// A force at an edge or an area is spread over it: each node has the share of its length or area.

namespace {

/// A strip of 1 m x 0.4 m, 10 mm thick, as a deck; across it the rows of nodes are at 0.4 m times the given parts.
std::string strip(const std::vector<double>& rows, bool triangles, int n = 6) {
  const int m = static_cast<int>(rows.size()) - 1;
  std::string nodes, quadrilaterals, halves, left, right, half;
  const auto id = [&](int i, int j) { return 1 + i + (n + 1) * j; };
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) {
      nodes += fmt::format("{}, {:.17g}, {:.17g}, 0\n", id(i, j), double(i) / n, 0.4 * rows[j]);
      if (i == n || j == m) continue;
      const int a = id(i, j), b = id(i + 1, j), c = id(i + 1, j + 1), d = id(i, j + 1), cell = 1 + i + n * j;
      quadrilaterals += fmt::format("{}, {}, {}, {}, {}\n", cell, a, b, c, d);
      halves += fmt::format("{}, {}, {}, {}\n{}, {}, {}, {}\n", 2 * cell, a, b, c, 2 * cell + 1, a, c, d);
    }
  for (int j = 0; j <= m; ++j) left += fmt::format("{},\n", id(0, j)), right += fmt::format("{},\n", id(n, j));
  for (int j = 0; j <= m; ++j)
    for (int i = n / 2; i <= n; ++i) half += fmt::format("{},\n", id(i, j));
  return "*NODE\n" + nodes +
         (triangles ? "*ELEMENT, TYPE=S3, ELSET=skin\n" + halves : "*ELEMENT, TYPE=S4, ELSET=skin\n" + quadrilaterals) +
         "*NSET, NSET=left\n" + left + "*NSET, NSET=right\n" + right + "*NSET, NSET=half\n" + half +
         "*MATERIAL, NAME=alloy\n*ELASTIC\n7e10, 0\n*DENSITY\n2700\n"
         "*SHELL SECTION, ELSET=skin, MATERIAL=alloy\n0.01\n";
}

std::string pulled(const std::string& deck, const std::string& rest) {
  return fill(R"yaml(
bodies: {strip: {mesh: {file: {path: $deck}}, reduction: {modes: 4, attachment: all}}}
$rest
)yaml",
              {{"deck", deck}, {"rest", rest}});
}

}  // namespace

TEST_CASE("edge forces: a strip in tension is longer by F L / EA, its end stays straight") {
  const Scratch folder;
  const std::string deck = (folder.path / "strip.inp").string();
  for (const bool triangles : {false, true})
    for (const std::vector<double>& rows :
         {std::vector<double>{0, 1}, {0, 0.5, 1}, {0, 0.1, 0.3, 1}, {0, 0.7, 0.9, 0.95, 1}}) {
      INFO((triangles ? "triangles, " : "quadrilaterals, ") << rows.size() - 1 << " across");
      write_text(deck, strip(rows, triangles));
      const std::string text = pulled(deck, R"yaml(
joints: {root: {type: fixed, between: [ground, strip.left]}}
loads: {pull: {type: force, at: strip.right, force: [7e6, 0, 0]}}
probes: {end: {at: strip.right}}
)yaml");
      for (const Formulation formulation : {Formulation::lffr, Formulation::nlffr, Formulation::vm_md}) {
        const History at = rest(text, formulation);
        CHECK(at["end.x"][0] == Approx(7e6 / (7e10 * 0.4 * 0.01)).epsilon(1e-6));  // nu = 0: uniform tension
        CHECK(std::abs(at["end.y"][0]) < 1e-6 * at["end.x"][0]);
      }
      const std::string file = (folder.path / "strip.h5").string(),
                        mesh = text.substr(text.find("{mesh"), text.find("}}\n") + 1 - text.find("{mesh"));
      std::vector<std::string> warnings;
      assembly::reduce_body(scene::parse_scene(text, "scene"), "strip", PETSC_COMM_WORLD, file, true, warnings);
      const History from_file =
          rest(std::string(text).replace(text.find(mesh), mesh.size(), "{reduced: " + file + "}"), Formulation::vm_md);
      CHECK(from_file["end.x"][0] == Approx(7e6 / (7e10 * 0.4 * 0.01)).epsilon(1e-6));
    }
}

// Newton and Euler: a free strip that a force pulls at the middle of its edge, or of its half, does not rotate, and its
// mean edge is the edge's middle.
TEST_CASE("edge forces: the line of action passes through the midpoint for any grading of the mesh") {
  const Scratch folder;
  const std::string deck = (folder.path / "strip.inp").string();
  for (const bool triangles : {false, true}) {
    write_text(deck, strip({0, 0.7, 0.9, 0.95, 1}, triangles));
    for (const std::string place : {"right", "half"})
      for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
        INFO(place << (triangles ? ", triangles" : ", quadrilaterals"));
        const History at = move(pulled(deck, fill(R"yaml(
loads: {pull: {type: force, at: strip.$place, force: [1000, 0, 0]}}
motion: {end: 0.01, step: 1e-3}
probes: {place: {at: strip.$place, quantity: position}, all: {at: strip.left, quantity: position}}
)yaml",
                                                  {{"place", place}})),
                                formulation);
        CHECK(at["place.y"].front() == Approx(0.2).epsilon(1e-9));
        const double way = 0.5 * 1000 / (2700 * 0.4 * 0.01) * 1e-4;
        CHECK(at["all.x"].back() - at["all.x"].front() == Approx(way).epsilon(1e-2));
        CHECK(std::abs(at["all.y"].back() - 0.2) < 1e-4 * way);
      }
  }
}
