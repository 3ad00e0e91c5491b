#include <catch2/catch.hpp>

#include "../../../src/app/error_budget.h"

using namespace floe;
using namespace floe::app;
using Catch::Matchers::Contains;
using nlohmann::ordered_json;

namespace {

ordered_json part(double tip, double end) {
  return {{"probes", {{"tip", tip}, {"end", end}}}, {"by", "twice the elements"}, {"until", 1.}, {"seconds", 0.5}};
}

/// Of a reduced motion to t = 1: 1 + 2 + 3 + 4 % of the tip, a third of that of the end.
ordered_json whole() {
  ordered_json j = part(0.01, 0.0033);
  j["model"] = part(0.02, 0.0067), j["mesh"] = part(0.03, 0.01), j["step"] = part(0.04, 0.013);
  j["total"] = {{"probes", {{"tip", 0.1}, {"end", 0.033}}}, {"parts", {"reduction", "model", "mesh", "step"}}};
  return j;
}

}  // namespace

TEST_CASE("error budget: one line has the total of the worst probe and its parts") {
  ordered_json j = whole();
  CHECK(budget_line(j) == "total 10 %: reduction 1 %, model 2 %, mesh 3 %, step 4 %");
  j["model"] = {{"none", "no cfr"}};
  CHECK(budget_line(j) == "total 10 %: reduction 1 %, model not known, mesh 3 %, step 4 %");
  j["total"]["probes"]["end"] = 0.2;
  CHECK_THAT(budget_line(j), Contains("total 20 %: reduction 0.33 %"));
  j["total"]["probes"]["end"] = nullptr;  // no finite number, as JSON has it
  CHECK_THAT(budget_line(j), Contains("total above 10000 %: "));
}

TEST_CASE("error budget: one line says why there is no total") {
  CHECK(budget_line(ordered_json()) == "not estimated");
  CHECK(budget_line({{"none", "no mesh"}}) == "not estimated: no mesh");
  CHECK(budget_line({{"none", "no mesh"}, {"mesh", {{"none", "no probes"}}}}) ==
        "not estimated: no mesh; mesh: no probes");
  CHECK(budget_line({{"total", {{"parts", {"step"}}}}}) == "not estimated: no probe has a total");
}

TEST_CASE("error budget: the table has a row for each probe, marks totals that lack a part, and names how each came") {
  CHECK(budget_words(ordered_json(), 1).empty());
  ordered_json j = whole();
  const std::string all = budget_words(j, 1);
  CHECK_THAT(all, Contains("reduction") && Contains("step") && Contains("total") && !Contains("*"));
  CHECK_THAT(all, Contains("mesh: twice the elements (computed in 0.5 s)\n") && !Contains("to t ="));
  j["mesh"]["until"] = 0.25;
  j["mesh"]["notes"] = {"a note"};
  j["total"]["missing"] = {{"tip", {"model"}}, {"end", {"model"}}};
  j["model"] = {{"none", "takes too long"}};
  const std::string some = budget_words(j, 1);
  CHECK_THAT(some, Contains("10 *") && Contains("3.3 *"));
  CHECK_THAT(some, Contains("* total without the model error\n"));
  CHECK_THAT(some, Contains("No estimate of the model error: takes too long\n"));
  CHECK_THAT(some,
             Contains("mesh: twice the elements, to t = 0.25 s (computed in 0.5 s)\nNote (mesh error): a note\n"));
  j["total"]["missing"] = {{"end", {"step"}}};
  CHECK_THAT(budget_words(j, 1), Contains("* total without the step error: end\n"));
  CHECK_THAT(budget_line(j), Contains("total 10 %: "));  // of tip
  j["total"]["missing"]["tip"] = {"model"};
  CHECK_THAT(budget_line(j), Contains("total of the known parts 10 %: "));
}

TEST_CASE("error budget: totals lack the deformation of bodies that the selection made rigid") {
  ordered_json j = whole();
  j["total"]["made_rigid"] = {"arm", "rod"};
  const std::string words = budget_words(j, 1);
  CHECK_THAT(words, Contains("10 *") && Contains("3.3 *"));
  CHECK_THAT(words, Contains("* total without the deformation of bodies that the selection made rigid: arm, rod\n"));
  CHECK_THAT(budget_line(j), Contains("total of the known parts 10 %: "));
}

TEST_CASE("error budget: errors that are no finite numbers, and parts that are not known, in the table") {
  ordered_json j = whole();
  j["step"]["probes"]["tip"] = nullptr;
  j["total"]["probes"]["tip"] = nullptr;
  j["total"]["missing"] = {{"tip", {"mesh"}}};
  j["mesh"].erase("probes");
  const std::string words = budget_words(j, 1);
  CHECK_THAT(words, Contains("> 10000 *") && Contains("> 10000 ") && Contains(" -"));
  j.erase("step");  // of equilibria
  CHECK_THAT(budget_words(j, 1), !Contains("step"));
  j.erase("total");  // no table
  CHECK_THAT(budget_words(j, 1), !Contains("estimated error") && Contains("model: twice the elements"));
}
