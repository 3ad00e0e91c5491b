#include <catch2/catch.hpp>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;

// A rigid body of inertia 1 that rotates or slides with speed v against a stop: a mass on a spring of stiffness k that
// sets in like a parabola over the width w. Undamped it leaves with -v, after
//   2 int_0^w dd / sqrt(v^2 - k d^3 / (3 w)) + (pi/2 + asin(w/2 / a)) ... of the linear part about w/2,
// where a^2 = (w/2)^2 + v_w^2 / k and v_w is the speed at d = w.

namespace {

constexpr double k = 400, width = 0.01;

double duration(double v) {
  double inner = 0;
  constexpr int n = 2000;  // midpoints
  for (int i = 0; i < n; ++i) {
    const double d = width * (i + 0.5) / n;
    inner += width / n / std::sqrt(v * v - k * d * d * d / (3 * width));
  }
  const double at_width = std::sqrt(v * v - k * width * width / 3), w = std::sqrt(k);
  const double outer = (M_PI - 2 * std::atan2(width / 2 * w, at_width)) / w;  // from d - w/2 = w/2 and back
  return 2 * inner + outer;
}

/// A rod of length 1 and mass 3 about its end: I = 1.
const std::string planar = R"yaml(
bodies:
  rod:
    rigid: true
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}
    section: {EA: 1, EI: 1, rhoA: 3}
    initial: {angular_velocity: $v}
joints: {hinge: {type: revolute, between: [ground, rod.start], limits: {lower: -1, upper: 0.5, stiffness: 400, damping: $c, width: 0.01}}}
motion: {end: $end, step: 1e-3}
probes: {rod: {at: rod.start, quantity: rotation}}
)yaml";

std::string fill_planar(double v, double c, double end) {
  return fill(planar, {{"v", number(v)}, {"c", number(c)}, {"end", number(end)}});
}

struct Contact {
  double duration, rebound;
};

/// @param x  a column  @param limit  that it passes upwards and downwards
Contact contact(const History& at, const std::vector<double>& x, double limit) {
  std::vector<double> times;
  for (std::size_t i = 1; i < x.size(); ++i)
    if ((x[i - 1] - limit) * (x[i] - limit) < 0)
      times.push_back(at.t[i - 1] + (at.t[i] - at.t[i - 1]) * (limit - x[i - 1]) / (x[i] - x[i - 1]));
  REQUIRE(times.size() == 2);
  const std::size_t n = x.size();
  return {times[1] - times[0], (x[n - 1] - x[n - 2]) / (at.t[n - 1] - at.t[n - 2])};
}

}  // namespace

TEST_CASE("stops: contact time and rebound of a rod are those of the penalty oscillator") {
  const History at = move(fill_planar(1, 0, 1), Formulation::vm_md);
  const Contact found = contact(at, at["rod.angle"], 0.5);
  CHECK(found.duration == Approx(duration(1)).epsilon(1e-3));
  CHECK(found.rebound == Approx(-1).epsilon(1e-3));
  CHECK(drift(at) < 1e-3);
  const std::vector<double> gaps = assembly::stop_gaps(at.model, 0, at.model.U);
  REQUIRE(gaps.size() == 2);
  CHECK(!at.model.stops[0].upper);
  CHECK(gaps[0] == Approx(at["rod.angle"].back() + 1));
  CHECK(gaps[1] == Approx(0.5 - at["rod.angle"].back()));
}

// A linear damped contact with the damping ratio z leaves with exp(-z pi / sqrt(1 - z^2)) of the speed when d = 0
// again; a width small against the depth changes that little.
TEST_CASE("stops: damping dissipates the expected speed") {
  const double z = 0.1;
  const History at = move(fill(fill_planar(4, 2 * z * std::sqrt(k), 0.5), {}), Formulation::vm_md);
  const Contact found = contact(at, at["rod.angle"], 0.5);
  CHECK(found.rebound == Approx(-4 * std::exp(-z * M_PI / std::sqrt(1 - z * z))).epsilon(0.02));
}

// A free body has no acceleration before the stop, nor at it: the error of a step from far before it to its end in the
// stop is estimated as nothing. Contacts came up to 78 % late, without a rebound, and in space with a turn less.
TEST_CASE("stops: adaptive steps do not pass over a stop that a free body comes to") {
  const std::string text = R"yaml(
bodies: {a: {rigid: {mass: 3, centre: $centre, inertia: $inertia}, initial: {angular_velocity: $w}}}
joints: {hinge: {type: revolute, between: [ground, a.centre], $axis limits: {upper: 0.5, stiffness: 400, width: 0.01}}}
motion: {end: 3, step: 1e-3, tolerance: $tolerance}
probes: {x: {joint: hinge, quantity: angle}, w: {joint: hinge, quantity: rate}}
)yaml";
  for (const bool space : {false, true})
    for (const double speed : {0.3, 1., 3.})
      for (const auto& [tolerance, rebound] : {std::pair("1e-4", 0.05), {"1e-6", 2e-3}}) {
        const std::string v = number(speed);
        const History at = move(fill(text, {{"centre", space ? "[0, 0, 0]" : "[0, 0]"},
                                            {"inertia", space ? "[1, 1, 1]" : "1"},
                                            {"w", space ? "[0, 0, " + v + "]" : v},
                                            {"axis", space ? "axis: [0, 0, 1]," : ""},
                                            {"tolerance", tolerance}}),
                                Formulation::vm_md);
        INFO((space ? "space " : "plane ") << speed << " " << tolerance);
        REQUIRE(at.events.size() == 2);
        CHECK(at.events[0].t == Approx(0.5 / speed).epsilon(1e-6));
        CHECK(at.events[1].t - at.events[0].t == Approx(duration(speed)).epsilon(rebound));
        CHECK(at["w.value"].back() == Approx(-speed).epsilon(rebound));
      }
}

// While a mass falls, its acceleration is constant: the estimated error of a step of any length is zero, and a step
// could end far beyond the stop.
TEST_CASE("stops: adaptive steps do not pass over a stop that a mass falls back on") {
  const std::string text = R"yaml(
gravity: [0, -10]
bodies: {a: {rigid: {mass: 3, centre: [0, 0], inertia: 1}, initial: {velocity: [0, $v]}}}
joints: {guide: {type: prismatic, between: [ground, a.centre], axis: [0, 1], limits: {lower: -$gap, stiffness: 1e5, width: 0.01}}}
motion: {end: $end, step: $step, tolerance: $tolerance}
probes: {y: {joint: guide, quantity: travel}}
)yaml";
  for (const auto& [v, gap, step] :
       {std::tuple(0., 100., "1e-3"), {0.1, 5., "1e-3"}, {20., 0.8, "1e-3"}, {1., 0., "0.25"}})
    for (const auto& [tolerance, rebound] : {std::pair("1e-4", 0.01), {"1e-6", 1e-3}}) {
      const double speed = std::sqrt(v * v + 2 * 10 * gap), contact = (v + speed) / 10;
      const History at = move(fill(text, {{"v", number(v)},
                                          {"gap", number(gap)},
                                          {"step", step},
                                          {"end", number(contact + 0.1)},
                                          {"tolerance", tolerance}}),
                              Formulation::vm_md);
      INFO(v << " " << tolerance);
      REQUIRE(at.events.size() >= 2);
      CHECK(at.events[0].t == Approx(contact).epsilon(1e-6));
      CHECK(at.events[0].speed.value() == Approx(speed).epsilon(1e-5));
      CHECK(at.events[1].speed.value() == Approx(speed).epsilon(rebound));
    }
}

// In space, more than a turn away: turns are counted.
TEST_CASE("stops in space: a hinge after more than one revolution, and a slide on both sides") {
  const Rotated rotation;
  const std::string rod = R"yaml(
bodies:
  rod:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 2}}
    section: {A: 1, Iy: 1e-9, Iz: 1e-9, J: 2e-9, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: 3}
    initial: {rotation: $turn, velocity: $u, angular_velocity: $w}
joints: {guide: {type: $type, between: [ground, rod.start], axis: $axis, limits: {$limits, stiffness: $k, width: 0.01}}}
motion: {end: $end, step: 1e-3}
probes: {rod: {at: rod.end, quantity: $quantity}}
)yaml";
  const History hinge = move(fill(rod, {{"turn", rotation.text()},
                                        {"u", "[0, 0, 0]"},
                                        {"w", rotation(0, 0, 10)},
                                        {"type", "revolute"},
                                        {"axis", rotation(0, 0, 1)},
                                        {"limits", "upper: 7"},
                                        {"k", "400"},
                                        {"end", "1.2"},
                                        {"quantity", "velocity"}}),
                             Formulation::vm_md);
  const auto speed = [&](std::size_t i) { return vector_at(hinge, "rod", i).norm(); };
  CHECK(speed(0) == Approx(10));
  CHECK(speed(hinge.t.size() - 1) == Approx(10).epsilon(2e-3));
  double longest = 0;  // slower than the hinge before and after: in contact
  for (std::size_t i = 0; i < hinge.t.size(); ++i)
    if (speed(i) < 10 * (1 - 1e-4)) longest += 1e-3;
  CHECK(longest == Approx(duration(10)).epsilon(0.05));
  CHECK(drift(hinge) < 2e-3);

  const History slide = move(fill(rod, {{"turn", rotation.text()},
                                        {"u", rotation(2, 0)},
                                        {"w", "[0, 0, 0]"},
                                        {"type", "prismatic"},
                                        {"axis", rotation(1, 0)},
                                        {"limits", "lower: -0.3, upper: 0.2"},
                                        {"k", "1200"},
                                        {"end", "0.75"},
                                        {"quantity", "displacement"}}),
                             Formulation::vm_md);
  std::vector<double> x;
  for (std::size_t i = 0; i < slide.t.size(); ++i)
    x.push_back((rotation.Q.transpose() * vector_at(slide, "rod", i)).x());
  // 0.1 s there, contact, 0.25 s back, contact, and on with 2 m/s: k/m as above
  const double back = 0.1 + duration(2) + 0.25 + duration(2);
  CHECK(*std::max_element(x.begin(), x.end()) > 0.29);
  CHECK(*std::min_element(x.begin(), x.end()) < -0.39);
  CHECK(x.back() == Approx(-0.3 + 2 * (0.75 - back)).margin(2e-3));
}

namespace {

/// The steps end at the event, or within a thousandth of one.
void check_landing(const History& at, double step) {
  for (const auto& event : at.events) {
    double nearest = INFINITY;
    for (const double t : at.t) nearest = std::min(nearest, std::abs(t - event.t));
    CHECK(nearest <= 1e-3 * step);
  }
}

}  // namespace

TEST_CASE("stops: contacts and releases are reported once each, in order, with times and speeds") {
  const double there = 0.5, release = there + duration(1), back = release + 1.5;
  const std::string adaptive = GENERATE("", ", tolerance: 1e-8");
  std::string text = fill_planar(1, 0, 3);
  text.replace(text.find("step: 1e-3"), 10, "step: 1e-3" + adaptive);
  const History at = move(text, Formulation::vm_md);
  REQUIRE(at.events.size() == 4);
  const std::vector<std::pair<std::string, double>> expected{
      {"joint hinge hits its upper limit", there},
      {"joint hinge leaves its upper limit", release},
      {"joint hinge hits its lower limit", back},
      {"joint hinge leaves its lower limit", back + duration(1)}};
  for (std::size_t i = 0; i < 4; ++i) {
    INFO(expected[i].first);
    CHECK(at.events[i].name == (i < 2 ? "hinge.upper" : "hinge.lower"));
    CHECK(at.events[i].what == expected[i].first);
    CHECK(at.events[i].t == Approx(expected[i].second).margin(i == 0 ? 1e-9 : 2e-4));
    CHECK(at.events[i].speed.value() == Approx(1).epsilon(1e-4));
  }
  check_landing(at, 1e-3);
}

// A body thrown up against a limit that is a millionth below where it would rotate: soft as nothing, it is hit and left
// within one step, which begins and ends on one side of it.
TEST_CASE("stops: contact and release within one step") {
  const double dip = std::sqrt(2 * 1e-6 / 10);
  const History at = move(R"yaml(
gravity: [0, -10]
bodies:
  ball:
    rigid: true
    mesh: {line: {from: [-0.5, 0], to: [0.5, 0], elements: 2}}
    section: {EA: 1, EI: 1, rhoA: 3}
    initial: {velocity: [0, 1]}
joints: {guide: {type: prismatic, between: [ground, ball.middle], axis: [0, 1],
                 limits: {upper: 0.05 - 1e-6, stiffness: 1e-9, width: 1e-3}}}
motion: {end: 0.2, step: 0.0123}
probes: {ball: {at: ball.middle}}
)yaml",
                          Formulation::vm_md);
  REQUIRE(at.events.size() == 2);
  CHECK(at.events[0].what == "joint guide hits its upper limit");
  CHECK(at.events[0].t == Approx(0.1 - dip).margin(1e-8));
  CHECK(at.events[0].speed.value() == Approx(10 * dip).epsilon(1e-4));
  CHECK(at.events[1].what == "joint guide leaves its upper limit");
  CHECK(at.events[1].t == Approx(0.1 + dip).margin(1e-8));
  check_landing(at, 0.0123);
}

// Many hits: each rebound is reported, and the energy that damping takes makes the speeds fall.
TEST_CASE("stops in space: a bouncing slide alternates contacts and releases") {
  const Rotated rotation;
  const History at = move(fill(R"yaml(
gravity: $g
bodies:
  ball:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 2}}
    section: {A: 1, Iy: 1e-9, Iz: 1e-9, J: 2e-9, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: 3}
    initial: {rotation: $turn}
joints: {guide: {type: cylindrical, between: [ground, ball.start], axis: $axis,
                 limits: {lower: -0.2, stiffness: 1e5, damping: 100, width: 1e-4},
                 turn_limits: {upper: 1, stiffness: 1, damping: 0}}}
motion: {end: 1.5, step: 2e-3, tolerance: 1e-6}
probes: {ball: {at: ball.start}}
)yaml",
                               {{"g", rotation(-10, 0)}, {"turn", rotation.text()}, {"axis", rotation(1, 0)}}),
                          Formulation::vm_md);
  REQUIRE(at.events.size() >= 8);
  double fastest = INFINITY, last = 0;
  for (std::size_t i = 0; i < at.events.size(); ++i) {
    CHECK(at.events[i].name == "guide.lower");
    CHECK(at.events[i].what == std::string("joint guide ") + (i % 2 == 0 ? "hits" : "leaves") + " its lower limit");
    CHECK(at.events[i].t > last);
    CHECK(at.events[i].speed.value() < fastest * 1.001);
    last = at.events[i].t, fastest = at.events[i].speed.value();
  }
  CHECK(at.events[0].t == Approx(0.2).margin(1e-6));
  CHECK(at.events[0].speed.value() == Approx(2).epsilon(1e-5));
}
