#include <catch2/catch.hpp>

#include "spatial_scenes.h"

using namespace floe;
using namespace floe::test;

namespace {

/// Square plate a = 1, h = 0.01, E = 1e7, nu = 0.3, clamped on all edges with no motion in its plane, under a pressure
/// of Q E h^4 / a^4; n elements across.
std::string pressed(double Q, int n, const std::string& cells, int modes) {
  return fill(
      R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 1, 0], elements: [$n, $n], cells: $cells}}
    section: {thickness: 0.01}
    material: {E: 1e7, nu: 0.3, rho: 1}
    reduction: {modes: {count: $modes, alone: $modes}}
joints:
  l: {type: fixed, between: [ground, plate.left]}
  r: {type: fixed, between: [ground, plate.right]}
  b: {type: fixed, between: [ground, plate.bottom]}
  t: {type: fixed, between: [ground, plate.top]}
loads: {pressure: {type: distributed, body: plate, force: [0, 0, $p*t]}}
probes: {centre: {at: {body: plate, node: [0.5, 0.5, 0]}}}
)yaml",
      {{"n", std::to_string(n)}, {"cells", cells}, {"modes", std::to_string(modes)}, {"p", number(Q * 1e7 * 1e-8)}});
}

double deflection(double Q, int n, const std::string& cells, Formulation formulation, int modes = 1) {
  return rest(pressed(Q, n, cells, modes), formulation, 4)["centre.z"].back() / 0.01;
}

}  // namespace

// w/h at the centre for Q = q a^4 / (E h^4): a converged independent computation.
TEST_CASE("clamped plate under pressure: large static deflection of the full-order model") {
  const std::string cells = GENERATE("triangles", "quadrilaterals");
  for (const auto& [Q, w] : {std::pair{1., .013816}, {25., .326962}, {100., .937420}, {200., 1.364028}}) {
    INFO(cells << ", Q = " << Q);
    const double coarse = deflection(Q, 10, cells, Formulation::nlffr),
                 fine = deflection(Q, 20, cells, Formulation::nlffr);
    CHECK(fine == Approx(w).epsilon(1e-2));
    CHECK((4 * fine - coarse) / 3 == Approx(w).epsilon(3e-3));
  }
}

// A uniform pressure bends the plate in its doubly symmetric modes. Their derivatives stretch
// the middle plane as it wants; without them it is too stiff.
TEST_CASE("clamped plate under pressure: reduced") {
  const auto reduced = [](Formulation formulation, int modes) {
    return deflection(100, 12, "quadrilaterals", formulation, modes);
  };
  const double full = reduced(Formulation::nlffr, 1);
  CHECK(reduced(Formulation::vm_md, 24) == Approx(full).epsilon(2e-3));
  CHECK(reduced(Formulation::vm, 24) < 0.96 * full);
  CHECK(reduced(Formulation::lffr, 1) == Approx(1.3816).epsilon(2e-2));
}

// Response vectors of a boom with next to no mass have little that is new in M, and are what the answer needs.
TEST_CASE("plate with a boom of almost no mass: reduced as the full-order model") {
  const Scratch scratch;
  std::string deck = "*NODE\n", sets = "*NSET, NSET=left\n1,2,3\n*NSET, NSET=tip\n20\n";
  for (int i = 0; i < 15; ++i) deck += fmt::format("{}, {}, {}, 0\n", i + 1, 0.1 * (i / 3), 0.1 * (i % 3));
  for (int i = 1; i <= 5; ++i) deck += fmt::format("{}, 0.4, 0.1, {}\n", 15 + i, 0.1 * i);
  deck += "*ELEMENT, TYPE=S4, ELSET=plate\n";
  for (int i = 0; i < 8; ++i) {
    const int a = 3 * (i / 2) + i % 2 + 1;
    deck += fmt::format("{}, {}, {}, {}, {}\n", i + 1, a, a + 3, a + 4, a + 1);
  }
  deck += "*ELEMENT, TYPE=B31, ELSET=boom\n9, 14, 16\n10, 16, 17\n11, 17, 18\n12, 18, 19\n13, 19, 20\n" + sets +
          "*MATERIAL, NAME=m\n*ELASTIC\n7e10, 0.3\n*DENSITY\n2700\n*MATERIAL, NAME=light\n*ELASTIC\n2e11, 0.3\n"
          "*DENSITY\n1e-6\n*SHELL SECTION, ELSET=plate, MATERIAL=m\n0.01\n"
          "*BEAM SECTION, ELSET=boom, MATERIAL=light, SECTION=RECT\n0.01, 0.01\n1, 0, 0\n";
  const std::string path = (scratch.path / "part.inp").string();
  write_text(path, deck);
  const std::string text = fill(R"yaml(
bodies: {part: {mesh: {file: {path: $path}}, reduction: {modes: 6, attachment: all}}}
joints: {root: {type: fixed, between: [ground, part.left]}}
loads: {tip: {type: force, at: part.tip, force: ["100*t", "200*t", 0]}}
probes: {tip: {at: part.tip}}
)yaml",
                                {{"path", path}});
  History full = rest(text, Formulation::nlffr, 4), reduced = rest(text, Formulation::vm_md, 4);
  for (const char* probe : {"tip.x", "tip.y"}) CHECK(reduced[probe].back() == Approx(full[probe].back()).epsilon(1e-3));
}
