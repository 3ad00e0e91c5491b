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
