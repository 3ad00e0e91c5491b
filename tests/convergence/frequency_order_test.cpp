#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// First frequency's relative error, L = EI = rhoA = 1.
double error(int elements, const std::string& joints, double exact) {
  const std::string text = fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: $elements}}
    section: {EA: 1e6, EI: 1, rhoA: 1}
    frame: mean-axis
    reduction: {modes: 1}
joints: {$joints}
motion: {end: 1, step: 1}
)yaml",
                                {{"elements", std::to_string(elements)}, {"joints", joints}});
  return assembly::body_modes(scene::parse_scene(text, "scene"), PETSC_COMM_WORLD).at(0).omega.at(0) / exact - 1;
}

const std::string clamp = "a: {type: fixed, between: [ground, beam.start]}";

}  // namespace

// Cubic elements and a consistent mass: the Rayleigh quotient is high by O(h^4).
TEST_CASE("order: linear frequencies converge from above with h^4") {
  const struct {
    const char* name;
    std::string joints;
    double exact;
  } cases[] = {
      {"CF", clamp, 3.51601526850},
      {"CC", clamp + ", b: {type: fixed, between: [ground, beam.end]}", 22.3732854480},
      {"FF", "", 22.3732854480},
      {"SS", "a: {type: revolute, between: [ground, beam.start]}, b: {type: revolute, between: [ground, beam.end]}",
       M_PI * M_PI}};
  for (const auto& beam : cases) {
    INFO(beam.name);
    const double coarse = error(4, beam.joints, beam.exact), middle = error(8, beam.joints, beam.exact),
                 fine = error(16, beam.joints, beam.exact);
    CHECK(fine > 0);
    CHECK(std::log2(middle / fine) == Approx(4).margin(0.1));
    CHECK(std::log2(coarse / middle) == Approx(4).margin(0.3));
  }
}
