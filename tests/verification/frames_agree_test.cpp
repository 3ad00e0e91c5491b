#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// A cantilever and a free beam, L = EI = rhoA = 1, moved by an amplitude that is small (or not).
History cantilever(Formulation formulation, const std::string& frame, double load) {
  return move(fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1e4, EI: 1, rhoA: 1, rhoI: 1e-3}
    frame: $frame
    reduction: {modes: 4, derivatives: all}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "$load*sin(5*t)^4"]}}
motion: {end: 2, step: 5e-3}
probes: {tip: {at: beam.end}}
)yaml",
                   {{"frame", frame}, {"load", number(load)}}),
              formulation);
}

History thrown(const std::string& frame, double load) {
  return move(fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1e4, EI: 1, rhoA: 1, rhoI: 1e-3}
    frame: $frame
    initial: {angular_velocity: 1, velocity: [0.3, 0.2]}
loads: {tip: {type: force, at: beam.end, force: [0, "$load*sin(9*t)"]}}
motion: {end: 2, step: 5e-3}
probes: {tip: {at: beam.end, quantity: position}}
)yaml",
                   {{"frame", frame}, {"load", number(load)}}),
              Formulation::nlffr);
}

}  // namespace

// The same body seen from three frames: strains differ by the square of the slope only.
TEST_CASE("frames: pinned, clamped and mean-axis agree for small motions of a cantilever") {
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    INFO(name_of(formulation));
    const double load = 2e-4;
    const History pinned = cantilever(formulation, "pinned", load), clamped = cantilever(formulation, "clamped", load),
                  mean = cantilever(formulation, "mean-axis", load);
    CHECK(relative_error(clamped, pinned, "tip.y") < 1e-6);
    CHECK(relative_error(mean, pinned, "tip.y") < 1e-6);
  }
}

// The difference is of second order in the amplitude: a tenth of the load, a hundredth of the difference.
TEST_CASE("frames: their difference falls with the square of the amplitude") {
  const auto difference = [](double load) {
    return relative_error(cantilever(Formulation::nlffr, "clamped", load),
                          cantilever(Formulation::nlffr, "pinned", load), "tip.y");
  };
  const double large = difference(0.1), small = difference(0.01);
  CHECK(large / small == Approx(100).epsilon(0.05));
}

// A free beam that rotates and is shaken: no joint, so that the frames alone hold it.
TEST_CASE("frames: pinned, clamped and mean-axis agree for a free body") {
  const History pinned = thrown("pinned", 1e-2), clamped = thrown("clamped", 1e-2), mean = thrown("mean-axis", 1e-2);
  for (const std::string column : {"tip.x", "tip.y"}) {
    CHECK(relative_error(clamped, pinned, column) < 1e-5);
    CHECK(relative_error(mean, pinned, column) < 1e-5);
  }
}
