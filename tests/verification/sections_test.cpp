// Forces and moments in sections of beams, as probes: closed forms in every formulation and frame.
#include <catch2/catch.hpp>

#include "building.h"
#include "estimated.h"

using namespace floe;
using namespace floe::test;
using Catch::Matchers::Contains;

namespace {

constexpr double pi = 3.14159265358979323846;

Eigen::Vector3d force(const History& history, const std::string& probe) {
  return {history[probe + ".N"].back(), history[probe + ".Vy"].back(), history[probe + ".Vz"].back()};
}
Eigen::Vector3d moment(const History& history, const std::string& probe) {
  return {history[probe + ".T"].back(), history[probe + ".My"].back(), history[probe + ".Mz"].back()};
}
Eigen::Vector3d rotation(const History& history, const std::string& probe) {
  return {history[probe + ".rx"].back(), history[probe + ".ry"].back(), history[probe + ".rz"].back()};
}
Eigen::Vector3d vector(const History& history, const std::string& probe) {
  return {history[probe + ".x"].back(), history[probe + ".y"].back(), history[probe + ".z"].back()};
}

}  // namespace

TEST_CASE("sections of a cantilever under tip force and weight: equilibrium of the part beyond", "[verification]") {
  const std::string text = R"yaml(
gravity: [0, 0, -9.81]
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [2, 0, 0], elements: 4}}
    section: {shape: rectangle, width: 0.05, height: 0.02, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    frame: $frame
    reduction: {modes: 4}
joints:
  clamp: {type: fixed, between: [ground, beam.start]}
loads:
  tip: {type: force, at: beam.end, force: [3, 2, 5]}
motion: {end: 0.1, step: 1e-3}
probes:
  f0: {at: beam.start, quantity: section_force}
  m0: {at: beam.start, quantity: section_moment}
  f1: {at: beam.middle, quantity: section_force}
  m1: {at: beam.middle, quantity: section_moment}
  f2: {at: beam.end, quantity: section_force}
  m2: {at: beam.end, quantity: section_moment}
  middle: {at: beam.middle, quantity: position}
  tip: {at: beam.end, quantity: position}
  turn1: {at: beam.middle, quantity: rotation}
  turn2: {at: beam.end, quantity: rotation}
)yaml";
  const double weight = 0.05 * 0.02 * 2700 * 9.81;  // per length
  for (const char* frame : {"{type: clamped, at: start}", "{type: pinned, from: start, to: end}", "{type: mean-axis}"})
    for (const auto formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
      INFO(frame << " " << scene::name_of(formulation));
      const History at = rest(fill(text, {{"frame", frame}}), formulation);
      const Eigen::Vector3d F(3, 2, 5), end = vector(at, "tip"), middle = vector(at, "middle");
      const auto beyond = [&](double length) { return Eigen::Vector3d(F - Eigen::Vector3d(0, 0, length * weight)); };
      CHECK((force(at, "f0") - beyond(2)).norm() < 1e-7);
      const Eigen::Matrix3d D1 = math::rotation(rotation(at, "turn1")), D2 = math::rotation(rotation(at, "turn2"));
      CHECK((force(at, "f1") - D1.transpose() * beyond(1)).norm() < 1e-7);
      CHECK((force(at, "f2") - D2.transpose() * F).norm() < 1e-7);
      CHECK(moment(at, "m2").norm() < 1e-7);
      // the weight acts near the middle of what lies beyond, as the bending line has it
      const Eigen::Vector3d m0 = end.cross(F) + Eigen::Vector3d(1, 0, 0).cross(Eigen::Vector3d(0, 0, -2 * weight));
      CHECK(moment(at, "m0").y() == Approx(m0.y()).epsilon(1e-4));
      CHECK(moment(at, "m0").z() == Approx(m0.z()).epsilon(1e-4));
      const Eigen::Vector3d m1 = D1.transpose() * (Eigen::Vector3d(end - middle).cross(F) +
                                                   Eigen::Vector3d(0.5, 0, 0).cross(Eigen::Vector3d(0, 0, -weight)));
      CHECK(moment(at, "m1").y() == Approx(m1.y()).epsilon(2e-3));
      CHECK(moment(at, "m1").z() == Approx(m1.z()).epsilon(2e-3));
    }
}

TEST_CASE("sections in the plane: jump at a load, both sides and their mean", "[verification]") {
  const std::string text = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}
    section: {EA: 1e6, EI: 1e3, rhoA: 1}
    frame: {type: pinned, from: start, to: end}
    reduction: {modes: {count: 4, of: joints}, attachment: all}
joints:
  left: {type: revolute, between: [ground, beam.start]}
  right: {type: prismatic, between: [ground, slide.middle], axis: [1, 0]}
  pin: {type: revolute, between: [slide.middle, beam.end]}
loads:
  load: {type: force, at: beam.middle, force: [0, -8]}
motion: {end: 0.1, step: 1e-3}
probes:
  mean: {at: beam.middle, quantity: section_force}
  before: {at: beam.middle, quantity: section_force, toward: beam.start}
  after: {at: beam.middle, quantity: section_force, toward: beam.end}
  m: {at: beam.middle, quantity: section_moment}
  quarter: {at: {body: beam, node: [0.25, 0]}, quantity: section_moment}
  end: {at: beam.end, quantity: section_force}
)yaml";
  std::string scene = text;
  scene.replace(scene.find("joints:"), 7,
                "  slide: {rigid: true, mesh: {line: {from: [0.9, 0], to: [1.1, 0], elements: 2}}, section: {rhoA: "
                "1e-9}}\njoints:");
  for (const auto formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
    INFO(scene::name_of(formulation));
    const History at = rest(scene, formulation);
    // V = what lies beyond exerts on what lies before: left of the load 4 - 8 from there, right 4
    CHECK(at["before.V"].back() == Approx(-4).epsilon(1e-4));
    CHECK(at["after.V"].back() == Approx(4).epsilon(1e-4));
    CHECK(std::abs(at["mean.V"].back()) < 1e-3);
    CHECK(at["end.V"].back() == Approx(4).epsilon(1e-4));
    CHECK(at["m.M"].back() == Approx(2).epsilon(1e-4));  // F L / 4, sagging
    CHECK(at["quarter.M"].back() == Approx(1).epsilon(1e-4));
  }
}

// The same where the load acts between two floating frames: each side has its own force.
TEST_CASE("sections of a beam in several frames, beside the border where a load acts", "[verification]") {
  const std::string text = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 16}}
    section: {EA: 1e6, EI: 1e3, rhoA: 1}
    frame: {type: pinned, from: start, to: end}
    frames: $n
    reduction: {modes: {count: 3, of: joints}, attachment: all}
joints:
  left: {type: fixed, between: [ground, beam.start]}
loads:
  load: {type: force, at: beam.middle, force: [0, -8]}
  tip: {type: force, at: beam.end, force: [0, 2]}
motion: {end: 0.1, step: 1e-3}
probes:
  before: {at: beam.middle, quantity: section_force, toward: beam.start}
  after: {at: beam.middle, quantity: section_force, toward: beam.end}
  back: {at: {body: beam, node: [0.9375, 0]}, quantity: section_moment, toward: beam.middle}
  quarter: {at: {body: beam, node: [0.25, 0]}, quantity: section_moment}
)yaml";
  for (const char* frames : {"1", "2", "4"})
    for (const auto formulation : {Formulation::vm_md, Formulation::nlffr}) {
      INFO(frames << " frames, " << scene::name_of(formulation));
      const History at = rest(fill(text, {{"n", frames}}), formulation);
      CHECK(at["before.V"].back() == Approx(2 - 8).epsilon(1e-4));
      CHECK(at["after.V"].back() == Approx(2).epsilon(1e-4));
      CHECK(at["back.M"].back() == Approx(2 * 0.0625).epsilon(1e-3));
      CHECK(at["quarter.M"].back() == Approx(2 * 0.75 - 8 * 0.25).epsilon(1e-3));
    }
  std::string mean = fill(text, {{"n", "2"}});
  mean.replace(mean.find(", toward: beam.start"), 20, "");
  CHECK_THROWS_WITH(rest(mean, Formulation::nlffr), Contains("lies between two floating frames of body beam"));
}

TEST_CASE("sections of a rotating blade: N = int rhoA Omega^2 r dr, on a coarse mesh", "[verification]") {
  const std::string text = R"yaml(
bodies:
  blade:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 5}}
    section: {shape: rectangle, width: 0.05, height: 0.02, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    initial: {angular_velocity: [0, 0, 30]}
    damping: {stiffness: 1e-4}
    reduction: {modes: 4}
joints:
  drive: {type: driven, between: [{body: ground, node: [0, 0, 0]}, blade.start], axis: [0, 0, 1], angle: "30*t"}
motion: {end: 0.1, step: 5e-4}
probes:
  root: {at: blade.start, quantity: section_force}
  bend: {at: blade.start, quantity: section_moment}
  inner: {at: {body: blade, node: [0.4, 0, 0]}, quantity: section_force}
  tip: {at: blade.end, quantity: section_force}
)yaml";
  const double mu = 2.7, w = 30;
  const auto N = [&](double r) { return mu * w * w * (1 - r * r) / 2; };
  for (const auto formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
    INFO(scene::name_of(formulation));
    const History at = move(text, formulation);
    CHECK(force(at, "root").x() == Approx(N(0)).epsilon(2e-3));
    CHECK(force(at, "inner").x() == Approx(N(0.4)).epsilon(2e-3));
    CHECK(std::abs(force(at, "tip").x()) < 1e-3 * N(0));
    CHECK(force(at, "root").tail<2>().norm() < 2e-3 * N(0));
    CHECK(moment(at, "bend").norm() < 2e-3 * N(0));
  }
}

TEST_CASE("the section at a pendulum's hinge carries what the hinge exerts", "[verification]") {
  const std::string text = R"yaml(
gravity: [0, -9.81]
bodies:
  rod:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 6}}
    section: {EA: 1e6, EI: 1e3, rhoA: 2}
    reduction: {modes: 3}
    damping: {stiffness: 1e-4}
joints:
  hinge: {type: revolute, between: [ground, rod.start]}
motion: {end: 0.5, step: 0.0005, output: 0.01}
probes:
  r: {joint: hinge, relative_to: rod.start}
  s: {at: rod.start, quantity: section_force}
  m: {at: rod.start, quantity: section_moment}
)yaml";
  for (const auto formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
    INFO(scene::name_of(formulation));
    const History at = move(text, formulation);
    for (std::size_t i = 0; i < at.t.size(); i += 100) {
      INFO("t = " << at.t[i]);
      CHECK(at["s.N"][i] == Approx(-at["r.x"][i]).margin(1e-4));
      CHECK(at["s.V"][i] == Approx(-at["r.y"][i]).margin(1e-4));
      CHECK(std::abs(at["m.M"][i]) < 1e-6);
    }
    CHECK(std::abs(at["s.N"].back()) > 10);
  }
}

TEST_CASE("a beam bent to a half circle by an end moment has that moment and no force", "[verification]") {
  const std::string space = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 16}}
    section: {shape: rectangle, width: 0.02, height: 0.02, orientation: [0, 1, 0]}
    material: {E: 1.2e9, nu: 0.2, rho: 1}
joints:
  clamp: {type: fixed, between: [ground, beam.start]}
loads:
  end: {type: moment, at: beam.end, moment: $moment}
motion: {end: 1, step: 0.1}
probes:
  f: {at: $place, quantity: section_force}
  m: {at: $place, quantity: section_moment}
)yaml";
  const std::string plane = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 16}}
    section: {EA: 4.8e5, EI: 16, rhoA: 1}
joints:
  clamp: {type: fixed, between: [ground, beam.start]}
loads:
  end: {type: moment, at: beam.end, moment: "16*pi*t"}
motion: {end: 1, step: 0.1}
probes:
  f: {at: $place, quantity: section_force}
  m: {at: $place, quantity: section_moment}
)yaml";
  const double M = 16 * pi;  // EI = 16
  for (const char* place : {"beam.start", "beam.middle", "beam.end"}) {
    INFO(place);
    const History flat = rest(fill(plane, {{"place", place}}), Formulation::cfr, 16);
    CHECK(flat["m.M"].back() == Approx(M).epsilon(1e-9));
    CHECK(std::hypot(flat["f.N"].back(), flat["f.V"].back()) < 1e-6 * M);
    for (const char* axis : {"[0, 0, \"16*pi*t\"]", "[0, \"16*pi*t\", 0]"}) {
      INFO(axis);
      const History at = rest(fill(space, {{"place", place}, {"moment", axis}}), Formulation::cfr, 16);
      const Eigen::Vector3d m = moment(at, "m");
      CHECK(m[axis[4] == '0' ? 2 : 1] == Approx(M).epsilon(1e-8));
      CHECK(m.norm() == Approx(M).epsilon(1e-8));
      CHECK(force(at, "f").norm() < 1e-5 * M);
    }
  }
}

TEST_CASE("sections of a beam between two clamps: q L^2 / 12 and -q L^2 / 24", "[verification]") {
  const std::string text = R"yaml(
gravity: [0, 0, -10]
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 8}}
    section: {shape: rectangle, width: 0.05, height: 0.02, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 1000}
    frame: {type: clamped, at: start}
    reduction: {modes: {count: 4, of: joints}, attachment: $attachment}
joints:
  clamp: {type: fixed, between: [ground, beam.start]}
  end: {type: fixed, between: [ground, beam.end]}
motion: {end: 1, step: 0.1}
probes:
  root: {at: beam.start, quantity: section_moment}
  middle: {at: beam.middle, quantity: section_moment}
  shear: {at: beam.start, quantity: section_force}
)yaml";
  for (const auto formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
    INFO(scene::name_of(formulation));
    const History at = rest(fill(text, {{"attachment", "joints"}}), formulation);
    // corotational: mass, and so weight, is lumped at the nodes
    const double tolerance = formulation == Formulation::vm_md ? 1e-3 : formulation == Formulation::cfr ? 1e-2 : 1e-5;
    CHECK(moment(at, "root").y() == Approx(10. / 12).epsilon(tolerance));
    CHECK(moment(at, "middle").y() == Approx(-10. / 24).epsilon(tolerance));
    CHECK(force(at, "shear").z() == Approx(-5).epsilon(tolerance));
  }
}

TEST_CASE("sections of a driven beam of three modes: error against the full-order model, and its estimate",
          "[verification]") {
  const std::string text = R"yaml(
gravity: [0, 0, -9.81]
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 20}}
    section: {shape: rectangle, width: 0.03, height: 0.01, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 3}
joints:
  drive: {type: driven, between: [ground, beam.start], axis: [0, 0, 1], angle: "2*smooth(t,0,0.5)"}
loads:
  tip: {type: force, at: beam.end, force: [0, "2*sin(40*t)", "sin(25*t)"]}
motion: {end: 0.5, step: 1e-3}
probes:
  root: {at: beam.start, quantity: section_moment}
  inner: {at: beam.middle, quantity: section_moment}
  force: {at: beam.middle, quantity: section_force}
)yaml";
  const Estimated reduced = move_and_estimate(text, Formulation::vm_md);
  REQUIRE(reduced.estimate.none == "");
  const History full = move(text, Formulation::nlffr);
  for (std::size_t p = 0; p < 3; ++p) {
    const std::string& name = reduced.history.model.probes[p].name;
    const double error = vector_error(reduced.history, full, name), estimate = reduced.estimate.probes[p];
    INFO(fmt::format("{}: error {:.3g}, estimate {:.3g}", name, error, estimate));
    CHECK(error < (name == "force" ? 0.02 : 0.006));
    CHECK(estimate > 0.2 * error);
    CHECK(estimate < 3 * error);
  }
}

TEST_CASE("sections that do not exist or are not determined", "[verification]") {
  const std::string text = R"yaml(
bodies:
  frame:
    mesh: {segments: {points: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0]], join: $join, elements: 4}}
    section: {shape: rectangle, width: 0.05, height: 0.02, orientation: [0, 0, 1]}
    material: {E: 7e10, nu: 0.3, rho: 1000}
    frame: {type: clamped, at: start}
    reduction: {modes: 3}
joints:
  clamp: {type: fixed, between: [ground, frame.start]}
$more
motion: {end: 1, step: 0.1}
probes:
  s: {at: $place, quantity: section_force}
)yaml";
  const auto of = [&](const char* join, const char* place, Formulation formulation, const char* more = "") {
    return testing::complaint(fill(text, {{"join", join}, {"place", place}, {"more", more}}), formulation);
  };
  const char *ring = "[[1, 2], [2, 3], [3, 4], [4, 1], [2, 5]]", *tree = "[[1, 2], [2, 3], [3, 4], [2, 5]]";
  CHECK_THAT(of(ring, "{body: frame, node: [0.5, 0, 0]}", Formulation::vm_md), Contains("form a ring"));
  CHECK(of(ring, "{body: frame, node: [0.5, 0, 0]}", Formulation::cfr).empty());
  CHECK(of(ring, "{body: frame, node: [1.5, 0, 0]}", Formulation::vm_md).empty());
  CHECK_THAT(of(tree, "frame.p2", Formulation::vm_md), Contains("3 elements of beams meet there; expected toward"));
  const char* chord = "  chord: {type: spring, between: [frame.p1, frame.p4], stiffness: 1e3}";
  CHECK_THAT(of(tree, "{body: frame, node: [0.5, 0, 0]}", Formulation::vm_md, chord),
             Contains("joint chord connects both parts of body frame"));
  CHECK(of(tree, "{body: frame, node: [1.5, 0, 0]}", Formulation::vm_md, chord).empty());
}

TEST_CASE("sections of damped bodies: a warning where the forces of the damping are not counted", "[verification]") {
  const auto warned = [](const std::string& beam, const std::string& damping) {
    const std::string text = fill(R"yaml(
bodies:
  beam: {$beam, reduction: {modes: 2}, damping: $damping}
joints:
  clamp: {type: fixed, between: [ground, beam.start]}
motion: {end: 1, step: 0.1}
probes:
  s: {at: beam.middle, quantity: section_force}
)yaml",
                                  {{"beam", beam}, {"damping", damping}});
    const auto model = assembly::build(scene::parse_scene(text, "scene"), Formulation::vm_md, PETSC_COMM_WORLD);
    return std::any_of(model.warnings.begin(), model.warnings.end(), [](const std::string& warning) {
      return warning.find("probe s: the forces of damping") != std::string::npos;
    });
  };
  for (const std::string beam :
       {"mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}, section: {EA: 1e5, EI: 1, rhoA: 1}",
        "mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 4}}, material: {E: 7e10, nu: 0.3, rho: 1000}, "
        "section: {shape: rectangle, width: 0.05, height: 0.02, orientation: [0, 0, 1]}"}) {
    INFO(beam);
    CHECK(warned(beam, "{mass: 0.1}"));
    CHECK(warned(beam, "{modal: [0.01, 0.01]}"));
    CHECK_FALSE(warned(beam, "{stiffness: 1e-4}"));
  }
}

TEST_CASE("sections where three beams meet, by what they lead to", "[verification]") {
  const std::string text = R"yaml(
gravity: [0, 0, -10]
bodies:
  frame:
    mesh: {segments: {points: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [2, 0, 0]], join: [[1, 2], [2, 3], [2, 4]], elements: 2}}
    section: {shape: rectangle, width: 0.05, height: 0.02, orientation: [0, 0, 1]}
    material: {E: 7e10, nu: 0.3, rho: 1000}
    frame: {type: clamped, at: start}
    reduction: {modes: 4}
joints:
  clamp: {type: fixed, between: [ground, frame.start]}
motion: {end: 1, step: 0.1}
probes:
  before: {at: frame.p2, toward: frame.start, quantity: section_force}
  side: {at: frame.p2, toward: frame.p3, quantity: section_force}
  ahead: {at: frame.p2, toward: frame.p4, quantity: section_force}
  turn: {at: frame.p2, toward: frame.start, quantity: section_moment}
)yaml";
  for (const auto formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
    INFO(scene::name_of(formulation));
    const History at = rest(text, formulation);  // 10 N a metre; y of the sections is up
    CHECK(at["before.Vy"].back() == Approx(-20).epsilon(1e-4));
    CHECK(at["side.Vy"].back() == Approx(-10).epsilon(1e-4));
    CHECK(at["ahead.Vy"].back() == Approx(-10).epsilon(1e-4));
    CHECK(std::abs(at["turn.T"].back()) == Approx(5).epsilon(2e-3));
  }
}

// The frame of such a body is fixed and has no equations, whose rows would be the forces in the section.
TEST_CASE("sections of bodies with supports are refused but in cfr", "[verification]") {
  const std::string text = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [2, 0, 0], elements: 4}}
    section: {shape: rectangle, width: 0.05, height: 0.02, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 4}
joints:
  left: {type: support, between: [ground, beam.start], hold: [x, y, z, rx]}
  right: {type: support, between: [ground, beam.end], hold: [y, z]}
loads: {middle: {type: force, at: beam.middle, force: [0, 0, -8]}}
motion: {end: 1, step: 0.1}
probes: {moment: {at: beam.middle, quantity: section_moment}}
)yaml";
  for (const auto formulation : {Formulation::vm_md, Formulation::vm, Formulation::nlffr, Formulation::lffr})
    CHECK_THROWS_WITH(rest(text, formulation),
                      Contains("probes.moment") && Contains("section forces of body beam") && Contains("supports"));
  CHECK(std::abs(moment(rest(text, Formulation::cfr), "moment")[1]) == Approx(4).epsilon(1e-3));  // F L / 4
}
