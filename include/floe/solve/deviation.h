#pragma once
#include <functional>
#include <string>
#include <vector>

#include "floe/dynamics/system.h"

namespace floe::solve {
using namespace dynamics;

/// What a motion is at an instant, in the local coordinates of a system (Coordinates); multipliers have no rates.
struct State {
  double t = 0;
  Eigen::VectorXd q, v, a;
  std::vector<Eigen::Quaterniond> bases;  ///< of System::attitudes, in their order, whose unknowns in q are zero
  std::vector<double> carried = {};  ///< by the terms of its system (System::save): turns of joints; empty: unknown
};

/// The state of an instant of `system`. Collective.
State state_of(const System& system, double t, Vec U, Vec V, Vec A);

/// Puts a state into vectors of the system, its bases into the attitudes, and what it carries into the terms. Entries
/// that other ranks own are left to them. Rank-local.
void set_state(const System& system, const State& state, Vec U, Vec V, Vec A);

/// What a search for the deviation took.
struct DeviationReport {
  int steps = 0, factorisations = 0, iterations = 0;
  double end = 0;  ///< reached [s]; short of the last state where Newton's method did not converge
};

struct DeviationStart {
  Eigen::VectorXd d, rate;
};

/// The deviation of one state from another of the same system, inverse of deviated() for these two.
DeviationStart deviation_between(const System& system, const State& from, const State& to);

/// How far the motion of a system is from one that satisfies only some of its equations: d(t) with
///
///   F(t, q + d, v + d', a + d'') = 0,   d and d' given at `begin`,   (q, v, a)(t) given
///
/// q + d is the system's own motion; only d is differenced in time, so that steps may be as long as d allows, however
/// fast q moves. The generalized-alpha scheme with the steps of the given states and a spectral radius of 0.5: a
/// vibration of twelve steps a period loses a seventieth of its amplitude in each, what is too fast settles on its
/// static answer within some steps, and multipliers do not oscillate. The first step is implicit Euler's. An attitude
/// deviates by A exp(d), its angular velocity by d' + omega x d and its rate by d'' + alpha x d + omega x d' (first
/// order in d). Newton's method to 1e-3 of what a step adds to h d' (or 1e-9 of q), with one factor for as long as that
/// converges (KSP prefix estimate_).
///
/// @param system   on one rank, whose terms take their steps from state to state (Term::begin_step)
/// @param known    in ascending order of t, all after `begin`; what they carry (State) is of `system`, or empty: then a
///                 joint turns by less than half a turn between two of them
/// @param start    d and d' at `begin`; empty: 0
/// @param observe  called at each of them with the state, d, d' and d''
DeviationReport deviation(const System& system, double begin, const std::vector<State>& known,
                          const std::function<void(const State&, const Eigen::VectorXd& d, const Eigen::VectorXd& rate,
                                                   const Eigen::VectorXd& second_rate)>& observe,
                          const DeviationStart& start = {});

/// The state with a deviation and its rates, as above.
State deviated(const System& system, const State& state, const Eigen::VectorXd& d, const Eigen::VectorXd& rate,
               const Eigen::VectorXd& second_rate);

}  // namespace floe::solve
