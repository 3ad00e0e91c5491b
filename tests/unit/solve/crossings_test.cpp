#include <catch2/catch.hpp>
#include <cmath>

#include "floe/solve/simulation.h"
#include "systems.h"

using namespace floe;

namespace {

using Gap = std::function<std::array<double, 2>(double t)>;

struct Told {
  std::vector<dynamics::EventReport> events;
  std::vector<double> ends;  // of steps
};

/// What is told of a gap that depends on the time alone, while a pendulum hangs at rest, in steps of 0.01.
Told watch(const Gap& gap, double end = 0.06) {
  const dynamics::System system = testing::pendulum(2, 1.5, 9.81);
  const petsc::VecHandle U = testing::vector_of(system, {0, 0, -M_PI / 2, 0, 0}), V = system.create_vector();
  Told told;
  dynamics::Event event{"stop", "hit"};
  event.gap = [&](double t, Vec, Vec) { return gap(t); };
  event.what_back = "left";
  solve::Integration how{end, 0.01, 0.8, {}};
  dynamics::Event other{"other stop", "hit"};
  other.gap = [](double, Vec, Vec) { return std::array{1., 0.}; };  // stays open
  how.events = {event, other};
  how.on_event = [&](const dynamics::EventReport& report) { told.events.push_back(report); };
  solve::simulate(system, how, U, V, [&](const solve::Instant& now) { told.ends.push_back(now.t); });
  return told;
}

/// k (t - a) (t - b) and its rate.
Gap between(double a, double b, double k = 1) {
  return [=](double t) { return std::array{k * (t - a) * (t - b), k * (2 * t - a - b)}; };
}

void check(const Told& told, const std::vector<std::pair<std::string, double>>& expected, double speed) {
  REQUIRE(told.events.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    INFO(expected[i].first << " at " << expected[i].second);
    CHECK(told.events[i].what == expected[i].first);
    CHECK(told.events[i].t == Approx(expected[i].second).epsilon(1e-9));
    CHECK(told.events[i].speed.value() == Approx(speed).epsilon(1e-6));
  }
  CHECK(told.ends.front() == 0);
  CHECK(told.ends.back() == Approx(0.06));
  for (std::size_t i = 1; i < told.ends.size(); ++i) CHECK(told.ends[i] > told.ends[i - 1]);
}

}  // namespace

TEST_CASE("a gap that closes and opens again is told of at both times, also within one step") {
  // within a step, over an end of a step, over several, from just before an end of a step to another
  for (const auto& [a, b] :
       {std::pair(0.0231, 0.0275), {0.0285, 0.0321}, {0.0115, 0.0478}, {0.02 - 1e-8, 0.05 - 1e-8}}) {
    INFO(a << " to " << b);
    check(watch(between(a, b)), {{"hit", a}, {"left", b}}, b - a);
    check(watch(between(a, b, -3)), {{"left", a}, {"hit", b}}, 3 * (b - a));  // closed at first
  }
}

TEST_CASE("a gap that does not quite close, or that opens not quite, is not told of") {
  for (const double sign : {1., -1.}) {
    const auto told = watch([=](double t) {
      return std::array{sign * ((t - 0.0253) * (t - 0.0253) + 1e-9), sign * 2 * (t - 0.0253)};
    });
    CHECK(told.events.empty());
    CHECK(told.ends.size() == 7);
  }
}

TEST_CASE("a gap that closes again and again is told of each time, and steps end there") {
  const double period = 0.037;
  const auto told = watch(
      [=](double t) {
        const double phase = 2 * M_PI / period * t + 1;
        return std::array{std::cos(phase), -2 * M_PI / period * std::sin(phase)};
      },
      0.2);
  std::vector<double> expected;
  for (double phase = M_PI / 2; phase < 2 * M_PI / period * 0.2 + 1; phase += M_PI)
    expected.push_back((phase - 1) * period / (2 * M_PI));
  REQUIRE(told.events.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK(told.events[i].what == (i % 2 == 0 ? "hit" : "left"));
    CHECK(told.events[i].t == Approx(expected[i]).epsilon(1e-6));
    CHECK(told.events[i].speed.value() == Approx(2 * M_PI / period).epsilon(1e-5));
    double nearest = 1;
    for (const double end : told.ends) nearest = std::min(nearest, std::abs(end - expected[i]));
    CHECK(nearest < 1e-5 + 1e-3 * 0.01);
  }
}
