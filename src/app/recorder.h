#pragma once
#include <array>
#include <functional>
#include <memory>
#include <tuple>

#include "floe/output/result_file.h"
#include "floe/output/series_file.h"
#include "floe/petsc/handle.h"
#include "floe/solve/energy_balance.h"
#include "run.h"

namespace floe::app {

/// Keeps what a run shows: probes, states, energy and constraint drift, and the summary.
class Recorder {
 public:
  Recorder(const scene::Scene& scene, const assembly::Model& model, MPI_Comm comm,
           const std::optional<output::ResultFolder>& folder, RunResult& result, const RunPlan& plan = {});
  /// Called at the start and after each step.
  void observe(const solve::Instant& instant);
  /// Writes a checkpoint where the plan wants one, at the end of the motion, and where it is about to be ended.
  /// @param ending  whether that is so; collective over those who move one copy
  void checkpoint_if_due(const solve::Instant& instant, const std::function<bool()>& ending);
  /// An event that happened.
  void note(const dynamics::EventReport& event);
  /// The results are whole on disk then. @param stopped  why the motion ended early, or empty
  /// @param assesses  whether conclude() is to follow; until then the summary says that this is not done
  /// Collective.
  void finish(const solve::IntegrationReport& report, const std::string& stopped, bool assesses);
  /// Adds what was found about the finished run: the estimate of its error, where it leaves the model's range, and
  /// warnings. The results stand, whatever happens here. @param budget  joins the summary's estimate; null: none.
  /// Collective.
  void conclude(const nlohmann::ordered_json& budget = {});
  /// Says in summary.json why there is no more to add, where the other ranks cannot be reached. Rank-local.
  void conclude_alone(const std::string& why) noexcept;
  /// A warning where the total energy has grown by what no load and no drive has brought; empty: it has not.
  std::string growth_warning() const;
  /// A warning where steps do not resolve what an event sets free, of the worst event; empty: there is none.
  std::string event_warning() const;
  MPI_Comm comm() const { return comm_; }
  /// Wall time that recording took. [s]
  double seconds() const { return seconds_; }

 private:
  bool balances_every_step() const;
  std::string clamped_frames() const;
  void open_files();
  void continue_files(const output::Checkpoint& from);
  std::int64_t expected_rows() const;
  std::vector<std::tuple<std::string, PetscInt, output::Label>> all_series() const;
  void write_checkpoint(const solve::Instant& instant);
  bool has_estimate() const;
  void write_estimate();
  void store_state(Vec U, Vec V);
  /// Energy, and the greatest violations of constraints and of their rates.
  struct Measured {
    dynamics::Energy energy;
    std::array<double, 2> violations;
  };
  Measured measured(double t, Vec U, Vec V);
  void store(double t, Vec U, Vec V, Vec A, const Measured& now);
  /// For the summary: of the ends of steps; between them all this has the error of the interpolation.
  void look_after(const solve::Instant& instant, const Measured& now);
  /// @throws RunError  total energy grows by itself (EnergyBalance::runs_away)
  void refuse_runaway() const;
  bool due(const solve::Instant& instant) const;
  /// The error of a step after an event, to this event.
  void note_error(const solve::Instant& instant);
  const scene::Scene& scene_;
  const assembly::Model& model_;
  MPI_Comm comm_;
  std::optional<output::ResultFolder> folder_;
  RunResult& result_;
  CheckpointEvery checkpoint_every_;
  bool energies_, checks_balance_;
  double end_;  // [s]
  bool alone_;  // this rank moves a copy of its own
  nlohmann::ordered_json identity_;
  std::unique_ptr<output::SeriesFile> probes_;
  std::unique_ptr<output::ResultFile> file_;
  std::string written_;  // the summary in result.h5
  double seconds_ = 0, energy_start_ = 0, energy_now_ = 0, max_energy_ = 0;
  double change_ = 0;  // greatest, of the total energy: work of loads and drives, dissipation, and drift
  solve::EnergyBalance balance_;
  double violation_ = 0, velocity_violation_ = 0;
  PetscInt first_step_ = 0, kept_step_ = 0, checkpoints_ = 0;
  double kept_at_ = 0, kept_seconds_ = 0;               // wall clock
  petsc::VecHandle between_U_, between_V_, between_A_;  // of instants within a step
};

}  // namespace floe::app
