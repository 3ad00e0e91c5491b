#include "options_probe.h"

#include <slepceps.h>
#include <slepcpep.h>

#include <algorithm>

#include "floe/petsc/error.h"
#include "floe/petsc/handle.h"
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

void read_linear(const std::string& prefix) {
  petsc::KspHandle ksp;
  const petsc::MatHandle matrix = two_unknowns();
  PC pc = nullptr;
  check(KSPCreate(PETSC_COMM_SELF, ksp.out()));
  check(KSPSetOptionsPrefix(ksp, prefix.c_str()));
  check(KSPSetOperators(ksp, matrix, matrix));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCLU));
  petsc::check_options(KSPSetFromOptions(ksp), prefix);
}

void give_operators(SNES snes, Mat matrix) {
  KSP ksp = nullptr;
  PC pc = nullptr;
  check(SNESGetKSP(snes, &ksp));
  check(KSPSetOperators(ksp, matrix, matrix));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCLU));
}

void read_nonlinear(const std::string& prefix) {
  petsc::SnesHandle snes;
  const petsc::MatHandle matrix = two_unknowns();
  check(SNESCreate(PETSC_COMM_SELF, snes.out()));
  check(SNESSetOptionsPrefix(snes, prefix.c_str()));
  give_operators(snes, matrix);
  petsc::check_options(SNESSetFromOptions(snes), prefix);
}

void read_motion(const std::string& prefix) {
  petsc::TsHandle ts;
  const petsc::MatHandle matrix = two_unknowns();
  SNES snes = nullptr;
  check(TSCreate(PETSC_COMM_SELF, ts.out()));
  check(TSSetOptionsPrefix(ts, prefix.c_str()));
  check(TSSetProblemType(ts, TS_NONLINEAR));
  check(TSSetType(ts, solve::generalized_alpha));
  check(TSGetSNES(ts, &snes));
  give_operators(snes, matrix);
  petsc::check_options(TSSetFromOptions(ts), prefix);
  read_linear(prefix + "start_");
}

void read_modes(const std::string& prefix) {
  petsc::EpsHandle eps;
  const petsc::MatHandle K = two_unknowns(), M = two_unknowns();
  ST st = nullptr;
  reduction::register_eigensolvers();
  check(EPSCreate(PETSC_COMM_SELF, eps.out()));
  check(EPSSetOptionsPrefix(eps, prefix.c_str()));
  check(EPSSetOperators(eps, K, M));
  check(EPSSetProblemType(eps, EPS_GHEP));
  check(EPSGetST(eps, &st));
  check(STSetType(st, STSINVERT));
  petsc::check_options(EPSSetFromOptions(eps), prefix);
}

void read_rotation(const std::string& prefix) {
  petsc::Handle<PEP, PEPDestroy> pep;
  const petsc::MatHandle matrix = two_unknowns();
  Mat all[3] = {matrix, matrix, matrix};
  ST st = nullptr;
  check(PEPCreate(PETSC_COMM_SELF, pep.out()));
  check(PEPSetOptionsPrefix(pep, prefix.c_str()));
  check(PEPSetOperators(pep, 3, all));
  check(PEPSetType(pep, PEPTOAR));
  check(PEPGetST(pep, &st));
  check(STSetType(st, STSINVERT));
  petsc::check_options(PEPSetFromOptions(pep), prefix);
}

struct Solver {
  const char* prefix;
  void (*read)(const std::string& prefix);
};
constexpr Solver solvers[] = {{"modes_", read_modes},      {"derivatives_", read_linear}, {"motion_", read_motion},
                              {"ranking_", read_motion},   {"static_", read_nonlinear},   {"estimate_", read_linear},
                              {"campbell_", read_rotation}};

bool has_prefix(const Option& option, const char* prefix) { return option.first.rfind(prefix, 0) == 0; }

/// What PETSc looks up only while it solves, or would open a file for.
bool read_later(const std::string& name) {
  for (const char* part :
       {"mat_", "mg_",      "gamg_",   "sub_", "fieldsplit_", "redundant_",       "telescope_", "inner_",
        "npc_", "esteig_",  "coarse",  "view", "monitor",     "converged_reason", "test_",      "compare_",
        "hmg_", "ksp_ksp_", "ksp_pc_", "asm_", "deflation_",  "block_lanczos",    "bddc_"})
    if (name.find(part) != std::string::npos) return true;
  return false;
}

/// A table of its own, which is PETSc's while this lives.
class Table {
 public:
  explicit Table(const std::vector<Option>& options) {
    check(PetscOptionsCreate(&options_));
    for (const auto& [name, value] : options)
      check(PetscOptionsSetValue(options_, ("-" + name).c_str(), value.empty() ? nullptr : value.c_str()));
    check(PetscOptionsPush(options_));
  }
  ~Table() {
    PetscOptionsPop();
    PetscOptionsDestroy(&options_);
  }
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  /// Names of those that nothing has read.
  std::vector<std::string> left() const {
    PetscInt count = 0;
    char **names = nullptr, **values = nullptr;
    check(PetscOptionsLeftGet(options_, &count, &names, &values));
    std::vector<std::string> all(names, names + count);
    check(PetscOptionsLeftRestore(options_, &count, &names, &values));
    return all;
  }

 private:
  PetscOptions options_ = nullptr;
};

}  // namespace

std::vector<Option> unread(const std::vector<Option>& options) {
  std::vector<Option> judged;
  std::copy_if(options.begin(), options.end(), std::back_inserter(judged), [](const Option& option) {
    const bool ours = std::any_of(std::begin(solvers), std::end(solvers),
                                  [&](const Solver& solver) { return has_prefix(option, solver.prefix); });
    return ours && !read_later(option.first);
  });
  std::vector<std::string> left;
  if (!judged.empty()) {
    const Table table(judged);
    for (const Solver& solver : solvers)
      if (std::any_of(judged.begin(), judged.end(), [&](const Option& o) { return has_prefix(o, solver.prefix); }))
        solver.read(solver.prefix);
    left = table.left();
  }
  std::erase_if(judged, [&](const Option& o) { return std::find(left.begin(), left.end(), o.first) == left.end(); });
  return judged;
}

}  // namespace floe::app
