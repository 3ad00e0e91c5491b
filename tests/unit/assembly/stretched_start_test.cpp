#include <catch2/catch.hpp>

#include "building.h"

using namespace floe;
using scene::Formulation;
using testing::built;

namespace {

/// A rod of 1 m, EA/EI = 1e4, that starts with the deflection w = 0.05 x^2 and the displacement u along it.
std::string rod(bool space, int frames, const std::string& u) {
  const std::string pieces = "    frames: " + std::to_string(frames) + "\n", end = "motion: {end: 1, step: 0.1}\n";
  if (!space)
    return "bodies:\n  rod:\n    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}\n"
           "    section: {EA: 1e4, EI: 1, rhoA: 1}\n" +
           pieces + "    initial: {deformation: [" + u + ", \"0.05*x^2\"]}\n" + end;
  return "bodies:\n  rod:\n    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 8}}\n"
         "    section: {A: 1, Iy: 1e-4, Iz: 1e-4, J: 2e-4, orientation: [0, 1, 0]}\n"
         "    material: {E: 1e4, nu: 0.3, rho: 1}\n" +
         pieces + "    initial: {deformation: [" + u + ", 0, \"0.05*x^2\"]}\n" + end;
}

}  // namespace

// eps = w'^2/2 = 0.005 x^2 and w'' = 0.1: U / U_1 = 1 + EA 5e-6 / (EI 0.01) = 6, and 5.9 with averaged strains of 8
// elements
TEST_CASE("an initial deflection without its shortening is reported with its energy, in the plane and in space") {
  const bool space = GENERATE(false, true);
  const int frames = GENERATE(1, 2);
  for (const Formulation formulation : {Formulation::cfr, Formulation::nlffr, Formulation::vm_md}) {
    INFO(space << " " << frames << " " << scene::name_of(formulation));
    const assembly::Model model = built(rod(space, frames, "0"), formulation);
    CHECK_THAT(
        model.stretched_start,
        Catch::StartsWith("initial.deformation of rod: its strain energy is 5.9 times that of its linear strains"));
    CHECK(std::count(model.warnings.begin(), model.warnings.end(), model.stretched_start) == 1);
  }
  // u' = -w'^2/2
  CHECK(built(rod(space, frames, "\"-0.005*x^3/3\""), Formulation::cfr).stretched_start == "");
}
