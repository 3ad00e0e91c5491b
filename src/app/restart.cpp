#include "restart.h"

#include <fmt/format.h>

#include "commands.h"
#include "floe/petsc/error.h"

namespace floe::app {

void restart_one(const std::string& path, const std::string& scene_file, const std::optional<std::string>& formulation,
                 const std::optional<double>& until, RunPlan plan, MPI_Comm comm) {
  const output::ResultFolder folder = output::reopen_folder(comm, path);
  plan.from = output::read_checkpoint(comm, folder.checkpoint());
  const nlohmann::ordered_json& run = plan.from->words.at("run");
  const scene::Formulation of_run =
      scene::formulation_of(formulation.value_or(run.at("formulation").get<std::string>()));
  scene::Scene scene;
  petsc::agree(
      comm, [&] { scene = scene::read_scene(scene_file.empty() ? run.at("scene").get<std::string>() : scene_file); });
  petsc::agree(comm, [&] { check_identity(run, identity_of(scene, of_run, comm), path); });
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
