#include <catch2/catch.hpp>

#include "estimated.h"
#include "space_twin.h"

using namespace floe;
using namespace floe::test;

namespace {

/// Three twisted blades on a hub that is driven: the second and third are copies, rotated by 120 and 240 degrees, with
/// `second` in place of the modulus of the second.
std::string rotor(const std::string& words = "", const std::string& second = "7e10") {
  return fill(R"yaml(
$words
parameters: {a: 2*pi/3}
bodies:
  hub: {rigid: {mass: 8, centre: [0, 0, 0], inertia: [0.05, 0.05, 0.09]}}
  one:
    mesh: {plate: {origin: [0.1, -0.05, 0], along: [0.8, 0, 0.1], across: [0, 0.1, 0.03], elements: [8, 2]}}
    section: {thickness: 3e-3}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    strains: second_order
    reduction: {modes: 4, derivatives: all}
    damping: {modal: [0.01, 0.01]}
  two: {like: one, material: {E: $second, nu: 0.3, rho: 2700}, initial: {rotation: [0, 0, a]}}
  three: {like: one, initial: {rotation: [0, 0, 2*a]}}
joints:
  shaft: {type: driven, between: [ground, hub.centre], axis: [0, 0, 1], angle: "10*t^2"}
  root1: {type: fixed, between: [{body: hub, node: [0.1, 0, 0.015]}, one.left]}
  root2: {type: fixed, between: [{body: hub, node: ["0.1*cos(a)", "0.1*sin(a)", 0.015]}, two.left]}
  root3: {type: fixed, between: [{body: hub, node: ["0.1*cos(2*a)", "0.1*sin(2*a)", 0.015]}, three.left]}
loads:
  gust: {type: force, at: two.right, force: [0, 0, "30*t"]}
motion: {end: 0.2, step: 1e-3}
probes:
  p1: {at: one.right, relative_to: one.left, quantity: position}
  p2: {at: two.right, relative_to: two.left, quantity: position}
  p3: {at: three.right, relative_to: three.left, quantity: position}
  stress: {at: {body: two, node: [0.2, 0, 0.0275]}, quantity: stress, surface: top, axis: [1, 0, 0]}
)yaml",
              {{"words", words}, {"second", second}});
}

std::vector<std::string> shared(const assembly::Model& model) {
  std::vector<std::string> all;
  for (const assembly::BodyReport& body : model.bodies) all.push_back(body.reduction_of);
  return all;
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("shared reductions: rotated blades on a hub have one reduction and move as with their own") {
  for (const std::string words : {"", "share_frames: false"}) {
    const History once = move(rotor(words), Formulation::vm_md);
    CHECK(shared(once.model) == Names{"", "", "one", "one"});
    // a modulus that differs in the eighth digit is one of its own: reduced anew, and the same motion
    const History anew = move(rotor(words, "7.0000001e10"), Formulation::vm_md);
    CHECK(shared(anew.model) == Names{"", "", "", "one"});
    for (const std::string probe : {"p1", "p2", "p3"}) CHECK(apart(once, anew, probe) < 1e-6);
    for (const std::string column : {"stress.xx", "stress.yy", "stress.xy"})
      CHECK(relative_error(once, anew, column) < 1e-4);
    // the blades without gust deform alike: positions in world axes of the start
    const Eigen::Matrix3d R = math::rotation({0, 0, 4 * M_PI / 3});
    const std::size_t end = once.t.size() - 1;
    CHECK((R * vector_at(once, "p1", end) - vector_at(once, "p3", end)).norm() < 1e-9);
    CHECK(std::abs(once["p1.z"].back() - once["p2.z"].back()) > 1e-3);
  }
}

TEST_CASE("shared reductions: a copy of the scene's first body moves as it does") {
  const History at = move(R"yaml(
bodies:
  a: {mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}, section: {EA: 1e5, EI: 1, rhoA: 1, rhoI: 1e-4}, frame: clamped}
  b: {like: a, initial: {position: [0, 1]}}
joints:
  ja: {type: fixed, between: [ground, a.start]}
  jb: {type: fixed, between: [ground, b.start]}
loads:
  la: {type: force, at: a.end, force: [0, "sin(9*t)"]}
  lb: {type: force, at: b.end, force: [0, "sin(9*t)"]}
motion: {end: 0.1, step: 2e-3}
probes: {a: {at: a.end}, b: {at: b.end}}
)yaml",
                          Formulation::vm_md);
  CHECK(shared(at.model) == Names{"", "a"});
  CHECK(std::abs(at["a.y"].back()) > 0.01);
  for (const std::string c : {"x", "y"}) CHECK(at["b." + c].back() == Approx(at["a." + c].back()).epsilon(1e-9));
}

TEST_CASE("shared reductions: the same estimates as of reductions of their own") {
  const Estimated once = move_and_estimate(rotor(), Formulation::vm_md),
                  anew = move_and_estimate(rotor("", "7.0000001e10"), Formulation::vm_md);
  REQUIRE(once.estimate.none == "");
  REQUIRE(once.estimate.probes.size() == anew.estimate.probes.size());
  for (std::size_t p = 0; p < once.estimate.probes.size(); ++p)
    CHECK(once.estimate.probes[p] == Approx(anew.estimate.probes[p]).epsilon(1e-3));
}

TEST_CASE("shared reductions: only where joints, settings and interfaces are the same") {
  const auto beams = [](const std::string& joint, const std::string& more) {
    return fill(R"yaml(
bodies:
  a: {mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}, section: {EA: 1e5, EI: 1, rhoA: 1, rhoI: 1e-4}, frame: clamped}
  b: {like: a, initial: {position: [0, 1]}$more}
joints:
  ja: {type: fixed, between: [ground, a.start]}
  jb: {type: $joint, between: [ground, b.start]}
motion: {end: 0.1, step: 1e-2}
)yaml",
                {{"joint", joint}, {"more", more}});
  };
  const auto of = [&](const std::string& joint, const std::string& more = "") {
    return shared(
        assembly::build(scene::parse_scene(beams(joint, more), "scene"), Formulation::vm_md, PETSC_COMM_WORLD))[1];
  };
  CHECK(of("fixed") == "a");
  CHECK(of("revolute") == "");
  CHECK(of("fixed", ", reduction: {modes: 3}") == "");
  CHECK(of("fixed", ", reduction: {interface: [end]}") == "");
  CHECK(of("fixed", ", section: {EA: 1e5, EI: 1.001, rhoA: 1, rhoI: 1e-4}") == "");
  CHECK(of("fixed", ", frame: pinned") == "");
}
