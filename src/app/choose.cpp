#include "choose.h"

#include "floe/output/progress.h"

namespace floe::app {

Chosen choose(const scene::Scene& scene, const scene::Accuracy& accuracy, MPI_Comm comm) {
  const double begin = MPI_Wtime();
  if (scene.probes.empty())
    throw InputError(scene.file + ": accuracy: applies to the probes, and there are none; expected `probes: {...}`");
  if (!scene.events.empty())
    throw InputError(scene.file +
                     ": accuracy: no selection is possible: events change the joints, or end the simulation, at a "
                     "time that depends on the model; expected a scene without events");
  const output::Waiting waiting(comm, "selecting the model");
  Chosen chosen =
      accuracy.total ? choose_total(scene, accuracy.share, comm) : choose_within(scene, accuracy.share, comm, {});
  chosen.seconds = MPI_Wtime() - begin;
  return chosen;
}

assembly::Model another_model(const Chosen& chosen, MPI_Comm comm) {
  if (!chosen.candidates || chosen.selection.responses > 0)
    return assembly::build(chosen.scene, scene::Formulation::vm_md, comm);
  return chosen.candidates->model(chosen.selection);
}

std::vector<std::string> write_scene(const Chosen& chosen, const std::string& path, bool overwrite, MPI_Comm comm) {
  if (chosen.candidates) return chosen.candidates->write(chosen.selection, chosen.scene.motion, path, overwrite);
  assess::write_scene(chosen.scene, path, overwrite, comm);
  return {path};
}

}  // namespace floe::app
