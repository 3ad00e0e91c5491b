#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// A cantilever of length 1 at rest under (3, 4) at its end, EA so large that it does not stretch; all linear.
std::string held(const std::string& mesh, const std::string& section, const std::string& force) {
  return fill(R"yaml(
bodies:
  beam:
    mesh: {line: {$mesh, elements: 8}}
    section: $section
    frame: {type: clamped, at: start}
    reduction: {modes: 3, attachment: all}
joints: {root: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: $force}}
motion: {end: 0.02, step: 0.01, start: equilibrium}
probes:
  N: {at: beam.middle, quantity: section_force}
  M: {at: beam.middle, quantity: section_moment}
  R: {at: beam.start, quantity: section_moment}
)yaml",
              {{"mesh", mesh}, {"section", section}, {"force", force}});
}

}  // namespace

TEST_CASE("sections of a cantilever at rest carry the force at its end, in the plane and in space") {
  for (const auto formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::lffr, Formulation::cfr}) {
    INFO(scene::name_of(formulation));
    const History flat = move(held("from: [0, 0], to: [1, 0]", "{EA: 1e9, EI: 1e6, rhoA: 1}", "[3, 4]"), formulation);
    CHECK(flat["N.N"].back() == Approx(3).epsilon(1e-4));
    CHECK(flat["N.V"].back() == Approx(4).epsilon(1e-4));
    CHECK(flat["M.M"].back() == Approx(2).epsilon(1e-4));
    CHECK(flat["R.M"].back() == Approx(4).epsilon(1e-4));
    const History space = move(
        held("from: [0, 0, 0], to: [1, 0, 0]",
             "{shape: rectangle, width: 0.1, height: 0.2, orientation: [0, 1, 0]}\n    material: {E: 2e11, nu: 0.3, "
             "rho: 100}",
             "[3, 4, 5]"),
        formulation);
    CHECK(space["N.N"].back() == Approx(3).epsilon(1e-4));
    CHECK(space["N.Vy"].back() == Approx(4).epsilon(1e-4));
    CHECK(space["N.Vz"].back() == Approx(5).epsilon(1e-4));
    CHECK(space["M.My"].back() == Approx(-2.5).epsilon(1e-4));
    CHECK(space["M.Mz"].back() == Approx(2).epsilon(1e-4));
    CHECK(std::abs(space["M.T"].back()) < 1e-6);
  }
}
