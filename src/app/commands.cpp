#include "commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "choose.h"
#include "error_budget.h"
#include "estimate_words.h"
#include "floe/assembly/reduced_bodies_file.h"
#include "floe/assess/validity.h"
#include "floe/math/rounded.h"
#include "floe/output/table.h"
#include "floe/petsc/rank.h"
#include "notices.h"
#include "run.h"

namespace floe::app {

using nlohmann::ordered_json;

namespace {

/// Of modes that bend within single cells; empty if there are none.
std::string unresolved_words(const assembly::BodyReport& body) {
  std::vector<std::size_t> which;
  double most = 0;
  for (std::size_t i = 0; i < body.intra_deflection.size(); ++i)
    if (body.intra_deflection[i] > assembly::max_intra_deflection_of_modes)
      which.push_back(i + 1), most = std::max(most, body.intra_deflection[i]);
  if (which.empty()) return "";
  const std::string modes = fmt::format("mode{} {}", which.size() > 1 ? "s" : "", fmt::join(which, ", "));
  return fmt::format("Note: {}\n",
                     assembly::intra_deflection_text(body.name, modes, most, assembly::max_intra_deflection_of_modes));
}

/// Numbers from 1, ascending, as `3, 7 to 9`.
std::string ranges_of(const std::vector<std::size_t>& numbers) {
  std::vector<std::string> words;
  for (std::size_t i = 0, end = 0; i < numbers.size(); i = end) {
    for (end = i + 1; end < numbers.size() && numbers[end] == numbers[end - 1] + 1;) ++end;
    if (end - i > 2)
      words.push_back(fmt::format("{} to {}", numbers[i], numbers[end - 1]));
    else
      for (std::size_t k = i; k < end; ++k) words.push_back(std::to_string(numbers[k]));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

/// Of modes whose equations are not met; empty if there are none.
std::string unsolved_words(const assembly::BodyReport& body) {
  constexpr double greatest = 1e-4;
  std::vector<std::size_t> which;
  double most = 0;
  for (std::size_t i = 0; i < body.residual.size(); ++i)
    if (!(body.residual[i] <= greatest)) which.push_back(i + 1), most = std::max(most, body.residual[i]);
  if (which.empty()) return "";
  return fmt::format(
      "Note: body {}: mode{} {} {} residuals up to {:.2g} (limit {:.0e}): the eigensolver reached no smaller ones; ask "
      "for fewer modes\n",
      body.name, which.size() > 1 ? "s" : "", ranges_of(which), which.size() > 1 ? "have" : "has", most, greatest);
}

}  // namespace

void modes(const scene::Scene& scene, MPI_Comm comm, const std::optional<std::string>& path,
           const std::optional<std::string>& matrices, bool overwrite) {
  if (matrices) assembly::write_matrices(scene, comm, *matrices, overwrite);
  const std::vector<assembly::BodyReport> bodies =
      path ? assembly::write_modes(scene, comm, *path, overwrite) : assembly::body_modes(scene, comm);
  if (!petsc::first_rank(comm)) return;
  output::Table table;
  table.columns = {{"body", ""}, {"mode", ""}, {"frequency", "Hz", 6}, {"frequency", "rad/s", 6}, {"residual", "", 2}};
  for (const auto& body : bodies) {
    for (int i = 0; i < body.free_motions; ++i) table.rows.push_back({body.name, "rigid", 0.0, 0.0, "-"});
    for (std::size_t i = 0; i < body.omega.size(); ++i)
      table.rows.push_back(
          {body.name, static_cast<std::int64_t>(i + 1), body.omega[i] / (2 * M_PI), body.omega[i], body.residual[i]});
    for (std::size_t i = 0; i < body.damped.size(); ++i)
      table.rows.push_back(
          {body.name, fmt::format("damped {}", i + 1), body.damped[i] / (2 * M_PI), body.damped[i], "-"});
  }
  fmt::print("{}", output::to_text(table));
  for (const auto& body : bodies) {
    fmt::print("{}{}", unsolved_words(body), unresolved_words(body));
    if (body.left_out > 0) fmt::print("Note: {}\n", assembly::left_out_text(body.name, body));
    if (!body.damped.empty())
      fmt::print(
          "Note: body {}: damping.modal refers to the rows `damped`: modes with the joints towards the ground fixed\n",
          body.name);
  }
  for (const std::string& notice : notices_of(bodies)) fmt::print("Note: {}\n", notice);
  if (matrices) fmt::print("Matrices: {}\n", *matrices);
  if (!path) return;
  for (const auto& body : bodies)
    if (!body.file.empty())
      fmt::print("Note: body {} comes from {}, which contains its shapes\n", body.name, body.file);
  fmt::print("Shapes: {}\n", *path);
}

void reduce(const scene::Scene& scene, const std::string& body, MPI_Comm comm, const std::string& path,
            bool overwrite) {
  std::vector<std::string> warnings;
  const output::ReducedBodyFile file = assembly::reduce_body(scene, body, comm, path, overwrite, warnings);
  if (!petsc::first_rank(comm)) return;
  fmt::print("{}", output::describe(file));
  for (const std::string& warning : warnings) fmt::print("Note: {}\n", warning);
  fmt::print("Reduced body: {}\n", path);
}

void info(const std::string& path, MPI_Comm comm) {
  const output::ReducedBodyFile file = output::read_reduced_body(comm, path);
  if (petsc::first_rank(comm)) fmt::print("{}", output::describe(file));
}

namespace {

/// What a run has to say, on the terminal.
void show(const scene::Scene& scene, scene::Formulation formulation, const RunResult& result,
          const output::ResultFolder& folder, const RunPlan& plan) {
  const auto& s = result.summary;
  fmt::print("{} as {} ({}): {} coordinates, {} steps to t = {} s\n", scene.title.empty() ? scene.file : scene.title,
             scene::name_of(formulation), result.label, result.coordinates, result.steps, result.end);
  fmt::print("offline {:.3g} s, simulation {:.3g} s ({:.3g} us per step)\n", result.offline_seconds,
             result.motion_seconds,
             1e6 * result.motion_seconds / std::max<double>(1, static_cast<double>(result.steps)));
  for (const auto& body : s["bodies"])
    if (body.contains("products") && body["products"]["kept"] != body["products"]["of"])
      fmt::print("body {}: {} of {} products of coordinates in the elastic force\n", body["name"].get<std::string>(),
                 body["products"]["kept"].get<int>(), body["products"]["of"].get<int>());
  fmt::print("constraint violation at most {:.2g} (rates {:.2g}); energy at the end {:.6g} J\n\n",
             s["constraints"]["greatest_violation"].get<double>(),
             s["constraints"]["greatest_velocity_violation"].get<double>(), s["energy"]["end"].get<double>());
  constexpr std::size_t shown = 20;  // a body that rests on a stop bounces many times
  std::size_t number = 0;
  for (const auto& event : s["events"]) {
    if (number++ == shown) {
      fmt::print("... and {} more events, in summary.json\n", s["events"].size() - shown);
      break;
    }
    fmt::print("event {} at t = {:.9g} s: {}{}\n", event["name"].get<std::string>(), event["t"].get<double>(),
               event["what"].get<std::string>(),
               event.contains("impulses") ? fmt::format(", impulses {}, {:.4g} J lost", event["impulses"].dump(),
                                                        event["kinetic_energy_lost"].get<double>())
               : event.contains("kinetic_energy_gained")
                   ? fmt::format(", {:.4g} J gained", event["kinetic_energy_gained"].get<double>())
               : event.contains("speed") ? fmt::format(", speed {:.4g}", event["speed"].get<double>())
                                         : "");
  }
  if (!s["events"].empty()) fmt::print("\n");
  output::Table table;
  table.columns = {{"probe", ""}, {"at the end", "", 6}, {"min", "", 6}, {"max", "", 6}, {"unit", ""}};
  for (std::size_t c = 0; c < result.series.columns.size(); ++c) {
    double least = result.series.values[0][c], greatest = least;
    for (const auto& row : result.series.values) least = std::min(least, row[c]), greatest = std::max(greatest, row[c]);
    table.rows.push_back({result.series.columns[c].name, result.series.values.back()[c], least, greatest,
                          result.series.columns[c].unit});
  }
  if (!table.rows.empty()) fmt::print("{}", output::to_text(table));
  if (plan.estimate && s.contains("estimate"))
    fmt::print("{}{}", budget_words(s["estimate"], result.end),
               estimate_words(result.estimate, s["estimate"].contains("total")));
  for (const std::string& warning : result.warnings) fmt::print("Note: {}\n", warning);
  fmt::print("Results: {}\n", folder.path.string());
}

/// Runs, and leaves no empty folder behind where that fails.
RunResult run_into(const output::ResultFolder& folder, const std::function<RunResult()>& work) {
  try {
    return work();
  } catch (const std::exception&) {
    output::discard_if_empty(folder);
    throw;
  }
}

}  // namespace

void run_one(const scene::Scene& scene, scene::Formulation formulation, MPI_Comm comm,
             const output::ResultFolder& folder, const RunPlan& plan) {
  const RunResult result = run_into(folder, [&] { return run(scene, formulation, comm, folder, plan); });
  if (petsc::first_rank(comm)) show(scene, formulation, result, folder, plan);
}

/// Of --write-scene, before anything is computed.
void check_target(const std::filesystem::path& target, const std::filesystem::path& scene, bool overwrite) {
  const std::string name = "--write-scene " + target.string();
  const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : ".";
  if (std::filesystem::is_directory(target)) throw InputError(name + ": is a folder; expected the name of a file");
  if (!std::filesystem::is_directory(folder) || access(folder.c_str(), W_OK) != 0)
    throw InputError(name + ": cannot be written there; expected a writable folder");
  if (!std::filesystem::exists(target)) return;
  if (std::filesystem::equivalent(target, scene))
    throw InputError(name + ": is the scene itself; expected another name");
  if (!overwrite) throw InputError(name + ": exists; expected another name, or --force");
}

namespace {

std::vector<std::string> made_rigid(const scene::Scene& selected, const scene::Scene& scene) {
  std::vector<std::string> names;
  for (const scene::Body& body : selected.bodies)
    for (const scene::Body& other : scene.bodies)
      if (other.name == body.name && body.rigid && !other.rigid) names.push_back(body.name);
  return names;
}

}  // namespace

void run_chosen(const scene::Scene& scene, const scene::Accuracy& accuracy, MPI_Comm comm,
                const output::ResultFolder& folder, const std::optional<std::string>& explicit_scene, bool overwrite) {
  std::vector<std::string> written;
  RunPlan plan;
  const RunResult result = run_into(folder, [&] {
    petsc::agree(comm, [&] {
      if (explicit_scene) check_target(*explicit_scene, scene.file, overwrite);
    });
    Chosen chosen = choose(scene, accuracy, comm);
    if (!chosen.total && petsc::first_rank(comm)) fmt::print("{}\n", output::to_text(decisions_table(chosen)));
    plan.choice = to_json(chosen);
    plan.measured = true;
    plan.estimate = chosen.total;
    if (chosen.total) plan.required = chosen.asked;
    plan.made_rigid = made_rigid(chosen.scene, scene);
    plan.budget = !chosen.candidates || !chosen.candidates->has_responses(chosen.selection);  // not on other meshes
    plan.offline_processor = chosen.building;
    RunResult moved = move(chosen.scene, chosen.model, chosen.seconds, comm, folder, plan);
    if (chosen.total) {
      chosen.decisions.insert(chosen.decisions.begin(), {"error before", "", budget_line(chosen.before)});
      chosen.decisions.push_back({"error after", "",
                                  plan.budget
                                      ? budget_line(moved.summary["estimate"])
                                      : "not estimated in parts: the correction vectors are of this mesh alone"});
      if (petsc::first_rank(comm)) fmt::print("{}\n", output::to_text(decisions_table(chosen)));
    }
    for (const auto& [part, why] : chosen.unbounded)
      moved.warnings.push_back(fmt::format("accuracy: the {} error is not bounded: {}", part, why));
    if (explicit_scene) {
      try {
        written = write_scene(chosen, *explicit_scene, overwrite, comm);
      } catch (const std::runtime_error& error) {  // the run stands
        moved.warnings.push_back(fmt::format("--write-scene: {}", error.what()));
      }
    }
    if (!chosen.within()) moved.warnings.push_back(missed_words(chosen.asked, chosen.supported));
    return moved;
  });
  if (!petsc::first_rank(comm)) return;
  show(scene, scene::Formulation::vm_md, result, folder, plan);
  if (!written.empty()) fmt::print("Scene: {}\n", fmt::join(written, ", "));
}

}  // namespace floe::app
