#include "restart.h"

#include <fmt/format.h>

#include <fstream>

#include "commands.h"
#include "floe/petsc/error.h"
#include "floe/petsc/rank.h"

namespace floe::app {
namespace {

/// Until when the run was simulated, if it is finished. Collective.
std::optional<double> finished_at(const output::ResultFolder& folder, MPI_Comm comm) {
  std::optional<double> reached;
  petsc::agree(comm, [&] {
    std::ifstream file(folder.summary());
    const nlohmann::ordered_json summary = nlohmann::ordered_json::parse(file, nullptr, false);
    if (!summary.is_object() || summary.value("status", "") != "finished") return;
    const auto integration = summary.value("integration", nlohmann::ordered_json::object());
    if (integration.contains("reached")) reached = integration["reached"].get<double>();
  });
  return reached;
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
  const std::optional<double> reached = finished_at(folder, comm);
  if (reached && until && *until < *reached)
    throw InputError(
        fmt::format("--until {}: the run is finished, at t = {}; expected a later time", *until, *reached));
  if (reached && (!until || *until == *reached)) {
    if (petsc::first_rank(comm))
      fmt::print("{} is finished, at t = {} s: nothing is left to simulate (--until T continues it)\n", path, *reached);
    return;
  }
  output::remove_drafts(comm, folder);
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
