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

// A torque at the end of a shaft that the ground holds twists it uniformly: T L / GJ at its end, J of a tube. With the
// torque balanced by rigid accelerations of the shaft, as a mean-axis frame would have it, it is three quarters of
// that.
TEST_CASE("a clamped shaft in a mean-axis frame has the twist of a torque that another body passes on") {
  const double G = 8e10, J = M_PI / 2 * (std::pow(0.02, 4) - std::pow(0.018, 4)), L = 0.5, T = 3;
  const std::string scene = R"yaml(
bodies:
  shaft:
    mesh: {line: {from: [0, 0, 0], to: [0.5, 0, 0], elements: 10}}
    section: {shape: tube, radius: 0.02, wall: 0.002, orientation: [0, 1, 0]}
    material: {E: 2.1e11, G: 8e10, rho: 7850}
    frame: mean-axis
  disc: {rigid: {mass: 1, centre: [0.5, 0, 0], inertia: [0.01, 0.01, 0.01]}}
joints:
  root: {type: fixed, between: [ground, shaft.start]}
  hub: {type: fixed, between: [shaft.end, disc.centre]}
loads: {torque: {type: moment, at: disc.centre, moment: ["3*t", 0, 0]}}
motion: {end: 1, step: 1}
probes: {twist: {at: shaft.end, quantity: rotation}}
)yaml";
  for (const char* frame : {"mean-axis", "clamped"}) {
    std::string text = scene;
    text.replace(text.find("frame: mean-axis"), 16, std::string("frame: ") + frame);
    CHECK(rest(text, Formulation::vm_md)["twist.rx"].back() == Approx(T * L / (G * J)).epsilon(1e-4));
  }
}
