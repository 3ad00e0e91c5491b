#pragma once
#include <petscksp.h>

#include <string>

namespace floe::petsc {

/// Why a solver's factorisation failed.
struct FactorFault {
  std::string text;       ///< in MUMPS' words, and what helps; empty if it did not fail
  bool singular = false;  ///< the matrix is: something is not constrained, or constraints repeat
};

/// Also where PETSc has raised an error of its own for it (PETSC_ERR_LIB). Collective.
FactorFault factor_fault(KSP ksp);

/// The text alone.
std::string why_failed(KSP ksp);

/// What MUMPS' INFOG(1) means to the user, and what helps. Source: MUMPS 5.5 users' guide, section 8.
/// @param detail  INFOG(2); negative ones count millions
/// @param prefix  of the solver's options
std::string mumps_words(PetscInt infog, PetscInt detail, const std::string& prefix);

/// Makes every factor by MUMPS, of whatever solver, better than PETSc's interface does. Call after PetscInitialize;
/// twice does no harm.
///
/// Blocks of right-hand sides on several ranks come into their places by one scatter that is kept; options of the
/// factor that set ICNTL(20), its -mat_mumps_use_omp_threads, or another version of MUMPS' structure leave that to
/// PETSc. A factorisation goes on with twice the work space (ICNTL(14), at least 100 %)
/// as long as that is too small (INFOG(1) = -8, -9, -11, -14, -15, -17, -20): pivots that are put off ask for more than
/// the analysis foresees. Up to 12800 %, but beyond 100 % not for more than 4 GiB by the analysis; where ICNTL(23)
/// bounds the memory, never.
void prepare_mumps();

}  // namespace floe::petsc
