#include <catch2/catch.hpp>

#include "scene_motion.h"
#include "space_twin.h"

using namespace floe;
using namespace floe::test;

namespace {

/// An L of beams on a hub that spins up to 9 rad/s in 0.6 s: its foot stands out of the plane of rotation, so that it
/// bends both ways and twists.
std::string frame(const std::string& end, const std::string& strains = "von_karman", double speed = 9) {
  return fill(R"yaml(
gravity: [0, 0, -9.81]
parameters: {Om: $speed, Ts: 0.6}
bodies:
  l:
    mesh: {polyline: {points: [[0, 0, 0], [1, 0, 0], [1.1, 0.2, 0.5]], elements: [9, 6]}}
    section: {shape: rectangle, width: 0.02, height: 0.02, orientation: [0, 1, 0.3]}
    material: {E: 1.5e9, nu: 0.3, rho: 1000}
    strains: $strains
    frame: {type: clamped, at: start}
    reduction: {modes: {count: 5, alone: 8}, derivatives: all}
joints:
  hub: {type: driven, between: [ground, l.start], axis: [0, 0, 1],
        angle: "t < Ts ? Om/Ts*(t^2/2 + (Ts/(2*pi))^2*(cos(2*pi*t/Ts) - 1)) : Om*(t - Ts/2)"}
motion: {end: $end, step: 4e-3}
probes: {tip: {at: l.end, quantity: deflection}, knee: {at: l.p2, quantity: deflection}}
)yaml",
              {{"end", end}, {"strains", strains}, {"speed", number(speed)}});
}

/// A plate driven along its left edge as a flap.
std::string plate(const std::string& end) {
  return fill(R"yaml(
parameters: {Om: 8, Ts: 0.6}
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.6, 0], elements: [6, 4], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 8e9, nu: 0.3, rho: 1000}
    frame: {type: clamped, at: left}
    reduction: {modes: {count: 6, alone: 6}, derivatives: all}
joints:
  hinge: {type: driven, between: [ground, plate.left],
          angle: "t < Ts ? Om/Ts*(t^2/2 + (Ts/(2*pi))^2*(cos(2*pi*t/Ts) - 1)) : Om*(t - Ts/2)"}
motion: {end: $end, step: 4e-3}
probes: {tip: {at: plate.p3, quantity: deflection}, side: {at: plate.p2, quantity: deflection}}
)yaml",
              {{"end", end}});
}

/// Relative L2 error of all components of a probe together.
double error(const History& a, const History& b, const std::string& probe) {
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < a.t.size(); ++i) {
    difference += (vector_at(a, probe, i) - vector_at(b, probe, i)).squaredNorm();
    size += vector_at(b, probe, i).squaredNorm();
  }
  return std::sqrt(difference / size);
}

/// Full order, on this rank alone.
History alone(const std::string& text) {
  History history{
      assembly::build(scene::parse_scene(text, "scene"), Formulation::nlffr, PETSC_COMM_SELF), {}, {}, {}, {}};
  const scene::Motion motion = scene::parse_scene(text, "scene").motion;
  solve::simulate(*history.model.system, {motion.end, motion.step, motion.spectral_radius, motion.tolerance},
                  history.model.U, history.model.V,
                  [&](const solve::Instant& at) { store(history, at.t, at.U, at.V); });
  return history;
}

}  // namespace

TEST_CASE("reduced in space: spin-up of a frame, with derivatives within 1 % of the full-order model") {
  const std::string text = frame("1");
  const History full = move(text, Formulation::nlffr);
  for (const std::string place : {"tip", "knee"}) {
    INFO(place);
    CHECK(error(move(text, Formulation::vm_md), full, place) < 0.01);
    CHECK(error(move(text, Formulation::vm), full, place) > 0.05);
  }
}

// Products of rotations, which torsion joins with strains of second order, converge more slowly in the modes; the
// full-order model is nearer to the geometrically exact one by more.
TEST_CASE("reduced in space: spin-up of a frame, strains of second order") {
  const std::string text = frame("1", "second_order", 3);
  const History full = move(text, Formulation::nlffr);
  for (const std::string place : {"tip", "knee"}) {
    INFO(place);
    CHECK(error(move(text, Formulation::vm_md), full, place) < 0.03);
    CHECK(error(move(text, Formulation::vm), full, place) > 0.05);
  }
}

TEST_CASE("reduced in space: a plate that flaps about its edge, with derivatives within 1 %") {
  const std::string text = plate("1");
  const History full = move(text, Formulation::nlffr);
  for (const std::string place : {"tip", "side"}) {
    INFO(place);
    CHECK(error(move(text, Formulation::vm_md), full, place) < 0.01);
    CHECK(error(move(text, Formulation::vm), full, place) > 0.05);
  }
}

// Under mpirun: what all ranks compute together is what each computes alone.
TEST_CASE("reduced in space: the full-order model does not depend on the number of ranks") {
  for (const std::string& text : {frame("0.2"), plate("0.2")}) {
    const History together = move(text, Formulation::nlffr), one = alone(text);
    CHECK(error(together, one, "tip") < 1e-9);
  }
}

namespace {

/// A tube of 0.5 m on a joint to the ground, with a disc at its end that passes on a torque of 3 N m from 0.2 s on.
std::string shaft(const std::string& root, const std::string& frame, const std::string& more = "", int modes = 6) {
  return fill(R"yaml(
bodies:
  shaft:
    mesh: {line: {from: [0, 0, 0], to: [0.5, 0, 0], elements: 10}}
    section: {shape: tube, radius: 0.02, wall: 0.002, orientation: [0, 1, 0]}
    material: {E: 2.1e11, G: 8e10, rho: 7850}
    frame: $frame
    reduction: {modes: $modes}
  disc: {rigid: {mass: 1, centre: [0.5, 0, 0], inertia: [0.01, 0.01, 0.01]}}
joints:
  root: {type: $root, between: [ground, shaft.start]}
  hub: {type: fixed, between: [shaft.end, disc.centre]}
$more
loads: {torque: {type: moment, at: disc.centre, moment: ["3*smooth(t, 0, 0.2)", 0, 0]}}
motion: {end: 0.25, step: 1e-3}
probes:
  twist: {at: shaft.end, quantity: rotation}
  middle: {at: shaft.middle, quantity: rotation}
  start: {at: shaft.start, quantity: rotation}
)yaml",
              {{"root", root}, {"frame", frame}, {"more", more}, {"modes", std::to_string(modes)}});
}

}  // namespace

// It twists uniformly: T L / GJ at its end. With the torque balanced by rigid accelerations of the shaft, as in a free
// body, it is three quarters of that.
TEST_CASE(
    "a shaft that joints hold on the ground has the twist of a torque that another body passes on, in any frame") {
  const double G = 8e10, J = M_PI / 2 * (std::pow(0.02, 4) - std::pow(0.018, 4)), L = 0.5, T = 3;
  for (const std::string root :
       {"fixed", "revolute, axis: [0, 0, 1]", "universal, axis: [0, 1, 0], second_axis: [0, 0, 1]"})
    for (const std::string frame : {"mean-axis", "clamped", "{type: clamped, at: end}", "{type: clamped, at: middle}",
                                    "{type: pinned, from: end, to: start}"})
      for (const int modes : {2, 6}) {
        if (root != "fixed" && frame != "mean-axis") continue;
        INFO(root << ", " << frame << ", " << modes);
        CHECK(move(shaft(root, frame, "", modes), Formulation::vm_md)["twist.rx"].back() ==
              Approx(T * L / (G * J)).epsilon(2e-4));
      }
}

// After the release rigid accelerations balance the torque.
TEST_CASE("a shaft that an event releases twists as its full-order model") {
  const auto twist = [](Formulation formulation, int modes) {
    const History at = move(shaft("fixed", "mean-axis", "events: {off: {unlock: root, at: 0.01}}", modes), formulation);
    return at["middle.rx"].back() - at["start.rx"].back();
  };
  const double expected = twist(Formulation::nlffr, 6);
  CHECK(std::abs(expected) > 1e-7);
  for (const int modes : {2, 6}) CHECK(twist(Formulation::vm_md, modes) == Approx(expected).epsilon(1e-2));
}

TEST_CASE("the basis of a body does not depend on an equal one that the ground holds") {
  const auto tip = [](bool other) {
    const std::string beam =
        "{mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 8}}, section: {shape: rectangle, width: 0.02, "
        "height: "
        "0.01, orientation: [0, 1, 0]}, material: {E: 2.1e11, G: 8e10, rho: 7850}, frame: mean-axis, reduction: "
        "{modes: "
        "{count: 4, of: frame}}}";
    return move(fill(R"yaml(
bodies:
  $a
  b: $beam
  hub: {rigid: {mass: 1, centre: [0, 0, 0], inertia: [0.1, 0.1, 0.1]}}
joints:
  $g
  r: {type: revolute, between: [ground, hub.centre], axis: [0, 0, 1]}
  w: {type: fixed, between: [hub.centre, b.start]}
loads: {tip: {type: force, at: b.end, force: [0, 0, "5*smooth(t, 0, 0.1)"]}}
motion: {end: 0.1, step: 1e-3}
probes: {tip: {at: b.end}}
)yaml",
                     {{"a", other ? "a: " + beam : ""},
                      {"g", other ? "g: {type: fixed, between: [ground, a.start]}" : ""},
                      {"beam", beam}}),
                Formulation::vm_md)["tip.z"]
        .back();
  };
  CHECK(tip(true) == Approx(tip(false)).epsilon(1e-9));
}

// The basis vectors span all ten elastic motions of the line along itself; what round-off leaves of a further one is a
// rigid motion, which the frame has already. Newton's method diverged in the first steps.
TEST_CASE("bases that span all elastic motions of a line along itself have no rigid motion") {
  const auto tip = [](bool oblique, int modes, Formulation formulation) {
    return move(fill(R"yaml(
gravity: [0, 0, -9.81]
bodies:
  rod:
    mesh: {line: {from: [0, 0, 0], to: $end, elements: 10}}
    section: {shape: rectangle, width: 0.012, height: 0.006, orientation: [0, 1, 0]}
    material: {E: 3e9, nu: 0.35, rho: 1200}
    reduction: {modes: $modes}
    damping: {stiffness: 5e-4}
  bob: {rigid: {mass: 0.05, centre: $end, inertia: [2e-5, 2e-5, 2e-5]}}
joints:
  ball: {type: spherical, between: [ground, rod.start]}
  weld: {type: fixed, between: [rod.end, bob.centre]}
motion: {end: 0.4, step: 2e-3}
probes: {tip: {at: rod.end}}
)yaml",
                     {{"modes", std::to_string(modes)}, {"end", oblique ? "[0.6, 0.48, 0.64]" : "[1, 0, 0]"}}),
                formulation)["tip.z"]
        .back();
  };
  for (const bool oblique : {false, true}) {
    const double whole = tip(oblique, 6, Formulation::nlffr);
    for (const int modes : {6, 8, 10}) CHECK(tip(oblique, modes, Formulation::vm_md) == Approx(whole).epsilon(1e-6));
  }
}
