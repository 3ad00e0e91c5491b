#include "../../../src/app/tradeoff.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "../../../src/app/tradeoff_table.h"

using namespace floe;
using namespace floe::app;

namespace {

Rung rung(const std::string& name, double motion, double error) {
  Rung one;
  one.name = name, one.motion = motion, one.steps = 10, one.coordinates = 7;
  one.rms = {error / 2, error}, one.peak = {error, error}, one.estimate = {error, error};
  return one;
}

std::vector<Rung> rungs() {
  std::vector<Rung> all = {rung("slow and good", 4, 1e-4), rung("dominated", 3, 0.2), rung("fair", 2, 0.008),
                           rung("fast and poor", 1, 0.5), rung("gone", 0.5, 0.01)};
  all.back().stopped = "diverged at t = 1 s";
  return all;
}

const scene::Scene& arm() {
  static const scene::Scene scene = scene::parse_scene(R"yaml(
bodies:
  arm:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1.2e4, EI: 1, rhoA: 1}
    reduction: {modes: 5, derivatives: [[1, 1], [4, 5]]}
  hub: {rigid: true, mesh: {line: {from: [0, 0], to: [1, 0], elements: 1}}, section: {rhoA: 1}}
joints: {hinge: {type: revolute, between: [ground, arm.start]}, other: {type: revolute, between: [ground, hub.start]}}
motion: {end: 1, step: 1e-2, every: 4}
probes: {tip: {at: arm.end}}
)yaml",
                                                       "scene");
  return scene;
}

}  // namespace

TEST_CASE("trade-off: the front has nothing that is slower and worse, and nothing that stopped") {
  const std::vector<Rung> all = rungs();
  CHECK(pareto_front(all) == std::vector<std::size_t>{3, 2, 0});
  CHECK(choice(all, 0.01) == std::size_t{2});
  CHECK(choice(all, 1e-3) == std::size_t{0});
  CHECK_FALSE(choice(all, 1e-9));
  CHECK_FALSE(choice({all.back()}, 0.01));
}

TEST_CASE("trade-off: a rung with errors that are no numbers is on no front") {
  std::vector<Rung> all = rungs();
  all[0].rms[1] = NAN;
  CHECK(pareto_front(all) == std::vector<std::size_t>{3, 2});
  CHECK(std::isinf(all[0].worst()));
}

TEST_CASE("trade-off: rungs go between ranks as they are") {
  for (const Rung& one : rungs()) {
    const Rung back = rung_of(to_json(one));
    CHECK(back.name == one.name);
    CHECK(back.stopped == one.stopped);
    CHECK(back.rms == one.rms);
    CHECK(back.estimate == one.estimate);
    CHECK(back.motion == one.motion);
  }
}

TEST_CASE("trade-off: a table has a row for the reference, for its own error and for every rung") {
  const Rung reference = rung("nlffr", 8, 0), own = rung("nlffr, finer", 30, 1e-3);
  for (const bool full : {false, true}) {
    const output::Table table = tradeoff_table({"tip", "end"}, reference, &own, rungs(), 2, full);
    REQUIRE(table.rows.size() == 7);
    for (const auto& row : table.rows) CHECK(row.size() == table.columns.size());
  }
  const std::string text = output::to_text(tradeoff_table({"tip", "end"}, reference, nullptr, rungs(), 2, false));
  CHECK(text.find("fair <- selected") != std::string::npos);
  CHECK(text.find("gone: diverged at t = 1 s") != std::string::npos);
}

TEST_CASE("trade-off: the ladder varies one thing at a time and leaves rigid bodies alone") {
  std::set<std::string> names, families;
  for (const Candidate& member : ladder(arm())) {
    CHECK(names.insert(member.family + member.name).second);
    families.insert(member.family);
    CHECK(member.scene.bodies[1].rigid);
    if (member.family == "modes") CHECK(member.formulation == scene::Formulation::vm);
    if (member.name == "3 modes + all MDs") {
      CHECK(member.scene.bodies[0].reduction.modes.count == 3);
      CHECK(member.scene.bodies[0].reduction.derivatives.pairs.empty());
    }
    if (member.name == "step 4x") {
      CHECK(member.scene.motion.step == Approx(4e-2));
      CHECK(*member.scene.motion.output == Approx(4e-2));  // as often as the scene's
    }
  }
  CHECK(families == std::set<std::string>{"scene", "linear", "rigid", "modes", "modes and derivatives",
                                          "attachment modes", "step", "integrator", "accuracy"});
}
