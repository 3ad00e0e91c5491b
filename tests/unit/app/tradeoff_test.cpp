#include "../../../src/app/tradeoff.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "../../../src/app/tradeoff_run.h"
#include "../../../src/app/tradeoff_table.h"

using namespace floe;
using namespace floe::app;

namespace {

ModelVariant variant(const std::string& name, double motion, double error) {
  ModelVariant one;
  one.name = name, one.motion = motion, one.steps = 10, one.coordinates = 7;
  one.total = {error / 2, error}, one.peak = {error, error}, one.estimate = {error, error};
  one.reduction = {0.1 * error, 0.2 * error};
  return one;
}

std::vector<ModelVariant> variants() {
  std::vector<ModelVariant> all = {variant("slow and good", 4, 1e-4), variant("dominated", 3, 0.2),
                                   variant("fair", 2, 0.008), variant("fast and poor", 1, 0.5),
                                   variant("gone", 0.5, 0.01)};
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
  const std::vector<ModelVariant> all = variants();
  CHECK(pareto_front(all) == std::vector<std::size_t>{3, 2, 0});
  CHECK(choice(all, 0.01) == std::size_t{2});
  CHECK(choice(all, 1e-3) == std::size_t{0});
  CHECK_FALSE(choice(all, 1e-9));
  CHECK_FALSE(choice({all.back()}, 0.01));
}

TEST_CASE("trade-off: a variant with errors that are no numbers is on no front") {
  std::vector<ModelVariant> all = variants();
  all[0].total[1] = NAN;
  CHECK(pareto_front(all) == std::vector<std::size_t>{3, 2});
  CHECK(std::isinf(all[0].worst()));
}

TEST_CASE("trade-off: variants go between ranks as they are") {
  std::vector<ModelVariant> all = variants();
  all[1].lacks = "model", all[2].required = 0.01, all[2].selected = "rigid";
  for (const ModelVariant& one : all) {
    const ModelVariant back = variant_of(to_json(one));
    CHECK(back.name == one.name);
    CHECK(back.stopped == one.stopped);
    CHECK(back.total == one.total);
    CHECK(back.reduction == one.reduction);
    CHECK(back.lacks == one.lacks);
    CHECK(back.required == one.required);
    CHECK(back.selected == one.selected);
    CHECK(back.estimate == one.estimate);
    CHECK(back.motion == one.motion);
  }
}

TEST_CASE("trade-off: a table has a row for every model, the worst probe, and the place on the front") {
  std::vector<ModelVariant> all = variants();
  all[2].lacks = "model";
  for (const bool full : {false, true}) {
    const output::Table table = tradeoff_table({"tip", "end"}, all, full);
    REQUIRE(table.rows.size() == all.size());
    for (const auto& row : table.rows) CHECK(row.size() == table.columns.size());
  }
  const output::Table table = tradeoff_table({"tip", "end"}, all, false);
  const std::vector<output::Cell>& fair = table.rows[2];
  CHECK(std::get<std::int64_t>(fair[1]) == 2);      // behind the fast and poor one
  CHECK(std::get<double>(fair[3]) == Approx(2e5));  // 2 s in 10 steps
  CHECK(std::get<double>(fair[5]) == Approx(0.16));
  CHECK(std::get<double>(fair[6]) == Approx(0.8));
  CHECK(std::get<std::string>(fair[7]) == "0.8 *");
  CHECK(std::get<std::string>(table.rows[1][1]).empty());
  CHECK(std::get<std::string>(table.rows[4][0]) == "gone: diverged at t = 1 s");
}

TEST_CASE("trade-off: selected models beside the fastest other one as accurate") {
  std::vector<ModelVariant> all = variants();
  CHECK(selections_table(all).rows.empty());
  ModelVariant one = variant("selected for 1 %", 1.5, 0.009);
  one.required = 0.01, one.selected = "2 of 9 basis vectors", one.estimate = {0.007, 0.006};
  all.push_back(one);
  one.required = 1e-5;
  all.push_back(one);
  const output::Table table = selections_table(all);
  REQUIRE(table.rows.size() == 2);
  CHECK(std::get<double>(table.rows[0][0]) == Approx(1));
  CHECK(std::get<double>(table.rows[0][1]) == Approx(0.9));
  CHECK(std::get<double>(table.rows[0][2]) == Approx(0.7));
  CHECK(std::get<std::string>(table.rows[0][3]) == "2 of 9 basis vectors");
  CHECK(std::get<double>(table.rows[0][7]) == Approx(0.75));  // of 2 s
  CHECK(std::get<std::string>(table.rows[0][8]) == "fair");
  CHECK(std::get<std::string>(table.rows[1][8]) == "there is none");
}

TEST_CASE("trade-off: the ladder varies frames, meshes, basis, steps and formulation, and leaves rigid bodies alone") {
  std::set<std::string> names, families;
  for (const Candidate& member : hierarchy(arm())) {
    INFO(member.name);
    CHECK(names.insert(member.family + member.name).second);
    families.insert(member.family);
    CHECK(member.impossible.empty());
    CHECK(member.scene.bodies[1].rigid);
    CHECK(*member.scene.motion.output == Approx(4e-2));  // as often as the scene's
    const scene::Body& body = member.scene.bodies[0];
    if (member.family == "modes") CHECK(member.formulation == scene::Formulation::vm);
    if (member.name == "3 modes + all MDs") {
      CHECK(body.reduction.modes.count == 3);
      CHECK(body.reduction.derivatives.pairs.empty());
    }
    if (member.name == "step 4x" || member.name == "nlffr, step 4x") CHECK(member.scene.motion.step == Approx(4e-2));
    if (member.name == "8 frames, twice the elements" || member.name == "nlffr, 8 frames, twice the elements") {
      CHECK(body.frames == 8);
      CHECK(body.mesh.elements[0] == 16);  // two in each frame
    }
    if (member.name == "half the elements" || member.name == "cfr, half the elements")
      CHECK(body.mesh.elements[0] == 4);
    if (member.family == "cfr") CHECK(member.formulation == scene::Formulation::cfr);
  }
  CHECK(families == std::set<std::string>{"scene", "rigid", "modes", "modes and derivatives", "attachment modes",
                                          "residual responses", "elastic force", "frames", "mesh", "step", "integrator",
                                          "full order", "cfr", "accuracy"});
  for (const char* name : {"2 frames", "4 frames", "nlffr, 2 frames", "nlffr", "cfr", "lffr", "twice the elements"})
    CHECK(std::any_of(names.begin(), names.end(), [&](const std::string& one) { return one.ends_with(name); }));
}

TEST_CASE("trade-off: full-order models are told apart by mesh, frames and step") {
  std::set<std::string> keys;
  std::size_t full = 0;
  for (const Candidate& member : hierarchy(arm()))
    if (member.formulation == scene::Formulation::nlffr) ++full, keys.insert(full_order_key(member.scene));
  CHECK(full == 9);  // as written; 2, 4 and 8 frames; half and twice the elements; 2, 4 and 8 times the step
  CHECK(keys.size() == full);
  CHECK(full_order_key(hierarchy(arm())[0].scene) == full_order_key(hierarchy(arm())[3].scene));  // another basis alone
}
