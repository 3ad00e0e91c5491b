#include <catch2/catch.hpp>
#include <cmath>

#include "floe/error.h"
#include "floe/scene/scene.h"

using namespace floe;
using Catch::Matchers::Contains;

namespace {

scene::Scene with_section(const std::string& section, const std::string& material = "{E: 4, rho: 2}") {
  return scene::parse_scene("bodies:\n  b:\n    mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}\n    section: {" +
                                section + "}\n" + (material.empty() ? "" : "    material: " + material + "\n") +
                                "motion: {end: 1, step: 0.1}\n",
                            "s.yaml");
}

std::string told(const std::string& section, const std::string& material = "{E: 4, rho: 2}") {
  try {
    with_section(section, material);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

// Second moments of area about the normal of the plane, heights in the plane.
TEST_CASE("sections of shapes in the plane") {
  struct Case {
    const char* keys;
    double A, I, fibre;
  };
  const double pi = M_PI;
  for (const Case& one :
       {Case{"shape: rectangle, width: 0.3, height: 0.5", 0.15, 0.3 * 0.125 / 12, 0.25},
        Case{"shape: circle, radius: 0.2", pi * 0.04, pi * 0.0016 / 4, 0.2},
        Case{"shape: tube, radius: 0.2, wall: 0.1", pi * 0.03, pi * (0.0016 - 0.0001) / 4, 0.2},
        Case{"shape: box, width: 0.3, height: 0.5, wall: 0.1", 0.12, (0.3 * 0.125 - 0.1 * 0.027) / 12, 0.25},
        Case{"shape: i, width: 0.3, height: 0.5, wall: 0.1, flange: 0.1", 0.09, (0.3 * 0.125 - 0.2 * 0.027) / 12,
             0.25}}) {
    INFO(one.keys);
    const scene::Section section = with_section(one.keys).bodies[0].section;
    CHECK(section.EA == Approx(4 * one.A));
    CHECK(section.EI == Approx(4 * one.I));
    CHECK(section.rhoA == Approx(2 * one.A));
    CHECK(section.rhoI == Approx(2 * one.I));
    CHECK(section.fibre == Approx(one.fibre));
    CHECK(section.E == 4);
  }
  const scene::Section section =
      with_section("shape: rectangle, width: 1, height: 2, rhoI: 0, GA: 5").bodies[0].section;
  CHECK(section.rhoI == 0);
  CHECK(section.GA == 5);
}

TEST_CASE("keys beside a shape in the plane, and shapes without material, are refused") {
  CHECK(told("shape: circle, radius: 1, A: 3") ==
        "s.yaml:4:44: bodies.b.section.A: does not apply to shape circle; expected one of shape, radius, rhoI, GA");
  CHECK_THAT(told("shape: circle, width: 1"), Contains("section.radius: is missing"));
  CHECK_THAT(told("shape: tub, radius: 1"), Contains("did you mean \"tube\"?"));
  CHECK_THAT(told("shape: tube, radius: 1, wall: 2"),
             Contains("s.yaml:4:5: bodies.b.section: tube: sizes must be positive"));
  CHECK_THAT(told("shape: circle, radius: 1", ""),
             Contains("section.shape: does not apply here; expected this key only with `material`"));
}
