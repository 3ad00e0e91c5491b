#pragma once
#include <petscksp.h>

#include <string>

namespace floe::petsc {

/// Whether the user gave an option that begins so, without the dash: `modes_st_`.
bool user_sets(const std::string& prefix);

/// A KSP of type preonly applies its preconditioner once and measures no residual: unless that is a factorisation, its
/// result is no solution, and nothing would say so. Call after KSPSetFromOptions.
/// @throws InputError  names the option
void refuse_preconditioner_alone(KSP ksp);

}  // namespace floe::petsc
