#include <catch2/catch.hpp>

#include "estimated.h"
#include "floe/assembly/offline.h"

using namespace floe;
using namespace floe::test;

namespace {

/// Equilibria at t = 1/steps, 2/steps, ..., 1, and the estimate of their error.
Estimated rest_and_estimate(const std::string& text, Formulation formulation, int steps, double seconds = 100) {
  const scene::Scene scene = scene::parse_scene(text, "scene");
  Estimated all{{assembly::build(scene, formulation, PETSC_COMM_WORLD, true), {}, {}, {}, {}}, {}};
  const assembly::Model& model = all.history.model;
  assess::KeptMotion kept(model);
  for (int i = 1; i <= steps; ++i) {
    const double t = double(i) / steps;
    solve::equilibrium(*model.system, t, model.U, model.V);
    model.system->rebase(model.U);
    store(all.history, t, model.U, model.V);
    kept.keep({t, i, model.U, model.V, model.V, i == steps});
  }
  if (scene::is_reduced(formulation)) all.estimate = assess::estimate_error_at_rest(model, kept.states(), seconds);
  return all;
}

/// Estimate against true error of every probe, wherever that is above the digits that an equilibrium has.
void check_effectivity(const std::string& name, const std::string& text, double least, double most) {
  const History full = rest_and_estimate(text, Formulation::nlffr, 4).history;
  int compared = 0;
  for (const Formulation formulation : {Formulation::vm, Formulation::vm_md}) {
    const Estimated reduced = rest_and_estimate(text, formulation, 4);
    REQUIRE(reduced.estimate.none == "");
    REQUIRE(reduced.estimate.t.size() == 4);
    bool condensed = false;  // its force is the gradient of the energy over W, not V' times that of full order
    for (const assembly::ReducedBody& body : reduced.history.model.offline->reduced)
      condensed = condensed || !body.relief.pairs.empty();
    CHECK(reduced.estimate.unbalanced < (condensed ? 2e-3 : 1e-6));  // 1.3e-3 is the greatest here
    for (std::size_t p = 0; p < reduced.estimate.probes.size(); ++p) {
      const std::string& probe = reduced.history.model.probes[p].name;
      const double error = vector_error(reduced.history, full, probe), estimate = reduced.estimate.probes[p];
      INFO(fmt::format("{} {} {}: error {:.3g}, estimate {:.3g}, effectivity {:.2f}", name, scene::name_of(formulation),
                       probe, error, estimate, estimate / error));
      if (error < 1e-6) continue;
      ++compared;
      CHECK(estimate > least * error);
      CHECK(estimate < most * error);
    }
  }
  REQUIRE(compared >= 2);
}

/// A plate bent over its thickness with so few columns that modes alone miss most of it.
std::string bent_plate(const std::string& force, const std::string& reduction) {
  return fill(R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [2, 0, 0], across: [0, 1, 0], elements: [8, 4]}}
    section: {thickness: 0.01}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: $reduction
joints: {left: {type: fixed, between: [ground, plate.left]}, right: {type: fixed, between: [ground, plate.right]}}
loads: {middle: {type: force, at: {body: plate, node: [1, 0.5, 0]}, force: [0, 0, $force*t]}}
probes: {middle: {at: {body: plate, node: [1, 0.5, 0]}}, corner: {at: {body: plate, node: [0.75, 0, 0]}}}
)yaml",
              {{"force", force}, {"reduction", reduction}});
}

}  // namespace

TEST_CASE("static estimate: plates whose stretching is missing in modes alone") {
  check_effectivity("plate", bent_plate("2e3", "{modes: 2, attachment: none}"), 0.9, 1.1);
  check_effectivity("plate, loaded far", bent_plate("2e4", "{modes: 1, attachment: none}"), 0.8, 1.25);
}

// What the frame does by the error of the deformations counts, too.
TEST_CASE("static estimate: mechanisms in the plane and in space") {
  check_effectivity("arms", R"yaml(
gravity: [0, "-9.81*t"]
bodies:
  upper:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1e4, EI: 2, rhoA: 1}
    frame: pinned
    reduction: {modes: 1, attachment: none}
  lower:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1e4, EI: 2, rhoA: 1}
    frame: pinned
    reduction: {modes: 1, attachment: none}
    initial: {position: [1, 0]}
joints:
  root: {type: fixed, between: [ground, upper.start]}
  elbow: {type: revolute, between: [upper.end, lower.start]}
  spring: {type: spring, between: [upper.end, lower.start], torsional_stiffness: 8}
probes: {elbow: {at: upper.end}, tip: {at: lower.end}, turn: {at: lower.end, quantity: rotation}}
)yaml",
                    0.9, 1.1);
  check_effectivity("door", R"yaml(
bodies:
  door:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0.4], elements: 8}}
    section: {shape: rectangle, width: 0.02, height: 0.01, orientation: [0, 1, 0]}
    material: {E: 2e9, nu: 0.3, rho: 1000}
    frame: {type: clamped, at: start}
    reduction: {modes: 2, attachment: none}
joints:
  hinge: {type: revolute, between: [ground, door.start], axis: [0, 0, 1]}
  stay: {type: bushing, between: [ground, door.middle], translation: [50, 200, 10], rotation: [1, 1, 1]}
loads: {tip: {type: force, at: door.end, force: [0, "4*t", "-2*t"]}}
probes: {tip: {at: door.end}}
)yaml",
                    0.9, 1.1);
}

TEST_CASE("static estimate: without time budget of the last equilibrium only; no error for round-off") {
  const std::string text = bent_plate("2e3", "{modes: 2, attachment: none}");
  const assess::Estimate whole = rest_and_estimate(text, Formulation::vm_md, 4).estimate,
                         last = rest_and_estimate(text, Formulation::vm_md, 4, 0).estimate;
  REQUIRE(last.none == "");
  REQUIRE(last.t == std::vector<double>{1});
  CHECK(last.samples == 1);
  CHECK(last.notes.size() >= 1);
  CHECK(last.relative[0] == Approx(whole.relative[3] * std::sqrt(4.) / 2).epsilon(0.5));
  CHECK(rest_and_estimate(text.substr(0, text.find(", corner")) + ", corner: {at: {body: plate, node: [0, 0, 0]}}}\n",
                          Formulation::vm, 4)
            .estimate.probes[1] == 0);
}

TEST_CASE("static estimate: none for full-order models") {
  const scene::Scene scene = scene::parse_scene(bent_plate("1", "{modes: 2}"), "scene");
  const assembly::Model model = assembly::build(scene, Formulation::nlffr, PETSC_COMM_WORLD, true);
  CHECK(assess::estimate_error_at_rest(model, {}, 1).none == "it applies to reduced models only (vm, vm+md)");
}

// The sum of loads and reactions vanishes in both models; the moment of a clamped beam depends on its deflection.
TEST_CASE("estimate at rest: reactions of supports, from the forces of the reduced model") {
  const std::string probes = "probes: {R: {joint: root, quantity: force}, M: {joint: root, quantity: moment}}\n",
                    joint = "joints: {root: {type: support, between: [ground, $at], hold: [x, y, z, rx, ry, rz]}}\n",
                    beam = fill(
                        "bodies:\n  b:\n"
                        "    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 12}}\n"
                        "    section: {shape: rectangle, width: 0.02, height: 0.01, orientation: [0, 1, 0]}\n"
                        "    material: {E: 7e10, nu: 0.3, rho: 2700}\n" +
                            joint + "loads: {q: {type: distributed, body: b, force: [0, \"20*t\", \"300*t\"]}}\n" +
                            probes,
                        {{"at", "b.start"}});
  check_effectivity("beam", beam, 0.8, 1.25);
  const Estimated reduced = rest_and_estimate(beam, Formulation::vm_md, 2);
  CHECK(reduced.estimate.probes[0] < 1e-8);
  check_effectivity("plate",
                    fill("bodies:\n  b:\n"
                         "    mesh: {plate: {along: [0.4, 0, 0], across: [0, 0.3, 0], elements: [6, 4]}}\n"
                         "    section: {thickness: 0.003}\n    material: {E: 7e10, nu: 0.3, rho: 2700}\n" +
                             joint + "loads: {q: {type: pressure, body: b, pressure: \"1000*t\"}}\n" + probes,
                         {{"at", "b.left"}}),
                    0.8, 1.25);
}
