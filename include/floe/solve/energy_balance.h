#pragma once
#include <array>

#include "floe/dynamics/system.h"

namespace floe::solve {
using namespace dynamics;

/// What of the total energy's growth no load and no drive has brought: sampled along a motion.
///
///   growth = max over t of X(t) - min of X before,   X = E - W - D,   W = int P dt,   D = int P_d dt
///
/// by the trapezoidal rule. P [W] is the power of all that has no energy of its own: loads and drives, less what
/// dampers dissipate, P = dE/dt - F.v with dE/dt the derivative of the total energy along (v, a) (a central difference,
/// exact but for its third order) and F the residual of the equations of motion, which does work where they are not
/// met. P_d = max(0, 1/2 v.(F(v) - F(-v))) is what dampers and friction dissipate: forces of inertia are even in v. So
/// P + P_d is the power of loads and drives, and dissipation lets X only fall, however badly samples of P_d integrate
/// (vibrations that steps do not resolve, friction that changes its sign from step to step). What loads along the
/// velocity feed in, beyond what is dissipated, is in P. What dampers have
/// dissipated is at most what the motion has lost: of vibrations that die out within a step P_d at its ends is far
/// more. X counts from the last instant before an event on. The integrator takes energy away and adds none; a motion
/// whose energy grows by itself is none.
class EnergyBalance {
 public:
  /// An instant. A null: not computed yet (at the start). Bases of attitudes and U are afterwards as before.
  /// Collective.
  /// @param energy    total, of U, V
  /// @param max_part  maximum of its parts so far
  void add(const System& system, double t, Vec U, Vec V, Vec A, double energy, double max_part);
  /// An event, where the power jumps: W over the step that contains it is h times the power at the step's end, not the
  /// trapezoidal rule. `gained` [J]: what impulses of drives bring there, which belongs to W; `lost`: in impulses of
  /// joints; `damped`: by strains at the event; `released`: what strains give at once, which is no work.
  void pass_event(double gained, double lost, double damped = 0, double released = 0);
  double work() const { return work_; }          ///< W [J]
  double growth() const { return growth_; }      ///< [J]
  double turnover() const { return turnover_; }  ///< int |P| dt [J]
  /// Whether the growth was more than `most_growth` times what the motion had and exchanged while its balance was met,
  /// at two instants in a row (one may be round-off of a motion that begins from rest), and more than `floor` [J].
  bool runs_away(double floor) const { return beyond_ >= 2 && growth() > floor; }
  static constexpr double most_growth = 3;

  /// All of it, for checkpoints.
  static constexpr int numbers = 15;
  std::array<double, numbers> save() const;
  void load(const std::array<double, numbers>& saved);

 private:
  double count_ = 0, t_ = 0, known_ = 0;  // of the instant before; whether its power is known
  double power_ = 0, dissipation_ = 0;    // P and P_d of the instant before
  double start_ = 0, work_ = 0, dissipated_ = 0, turnover_ = 0, growth_ = 0;
  double lost_in_impulses_ = 0;        // of joints [J]
  double level_ = 0, lowest_ = 0;      // X of the instant before, and its minimum
  double accounted_ = 0, beyond_ = 0;  // energy while growth was less than half of it; instants in a row
};

}  // namespace floe::solve
