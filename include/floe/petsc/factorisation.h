#pragma once
#include <petscksp.h>

#include <string>

namespace floe::petsc {

/// Why a solver's factorisation failed.
struct FactorFault {
  std::string text;       ///< in MUMPS' words, and what helps; empty if it did not fail
  bool singular = false;  ///< the matrix is: something is not held, or constraints repeat
};

/// Also where PETSc has raised an error of its own for it (PETSC_ERR_LIB). Collective.
FactorFault factor_fault(KSP ksp);

/// The text alone.
std::string why_failed(KSP ksp);

/// What MUMPS' INFOG(1) means to the user, and what helps. Source: MUMPS 5.5 users' guide, section 8.
/// @param detail  INFOG(2); negative ones count millions
/// @param prefix  of the solver's options
std::string mumps_words(PetscInt infog, PetscInt detail, const std::string& prefix);

}  // namespace floe::petsc
