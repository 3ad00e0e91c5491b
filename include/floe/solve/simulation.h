#pragma once
#include <functional>
#include <optional>
#include <string>

#include "floe/dynamics/event.h"
#include "floe/solve/motion_state.h"

namespace floe::solve {
using namespace dynamics;

/// What the motion is integrated with; every -motion_ts_... and -motion_snes_... option on the command line wins.
struct Integration {
  double end = 0;                   ///< [s]
  double step = 0;                  ///< [s], the first one when adaptive
  double radius = 0.8;              ///< spectral radius at infinite frequency
  std::optional<double> tolerance;  ///< relative local error: adaptive steps
  std::string prefix = "motion_";
  double newton_tolerance = 0;     ///< of Newton's updates, relative to a step's increment, where the usual one is less
  std::vector<Event> events = {};  ///< those that do not repeat happen once, in the order of their times
  std::function<void(const EventReport&)> on_event = {};  ///< called for each that happens
  std::vector<Kink> kinks = {};                           ///< ascending, none within another
  bool state_loads = false;                               ///< loads depend on the motion (sensors)
  const MotionState* from = nullptr;  ///< a motion to be taken up again, of the same system with the same options
};

/// One instant of the motion, borrowed until `observe` returns.
struct Instant {
  double t;       ///< [s]
  PetscInt step;  ///< 0 at the start
  Vec U, V;       ///< U with multipliers, at the start those of consistent accelerations
  Vec A;          ///< null at step 0 and with other types of TS than generalized-alpha
  bool last;
  /// All that the motion goes on from here with; null with other types of TS than generalized-alpha. Rank-local.
  const std::function<MotionState()>* state = nullptr;
  /// U, V and A at a time within the step that ends here (TSGeneralizedAlphaInterpolate); null at the start and with
  /// other types of TS. Attitudes are relative to the bases that stand. Collective.
  const std::function<void(double t, Vec U, Vec V, Vec A)>* between = nullptr;
  bool at_rest = false;    ///< an equilibrium: all rates are zero
  double event_error = 0;  ///< TSGeneralizedAlphaGetEventError of the step that ends here
  /// The accelerations, where they are known. @return  null: they are not
  Vec accelerations() const { return at_rest ? V : A; }
};

/// What an integration took, and how far it came.
struct IntegrationReport {
  PetscInt steps = 0, rejected = 0, newton = 0, solves = 0;
  double end = 0;                ///< reached [s]
  double seconds = 0;            ///< wall clock
  double processor_seconds = 0;  ///< of this rank
  std::string type;              ///< of the TS
};

/// The motion stopped before its end. What was observed until then stands.
class MotionStopped : public RunError {
 public:
  MotionStopped(const std::string& text, IntegrationReport report, std::string reason)
      : RunError(text), report_(std::move(report)), reason_(std::move(reason)) {}
  const IntegrationReport& report() const { return report_; }
  /// The text without when it stopped.
  const std::string& reason() const { return reason_; }

 private:
  IntegrationReport report_;
  std::string reason_;
};

/// Integrates F(t, U, U', U'') = 0 from (U, V) at t = 0 by a PETSc TS (default type generalized-alpha), with consistent
/// accelerations and multipliers at the start. U, V hold the state reached at return. Bases of attitudes are taken
/// over at the beginning of every step: at each instant, and at return, A = base exp(x) of the U that belongs to it.
///
/// A motion that is taken up again (`from`) begins at the state's time, which `observe` sees once more; U, V are
/// overwritten. Events at one time happen in their order; a motion without a step before one has it at its start. Where
/// a motion is among kinks its time tells, so that kinks behind its end need not be known.
///
/// @param observe  called at the start and after every step (at an event before it); what it throws ends the motion
/// @throws InputError     an option has a value that it cannot have, or the TS type is for first-order systems, or is
/// not
///                        generalized-alpha and there are attitudes
/// @throws MotionStopped  a step did not converge, the steps allowed ran out, a term or `observe` threw: when, why, and
///                        what was tried. Then U, V hold the last state that was reached. An InputError of `observe` or
///                        of a term comes out unchanged. Collective.
IntegrationReport simulate(const System& system, const Integration& how, Vec U, Vec V,
                           const std::function<void(const Instant&)>& observe);

}  // namespace floe::solve
