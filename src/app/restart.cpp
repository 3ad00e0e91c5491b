#include "restart.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "commands.h"
#include "floe/petsc/error.h"
#include "floe/petsc/rank.h"

namespace floe::app {
namespace {

std::optional<double> ended_at(const nlohmann::ordered_json& summary, double end) {
  using nlohmann::ordered_json;
  if (summary.at("status") != "finished") return {};
  const ordered_json integration = summary.value("integration", ordered_json::object()),
                     events = summary.value("events", ordered_json::array());
  if (!integration.contains("reached")) return {};
  const double reached = integration["reached"];
  const bool stopped =
      std::any_of(events.begin(), events.end(), [](const auto& event) { return event.value("what", "") == "stop"; });
  return stopped || reached >= end ? std::optional(reached) : std::nullopt;
}

/// Where a finished run ended, at the end of the motion or by an event that stops it; none: something is left of it.
/// Collective.
std::optional<double> ended_at(const output::ResultFolder& folder, double end, MPI_Comm comm) {
  std::optional<double> ended;
  petsc::agree(comm, [&] {
    std::ifstream file(folder.summary());
    if (!file) return;
    try {
      ended = ended_at(nlohmann::ordered_json::parse(file), end);
    } catch (const nlohmann::json::exception&) {
      throw InputError(folder.summary().string() + ": is damaged; expected the summary that the run wrote, or no file");
    }
  });
  return ended;
}

}  // namespace

void restart_one(const std::string& path, const std::string& scene_file, const std::optional<std::string>& formulation,
                 const std::optional<double>& until, RunPlan plan, MPI_Comm comm) {
  const output::ResultFolder folder = output::reopen_folder(comm, path);
  plan.from = output::read_checkpoint(comm, folder.checkpoint());
  const nlohmann::ordered_json& run = plan.from->words.at("run");
  const scene::Formulation of_run =
      scene::formulation_of(formulation.value_or(run.at("formulation").get<std::string>()));
  plan.estimate = plan.estimate && scene::is_reduced(of_run);
  scene::Scene scene;
  petsc::agree(
      comm, [&] { scene = scene::read_scene(scene_file.empty() ? run.at("scene").get<std::string>() : scene_file); });
  petsc::agree(comm, [&] { check_identity(run, identity_of(scene, of_run, comm), path); });
  output::remove_drafts(comm, folder);  // also of a finished run: it may have been killed at its last file
  if (const std::optional<double> ended = ended_at(folder, until.value_or(scene.motion.end), comm)) {
    if (until && *until < *ended)
      throw InputError(
          fmt::format("--until {}: the run is finished, at t = {}; expected a later time", *until, *ended));
    if (petsc::first_rank(comm)) fmt::print("{} is finished, at t = {} s: nothing is left to simulate\n", path, *ended);
    return;
  }
  plan.until = until;
  if (const double t = plan.from->words.at("t"); until && *until < t)
    throw InputError(fmt::format("--until {}: the checkpoint is at t = {}; expected a later time", *until, t));
  if (!plan.checkpoints.any()) {
    plan.checkpoints.steps = run.at("checkpoint").at("steps");
    plan.checkpoints.seconds = run.at("checkpoint").at("seconds");
  }
  run_one(scene, of_run, comm, folder, plan);
}

}  // namespace floe::app
