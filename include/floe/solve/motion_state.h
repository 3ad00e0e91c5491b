#pragma once
#include <petscts.h>

#include <string>
#include <utility>
#include <vector>

#include "floe/dynamics/system.h"

namespace floe::solve {
using namespace dynamics;

/// All that a motion carries from one step to the next: what continues from it is the same motion, bit for bit, on the
/// same number of ranks (as far as the linear solver repeats itself).
///
/// Beside U, V, A, the auxiliary acceleration and multipliers these are the step's size and the adaptor's memory, bases
/// of attitudes, what terms carry, Newton's experience of its rate, and the point that the factorised Jacobian was
/// formed at: it is formed and factorised again from there, so that keeping a state changes nothing in the motion that
/// goes on.
struct MotionState {
  std::vector<std::pair<std::string, std::vector<double>>> vectors;  ///< this rank's entries
  std::vector<double> numbers;                                       ///< the same on all ranks
  std::vector<double> carried, carried_of_tangent;                   ///< System::save, this rank's
  std::vector<double> events;                                        ///< of each: 1 where it has happened
  double stop = 0;  ///< the instant that the steps were cut to meet: the motion's end, or an event before it [s]
};

/// Of a TS of type generalized-alpha after a step; `carried_of_tangent`, `events` and `stop` are the caller's.
/// Rank-local.
void save_motion(TS ts, const System& system, MotionState& state);
/// Makes a TS that is set up continue from a state. Collective.
/// @throws RunError  the state is that of another system
void load_motion(TS ts, const System& system, const MotionState& state);

}  // namespace floe::solve
