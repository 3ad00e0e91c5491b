#include "options_solvers.h"

#include <slepceps.h>
#include <slepcpep.h>

#include <utility>

#include "floe/mesh/partition.h"
#include "floe/petsc/error.h"
#include "floe/petsc/handle.h"
#include "floe/petsc/options.h"
#include "floe/reduction/eigensolvers.h"
#include "floe/solve/generalized_alpha.h"

namespace floe::app {

using petsc::check;

namespace {

/// Diagonal, in the sparse format, which all solvers take.
petsc::MatHandle two_unknowns() {
  petsc::MatHandle matrix;
  check(MatCreateSeqAIJ(PETSC_COMM_SELF, 2, 2, 1, nullptr, matrix.out()));
  for (PetscInt i = 0; i < 2; ++i) check(MatSetValue(matrix, i, i, 1, INSERT_VALUES));
  check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  return matrix;
}

void set_direct(KSP ksp, Mat matrix) {
  PC pc = nullptr;
  check(KSPSetOperators(ksp, matrix, matrix));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCLU));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
}

/// Of those that begin so.
void count_as_read(const std::string& prefix) {
  PetscInt count = 0;
  char **names = nullptr, **values = nullptr;
  PetscBool has = PETSC_FALSE;
  check(PetscOptionsLeftGet(nullptr, &count, &names, &values));
  for (PetscInt i = 0; i < count; ++i)
    if (const std::string name = names[i]; name.starts_with(prefix))
      check(PetscOptionsHasName(nullptr, nullptr, ("-" + name).c_str(), &has));
  check(PetscOptionsLeftRestore(nullptr, &count, &names, &values));
}

/// What PETSc looks up when it factors. Where it cannot factor this matrix, nothing is known of these options.
void read_factor(KSP ksp, const std::string& prefix) {
  PC pc = nullptr;
  PetscBool factors = PETSC_FALSE;
  if (!petsc::user_sets(prefix + "mat_")) return;
  check(KSPGetPC(ksp, &pc));
  check(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(pc), &factors, PCLU, PCCHOLESKY, PCILU, PCICC, ""));
  if (!factors) return;
  try {
    check(KSPSetUp(ksp));
  } catch (const petsc::Error&) {
    count_as_read(prefix + "mat_");
  }
}

void read_linear(const std::string& prefix, KSPType type, PCType preconditioner) {
  petsc::KspHandle ksp;
  const petsc::MatHandle matrix = two_unknowns();
  PC pc = nullptr;
  check(KSPCreate(PETSC_COMM_SELF, ksp.out()));
  check(KSPSetOptionsPrefix(ksp, prefix.c_str()));
  set_direct(ksp, matrix);
  check(KSPSetType(ksp, type));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, preconditioner));
  petsc::check_options(KSPSetFromOptions(ksp), prefix);
  read_factor(ksp, prefix);
}

void read_direct(const std::string& prefix) { read_linear(prefix, KSPPREONLY, PCLU); }

void read_nonlinear(const std::string& prefix) {
  petsc::SnesHandle snes;
  const petsc::MatHandle matrix = two_unknowns();
  KSP ksp = nullptr;
  check(SNESCreate(PETSC_COMM_SELF, snes.out()));
  check(SNESSetOptionsPrefix(snes, prefix.c_str()));
  check(SNESGetKSP(snes, &ksp));
  set_direct(ksp, matrix);
  petsc::check_options(SNESSetFromOptions(snes), prefix);
  read_factor(ksp, prefix);
}

void read_motion(const std::string& prefix) {
  petsc::TsHandle ts;
  const petsc::MatHandle matrix = two_unknowns();
  SNES snes = nullptr;
  KSP ksp = nullptr;
  check(TSCreate(PETSC_COMM_SELF, ts.out()));
  check(TSSetOptionsPrefix(ts, prefix.c_str()));
  check(TSSetProblemType(ts, TS_NONLINEAR));
  check(TSSetType(ts, solve::generalized_alpha));
  check(TSGetSNES(ts, &snes));
  check(SNESGetKSP(snes, &ksp));
  set_direct(ksp, matrix);
  petsc::check_options(TSSetFromOptions(ts), prefix);
  read_factor(ksp, prefix);
}

void set_inverting(ST st, Mat matrix) {
  KSP ksp = nullptr;
  check(STSetType(st, STSINVERT));
  check(STGetKSP(st, &ksp));
  set_direct(ksp, matrix);
}

void read_modes(const std::string& prefix) {
  petsc::EpsHandle eps;
  const petsc::MatHandle K = two_unknowns(), M = two_unknowns();
  ST st = nullptr;
  KSP ksp = nullptr;
  reduction::register_eigensolvers();
  check(EPSCreate(PETSC_COMM_SELF, eps.out()));
  check(EPSSetOptionsPrefix(eps, prefix.c_str()));
  check(EPSSetOperators(eps, K, M));
  check(EPSSetProblemType(eps, EPS_GHEP));
  check(EPSGetST(eps, &st));
  set_inverting(st, K);
  petsc::check_options(EPSSetFromOptions(eps), prefix);
  check(STGetKSP(st, &ksp));
  read_factor(ksp, prefix + "st_");
  if (petsc::user_sets(prefix + "eps_type")) return;
  check(EPSSetType(eps, "block-lanczos"));  // the default of large bodies
  petsc::check_options(EPSSetFromOptions(eps), prefix);
}

void read_rotation(const std::string& prefix) {
  petsc::Handle<PEP, PEPDestroy> pep;
  const petsc::MatHandle matrix = two_unknowns();
  Mat all[3] = {matrix, matrix, matrix};
  ST st = nullptr;
  KSP ksp = nullptr;
  check(PEPCreate(PETSC_COMM_SELF, pep.out()));
  check(PEPSetOptionsPrefix(pep, prefix.c_str()));
  check(PEPSetOperators(pep, 3, all));
  check(PEPSetType(pep, PEPTOAR));
  check(PEPGetST(pep, &st));
  set_inverting(st, matrix);
  petsc::check_options(PEPSetFromOptions(pep), prefix);
  check(STGetKSP(st, &ksp));
  read_factor(ksp, prefix + "st_");
}

void read_basis(const std::string& prefix) {
  petsc::BvHandle bv;
  check(BVCreate(PETSC_COMM_SELF, bv.out()));
  check(BVSetOptionsPrefix(bv, prefix.c_str()));
  check(BVSetSizes(bv, 2, 2, 1));
  petsc::check_options(BVSetFromOptions(bv), prefix + "bv_");
}

OptionReader reader(const std::string& prefix, const std::string& linear, void (*read)(const std::string&)) {
  return {prefix, prefix + linear, [=](const std::string& tag) { read(tag + prefix); }};
}

}  // namespace

const std::vector<OptionReader>& option_readers() {
  static const std::vector<OptionReader> all = {reader("modes_", "st_", read_modes),
                                                reader("derivatives_", "", read_direct),
                                                reader("motion_", "", read_motion),
                                                reader("motion_start_", "", read_direct),
                                                reader("ranking_", "", read_motion),
                                                reader("ranking_start_", "", read_direct),
                                                reader("static_", "", read_nonlinear),
                                                reader("estimate_", "", read_direct),
                                                reader("campbell_", "st_", read_rotation),
                                                reader("mesh_", "", mesh::check_partitioning_options),
                                                {"bv_", "", read_basis},
                                                {"mat_mumps_", "", read_direct}};
  return all;
}

void read_inner(const std::string& prefix) {
  constexpr std::pair<KSPType, PCType> types[] = {
      {KSPPREONLY, PCLU},    {KSPPREONLY, PCILU}, {KSPPREONLY, PCBJACOBI}, {KSPPREONLY, PCREDUNDANT},
      {KSPCHEBYSHEV, PCSOR}, {KSPCG, PCJACOBI},   {KSPGMRES, PCNONE}};
  for (const auto& [type, preconditioner] : types) read_linear(prefix, type, preconditioner);
}

}  // namespace floe::app
