#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// A rigid rod of mass 2 and length 1.5 that spins about a hinge at its start.
std::string rod(const std::string& events, const std::string& motion = "{end: 1, step: 3e-3}") {
  return fill(R"yaml(
bodies:
  rod:
    rigid: true
    mesh: {line: {from: [0, 0], to: [1.5, 0], elements: 2}}
    section: {rhoA: 1.3333333333333333}
    initial: {angular_velocity: 2}
joints: {hinge: {type: revolute, between: [ground, rod.start]}}
motion: $motion
probes:
  turn: {at: rod.end, quantity: rotation}
  end: {at: rod.end, quantity: velocity}
  middle: {at: rod.middle, quantity: position}
  pull: {joint: hinge, quantity: force}
events: {$events}
)yaml",
              {{"motion", motion}, {"events", events}});
}

/// The same in space, about z.
std::string rod_in_space(const std::string& events) {
  return fill(R"yaml(
bodies:
  rod:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [1.5, 0, 0], elements: 2}}
    section: {A: 1, Iy: 1e-9, Iz: 1e-9, J: 1e-9, orientation: [0, 0, 1]}
    material: {E: 1, nu: 0, rho: 1.3333333333333333}
    initial: {angular_velocity: [0, 0, 2]}
joints: {hinge: {type: revolute, between: [ground, rod.start], axis: [0, 0, 1]}}
motion: {end: 1, step: 3e-3}
probes:
  turn: {at: rod.end, quantity: rotation}
  end: {at: rod.end, quantity: velocity}
  middle: {at: rod.middle, quantity: position}
  pull: {joint: hinge, quantity: force}
events: {$events}
)yaml",
              {{"events", events}});
}

/// A soft double pendulum whose knee is locked, let go, and whose lower part falls off at the end.
History falling(double step, const std::string& space = "") {
  const std::string in_space = R"yaml(
gravity: [0, -9.81, 0]
bodies:
  upper:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 2}}
    section: {A: 0.01, Iy: 2e-4, Iz: 1e-4, J: 3e-4, orientation: [0, 0, 1]}
    material: {E: 5e4, nu: 0.3, rho: 100}
    reduction: {modes: 2, derivatives: all}
  lower:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 2}}
    section: {A: 0.01, Iy: 2e-4, Iz: 1e-4, J: 3e-4, orientation: [0, 0, 1]}
    material: {E: 5e4, nu: 0.3, rho: 100}
    initial: {position: [1, 0, 0], angular_velocity: [0, 0, 1]}
joints:
  hinge: {type: revolute, between: [ground, upper.start], axis: [0, 0, 1]}
  knee: {type: spherical, between: [upper.end, lower.start]}
)yaml";
  const std::string in_plane = R"yaml(
gravity: [0, -9.81]
bodies:
  upper:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}
    section: {EA: 500, EI: 5, rhoA: 1, rhoI: 0.01}
    reduction: {modes: 2, derivatives: all}
  lower:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}
    section: {EA: 500, EI: 5, rhoA: 1, rhoI: 0.01}
    reduction: {modes: 2, derivatives: all}
    initial: {position: [1, 0]}
joints:
  hinge: {type: revolute, between: [ground, upper.start]}
  knee: {type: revolute, between: [upper.end, lower.start]}
)yaml";
  return move(fill((space.empty() ? in_plane : in_space) + R"yaml(
motion: {end: 0.5, step: $step}
probes: {tip: {at: lower.end, quantity: position}, speed: {at: lower.end, quantity: velocity}}
events:
  hold: {lock: knee, at: 0.1437}
  free: {unlock: knee, when: "sin(t - 0.2791)"}
  off: {unlock: hinge, at: 0.3533}
)yaml",
                   {{"step", number(step)}}),
              Formulation::vm_md);
}

Eigen::VectorXd end_of(const History& at) {
  Eigen::VectorXd all(4);
  all << at["tip.x"].back(), at["tip.y"].back(), at["speed.x"].back(), at["speed.y"].back();
  return all;
}

Eigen::VectorXd multipliers_of(const History& at) {
  const Eigen::VectorXd U = everywhere(at.model.U);
  const std::vector<PetscInt> rows = multipliers(*at.model.system);
  Eigen::VectorXd all(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) all[i] = U[rows[i]];
  return all;
}

}  // namespace

TEST_CASE("a hinge that is locked stops a rod at once and says what that took") {
  const bool space = GENERATE(false, true);
  const std::string events = "stop: {lock: hinge, at: 0.5}";
  const History history = move(space ? rod_in_space(events) : rod(events), Formulation::vm_md);
  const double moment = 2 * 1.5 * 1.5 / 3;  // of inertia
  REQUIRE(history.events.size() == 1);
  CHECK(history.events[0].t == Approx(0.5).epsilon(1e-12));
  CHECK(history.events[0].what == "lock joint hinge");
  CHECK(history.events[0].lost == Approx(0.5 * moment * 4).epsilon(1e-6));
  REQUIRE(history.events[0].impulses.size() == 1);
  CHECK(std::abs(history.events[0].impulses[0]) == Approx(moment * 2).epsilon(1e-6));
  CHECK(history[space ? "turn.rz" : "turn.angle"].back() == Approx(1).epsilon(1e-6));
  CHECK(std::abs(history["end.y"].back()) < 1e-6);
  CHECK(history.t.back() == Approx(1).epsilon(1e-12));
}

TEST_CASE("an event happens where its formula first changes sign, also where that begins at zero") {
  const std::vector<std::pair<std::string, double>> cases{
      {"sin(5*t)", M_PI / 5}, {"t*(t - 0.4)", 0.4},       {"(t - 0.2)*(t - 0.6)", 0.2},
      {"0.3 - t", 0.3},       {"cos(20*t)", M_PI / 40},   {"t > 0.7", 0.7},
      {"t < 0.7", 0.7},       {"pulse(t, 0.2, 0.4)", 0.2}};
  for (const auto& [when, t] : cases) {
    INFO(when);
    const History history = move(rod("enough: {stop: true, when: \"" + when + "\"}"), Formulation::vm_md);
    REQUIRE(history.events.size() == 1);
    CHECK(history.events[0].t == Approx(t).epsilon(1e-12));
    CHECK(history.t.back() == Approx(t).epsilon(1e-12));
  }
}

TEST_CASE("a rod whose hinge lets go flies straight on") {
  const bool space = GENERATE(false, true);
  const std::string events = "go: {unlock: hinge, when: \"t^2 - 0.25\"}";
  const History history = move(space ? rod_in_space(events) : rod(events), Formulation::vm_md);
  REQUIRE(history.events.size() == 1);
  CHECK(history.events[0].t == Approx(0.5).epsilon(1e-12));
  // to (omega h)^2 = 4e-5: the middle leaves where it is at t = 0.5, at speed 2 x 0.75 along the tangent, and the rod
  // goes on rotating
  CHECK(history["middle.x"].back() == Approx(0.75 * std::cos(1.) - 0.5 * 1.5 * std::sin(1.)).epsilon(4e-5));
  CHECK(history["middle.y"].back() == Approx(0.75 * std::sin(1.) + 0.5 * 1.5 * std::cos(1.)).epsilon(4e-5));
  CHECK(history[space ? "turn.rz" : "turn.angle"].back() == Approx(2).epsilon(1e-5));
  CHECK(multipliers_of(history).norm() == 0);
}

TEST_CASE("a motion stops where a probe passes a value") {
  const History history = move(rod("enough: {stop: true, probe: turn.angle, crosses: 1.2345}"), Formulation::vm_md);
  REQUIRE(history.events.size() == 1);
  CHECK(history.t.back() == history.events[0].t);
  CHECK(history.t.back() == Approx(1.2345 / 2).epsilon(1e-5));  // the step's own error in the rotation
  CHECK(history["turn.angle"].back() == Approx(1.2345).epsilon(1e-8));
  for (std::size_t i = 1; i < history.t.size(); ++i) CHECK(history.t[i] > history.t[i - 1]);
}

// v_y = 3 cos 2t at the rod's end.
TEST_CASE("a motion stops where a velocity passes a value") {
  const double at = 0.5 * std::acos(2. / 3);
  const std::string stop = "enough: {stop: true, probe: end.y, crosses: 2}";
  for (const std::string& text : {rod(stop), rod(stop, "{end: 1, step: 0.02}"),
                                  rod(stop, "{end: 1, step: 3e-3, tolerance: 1e-6}"), rod_in_space(stop)}) {
    const History history = move(text, Formulation::vm_md);
    REQUIRE(history.events.size() == 1);
    CHECK(history.t.back() == history.events[0].t);
    CHECK(history.t.back() == Approx(at).epsilon(2e-4));
    CHECK(history["end.y"].back() == Approx(2).epsilon(1e-5));
    REQUIRE(history.t.size() > 2);
    CHECK(history.t.back() - history.t[history.t.size() - 2] > 1e-6);
  }
}

// The hinge holds the rod by m l w^2 / 2 = 6 N, also in the row of the event, whose step is shorter than those before.
TEST_CASE("reactions where an event is found within a step are those of the motion") {
  for (const std::string angle : {"1.2", "1.21", "1.225", "1.2345"})
    for (const bool space : {false, true}) {
      INFO(angle << (space ? " in space" : ""));
      const std::string stop =
          "enough: {stop: true, probe: turn." + std::string(space ? "rz" : "angle") + ", crosses: " + angle + "}";
      const History history = move(space ? rod_in_space(stop) : rod(stop, "{end: 1, step: 0.02}"), Formulation::vm_md);
      REQUIRE(history.events.size() == 1);
      CHECK(std::hypot(history["pull.x"].back(), history["pull.y"].back()) == Approx(6).epsilon(2e-3));
    }
}

TEST_CASE("events whose probes pass their values at one instant, or nearly, all happen") {
  for (const std::string second : {"0.5", "0.500000000001", "0.49999999999", "0.50000001", "0.500001", "0.5001"})
    for (const std::string motion : {"{end: 1, step: 3e-3}", "{end: 1, step: 3e-3, tolerance: 1e-4}"}) {
      INFO(second << " " << motion);
      const std::string unlock = "first: {unlock: hinge, probe: middle.y, crosses: 0.5}, ";
      const History history = move(
          rod(unlock + "second: {stop: true, probe: middle.y, crosses: " + second + "}", motion), Formulation::vm_md);
      CHECK(history.events.size() == 2);
      CHECK(history.t.back() == Approx(0.5 * std::asin(2. / 3)).epsilon(1e-3));
    }
}

TEST_CASE("adaptive steps meet events, too") {
  const History history =
      move(rod("stop: {lock: hinge, at: 0.5}, enough: {stop: true, at: 0.75}", "{end: 1, step: 3e-3, tolerance: 1e-6}"),
           Formulation::vm_md);
  REQUIRE(history.events.size() == 2);
  CHECK(history["turn.angle"].back() == Approx(1).epsilon(1e-5));
  CHECK(history.t.back() == Approx(0.75).epsilon(1e-12));
}

TEST_CASE("order 2 in positions, velocities and multipliers goes on across events") {
  const std::string space = GENERATE("", "space");
  const History a = falling(5e-4, space), b = falling(2.5e-4, space), c = falling(1.25e-4, space);
  REQUIRE(a.events.size() == 3);
  const Eigen::VectorXd first = end_of(a) - end_of(b), second = end_of(b) - end_of(c);
  CHECK(std::log2(first.head<2>().norm() / second.head<2>().norm()) == Approx(2).margin(0.25));
  CHECK(std::log2(first.tail<2>().norm() / second.tail<2>().norm()) == Approx(2).margin(0.25));
  const Eigen::VectorXd force = multipliers_of(a) - multipliers_of(b), finer = multipliers_of(b) - multipliers_of(c);
  CHECK(std::log2(force.norm() / finer.norm()) == Approx(2).margin(0.3));
}

TEST_CASE("joints and probes that events name must be there") {
  const auto fault = [](const std::string& events) {
    try {
      scene::parse_scene(rod(events), "scene");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  using Catch::Contains;
  CHECK_THAT(fault("e: {unlock: hinges, at: 0.5}"), Contains("did you mean \"hinge\"?"));
  CHECK_THAT(fault("e: {unlock: hinge}"), Contains("none of at, when, probe"));
  CHECK_THAT(fault("e: {unlock: hinge, lock: hinge, at: 0.5}"), Contains("unlock and lock together"));
  CHECK_THAT(fault("e: {stop: true, probe: turns.angle, crosses: 1}"), Contains("did you mean \"turn.angle\"?"));
  CHECK_THAT(fault("e: {stop: true, at: 2}"), Contains("at most motion.end, 1"));
}

TEST_CASE("a formula of an event that is no number is told with its key, unless the event comes before") {
  const auto events = [](const std::string& when) {
    const scene::Scene scene = scene::parse_scene(rod("e: {stop: true, when: \"" + when + "\"}"), "scene");
    const assembly::Model model = assembly::build(scene, scene::Formulation::vm_md, PETSC_COMM_WORLD);
    return assembly::events_of(scene, model, 1);
  };
  using Catch::Contains;
  CHECK_THROWS_WITH(events("sqrt(0.5 - t) + 1"), Contains(".when: \"sqrt(0.5 - t) + 1\" is not a number at t = 0.5"));
  CHECK(events("sqrt(0.5 - t) - 0.5")[0].at == Approx(0.25));
}

// Accelerations of another probe cost a factorisation of the whole system; here they cannot even be computed.
TEST_CASE("events: evaluate the probe that they watch alone") {
  const scene::Scene scene = scene::parse_scene(R"yaml(
bodies:
  rod:
    rigid: true
    mesh: {line: {from: [0, 0], to: [1.5, 0], elements: 2}}
    section: {rhoA: 1}
joints: {hinge: {type: revolute, between: [ground, rod.start]}}
motion: {end: 1, step: 1e-2}
probes:
  pull: {at: rod.end, quantity: acceleration}
  turn: {at: rod.end, quantity: rotation}
events: {end: {stop: true, probe: turn.angle, crosses: 0.25}}
)yaml",
                                                "scene");
  const assembly::Model model = assembly::build(scene, Formulation::vm_md, PETSC_COMM_WORLD);
  const std::vector<dynamics::Event> events = assembly::events_of(scene, model, 1);
  const petsc::VecHandle unknown = model.system->create_vector();
  petsc::check(VecSet(unknown, std::nan("")));
  CHECK(events.at(0).crosses(0, model.U, unknown) == Approx(-0.25));
}
