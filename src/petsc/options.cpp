#include "floe/petsc/options.h"

#include <fmt/format.h>

#include "floe/petsc/error.h"

namespace floe::petsc {

bool user_sets(const std::string& prefix) {
  char* all = nullptr;
  check(PetscOptionsGetAll(nullptr, &all));
  const bool sets = (" " + std::string(all)).find(" -" + prefix) != std::string::npos;
  check(PetscFree(all));
  return sets;
}

void refuse_preconditioner_alone(KSP ksp) {
  PC pc = nullptr;
  PetscBool alone = PETSC_FALSE, solves = PETSC_FALSE;
  PCType type = nullptr;
  const char* prefix = nullptr;
  check(KSPGetPC(ksp, &pc));
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(ksp), KSPPREONLY, &alone));
  check(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(pc), &solves, PCCHOLESKY, PCLU, PCREDUNDANT, PCSVD,
                                  PCQR, PCKSP, ""));
  if (!alone || solves) return;
  check(PCGetType(pc, &type));
  check(KSPGetOptionsPrefix(ksp, &prefix));
  throw InputError(
      fmt::format("option -{0}pc_type {1}: is only a preconditioner; expected a factorisation (cholesky, lu), or an "
                  "iterative solver with it (-{0}ksp_type gmres)",
                  prefix ? prefix : "", type ? type : "none"));
}

}  // namespace floe::petsc
