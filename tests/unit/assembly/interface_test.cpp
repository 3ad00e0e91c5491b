#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>

#include "building.h"

using namespace floe;
using Catch::Matchers::Contains;
using scene::Formulation;
using testing::built;
using testing::complaint;

namespace {

/// Quadrilaterals, 1 x 0.5, clamped at the left: p1 (0, 0), p2 (1, 0), p3 (1, 0.5), p4 (0, 0.5).
std::string plate(const std::string& reduction, const std::string& joints = "") {
  return R"yaml(
bodies:
  p:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.5, 0], elements: [4, 2], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: )yaml" +
         reduction + "\njoints:\n  root: {type: fixed, between: [ground, p.left]}\n" + joints +
         "motion: {end: 0.2, step: 0.01}\n";
}

/// Two beams in a row, the first one hinged to the ground.
std::string two_beams(const std::string& first, const std::string& second) {
  const auto beam = [](const std::string& name, int from, const std::string& reduction) {
    return fmt::format(
        "  {}:\n    mesh: {{line: {{from: [{}, 0], to: [{}, 0], elements: 10}}}}\n"
        "    section: {{EA: 1e5, EI: 10, rhoA: 1}}\n    frame: mean-axis\n    reduction: {}\n",
        name, from, from + 1, reduction);
  };
  return "bodies:\n" + beam("arm", 0, first) + beam("fore", 1, second) + R"yaml(
joints:
  c: {type: revolute, between: [ground, arm.start]}
  h: {type: fixed, between: [arm.end, fore.start]}
motion: {end: 0.1, step: 0.01}
)yaml";
}

int notes_with(const assembly::Model& model, const std::string& words) {
  return static_cast<int>(std::count_if(model.warnings.begin(), model.warnings.end(), [&](const std::string& note) {
    return note.find(words) != std::string::npos;
  }));
}

}  // namespace

// Its columns would move what the ground holds: the clamp would open.
TEST_CASE("an interface that touches a joint to the ground is refused in space") {
  for (const char* place : {"p1", "bottom", "left", "[0, 0.25, 0]"}) {
    INFO(place);
    const std::string text =
        complaint(plate(std::string("{modes: 2, interface: [") + place + "]}"), Formulation::vm_md);
    CHECK_THAT(text, Contains("test.yaml:7") && Contains("has a node fixed by joint root") && !Contains("\n"));
  }
  CHECK(complaint(plate("{modes: 2, interface: [right]}"), Formulation::vm_md).empty());
}

TEST_CASE("interfaces that share a node are refused: neither is a rigid piece of its own") {
  const std::string text = complaint(plate("{modes: 2, interface: [p2, right]}"), Formulation::vm_md);
  CHECK_THAT(text, Contains("interface[2]: shares a node with interface[1]") && !Contains("\n"));
  CHECK_THAT(complaint(two_beams("{modes: 2, interface: [end, [1, 0]]}", "{modes: 2}"), Formulation::vm_md),
             Contains("interface[2]: shares a node with interface[1]"));
  CHECK(complaint(plate("{modes: 2, interface: [p2, p3]}"), Formulation::vm_md).empty());
}

TEST_CASE("the default count of modes fits what an interface leaves") {
  const auto beam = [](const std::string& reduction) {
    return R"yaml(
bodies:
  b:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    reduction: )yaml" +
           reduction + "\njoints: {c: {type: fixed, between: [ground, b.start]}}\nmotion: {end: 0.1, step: 0.01}\n";
  };
  for (const auto formulation : {Formulation::vm_md, Formulation::vm}) {
    CHECK(built(beam("{interface: [end]}"), formulation).bodies[0].omega.size() == 3);
    CHECK(built(beam("{interface: [end, middle]}"), formulation).bodies[0].omega.empty());
  }
  CHECK_THAT(complaint(beam("{modes: 6, interface: [end]}"), Formulation::vm_md), Contains("6 modes"));
  CHECK_THAT(complaint(beam("{interface: [end], derivatives: [[1, 5]]}"), Formulation::vm_md),
             Contains("[1, 5] refers to mode 5"));
}

TEST_CASE("where an interface carries a joint's moment there is nothing to warn of") {
  const std::string words = "its modes have no moment at joint h";
  const std::string plain = "{modes: 3, attachment: none}";
  CHECK(notes_with(built(two_beams(plain, plain), Formulation::vm_md), words) == 2);
  const assembly::Model model =
      built(two_beams("{modes: 3, attachment: none, interface: [end]}", plain), Formulation::vm_md);
  CHECK(notes_with(model, words) == 1);
  CHECK(notes_with(model, "body arm") == 0);
}

TEST_CASE("without derivatives a body in space is warned of that two joints hold, not one clamped edge") {
  const std::string reduction = "{modes: 2, derivatives: none}";
  CHECK(notes_with(built(plate(reduction), Formulation::vm_md), "prevent axial displacement") == 0);
  const std::string other = "  far: {type: fixed, between: [ground, p.right]}\n";
  CHECK(notes_with(built(plate(reduction, other), Formulation::vm_md), "prevent axial displacement") == 1);
}
