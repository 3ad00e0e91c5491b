#pragma once
#include <petscsnes.h>

namespace floe::solve {

/// Name of the SNES type.
inline constexpr char simplified_newton[] = "simplified-newton";

/// A state of this norm is as good as not finite: energies are its fourth powers.
inline constexpr PetscReal beyond_numbers = 1e50;

/// Name of a Vec composed with the SNES: what each entry of a linear solve is multiplied with, where the columns of J
/// were scaled.
inline constexpr char column_scales[] = "floe_column_scales";

/// Registers the SNES type simplified-newton with PETSc.
///
///   J d = F(U),   U <- U - d,   J kept from before as the lags of SNES say
///
/// Newton's iteration with full steps that does only what this takes: the convergence test sees the update before F is
/// evaluated again, so that n updates cost n residuals (SNESNEWTONLS: n + 1), and options are looked up once, not in
/// every solve. The test gets the norm of F before the update; F at the solution is not evaluated. Monitors, tolerances
/// (-snes_max_it, -snes_rtol), lags and the KSP work as for any SNES. Source of the name: Hairer and Wanner, Solving
/// Ordinary Differential Equations II, IV.8.
void register_simplified_newton();

/// Makes of a J that is kept one for U: the linear solve becomes d = rotate(J^-1 rotate_back(F)). Also called where J
/// was formed at U itself.
using Rotate = PetscErrorCode (*)(SNES snes, Vec U, PetscBool back, Vec y, void* context);

/// Sets it; NULL: none. Nothing happens to a SNES of another type.
PetscErrorCode set_rotation(SNES snes, Rotate rotate, void* context);

/// SNESSolve(snes, nullptr, U) for a SNES of any type; one of type simplified-newton that has solved for the same U
/// before, and of which no option wants a view, skips what SNESSolve does around. Collective.
PetscErrorCode solve_again(SNES snes, Vec U);

}  // namespace floe::solve
