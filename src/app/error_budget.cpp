#include "error_budget.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "floe/math/rounded.h"
#include "floe/output/table.h"
#include "floe/petsc/together.h"

namespace floe::app {

using nlohmann::ordered_json;

namespace {

constexpr double limit = 0.01;  // above it a part is warned of
constexpr const char* parts[] = {"reduction", "model", "mesh", "step"};

/// `probes` of those that are known, and the number of the largest one.
std::size_t put_probes(const std::vector<double>& errors, const assembly::Model& model, ordered_json& j) {
  std::size_t worst = 0;
  for (std::size_t p = 0; p < errors.size(); ++p) {
    if (std::isnan(errors[p])) continue;
    j["probes"][model.probes[p].name] = errors[p];
    if (std::isnan(errors[worst]) || errors[p] > errors[worst]) worst = p;
  }
  return worst;
}

ordered_json step_part(const assess::FinishedMotion& motion, const assess::KeptMotion& kept, double allowed,
                       assess::ErrorPart& part, RunResult& result) {
  double took = motion.seconds;
  MPI_Bcast(&took, 1, MPI_DOUBLE, 0, motion.comm);
  assess::StepError error;
  const std::string why = petsc::failed_together(motion.comm, [&] {
    error = assess::estimate_step_error(motion.model, motion.start, kept, motion.how, took, allowed);
  });
  if (!why.empty()) error.none = "with another step: " + why;
  part.none = error.none;
  if (!error.none.empty()) return {{"none", error.none}};
  part.probes = error.probes, part.t = std::move(error.t), part.errors = std::move(error.errors);
  ordered_json j{{"deformation", error.deformation}};
  const std::size_t worst = put_probes(error.probes, motion.model, j);
  j["by"] = error.halved ? "half the step" : "twice the step";
  j["until"] = error.until;
  j["seconds"] = error.seconds;
  if (!error.probes.empty() && error.probes[worst] > limit)
    result.warnings.push_back(fmt::format("motion.step {:.3g} s: its error in probe {} is {} (limit {}); take {:.2g} s",
                                          motion.how.step, motion.model.probes[worst].name,
                                          math::percent(error.probes[worst]), math::percent(limit),
                                          motion.how.step * std::sqrt(limit / error.probes[worst])));
  return j;
}

/// A part that is found by `work`; `advice`: what to do where it is large.
ordered_json part_of(const char* name, const std::string& advice, const assess::FinishedMotion& motion,
                     const std::function<assess::ErrorPart()>& work, assess::ErrorPart& part, RunResult& result) {
  const std::string why = petsc::failed_together(motion.comm, [&] { part = work(); });
  if (!why.empty()) part = {}, part.none = why;
  ordered_json j;
  if (!part.notes.empty()) j["notes"] = part.notes;
  if (!part.none.empty()) {
    j["none"] = part.none;
    return j;
  }
  const std::size_t worst = put_probes(part.probes, motion.model, j);
  j["by"] = part.by;
  j["until"] = part.until;
  j["seconds"] = part.seconds;
  if (!part.probes.empty() && part.probes[worst] > limit)
    result.warnings.push_back(fmt::format("error of the {} in probe {}: {} (limit {}); {}", name,
                                          motion.model.probes[worst].name, math::percent(part.probes[worst]),
                                          math::percent(limit), advice));
  return j;
}

output::Cell cell_of(const ordered_json& part, const std::string& probe) {
  if (!part.is_object() || !part.contains("probes") || !part["probes"].contains(probe)) return "-";
  const ordered_json& error = part["probes"][probe];
  if (!error.is_number() || !std::isfinite(error.get<double>())) return "> 10000";
  return 100 * error.get<double>();
}

}  // namespace

ordered_json error_budget(const assess::FinishedMotion& motion, const assess::KeptMotion& kept, RunResult& result) {
  double allowed = assess::estimate_seconds(result.offline_seconds + result.motion_seconds);
  MPI_Bcast(&allowed, 1, MPI_DOUBLE, 0, motion.comm);
  const assess::ProbeSeries own = assess::probe_series(motion.model, kept, result.estimate);
  assess::ErrorPart reduction, step, model, mesh;
  reduction.none = result.estimate.none;
  reduction.probes = result.estimate.probes, reduction.t = result.estimate.t, reduction.errors = result.estimate.errors;
  const ordered_json of_mesh = part_of(
      "mesh", "take more elements", motion, [&] { return assess::estimate_mesh_error(motion, own, allowed); }, mesh,
      result);
  ordered_json j;
  j["model"] = part_of(
      "model (strains, floating frames)",
      motion.scene.dimension == 2
          ? "divide the body into floating frames (frames: N), or use formulation cfr"
          : "use strains: second_order, divide the body into floating frames (frames: N), or use formulation cfr",
      motion, [&] { return assess::estimate_model_error(motion, own, result.estimate, mesh, allowed); }, model, result);
  j["mesh"] = of_mesh;
  j["step"] = step_part(motion, kept, allowed, step, result);
  std::vector<const assess::ErrorPart*> known, beside;
  const assess::ErrorPart* all[] = {&reduction, &model, &mesh, &step};
  ordered_json names = ordered_json::array();
  for (int i = 0; i < 4; ++i) {
    if (!all[i]->none.empty()) continue;
    const bool unsigned_one = all[i] == &mesh && model.none.empty() && !model.apart;
    (unsigned_one ? beside : known).push_back(all[i]);
    names.push_back(parts[i]);
  }
  if (known.empty() || motion.model.probes.empty()) return j;
  put_probes(assess::total_error(own, known, beside), motion.model, j["total"]);
  j["total"]["parts"] = names;
  return j;
}

std::string budget_words(const ordered_json& estimate, double end) {
  if (!estimate.is_object()) return "";
  const bool has_total = estimate.contains("total") && estimate["total"].contains("probes");
  output::Table table;
  table.columns = {{"estimated error", ""}};
  for (const char* name : parts) table.columns.push_back({name, "%", 2});
  table.columns.push_back({"total", "%", 2});
  if (has_total)
    for (const auto& [probe, error] : estimate["total"]["probes"].items())
      table.rows.push_back({probe, cell_of(estimate, probe), cell_of(estimate.value("model", ordered_json()), probe),
                            cell_of(estimate.value("mesh", ordered_json()), probe),
                            cell_of(estimate.value("step", ordered_json()), probe), cell_of(estimate["total"], probe)});
  std::string words = has_total ? "\n" + output::to_text(table) : "";
  for (const char* name : {"model", "mesh", "step"}) {
    const ordered_json part = estimate.value(name, ordered_json());
    if (!part.is_object()) continue;
    if (part.contains("none")) {
      words += fmt::format("No estimate of the {} error: {}\n", name, part["none"].get<std::string>());
    } else {
      const double until = part["until"];
      words +=
          fmt::format("{}: {}{} ({:.2g} s)\n", name, part["by"].get<std::string>(),
                      until < 0.98 * end ? fmt::format(", to t = {:.3g} s", until) : "", part["seconds"].get<double>());
    }
    if (part.contains("notes"))
      for (const auto& note : part["notes"])
        words += fmt::format("Note ({} error): {}\n", name, note.get<std::string>());
  }
  return words;
}

}  // namespace floe::app
