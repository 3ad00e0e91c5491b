#include "error_budget.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "floe/math/rounded.h"
#include "floe/output/table.h"
#include "floe/petsc/together.h"

namespace floe::app {

using nlohmann::ordered_json;

namespace {

constexpr double greatest = 0.01;  // above it the largest part is warned of
constexpr const char* parts[] = {"reduction", "model", "mesh", "step"};

/// `probes` of those that are known.
void put_probes(const std::vector<double>& errors, const assembly::Model& model, ordered_json& j) {
  for (std::size_t p = 0; p < errors.size(); ++p)
    if (!std::isnan(errors[p])) j["probes"][model.probes[p].name] = errors[p];
}

ordered_json step_part(const assess::FinishedMotion& motion, const assess::KeptMotion& kept,
                       const assess::ProbeSeries& own, double allowed, assess::ErrorPart& part) {
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
  part.until = error.until;
  assess::leave_out_quiet(own, part);
  ordered_json j{{"deformation", error.deformation}};
  if (!part.notes.empty()) j["notes"] = part.notes;
  put_probes(part.probes, motion.model, j);
  j["by"] = error.halved ? "half the step" : "twice the step";
  j["until"] = error.until;
  j["seconds"] = error.seconds;
  return j;
}

/// A part for the summary.
ordered_json part_of(const assess::FinishedMotion& motion, const assess::ErrorPart& part) {
  ordered_json j;
  if (!part.notes.empty()) j["notes"] = part.notes;
  if (!part.none.empty()) {
    j["none"] = part.none;
    return j;
  }
  put_probes(part.probes, motion.model, j);
  j["by"] = part.by;
  j["until"] = part.until;
  j["seconds"] = part.seconds;
  return j;
}

bool any_body(const scene::Scene& scene, bool (*is)(const scene::Body&)) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), is);
}
bool straight(const scene::Body& body) { return is_meshed(body) && body.mesh.segments.size() == 1; }

/// What makes the part `model` smaller: what the bodies do not have yet.
std::string model_advice(const assess::FinishedMotion& motion, const assess::ErrorPart& part) {
  std::vector<std::string> all;
  if (part.with_reduction) all.push_back("take more modes or derivatives (the part contains the reduction error)");
  if (!part.apart) all.push_back("take more elements (the part contains the difference of both models' mesh errors)");
  const auto& bodies = motion.model.bodies;
  if (std::any_of(bodies.begin(), bodies.end(),
                  [](const auto& body) { return body.strains.starts_with("von_karman"); }))
    all.push_back("use strains: second_order");
  if (any_body(motion.scene, motion.scene.dimension == 3 ? scene::is_meshed : straight)) {
    const bool divided = any_body(motion.scene, [](const scene::Body& body) { return body.frames > 1; });
    all.push_back(divided ? "divide the body into more floating frames (frames: N)"
                          : "divide the body into floating frames (frames: N)");
  }
  all.push_back("use formulation cfr");
  return fmt::format("{}", fmt::join(all, ", or "));
}

/// What makes a part smaller whose worst probe has this error.
std::string advice(int part, const assess::FinishedMotion& motion, const assess::ErrorPart& model, double error) {
  switch (part) {
    case 0:
      return motion.at_rest || !motion.scene.events.empty()
                 ? "take more modes or derivatives (reduction)"
                 : "take more modes or derivatives (reduction), or select them: --accuracy reduction:1%";
    case 1:
      return model_advice(motion, model);
    case 2:
      return "take more elements";
    default:
      return std::isfinite(error)
                 ? fmt::format("take motion.step {:.2g} s or less", motion.how.step * std::sqrt(greatest / error))
                 : "take a shorter motion.step";
  }
}

/// The largest part of all probes, what to do about it, and a warning where it is above the limit.
void put_largest(const assess::FinishedMotion& motion, const assess::ErrorPart* const all[], ordered_json& j,
                 RunResult& result) {
  int largest = -1;
  std::size_t worst = 0;
  double error = 0;
  for (int i = 0; i < 4; ++i)
    for (std::size_t p = 0; all[i]->none.empty() && p < all[i]->probes.size(); ++p)
      if (all[i]->probes[p] > error) largest = i, worst = p, error = all[i]->probes[p];
  if (!(error > greatest)) return;
  const std::string what = advice(largest, motion, *all[1], error), &probe = motion.model.probes[worst].name;
  j["largest"] = {{"part", parts[largest]}, {"probe", probe}, {"advice", what}};
  result.warnings.push_back(fmt::format("largest part of the estimated error: {} of probe {}, {} (limit {}); {}",
                                        parts[largest], probe, math::percent(error), math::percent(greatest), what));
}

/// Rigid bodies have no error but that of the step, unless a selection made them rigid.
bool all_rigid(const scene::Scene& scene) {
  return std::all_of(scene.bodies.begin(), scene.bodies.end(), [](const scene::Body& body) { return body.rigid; });
}

/// Of a total: with a mark where it lacks a part.
output::Cell marked(const output::Cell& cell) {
  return std::holds_alternative<double>(cell) ? math::rounded(std::get<double>(cell), 2) + " *"
                                              : std::get<std::string>(cell) + " *";
}

/// Whether a probe's total lacks a part, or the errors of bodies that became rigid.
bool lacks_some(const ordered_json& total, const std::string& probe) {
  return total.contains("made_rigid") || (total.contains("missing") && total["missing"].contains(probe));
}

/// `* without the model error: inner` of each part.
std::string missing_words(const ordered_json& total) {
  std::string words;
  if (total.contains("made_rigid"))
    words = fmt::format("* total without the deformation of bodies that the selection made rigid: {}\n",
                        fmt::join(total["made_rigid"].get<std::vector<std::string>>(), ", "));
  if (!total.contains("missing")) return words;
  for (const char* part : parts) {
    std::vector<std::string> probes;
    for (const auto& [probe, lacks] : total["missing"].items())
      if (std::find(lacks.begin(), lacks.end(), part) != lacks.end()) probes.push_back(probe);
    if (probes.size() == total["probes"].size())
      words += fmt::format("* total without the {} error\n", part);
    else if (!probes.empty())
      words += fmt::format("* total without the {} error: {}\n", part, fmt::join(probes, ", "));
  }
  return words;
}

/// In a summary's estimate; that of the reduction is the estimate itself.
ordered_json part_in(const ordered_json& estimate, const std::string& name) {
  return name == "reduction" ? estimate : estimate.value(name, ordered_json());
}
/// Not of equilibria: a step.
bool has_part(const ordered_json& estimate, const std::string& name) {
  return name == "reduction" || estimate.contains(name);
}

output::Cell cell_of(const ordered_json& part, const std::string& probe) {
  if (!part.is_object() || !part.contains("probes") || !part["probes"].contains(probe)) return "-";
  const ordered_json& error = part["probes"][probe];
  if (!error.is_number() || !std::isfinite(error.get<double>())) return "> 10000";
  return 100 * error.get<double>();
}

}  // namespace

ordered_json error_budget(const assess::FinishedMotion& motion, const assess::KeptMotion& kept,
                          const std::string& no_model, RunResult& result, std::optional<double> required,
                          const std::vector<std::string>& made_rigid) {
  double allowed = assess::estimate_seconds(motion.offline + motion.seconds);
  MPI_Bcast(&allowed, 1, MPI_DOUBLE, 0, motion.comm);
  result.estimate = assess::of_whole(std::move(result.estimate), kept);
  const assess::ProbeSeries own = assess::probe_series(motion.model, kept, result.estimate);
  if (!own.changes.empty() || own.impulsive) result.estimate = assess::estimate_by_full_order(motion, own, allowed);
  assess::ErrorPart reduction, step, model, mesh;
  reduction.none = result.estimate.none;
  reduction.probes = result.estimate.probes, reduction.t = result.estimate.t, reduction.errors = result.estimate.errors;
  ordered_json of_step;
  if (!motion.at_rest) of_step = step_part(motion, kept, own, allowed, step);
  mesh = assess::estimate_mesh_error(motion, own, allowed);
  if (no_model.empty())
    model = assess::estimate_model_error(motion, own, result.estimate, mesh, allowed);
  else
    model.none = no_model;
  ordered_json j;
  j["model"] = part_of(motion, model);
  j["mesh"] = part_of(motion, mesh);
  if (!motion.at_rest) j["step"] = std::move(of_step);
  const int count = motion.at_rest ? 3 : 4;
  std::vector<const assess::ErrorPart*> known, beside;
  const assess::ErrorPart* all[] = {&reduction, &model, &mesh, &step};
  ordered_json names = ordered_json::array();
  for (int i = 0; i < count; ++i) {
    if (!all[i]->none.empty()) continue;
    const bool unsigned_one = all[i] == &mesh && model.none.empty() && !model.apart;
    (unsigned_one ? beside : known).push_back(all[i]);
    names.push_back(parts[i]);
  }
  if (known.empty() || motion.model.probes.empty()) return j;
  const std::vector<double> total = assess::total_error(own, known, beside);
  const bool within = required && std::none_of(total.begin(), total.end(), [&](double e) { return e > *required; });
  if (!within) put_largest(motion, all, j, result);
  put_probes(total, motion.model, j["total"]);
  j["total"]["parts"] = names;
  if (!made_rigid.empty()) j["total"]["made_rigid"] = made_rigid;
  for (std::size_t p = 0; p < motion.model.probes.size(); ++p) {
    ordered_json lacks = ordered_json::array();
    const bool in_model = model.with_reduction && model.none.empty() && !std::isnan(model.probes[p]);
    for (int i = all_rigid(motion.scene) && made_rigid.empty() ? 3 : 0; i < count; ++i)
      if ((i > 0 || !in_model) && (!all[i]->none.empty() || std::isnan(all[i]->probes[p]))) lacks.push_back(parts[i]);
    if (!lacks.empty()) j["total"]["missing"][motion.model.probes[p].name] = lacks;
  }
  return j;
}

namespace {

/// Why there is no total.
std::string why_none(const ordered_json& estimate) {
  std::string all = estimate.value("none", std::string());
  for (const char* name : {"model", "mesh", "step"})
    if (const ordered_json part = part_in(estimate, name); part.is_object() && part.contains("none"))
      all += fmt::format("{}{}: {}", all.empty() ? "" : "; ", name, part["none"].get<std::string>());
  return all.empty() ? "no probe has a total" : all;
}

}  // namespace

std::string budget_line(const ordered_json& estimate) {
  if (!estimate.is_object()) return "not estimated";
  if (!estimate.contains("total") || !estimate["total"].contains("probes"))
    return "not estimated: " + why_none(estimate);
  const ordered_json& total = estimate["total"];
  const auto size = [](const ordered_json& error) { return error.is_number() ? error.get<double>() : INFINITY; };
  const auto words = [&](const ordered_json& error) {
    return std::isfinite(size(error)) ? math::percent(size(error)) : "above 10000 %";
  };
  std::string worst;
  for (const auto& [probe, error] : total["probes"].items())
    if (worst.empty() || size(error) > size(total["probes"][worst])) worst = probe;
  std::vector<std::string> all;
  for (const char* name : parts) {
    const ordered_json part = part_in(estimate, name);
    const bool known = part.is_object() && part.contains("probes") && part["probes"].contains(worst);
    all.push_back(fmt::format("{} {}", name, known ? words(part["probes"][worst]) : "not known"));
  }
  return fmt::format("{} {}: {}", lacks_some(total, worst) ? "total of the known parts" : "total",
                     words(total["probes"][worst]), fmt::join(all, ", "));
}

std::string budget_words(const ordered_json& estimate, double end) {
  if (!estimate.is_object()) return "";
  const bool has_total = estimate.contains("total") && estimate["total"].contains("probes");
  output::Table table;
  table.columns = {{"estimated error", ""}};
  for (const char* name : parts)
    if (has_part(estimate, name)) table.columns.push_back({name, "%", 2});
  table.columns.push_back({"total", "%", 2});
  if (has_total)
    for (const auto& [probe, error] : estimate["total"]["probes"].items()) {
      const output::Cell total = cell_of(estimate["total"], probe);
      std::vector<output::Cell>& row = table.rows.emplace_back(1, probe);
      for (const char* name : parts)
        if (has_part(estimate, name)) row.push_back(cell_of(part_in(estimate, name), probe));
      row.push_back(lacks_some(estimate["total"], probe) ? marked(total) : total);
    }
  std::string words = has_total ? "\n" + output::to_text(table) + missing_words(estimate["total"]) : "";
  for (const char* name : {"model", "mesh", "step"}) {
    const ordered_json part = estimate.value(name, ordered_json());
    if (!part.is_object()) continue;
    if (part.contains("none")) {
      words += fmt::format("No estimate of the {} error: {}\n", name, part["none"].get<std::string>());
    } else {
      const double until = part["until"];
      words +=
          fmt::format("{}: {}{} (computed in {:.2g} s)\n", name, part["by"].get<std::string>(),
                      until < 0.98 * end ? fmt::format(", to t = {:.3g} s", until) : "", part["seconds"].get<double>());
    }
    if (part.contains("notes"))
      for (const auto& note : part["notes"])
        words += fmt::format("Note ({} error): {}\n", name, note.get<std::string>());
  }
  return words;
}

}  // namespace floe::app
