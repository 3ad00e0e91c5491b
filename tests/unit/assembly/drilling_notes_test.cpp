#include <catch2/catch.hpp>

#include "building.h"
#include "scene_motion.h"

using namespace floe;

namespace {

/// Notes on rotations about normals of a plate in the plane of x and y.
long notes(const std::string& joints, const std::string& loads = "") {
  const assembly::Model model = testing::built(test::fill(R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 1, 0], elements: [2, 2]}}
    section: {thickness: 0.01}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    initial: {rotation: [0, 0, 0.3]}
joints: {$joints}
loads: {$loads}
)yaml",
                                                          {{"joints", joints}, {"loads", loads}}),
                                               scene::Formulation::nlffr);
  return std::count_if(model.warnings.begin(), model.warnings.end(), [](const std::string& note) {
    return note.find("about the normal of the shells at one node, (0, 0, 0)") != std::string::npos;
  });
}

}  // namespace

TEST_CASE("rotations about the normal of shells that a joint holds, or a moment acts about, at one node") {
  const std::string corner = ", between: [ground, plate.p1]}";
  for (const std::string joint :
       {"{type: fixed", "{type: driven, axis: [0, 0, 1], angle: t", "{type: revolute, axis: [0, 1, 0]",
        "{type: revolute, axis: [0, 0, 1], friction: {level: 1, speed: 0.1}", "{type: bushing, rotation: [0, 0, 10]",
        "{type: spring, axis: [0, 0, 1], torsional_stiffness: 10"}) {
    INFO(joint);
    CHECK(notes("j: " + joint + corner) == 1);
  }
  for (const std::string joint : {"{type: spherical", "{type: revolute, axis: [0, 0, 1]",
                                  "{type: bushing, translation: [1, 1, 1], rotation: [10, 10, 0]"}) {
    INFO(joint);
    CHECK(notes("j: " + joint + corner) == 0);
  }
  CHECK(notes("j: {type: fixed, between: [ground, plate.left]}") == 0);
  CHECK(notes("j: {type: fixed" + corner + ", k: {type: spherical, between: [ground, plate.p3]}") == 0);
  const std::string free = "j: {type: spherical, between: [ground, plate.p3]}";
  CHECK(notes(free, "m: {type: moment, at: plate.p1, moment: [0, 0, t]}") == 1);
  CHECK(notes(free, "m: {type: moment, at: plate.p1, moment: [t, 1, 0]}") == 0);
  CHECK(notes(free, "m: {type: moment, at: plate.left, moment: [0, 0, t]}") == 0);
}
