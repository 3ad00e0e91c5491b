#include <catch2/catch.hpp>

#include "shell_decks.h"
#include "space_twin.h"

// Places of several nodes of corotational bodies: joints, springs, follower loads and probes on the mean of an edge.

using namespace floe;
using namespace floe::test;

namespace {

/// A strip clamped at its left edge, with what is at its right one.
std::string strip(const std::string& bodies, const std::string& joints, const std::string& rest) {
  return fill(R"yaml(
bodies:
  strip:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.2, 0], elements: [12, 4], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 2e9, nu: 0.3, rho: 1000}
    strains: second_order
$bodies
joints:
  clamp: {type: fixed, between: [ground, strip.left]}
$joints
motion: {end: 0.2, step: 2e-3}
$rest
)yaml",
              {{"bodies", bodies}, {"joints", joints}, {"rest", rest}});
}

/// Greatest difference of a probe over its greatest size.
double difference(const History& a, const History& b, const std::string& probe) {
  double worst = 0, size = 0;
  for (const auto& [column, values] : b.columns) {
    if (column.find(probe + ".") != 0) continue;
    for (std::size_t i = 0; i < values.size(); ++i) {
      worst = std::max(worst, std::abs(a[column][i] - values[i]));
      size = std::max(size, std::abs(values[i]));
    }
  }
  return worst / size;
}

}  // namespace

TEST_CASE("cfr edges: joints, springs and probes of an edge's mean, against the full-order model") {
  const std::string rod = R"yaml(
  rod:
    rigid: true
    mesh: {line: {from: [1, 0.1, 0], to: [1.3, 0.1, 0], elements: 1}}
    section: {shape: rectangle, width: 0.02, height: 0.02, orientation: [0, 1, 0]}
    material: {E: 2e9, nu: 0.3, rho: 1000}
)yaml",
                    probes = R"yaml(
probes:
  tip: {at: strip.p2}
  edge: {at: strip.right, quantity: displacement}
  turn: {at: strip.right, quantity: rotation}
  spin: {at: strip.right, quantity: angular_velocity}
  seen: {at: strip.p1, quantity: position, relative_to: strip.right}
  reaction: {joint: j, quantity: force}
  rate: {formula: "2*spin.y"}
)yaml",
                    push = "loads: {f: {type: force, at: strip.p3, force: [0, 0, \"0.5*sin(20*t)\"]}}\n";
  const std::pair<std::string, std::string> cases[] = {
      {rod, "  j: {type: spherical, between: [strip.right, rod.start]}\n"},
      {rod, "  j: {type: fixed, edges: mean, between: [strip.right, rod.start]}\n"},
      {rod, "  j: {type: universal, axis: [0, 1, 0], second_axis: [0, 0, 1], between: [strip.right, rod.start]}\n"},
      {"", "  j: {type: spring, between: [strip.right, {body: ground, node: [1, 0.1, -1]}], stiffness: 200}\n"},
      {"", "  j: {type: bushing, between: [ground, strip.right], translation: [0, 0, 50], rotation: [2, 3, 1]}\n"}};
  for (const auto& [bodies, joint] : cases) {
    INFO(joint);
    const std::string text = strip(bodies, joint, push + probes);
    const History own = move(text, Formulation::cfr), full = move(text, Formulation::nlffr);
    for (const char* probe : {"tip", "edge", "turn", "seen"}) {
      INFO(probe);
      CHECK(difference(own, full, probe) < 0.02);
    }
    for (const char* probe : {"spin", "reaction"}) {
      INFO(probe);
      CHECK(difference(own, full, probe) < 0.06);
    }
    REQUIRE(own.columns.contains("rate.value"));
    CHECK(own["rate.value"].back() == Approx(2 * own["spin.y"].back()).epsilon(1e-9));
  }
}

// Until it is released, a clamp holds every node of its edge, as one that never is.
TEST_CASE("cfr edges: a clamp that an event releases") {
  const std::string gravity = "gravity: [0, 0, -9.81]\n",
                    probes = "probes: {tip: {at: strip.p2}, left: {at: strip.left}}\n";
  const auto moved = [&](const std::string& events) {
    return move(strip("", "", gravity + probes + events), Formulation::cfr);
  };
  const History kept = moved(""), released = moved("events: {drop: {unlock: clamp, at: 0.1}}\n");
  for (const double t : {0.04, 0.09}) CHECK(released.at("tip.z", t) == Approx(kept.at("tip.z", t)).epsilon(1e-6));
  CHECK(std::abs(released.at("left.z", 0.1)) < 1e-9);
  CHECK(released["left.z"].back() < -1e-3);
}

// The moment at the edge rotates with it: half a circle, of height 2 L / pi and without length.
TEST_CASE("cfr edges: a moment in axes of an edge rolls a strip") {
  const double EI = 2e9 * 0.2 * 1e-6 / 12;
  const History at = rest(fill(R"yaml(
bodies:
  strip:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.2, 0], elements: [20, 2], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 2e9, nu: 0, rho: 1000}
joints: {clamp: {type: fixed, between: [ground, strip.left]}}
loads: {m: {type: moment, at: strip.right, moment: [0, "$m*t", 0], axes: place}}
motion: {end: 1, step: 0.1}
probes: {edge: {at: strip.right, quantity: position}, turn: {at: strip.right, quantity: rotation}}
)yaml",
                               {{"m", number(-0.5 * M_PI * EI)}}),
                          Formulation::cfr, 10);
  CHECK(at["edge.z"][0] == Approx(2 / M_PI).epsilon(3e-3));
  CHECK(at["edge.x"][0] == Approx(2 / M_PI).epsilon(3e-3));
  CHECK(at["turn.ry"][0] == Approx(-M_PI / 2).epsilon(3e-3));
}

// Nothing acts from outside: the energy stays, whatever the edges transmit.
TEST_CASE("cfr edges: plates that are joined at the means of their edges keep their energy") {
  const History at = move(R"yaml(
bodies:
  a:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.4, 0], elements: [4, 3], cells: quadrilaterals}}
    section: {thickness: 0.02}
    material: {E: 1e7, nu: 0.3, rho: 1000}
    initial: {angular_velocity: [0, 3, 1]}
  b:
    mesh: {plate: {origin: [1, 0, 0], along: [0.8, 0, 0], across: [0, 0.4, 0], elements: [3, 2], cells: quadrilaterals}}
    section: {thickness: 0.02}
    material: {E: 1e7, nu: 0.3, rho: 1000}
    initial: {angular_velocity: [0, 3, 1]}
joints: {j: {type: fixed, edges: mean, between: [a.right, b.left]}}
motion: {end: 0.3, step: 1e-3, spectral_radius: 0.99}
probes: {tip: {at: b.right, quantity: position}, a: {at: a.right, quantity: position}, b: {at: b.left, quantity: position}}
)yaml",
                          Formulation::cfr);
  CHECK(drift(at) < 1e-3);
  for (std::size_t i = 0; i < at.t.size(); ++i) CHECK((vector_at(at, "a", i) - vector_at(at, "b", i)).norm() < 1e-8);
}

// The plate has axes of its own, without mass or stiffness, as long as the clamp constrains it; dense factors of small
// meshes broke down where round-off of their weights scaled the rows of these axes.
TEST_CASE("a plate of corotational elements whose clamp an event releases moves as the clamped one before it") {
  const std::string plate = R"yaml(
bodies:
  p:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.4, 0], elements: [$elements], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 2e9, nu: 0.3, rho: 1000}
joints: {a: {type: fixed, between: [ground, p.left]}}
loads: {l: {type: force, at: p.right, force: [0, 0, 0.5], axes: body}}
motion: {end: 0.2, step: $step}
probes: {c: {at: p.p3}}
)yaml";
  for (const std::string elements : {"2, 1", "4, 2", "6, 3"}) {
    INFO(elements);
    const std::string clamped = fill(plate, {{"elements", elements}, {"step", "2e-3"}}),
                      event = "events: {e: {unlock: a, at: 0.1}}\n";
    const History released = move(clamped + event, Formulation::cfr), before = move(clamped, Formulation::cfr);
    for (const double t : {0.03, 0.06, 0.09, 0.1})
      CHECK(released.at("c.z", t) == Approx(before.at("c.z", t)).epsilon(1e-4));
    const std::string shorter = fill(plate, {{"elements", elements}, {"step", "5e-4"}});
    CHECK(released.at("c.z", 0.2) == Approx(move(shorter + event, Formulation::cfr).at("c.z", 0.2)).epsilon(0.01));
  }
}

// Moments at the ends of a graded edge are those of its elements, in their axes.
TEST_CASE("a force at a graded edge of corotational shells acts alike in every position of the scene") {
  const Eigen::Vector3d force(2, 1, 0.1);
  const auto motion = [&](const Eigen::Matrix3d& R) {
    const Deck deck(shells("S4", 4, 3, 0.01, "*ELASTIC\n2e9, 0.3\n*DENSITY\n1000\n", [&](double u, double v) {
      return Eigen::Vector3d(R * Eigen::Vector3d(u, 0.2 * v * v, 0));
    }));
    const Eigen::Vector3d f = R * force;
    const History at =
        rest(fill(R"yaml(
bodies: {p: {mesh: {file: {path: $path}}}}
joints: {a: {type: fixed, between: [ground, p.left]}}
loads: {f: {type: force, at: p.right, force: [$fx, $fy, $fz]}}
probes: {turn: {at: p.right, quantity: rotation}, d: {at: p.right, quantity: displacement}}
)yaml",
                  {{"path", deck.path()}, {"fx", number(f.x())}, {"fy", number(f.y())}, {"fz", number(f.z())}}),
             Formulation::cfr);
    Eigen::Matrix<double, 3, 2> found;
    for (int i = 0; i < 3; ++i) {
      found(i, 0) = at[std::string("d.") + "xyz"[i]].back();
      found(i, 1) = at[std::string("turn.r") + "xyz"[i]].back();
    }
    return Eigen::Matrix<double, 3, 2>(R.transpose() * found);
  };
  const Eigen::Matrix<double, 3, 2> along = motion(Eigen::Matrix3d::Identity());
  const Eigen::Matrix<double, 3, 2> rotated = motion(math::rotation(Eigen::Vector3d(0.9, 1.2, -1.4)));
  for (int i = 0; i < 2; ++i) CHECK((rotated - along).col(i).norm() < 1e-7 * along.col(i).norm());
}

// A plate of 0.8 x 1 on a hinge along its edge, that a spring holds there: it rotates by F L / k as a whole and bends
// as one that is clamped at the mean of its edge, by about F L^3 / 3 EI. A moment on one node of the edge bends it
// twice as much, and more on finer meshes.
TEST_CASE("cfr edges: springs, motors and stops of a hinge along an edge act on its mean") {
  const std::string text = R"yaml(
bodies:
  base: {rigid: {mass: 1, centre: [0, 0, 0], inertia: [1, 1, 1]}}
  p:
    mesh: {plate: {along: [0.8, 0, 0], across: [0, 1, 0], elements: [8, 6], cells: quadrilaterals}}
    section: {thickness: 4e-3}
    material: {E: 4e9, nu: 0.3, rho: 800}
    initial: {position: [-0.4, 0, 0]}
joints:
  g: {type: fixed, between: [ground, {body: base, node: [0, 0, 0]}]}
  h: {type: revolute, between: [$base, p.bottom], axis: [1, 0, 0]$stop}
  $spring
loads:
  f: {type: force, at: p.top, force: [0, 0, "0.1*t"]}
  $motor
probes: {tip: {at: p.top}, edge: {at: p.bottom, quantity: rotation}, a: {joint: h, quantity: angle}}
)yaml";
  const std::string place = "{body: base, node: [0, 0, 0]}";
  const std::string spring = "s: {type: spring, between: [" + place +
                             ", p.bottom], axis: [1, 0, 0], torsional_stiffness: 6}",
                    grounded =
                        "s: {type: spring, between: [ground, p.bottom], axis: [1, 0, 0], torsional_stiffness: 6}";
  const std::vector<Words> variants = {
      {{"base", place}, {"stop", ""}, {"spring", spring}, {"motor", ""}},
      {{"base", "ground"}, {"stop", ""}, {"spring", grounded}, {"motor", ""}},
      {{"base", place}, {"stop", ""}, {"spring", ""}, {"motor", "m: {type: moment, joint: h, moment: \"-6*h.angle\"}"}},
      {{"base", place}, {"stop", ", limits: {upper: 0, stiffness: 6, width: 1e-6}"}, {"spring", ""}, {"motor", ""}}};
  for (const Words& words : variants) {
    CAPTURE(fill(text, words));
    const History exact = rest(fill(text, words), Formulation::cfr), full = rest(fill(text, words), Formulation::nlffr);
    CHECK(exact["a.value"][0] == Approx(0.1 / 6).epsilon(2e-3));
    CHECK(exact["edge.rx"][0] == Approx(0.1 / 6).epsilon(2e-3));
    CHECK(exact["tip.z"][0] == Approx(0.1 / 6 + 0.1 / (3 * 4e9 * 0.8 * 6.4e-8 / 12)).epsilon(0.01));
    CHECK(exact["tip.z"][0] == Approx(full["tip.z"][0]).epsilon(3e-3));
  }
}
