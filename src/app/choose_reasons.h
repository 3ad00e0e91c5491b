#pragma once
#include "choose_trials.h"

namespace floe::app {

/// Its error, or why there is none.
std::string words(const Trial& trial);

/// A model that was selected: the first `count` vectors of `order`, in one step size.
struct Choice {
  const assess::Selection& selection;
  const std::vector<assess::EnergyContribution>& order;
  std::size_t count;
  double step;
  bool longer_step;           ///< whether steps twice as long may be taken
  const std::string& linear;  ///< what came of a linear elastic force
};

/// Why it was selected: bodies, basis vectors, elastic force and step, each with the error of the next cheaper model.
/// Collective; simulates what is not known.
std::vector<Decision> reasons(const Choice& choice, assess::CandidateBasis& candidates, Trials& trials);

}  // namespace floe::app
