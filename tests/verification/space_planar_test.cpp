#include <catch2/catch.hpp>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;

// Planar mechanisms rotated by an arbitrary rotation in space move as they do in the plane. A square section of side b:
// A = b^2, I = b^4/12.

namespace {

const Rotated rotation;

History plane(const std::string& text, const Words& words, Formulation formulation) {
  return move(fill(text, words), formulation);
}

/// $z: the plane's normal, $turn: the rotation vector, as all else of `words`.
History space(const std::string& text, Words words, Formulation formulation) {
  words.push_back({"z", rotation(0, 0, 1)});
  words.push_back({"turn", rotation.text()});
  return move(fill(text, words), formulation);
}

const std::string flat_pendulum = R"yaml(
gravity: [0, -9.81]
bodies:
  rod:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: $elements}}
    section: {A: 1e-3, I: 1e-6/12}
    material: {E: 1.2e7, rho: 1000}
    frame: $frame
    reduction: {modes: $modes, derivatives: all, attachment: none}
joints: {hinge: {type: revolute, between: [ground, rod.start]}}
motion: {end: $end, step: $step}
probes: {tip: {at: rod.end, quantity: position}, bent: {at: rod.middle, quantity: deflection}}
)yaml";

const std::string pendulum = R"yaml(
gravity: $gravity
bodies:
  rod:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: $elements}}
    section: {$section, orientation: [0, 1, 0]}
    material: {E: 1.2e7, nu: 0.3, rho: 1000}
    frame: $frame
    reduction: {modes: $modes, derivatives: all, attachment: none}
    initial: {rotation: $turn}
joints: {hinge: {type: $hinge, between: [ground, rod.start]}}
motion: {end: $end, step: $step}
probes: {tip: {at: rod.end, quantity: position}, bent: {at: rod.middle, quantity: deflection}}
)yaml";

const std::string square = "shape: rectangle, width: sqrt(1e-3), height: sqrt(1e-3)",
                  stiff = "A: 1e-3, Iz: 1e-6/12, Iy: 1e-3, J: 1";  // out of the plane and in torsion

}  // namespace

// Table: independent converged computation, von Karman in the pinned frame.
TEST_CASE("in space: a flexible pendulum, full-order") {
  for (const std::string frame : {"pinned", "clamped"}) {
    INFO(frame);
    Words words{{"frame", frame}, {"elements", "10"}, {"modes", "1"}, {"end", "0.5"}, {"step", "2e-3"}};
    const History flat = plane(flat_pendulum, words, Formulation::nlffr);
    words.push_back({"gravity", rotation(0, -9.81)}), words.push_back({"section", square}),
        words.push_back({"hinge", "revolute, axis: $z"});
    const History at = space(pendulum, words, Formulation::nlffr);
    CHECK(apart(at, rotation.Q, flat, "tip") < 1e-6);
    CHECK(apart(at, Eigen::Matrix3d::Identity(), flat, "bent") < 1e-6);
    if (frame == "clamped") continue;
    const Eigen::Vector3d tip = rotation.Q.transpose() * vector_at(at, "tip", at.t.size() - 1);
    CHECK((tip - Eigen::Vector3d(-.05760, -.99741, 0)).norm() < 1e-3);
  }
}

TEST_CASE("in space: a flexible pendulum, reduced to the modes of its plane and their derivatives") {
  for (const std::string frame : {"pinned", "clamped", "mean-axis"}) {
    INFO(frame);
    Words words{{"frame", frame}, {"elements", "10"}, {"modes", "3"}, {"end", "0.5"}, {"step", "2e-3"}};
    const History flat = plane(flat_pendulum, words, Formulation::vm_md);
    words.push_back({"gravity", rotation(0, -9.81)}), words.push_back({"section", stiff}),
        words.push_back({"hinge", "revolute, axis: $z"});
    const History at = space(pendulum, words, Formulation::vm_md);
    CHECK(apart(at, rotation.Q, flat, "tip") < 1e-6);
    CHECK(apart(at, Eigen::Matrix3d::Identity(), flat, "bent") < 1e-6);
  }
}

// Square and on a ball: each mode comes twice, and the two of a pair with their derivatives span what the plane's modes
// do there.
TEST_CASE("in space: a flexible pendulum of square section on a spherical joint, reduced") {
  Words words{{"frame", "pinned"}, {"elements", "10"}, {"modes", "3"}, {"end", "0.5"}, {"step", "2e-3"}};
  const History flat = plane(flat_pendulum, words, Formulation::vm_md);
  words[2].second = "6";
  words.push_back({"gravity", rotation(0, -9.81)}), words.push_back({"section", square}),
      words.push_back({"hinge", "spherical"});
  const History at = space(pendulum, words, Formulation::vm_md);
  CHECK(apart(at, rotation.Q, flat, "tip") < 1e-6);
}

namespace {

// The second link's mesh stands rotated in its own axes, the first one is rotated by `initial`.
const std::string flat_arm = R"yaml(
gravity: [0, -9.81]
bodies:
  upper:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 6}}
    section: {A: 1e-3, I: 1e-6/12}
    material: {E: 2e8, rho: 1000}
    reduction: {modes: 3, attachment: none}
  lower:
    mesh: {line: {from: [1, 0], to: [1, 0.8], elements: 6}}
    section: {A: 1e-3, I: 1e-6/12}
    material: {E: 2e8, rho: 1000}
    reduction: {modes: 3, attachment: none}
joints: {$joints}
motion: {end: 0.6, step: 2e-3}
probes: {elbow: {at: upper.end, quantity: position}, tip: {at: lower.end, quantity: position}}
)yaml";

const std::string arm = R"yaml(
gravity: $gravity
bodies:
  upper:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 6}}
    section: {$section, orientation: [0, 1, 0]}
    material: {E: 2e8, nu: 0.3, rho: 1000}
    frame: pinned
    reduction: {modes: 3, attachment: none}
    initial: {rotation: $turn}
  lower:
    mesh: {line: {from: $elbow, to: $tip, elements: 6}}
    section: {$section, orientation: $x}
    material: {E: 2e8, nu: 0.3, rho: 1000}
    frame: pinned
    reduction: {modes: 3, attachment: none}
joints: {$joints}
motion: {end: 0.6, step: 2e-3}
probes: {elbow: {at: upper.end, quantity: position}, tip: {at: lower.end, quantity: position}}
)yaml";

void check_arm(const std::string& flat_joints, const std::string& joints, Formulation formulation,
               const std::string& section) {
  const History flat = plane(flat_arm, {{"joints", flat_joints}}, formulation);
  const History at = space(arm,
                           {{"joints", joints},
                            {"gravity", rotation(0, -9.81)},
                            {"section", section},
                            {"elbow", rotation(1, 0)},
                            {"tip", rotation(1, 0.8)},
                            {"x", rotation(1, 0)}},
                           formulation);
  CHECK(apart(at, rotation.Q, flat, "elbow") < 1e-6);
  CHECK(apart(at, rotation.Q, flat, "tip") < 1e-6);
}

}  // namespace

TEST_CASE("in space: a flexible double pendulum with a revolute, spherical or universal joint") {
  const std::string hinges =
      "a: {type: revolute, between: [ground, upper.start]}, b: {type: revolute, between: [upper.end, lower.start]}";
  for (const std::string elbow : {"type: revolute, axis: $z", "type: spherical",
                                  "type: universal, axis: $z, second_axis: $x", "type: cylindrical, axis: $z"}) {
    INFO(elbow);
    check_arm(hinges,
              "a: {type: revolute, between: [ground, upper.start], axis: $z}, b: {between: [upper.end, lower.start], " +
                  elbow + "}",
              Formulation::nlffr, square);
  }
}

TEST_CASE("in space: a reduced double pendulum and a robot arm that is driven at both joints") {
  const std::string drive = "angle: \"1.2*(1 - cos(4*t))\"", back = "angle: \"-0.9*sin(5*t)^2\"";
  check_arm(
      "a: {type: revolute, between: [ground, upper.start]}, b: {type: revolute, between: [upper.end, lower.start]}",
      "a: {type: revolute, between: [ground, upper.start], axis: $z}, b: {type: revolute, between: [upper.end, "
      "lower.start], axis: $z}",
      Formulation::vm_md, stiff);
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    INFO(name_of(formulation));
    check_arm("a: {type: driven, between: [ground, upper.start], " + drive +
                  "}, b: {type: driven, between: [upper.end, lower.start], " + back + "}",
              "a: {type: driven, between: [ground, upper.start], axis: $z, " + drive +
                  "}, b: {type: driven, between: [upper.end, lower.start], axis: $z, " + back + "}",
              formulation, stiff);
  }
}

namespace {

const std::string flat_spin_up = R"yaml(
parameters: {Om: 6, Ts: 15}
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [8, 0], elements: 10}}
    section: {A: 7.3e-5, I: 8.218e-9}
    material: {E: 6.895e10, rho: 2766.67}
    frame: clamped
    reduction: {modes: 2, derivatives: all, attachment: none}
joints:
  hub: {type: driven, between: [ground, beam.start],
        angle: "Om/Ts*(t^2/2 + (Ts/(2*pi))^2*(cos(2*pi*t/Ts) - 1))"}
motion: {end: 2.5, step: 1e-2}
probes: {bent: {at: beam.end, quantity: deflection}}
)yaml";

const std::string spin_up = R"yaml(
parameters: {Om: 6, Ts: 15}
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [8, 0, 0], elements: 10}}
    section: {A: 7.3e-5, Iz: 8.218e-9, Iy: $Iy, J: 1e-4, orientation: [0, 1, 0]}
    material: {E: 6.895e10, nu: 0.3, rho: 2766.67}
    frame: clamped
    reduction: {modes: 2, derivatives: all, attachment: none}
    initial: {rotation: $turn}
joints:
  hub: {type: driven, between: [ground, beam.start], axis: $z,
        angle: "Om/Ts*(t^2/2 + (Ts/(2*pi))^2*(cos(2*pi*t/Ts) - 1))"}
motion: {end: 2.5, step: 1e-2}
probes: {bent: {at: beam.end, quantity: deflection}}
)yaml";

}  // namespace

// -0.2145215: independent converged computation (von Karman).
TEST_CASE("in space: spin-up about a skew axis") {
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    INFO(name_of(formulation));
    const History flat = plane(flat_spin_up, {}, formulation), at = space(spin_up, {{"Iy", "8.218e-7"}}, formulation);
    CHECK(apart(at, Eigen::Matrix3d::Identity(), flat, "bent") < 1e-6);
    CHECK(at.at("bent.y", 2.5) == Approx(-.2145215).margin(2e-3));
  }
}

// Everything begins at zero, and a stiff direction has only round-off: Newton must not ask for less.
TEST_CASE("in space: spin-up from rest of a section that is wide across its plane") {
  const History flat = plane(flat_spin_up, {}, Formulation::nlffr),
                at = space(spin_up, {{"Iy", "2e-5"}}, Formulation::nlffr);
  CHECK(apart(at, Eigen::Matrix3d::Identity(), flat, "bent") < 1e-6);
}

namespace {

// Data of the planar test: crank .15 at 150 rad/s, rod .30 of 6 mm diameter, slider of 0.033378 kg.
const std::string flat_crank = R"yaml(
parameters: {c: 0.15, L: 0.30, d: 0.006, A: pi*d^2/4, I: pi*d^4/64, E: 2e11, rho: 7870, speed: 150, s: 0.04}
bodies:
  crank:
    rigid: true
    mesh: {line: {from: [0, 0], to: [c, 0], elements: 1}}
    section: {A: A, I: I}
    material: {E: E, rho: rho}
    initial: {angular_velocity: speed}
  rod:
    mesh: {line: {from: [0, 0], to: [L, 0], elements: 8}}
    section: {A: A, I: I}
    material: {E: E, rho: rho}
    frame: pinned
    reduction: {modes: 3, derivatives: all, attachment: none}
    initial: {position: [c, 0], velocity: [0, speed*c], angular_velocity: -speed*c/L}
  slider:
    rigid: true
    mesh: {line: {from: [-s/2, 0], to: [s/2, 0], elements: 2}}
    section: {rhoA: 0.033378/s}
    initial: {position: [c + L, 0]}
joints:
  motor: {type: driven, between: [ground, crank.start], angle: speed*t}
  crank-pin: {type: revolute, between: [crank.end, rod.start]}
  slider-pin: {type: revolute, between: [rod.end, slider.middle]}
  guide: {type: prismatic, between: [ground, slider.middle], axis: [1, 0]}
motion: {end: 0.01, step: 2e-5}
probes: {middle: {at: rod.middle, quantity: deflection}, slider: {at: slider.middle, quantity: position}}
)yaml";

const std::string crank = R"yaml(
parameters: {c: 0.15, L: 0.30, d: 0.006, E: 2e11, rho: 7870, speed: 150, s: 0.04}
bodies:
  crank:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [c, 0, 0], elements: 1}}
    section: {shape: circle, radius: d/2, orientation: [0, 1, 0]}
    material: {E: E, nu: 0.3, rho: rho}
    initial: {rotation: $turn, angular_velocity: $crank_spin}
  rod:
    mesh: {line: {from: [0, 0, 0], to: [L, 0, 0], elements: 8}}
    section: {$section, orientation: [0, 1, 0]}
    material: {E: E, nu: 0.3, rho: rho}
    frame: pinned
    reduction: {modes: 3, derivatives: all, attachment: none}
    initial: {rotation: $turn, position: $pin, velocity: $pin_speed, angular_velocity: $rod_spin}
  slider:
    rigid: true
    mesh: {line: {from: [-s/2, 0, 0], to: [s/2, 0, 0], elements: 2}}
    section: {A: 1e-4, Iy: 1e-8, Iz: 1e-8, J: 1e-8, orientation: [0, 1, 0]}
    material: {E: E, nu: 0.3, rho: 0.033378/s/1e-4}
    initial: {rotation: $turn, position: $slider}
joints:
  motor: {type: driven, between: [ground, crank.start], axis: $z, angle: speed*t}
  crank-pin: {between: [crank.end, rod.start], $crank_pin}
  slider-pin: {between: [rod.end, slider.middle], $slider_pin}
  guide: {between: [ground, slider.middle], axis: $x, type: $guide}
motion: {end: 0.01, step: 2e-5}
probes: {middle: {at: rod.middle, quantity: deflection}, slider: {at: slider.middle, quantity: position}}
)yaml";

struct Pins {
  std::string crank_pin, slider_pin, guide;
};

History rotated_crank(const Pins& pins, Formulation formulation, const std::string& section) {
  return space(crank,
               {{"crank_spin", rotation(0, 0, 150)},
                {"pin_speed", rotation(0, 150 * 0.15)},
                {"rod_spin", rotation(0, 0, -75)},
                {"crank_pin", pins.crank_pin},
                {"slider_pin", pins.slider_pin},
                {"pin", rotation(0.15, 0)},
                {"slider", rotation(0.45, 0)},
                {"guide", pins.guide},
                {"section", section},
                {"x", rotation(1, 0)},
                {"y", rotation(0, 1)}},
               formulation);
}

const Pins hinges{"type: revolute, axis: $z", "type: revolute, axis: $z", "prismatic"};

}  // namespace

// Table: geometrically exact deflection over the rod's length, independent converged computation.
TEST_CASE("in space: slider-crank of revolute joints, as in the plane") {
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    INFO(name_of(formulation));
    const History flat = plane(flat_crank, {}, formulation);
    const History at =
        rotated_crank(hinges, formulation, "A: pi*d^2/4, Iz: pi*d^4/64, Iy: pi*d^4/64*100, J: pi*d^4/64*100");
    CHECK(apart(at, rotation.Q, flat, "slider") < 1e-9);
    CHECK(apart(at, Eigen::Matrix3d::Identity(), flat, "middle") < 1e-6);
    CHECK(at.at("middle.y", .005) / 0.3 == Approx(.015097).margin(3e-4));
    CHECK(at.at("middle.y", .01) / 0.3 == Approx(.005309).margin(3e-4));
  }
}

// No constraint is left over: a ball and a cylinder, or a cross and a ball, take the place of two hinges.
TEST_CASE("in space: slider-crank with spherical, universal and cylindrical joints") {
  const History flat = plane(flat_crank, {}, Formulation::nlffr);
  for (const Pins& pins : {Pins{"type: spherical", "type: revolute, axis: $z", "cylindrical"},
                           Pins{"type: spherical", "type: universal, axis: $z, second_axis: $y", "prismatic"}}) {
    INFO(pins.slider_pin);
    const History at = rotated_crank(pins, Formulation::nlffr, "shape: circle, radius: d/2");
    CHECK(apart(at, rotation.Q, flat, "slider") < 1e-9);
    CHECK(apart(at, Eigen::Matrix3d::Identity(), flat, "middle") < 1e-6);
  }
}
