#include "run.h"

#include <fmt/format.h>

#include <cmath>

#include "floe/dynamics/start.h"
#include "floe/output/progress.h"
#include "recorder.h"

namespace floe::app {

using nlohmann::ordered_json;

std::string label_of(const scene::Model& model) {
  switch (model.formulation) {
    case scene::Formulation::cfr:
      return "CFR";
    case scene::Formulation::nlffr:
      return "NLFFR";
    case scene::Formulation::lffr:
      return "LFFR";
    default:
      break;
  }
  int count[3] = {0, 0, 0};
  for (const auto& body : model.bodies)
    for (const auto& origin : body.origins)
      if (origin.kept) ++count[static_cast<int>(origin.kind)];
  std::string label = fmt::format("{} VMs", count[0]);
  if (count[2]) label += fmt::format(" + {} AMs", count[2]);
  if (count[1]) label += fmt::format(" + {} MDs", count[1]);
  return label;
}

RunResult run(const scene::Scene& scene, scene::Formulation formulation, MPI_Comm comm,
              const std::optional<output::ResultFolder>& folder) {
  RunResult result;
  const double begin = MPI_Wtime();
  scene::Model model = scene::build(scene, formulation, comm);
  result.offline_seconds = MPI_Wtime() - begin;
  result.label = label_of(model);
  result.coordinates = model.coordinates;
  result.warnings = model.warnings;
  result.series.columns = scene::probe_columns(model);

  Recorder recorder(scene, model, comm, folder, result);
  dynamics::Integration how{scene.motion.end, scene.motion.step, scene.motion.spectral_radius, scene.motion.tolerance};
  dynamics::IntegrationReport report;
  std::string stopped;
  {
    output::Progress progress(comm, 0, scene.motion.end);
    const auto observe = [&](const dynamics::Instant& instant) {
      recorder.observe(instant);
      progress.update(instant.t, instant.step);
    };
    const auto move = [&] {
      try {
        report = dynamics::simulate(*model.system, how, model.U, model.V, observe);
      } catch (const dynamics::MotionStopped& error) {
        report = error.report();
        stopped = error.what();
      }
    };
    if (scene::is_reduced(formulation))
      petsc::agree(comm, move);  // every rank moves its own copy, rank 0 writes: a fault there is everybody's
    else
      move();
  }
  result.steps = report.steps;
  result.motion_seconds = report.seconds - recorder.seconds();
  recorder.finish(report, stopped);
  if (!stopped.empty()) throw RunError(stopped);
  return result;
}

}  // namespace floe::app
