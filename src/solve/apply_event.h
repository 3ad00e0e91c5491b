#pragma once
#include "floe/dynamics/event.h"
#include "floe/dynamics/system.h"

namespace floe::solve {
using namespace dynamics;

/// Applies an event at the state (t, U, V): its constraint switch changes, and velocities go to the nearest ones that
/// fit, less what damping ends within the step h that follows (damp_jump). That step must start anew (TSRestartStep).
/// @throws RunError  the rows that close contradict or repeat others. Collective.
EventReport apply_event(const System& system, const Event& event, double t, double h, Vec U, Vec V);

/// Takes velocities before a kink to those after it, likewise. The next step must start anew, at kink.after.
/// @throws RunError  the drives contradict one another. Collective.
EventReport pass(const System& system, const Kink& kink, double h, Vec U, Vec V);

}  // namespace floe::solve
