#include <catch2/catch.hpp>

#include "spatial_scenes.h"

using namespace floe;
using namespace floe::test;

namespace {

std::string cantilever(const std::string& reduction, double force, double moment) {
  return fill(R"yaml(
bodies:
  b:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 16}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    reduction: $reduction
joints: {c: {type: fixed, between: [ground, b.start]}}
loads:
  f: {type: force, at: b.end, force: [0, $force*t]}
  m: {type: moment, at: b.end, moment: $moment*t}
probes: {e: {at: b.end}, r: {at: b.end, quantity: rotation}}
)yaml",
              {{"reduction", reduction}, {"force", number(force)}, {"moment", number(moment)}});
}

}  // namespace

// The modes hold the interface: those of a beam clamped at both ends (22.3733, 61.6728: roots of 1 - cos cosh,
// squared).
TEST_CASE("Craig-Bampton: the interface is fixed in the modes") {
  const auto omega = omega_of(cantilever("{modes: 2, interface: [end]}", 0, 0));
  CHECK(omega[0] == Approx(22.3732854481).epsilon(1e-4));
  CHECK(omega[1] == Approx(61.6728228676).epsilon(1e-4));
}

TEST_CASE("Craig-Bampton: loads on the interface have their exact linear response for any number of modes") {
  for (const std::string modes : {"0", "3"}) {
    INFO(modes);
    const History at =
        rest(cantilever("{modes: " + modes + ", interface: [end], attachment: none, derivatives: none}", 1e-6, 2e-6),
             Formulation::vm_md);
    CHECK(at["e.y"].back() == Approx(1e-6 / 3 + 2e-6 / 2).epsilon(1e-9));  // F L^3 / 3 EI + M L^2 / 2 EI
    CHECK(at["r.angle"].back() == Approx(1e-6 / 2 + 2e-6).epsilon(1e-9));
  }
}

TEST_CASE("Craig-Bampton: derivatives of modes and constraint modes represent large deflections") {
  const History full = rest(cantilever("{modes: 1}", 1, 0.5), Formulation::nlffr, 4),
                reduced =
                    rest(cantilever("{modes: 3, interface: [end], attachment: none}", 1, 0.5), Formulation::vm_md, 4);
  CHECK(full["e.x"].back() < -0.1);
  for (const std::string column : {"e.x", "e.y", "r.angle"})
    CHECK(reduced[column].back() == Approx(full[column].back()).epsilon(1e-3));
}

// Both ends of a beam that floats: six constraint modes, of which rigid motions leave three.
TEST_CASE("Craig-Bampton: rigid-body motions are not basis vectors") {
  const std::string frame = GENERATE("pinned", "clamped", "mean-axis");
  const std::string text = fill(R"yaml(
bodies:
  b:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1e4, EI: 1, rhoA: 1}
    frame: $frame
    reduction: {modes: 4, interface: [start, [1, 0]], attachment: none, derivatives: none}
motion: {end: 1, step: 0.1}
)yaml",
                                {{"frame", frame}});
  const assembly::Model model = history_of(text, Formulation::vm_md).model;
  CHECK(model.bodies[0].columns == 4 + 3);
}

TEST_CASE("Craig-Bampton: a node of a plate, and an edge as one rigid region") {
  const auto plate = [](const std::string& reduction, const std::string& place) {
    return fill(R"yaml(
bodies:
  p:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.5, 0], elements: [8, 4], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: $reduction
joints: {root: {type: fixed, between: [ground, p.left]}}
loads: {f: {type: force, at: p.$place, force: [0, 0, 1e-3*t]}}
probes: {tip: {at: p.$place}}
)yaml",
                {{"reduction", reduction}, {"place", place}});
  };
  const double full = rest(plate("{modes: 1}", "p2"), Formulation::lffr)["tip.z"].back();
  const std::string reduction = "{modes: 2, interface: [p2], attachment: none, derivatives: none}";
  CHECK(rest(plate(reduction, "p2"), Formulation::vm_md)["tip.z"].back() == Approx(full).epsilon(1e-7));
  const double soft = rest(plate("{modes: 1}", "right"), Formulation::lffr)["tip.z"].back(),
               stiff = rest(plate("{modes: 2, interface: [right], attachment: none, derivatives: none}", "right"),
                            Formulation::vm_md)["tip.z"]
                           .back();
  CHECK(stiff < soft);  // the edge stays straight, across and along
  CHECK(stiff == Approx(soft).epsilon(0.03));
}
