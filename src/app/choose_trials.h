#pragma once
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "choose.h"

namespace floe::app {

/// A model that was simulated.
struct Trial {
  static constexpr double none = std::numeric_limits<double>::infinity();
  double error = none;    ///< of the worst probe, against the reference
  double seconds = none;  ///< of the simulation
  std::string failed;     ///< why there is no error
  Series series;          ///< the probes, where all of the trials' fit in memory
};

/// The first line of a message, cut to 90 characters.
std::string shortened(const std::string& text);

/// Simulates models of a candidate basis, each once, and compares them with a reference. Collective, as is all of it.
class Trials {
 public:
  using Selection = assess::Selection;

  /// @param scene, candidates  borrowed
  /// @param accuracy           that is asked for: equations of a step are solved to 1e-5 of it
  Trials(const scene::Scene& scene, assess::CandidateBasis& candidates, double accuracy, MPI_Comm comm)
      : scene_(scene), candidates_(candidates), newton_tolerance_(1e-5 * accuracy), comm_(comm) {}

  /// What models are compared with; those that were simulated are compared again.
  void compare_with(Series reference);
  const Series& reference() const { return reference_; }

  /// The scene in fixed steps of another size, with the same instants of output.
  scene::Scene with_step(double step) const;
  RunResult moved(const Selection& selection, double step, bool estimate, bool keep_states);
  const Trial& tried(const Selection& selection, double step);
  /// Its probes. @throws as the simulation
  Series series_of(const Selection& selection, double step);
  /// The same of a scene's own reduced model; Trial::none where it ends elsewhere than the reference, by two `step`s.
  double error_of(const scene::Scene& scene, double step);
  /// Of the simulation [s], the least of five where one is too short to measure.
  double seconds_of(const Selection& selection, double step);
  Selection first_of(const std::vector<assess::EnergyContribution>& order, std::size_t count) const;
  /// The fewest basis vectors with at most this error; `most` of `order` where none will do. Bisection, about where
  /// the energy that is left out is as small as the error; trials that are known count.
  std::size_t fewest(const std::vector<assess::EnergyContribution>& order, std::size_t most, double step, double error,
                     bool linear = false);
  /// The candidates are others.
  void forget() { known_.clear(), numbers_ = 0; }
  int count() const { return count_; }

 private:
  const scene::Scene& scene_;
  assess::CandidateBasis& candidates_;
  double newton_tolerance_;
  MPI_Comm comm_;
  void compare(Trial& trial, double step) const;

  Series reference_;
  std::map<std::tuple<std::vector<char>, bool, double>, Trial> known_;
  std::size_t numbers_ = 0;  ///< of the series of all trials
  int count_ = 0;
};

}  // namespace floe::app
