#include <catch2/catch.hpp>
#include <cmath>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

std::string thrown(const std::string& frame) {
  return fill(R"yaml(
bodies:
  b:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 12}}
    section: {EA: 1e4, EI: 1, rhoA: 1, rhoI: 1e-4}
    frame: $frame
    reduction: {modes: 4}
    initial: {velocity: [1, 2], angular_velocity: 3, deformation_rate: [0, "sin(pi*x)-2/pi"]}
motion: {end: 0.2, step: 1e-3}
probes: {m: {at: b.middle, quantity: position}, e: {at: b.end, quantity: position}}
)yaml",
              {{"frame", frame}});
}

// v = (1, 2 + 3 x + w), w = sin(pi x) - 2/pi, which has no part in rigid motions; slopes rotate at 3 + pi cos(pi x).
const double energy = 0.5 * (1 + 13 + (0.5 - 4 / (M_PI * M_PI))) + 0.5 * 1e-4 * (9 + M_PI * M_PI / 2);

}  // namespace

TEST_CASE("a free beam thrown with a rate of deformation has the kinetic energy of its velocities, in every frame") {
  const std::string frame = GENERATE("pinned", "clamped", "mean-axis");
  INFO(frame);
  for (const auto& [formulation, tolerance] :
       {std::pair{Formulation::cfr, 1e-5}, {Formulation::nlffr, 1e-5}, {Formulation::vm_md, 1e-3}}) {
    INFO(scene::name_of(formulation));
    const History start = history_of(thrown(frame), formulation);
    const dynamics::Energy found = start.model.system->energy(0, start.model.U, start.model.V);
    CHECK(found.kinetic == Approx(energy).epsilon(tolerance));
  }
}

TEST_CASE("a free beam flies and vibrates the same in every frame") {
  const History corotational = move(thrown("pinned"), Formulation::cfr);
  for (const std::string frame : {"pinned", "clamped", "mean-axis"})
    for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
      INFO(frame << " " << scene::name_of(formulation));
      const History at = move(thrown(frame), formulation);
      for (const std::string column : {"m.x", "m.y", "e.x", "e.y"})
        CHECK(relative_error(at, corotational, column) < 2e-3);
    }
}

// A joint at the tip of a beam that starts bent: the neighbour stands where the tip is, and the start is consistent.
TEST_CASE("a joint at the tip of a beam that starts bent is satisfied from the start in every formulation") {
  const std::string text = R"yaml(
bodies:
  a:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    initial: {deformation: [0, "0.1*x^2"]}
  b:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}
    section: {rhoA: 1}
    rigid: true
    initial: {position: [1, 0.1]}
joints:
  c: {type: fixed, between: [ground, a.start]}
  d: {type: revolute, between: [a.end, b.start]}
motion: {end: 1e-2, step: 1e-3}
probes: {a: {at: a.end, quantity: position}, b: {at: b.start, quantity: position}}
)yaml";
  for (const Formulation formulation : {Formulation::cfr, Formulation::nlffr, Formulation::vm_md}) {
    INFO(scene::name_of(formulation));
    const History at = move(text, formulation);
    for (const double time : {0., 1e-3, 1e-2}) {
      CHECK(at.at("a.x", time) == Approx(at.at("b.x", time)).margin(1e-9));
      CHECK(at.at("a.y", time) == Approx(at.at("b.y", time)).margin(1e-9));
    }
    CHECK(at.at("a.y", 0) == Approx(0.1).margin(1e-3));
  }
}
