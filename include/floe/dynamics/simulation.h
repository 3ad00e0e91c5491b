#pragma once
#include <functional>
#include <optional>
#include <string>

#include "floe/dynamics/system.h"

namespace floe::dynamics {

/// What the motion is integrated with; every -motion_ts_... and -motion_snes_... option on the command line wins.
struct Integration {
  double end = 0;                   ///< [s]
  double step = 0;                  ///< [s], the first one when adaptive
  double radius = 0.8;              ///< spectral radius at infinite frequency
  std::optional<double> tolerance;  ///< relative local error: adaptive steps
  std::string prefix = "motion_";
};

/// One instant of the motion, borrowed until `observe` returns.
struct Instant {
  double t;       ///< [s]
  PetscInt step;  ///< 0 at the start
  Vec U, V;
  Vec A;  ///< null at step 0 (the first step finds it) and with other types of TS than generalized-alpha
  bool last;
};

struct IntegrationReport {
  PetscInt steps = 0, rejected = 0, newton = 0, solves = 0;
  double end = 0;      ///< reached [s]
  double seconds = 0;  ///< wall clock
  double processor_seconds = 0;  ///< of this rank
  std::string type;    ///< of the TS
};

/// The motion stopped before its end. What was observed until then stands.
class MotionStopped : public RunError {
 public:
  MotionStopped(const std::string& text, IntegrationReport report) : RunError(text), report_(std::move(report)) {}
  const IntegrationReport& report() const { return report_; }

 private:
  IntegrationReport report_;
};

/// Integrates F(t, U, U', U'') = 0 from (U, V) at t = 0 by a PETSc TS (default type generalized-alpha), with consistent
/// accelerations and multipliers at the start. U, V hold the state reached at return. Bases of attitudes are taken
/// over at the beginning of every step: at each instant, and at return, A = base exp(x) of the U that belongs to it.
///
/// @param observe  called at the start and after every step; what it throws ends the motion
/// @throws InputError     an option has a value that it cannot have, or the TS type is for first-order systems, or is
/// not
///                        generalized-alpha and there are attitudes
/// @throws MotionStopped  a step did not converge, the steps allowed ran out, a term or `observe` threw: when, why, and
///                        what was tried. Then U, V hold the last state that was reached. An InputError of `observe` or
///                        of a term comes out unchanged. Collective.
IntegrationReport simulate(const System& system, const Integration& how, Vec U, Vec V,
                           const std::function<void(const Instant&)>& observe);

}  // namespace floe::dynamics
