#include "floe/petsc/factorisation.h"

#include <fmt/format.h>

#include "floe/petsc/error.h"

namespace floe::petsc {

std::string mumps_words(PetscInt infog, PetscInt detail, const std::string& prefix) {
  const std::string less =
      fmt::format("run on more ranks, or keep the factor on disk (-{}mat_mumps_icntl_22 1)", prefix);
  switch (infog) {
    case -5:
    case -7:
    case -13:
      return fmt::format("memory ran out, {}{} entries short: {}", detail < 0 ? -detail : detail,
                         detail < 0 ? " million" : "", less);
    case -19:
      return fmt::format("the memory allowed (-{}mat_mumps_icntl_23) is too small: allow more, or {}", prefix, less);
    case -8:
    case -9:
    case -11:
    case -12:
    case -14:
    case -15:
    case -17:
    case -20:
      return fmt::format(
          "its work space is too small, although floe enlarged it up to its limit; enlarge it further "
          "(-{0}mat_mumps_icntl_14 1000, or a higher limit -{0}mat_mumps_icntl_23), or {1}",
          prefix, less);
    case -6:
    case -10:
      return "the matrix is singular: an unconstrained rigid-body motion, or almost no stiffness in some direction";
    case -90:
      return "the factor cannot be written to disk (MUMPS_OOC_TMPDIR names the folder)";
    default:
      return "see MUMPS' users' guide, section 8";
  }
}

namespace {

/// MUMPS' factor, where it is what factors and has begun; else none.
Mat mumps_factor(PC pc) {
  PetscBool factors = PETSC_FALSE, mumps = PETSC_FALSE;
  MatSolverType type = nullptr;
  Mat factor = nullptr;
  check(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(pc), &factors, PCCHOLESKY, PCLU, ""));
  if (factors) check(PCFactorGetMatSolverType(pc, &type));
  if (type) check(PetscStrcmp(type, MATSOLVERMUMPS, &mumps));
  if (!mumps) return nullptr;
  try {
    check(PCFactorGetMatrix(pc, &factor));
  } catch (const Error&) {  // nothing is factored yet
    return nullptr;
  }
  return factor;
}

}  // namespace

FactorFault factor_fault(KSP ksp) {
  PC pc = nullptr;
  PCFailedReason reason = PC_NOERROR;
  const char* prefix = nullptr;
  check(KSPGetPC(ksp, &pc));
  check(PCGetFailedReason(pc, &reason));
  check(KSPGetOptionsPrefix(ksp, &prefix));
  const bool pivot = reason == PC_FACTOR_STRUCT_ZEROPIVOT || reason == PC_FACTOR_NUMERIC_ZEROPIVOT;
  PetscInt infog = 0, detail = 0;
  if (const Mat factor = mumps_factor(pc)) {
    check(MatMumpsGetInfog(factor, 1, &infog));
    check(MatMumpsGetInfog(factor, 2, &detail));
  }
  if (infog < 0)
    return {fmt::format("MUMPS' factorisation failed, INFOG(1) = {}: {}", infog,
                        mumps_words(infog, detail, prefix ? prefix : "")),
            infog == -6 || infog == -10};
  if (reason == PC_NOERROR) return {};
  return {PCFailedReasons[reason], pivot};
}

std::string why_failed(KSP ksp) { return factor_fault(ksp).text; }

}  // namespace floe::petsc
