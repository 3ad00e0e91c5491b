#pragma once
#include <optional>

#include "floe/dynamics/system.h"

namespace floe::solve {
using namespace dynamics;

/// What is wrong where accelerations and multipliers are not determined.
inline const std::string singular_start =
    "the initial accelerations are undetermined: redundant or contradictory constraints (two joints that "
    "constrain the same motion), or a body has no mass";
/// Whether a linear solve that returned `code` met a singular matrix: each solver has an error of its own for it.
bool is_singular(PetscErrorCode code);

/// Consistent accelerations and multipliers at an instant:
///
///   M a + C_q' lambda = Q(t, q, v),   d2C/dt2 = C_q a + ... = 0
///
/// Attitudes may stand anywhere in their charts; among A are their angular accelerations in body axes.
/// @param U  coordinates given, multipliers overwritten;  @param A  overwritten
/// @throws RunError  the matrix is singular: constraints that repeat or contradict one another, or mass that is missing
/// Collective. One factorisation (KSP prefix motion_start_).
void consistent_start(const System& system, double t, Vec U, Vec V, Vec A);

/// Takes the velocities to the nearest ones (in kinetic energy) that the joints allow, and returns the relative change.
/// @param impulses  if given, its multipliers become the impulses that change the velocities [N s], [N m s]
/// Collective. One factorisation.
double consistent_velocities(const System& system, double t, Vec U, Vec V, Vec impulses = nullptr);

/// Takes from a jump of the velocities, V - before, what the damping of strains ends within a step h:
///
///   (1 - R)^2 (V - before),   R = (M + h C)^-1 M   with the rows of the joints,   C at rest
///
/// which is h^2 of what a step resolves, and nearly all of what it does not (rates of beta omega^2 h >> 1, which move a
/// body by v/(beta omega^2), not by h v). Momentum is kept.
/// @param h  0: nothing is done
/// @param impulses  if given, those of the joints that made the jump; they become those of what is left of it
/// @return  what this takes of the kinetic energy [J], negative where drives carry the bodies along
/// Collective. One factorisation, none where nothing damps strains.
double damp_jump(const System& system, double t, double h, Vec U, Vec before, Vec V, Vec impulses = nullptr);

/// consistent_start, in a new vector; null where accelerations cannot be found (the step that follows says why).
/// Collective.
petsc::VecHandle accelerations_at(const System& system, double t, Vec U, Vec V);

/// Where an event releases a joint, adds to the velocities what bodies whose strains are damped give way with within a
/// step h:
///
///   V += h R (1 - R)^2 (A - before),   R = (M + h C)^-1 M   with the rows of the joints,   C at rest
///
/// which is h^3 of what a step resolves, and C^-1 of the jump of the forces for what it does not (rates of beta omega^2
/// h >> 1), as far as this lasts (System::damped_mass). A step that made this jump itself would have accelerations of
/// 1/h that alternate from step to step, and with them the forces of joints.
/// @param before  accelerations before the jump; null: nothing is done.  @param h  0: nothing is done
/// @return  what this adds to the kinetic energy [J]
/// Collective. Two factorisations, none where nothing damps strains.
double give_way(const System& system, double t, double h, Vec U, Vec before, Vec V);

/// |C(q, t)|, or of its rate, maximum over all rows. Collective.
double constraint_violation(const System& system, double t, Vec U, Vec V, ConstraintLevel level);

/// Nothing holds the configuration in some direction: at the start of the search and after relaxation; or because the
/// loads drive it away along a path without stiffness; or where the search ends, where the tangent is no more than its
/// own round-off there.
class Unconstrained : public RunError {
  using RunError::RunError;
};

/// Round-off of the maximum forces leaves the equilibrium open: smaller steps of the loads find no more.
class LostInRoundOff : public RunError {
  using RunError::RunError;
};

/// Coordinates and multipliers with F(t, U, V, 0) = 0 at given velocities: a static equilibrium (V = 0) or the steady
/// shape of a body that rotates at constant speed.
///
/// SNES prefix static_ (Newton with full steps). Returns its iterations. Where K is singular at the start, because what
/// will hold the configuration is not stressed yet, where a step rotates by more than a right angle and where the
/// search fails, steps with K + s M come first, s falling to nothing from where a step is short, none of them beyond a
/// radian or uphill (pseudo-transient continuation; Kelley and Keyes 1998): of several equilibria the one that a slow
/// damped motion comes to.
///
/// Where U need not be near an equilibrium (`descend`) and the tangent is indefinite there, as between two shapes that
/// a buckled body can have, Newton's method goes uphill to any of them: these steps come first, too.
///
/// What the search ends at is an equilibrium where the next step, by the tangent of that configuration, is below 1e-6
/// of 1 rad in every rotation, of its size in every body's place, and of the configuration in the norm of |K_ii|; until
/// then further steps are taken.
/// @throws RunError  not converged, joints not met as they are meant to be (System::failed_constraint), or constraints
/// repeat; Unconstrained, LostInRoundOff; U is then whatever it was last. Collective.
PetscInt equilibrium(const System& system, double t, Vec U, Vec V, bool descend = false);

/// Directions in which an equilibrium gives way, 0 for a stable one: negative eigenvalues of [K C'; C 0] beyond one for
/// each multiplier, counted by the signs of an LDL' factor (Sylvester), whatever the size.
///
/// Nothing where K is not symmetric, as under loads that follow the body: its signs do not tell (such a body flutters
/// while K is regular), or where it has no factor. The same on every rank. Collective.
std::optional<int> unstable_directions(const System& system, double t, Vec U, Vec V);

/// A direct solver for a tangent: LAPACK's LU where it is dense, MUMPS' where it is sparse; `prefix` for the user.
/// Collective.
petsc::KspHandle tangent_solver(Mat J, const char* prefix);
/// The same defaults on a solver that exists (a SNES's).
void set_tangent_solver(KSP ksp, Mat J);

}  // namespace floe::solve
