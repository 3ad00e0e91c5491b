#pragma once
#include <memory>

#include "floe/output/result_file.h"
#include "floe/output/series_file.h"
#include "run.h"

namespace floe::app {

/// Keeps what a run shows: probes, states, energy and constraint drift, and the summary.
class Recorder {
 public:
  Recorder(const scene::Scene& scene, const scene::Model& model, MPI_Comm comm,
           const std::optional<output::ResultFolder>& folder, RunResult& result);
  /// Called at the start and after each step.
  void observe(const dynamics::Instant& instant);
  /// @param stopped  why the motion ended early, or empty. Collective.
  void finish(const dynamics::IntegrationReport& report, const std::string& stopped);
  /// Wall time that recording took. [s]
  double seconds() const { return seconds_; }

 private:
  void open_files();
  void write_basis();
  void write_estimate();
  void store_state(const dynamics::Instant& instant);
  const scene::Scene& scene_;
  const scene::Model& model_;
  MPI_Comm comm_;
  std::optional<output::ResultFolder> folder_;
  RunResult& result_;
  std::unique_ptr<output::SeriesFile> probes_;
  std::unique_ptr<output::ResultFile> file_;
  double seconds_ = 0, energy_start_ = 0, energy_now_ = 0, energy_greatest_ = 0;
  double change_ = 0;  // greatest, of the total energy: work of loads and drives, dissipation, and drift
  double violation_ = 0, velocity_violation_ = 0;
};

}  // namespace floe::app
