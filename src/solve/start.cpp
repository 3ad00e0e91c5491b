#include "floe/solve/start.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "at_base.h"
#include "floe/petsc/factorisation.h"
#include "floe/petsc/options.h"
#include "floe/petsc/values.h"
#include "undetermined.h"

namespace floe::solve {

using petsc::check;

void set_tangent_solver(KSP ksp, Mat J) {
  PC pc = nullptr;
  PetscBool dense = PETSC_FALSE;
  check(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(J), &dense, MATSEQDENSE, MATDENSE, ""));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCLU));
  if (!dense) check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
}

petsc::KspHandle tangent_solver(Mat J, const char* prefix) {
  petsc::KspHandle ksp;
  check(KSPCreate(PetscObjectComm(reinterpret_cast<PetscObject>(J)), ksp.out()));
  check(KSPSetOptionsPrefix(ksp, prefix));
  check(KSPSetOperators(ksp, J, J));
  set_tangent_solver(ksp, J);
  petsc::check_options(KSPSetFromOptions(ksp), prefix);
  petsc::refuse_preconditioner_alone(ksp);
  return ksp;
}

bool is_singular(PetscErrorCode code) {
  return code == PETSC_ERR_MAT_LU_ZRPVT || code == PETSC_ERR_NOT_CONVERGED || code == PETSC_ERR_LIB;
}

namespace {

/// Symmetric scaling of [M C'; C 0]: 1 / sqrt(M_ii) for coordinates, 1 / |row of C M^(-1/2)| for multipliers. Scales J.
petsc::VecHandle equilibrate(const System& system, Mat J) {
  const auto& multipliers = system.coordinates().owned_multipliers();
  petsc::VecHandle scale = system.create_vector();
  check(MatGetDiagonal(J, scale));
  {
    petsc::Values s(scale);
    for (PetscInt i = s.first; i < s.end; ++i) s[i] = s[i] != 0 ? 1 / std::sqrt(std::abs(s[i])) : 1;
    for (PetscInt row : multipliers) s[row] = 1;
  }
  check(MatDiagonalScale(J, nullptr, scale));
  const petsc::VecHandle columns = system.create_vector();
  check(VecSet(columns, 1));
  {
    petsc::Values s(scale), c(columns);
    for (PetscInt row : multipliers) {
      PetscInt count = 0;
      const PetscInt* where = nullptr;
      const double* entries = nullptr;
      check(MatGetRow(J, row, &count, &where, &entries));
      const double norm = Eigen::Map<const Eigen::VectorXd>(entries, count).norm();
      check(MatRestoreRow(J, row, &count, &where, &entries));
      s[row] = c[row] = norm > 0 ? 1 / norm : 1;
    }
  }
  check(MatDiagonalScale(J, scale, columns));
  return scale;
}

/// Smaller numbers have rounding errors of denormal ones: numerical damping leaves these of velocities after a long
/// rest.
constexpr double least_exact = std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();

/// [M C'; C 0] x = b, factored once.
class Saddle {
 public:
  /// @param J  is scaled
  Saddle(const System& system, Mat J) : system_(system), scale_(equilibrate(system, J)) {
    check(MatDuplicate(J, MAT_COPY_VALUES, kept_.out()));  // a dense LU overwrites its matrix
    ksp_ = tangent_solver(J, "motion_start_");
  }
  petsc::VecHandle solve(Vec b) const {
    const petsc::VecHandle right = system_.create_vector(), product = system_.create_vector();
    petsc::VecHandle x = system_.create_vector();
    check(VecPointwiseMult(right, b, scale_));
    std::string raised;
    try {
      check(KSPSolve(ksp_, right, x));
    } catch (const petsc::Error& error) {
      raised = error.what();
      if (!is_singular(error.code())) throw RunError(raised);
    }
    if (const petsc::FactorFault fault = petsc::factor_fault(ksp_); !fault.text.empty() && !fault.singular)
      throw RunError(fault.text);
    if (!raised.empty()) throw RunError(singular_start + undetermined(system_, kept_));
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    double size = 0, residual = 0, given = 0;
    check(KSPGetConvergedReason(ksp_, &reason));
    check(VecNorm(x, NORM_INFINITY, &size));
    check(MatMult(kept_, x, product));
    check(VecAXPY(product, -1, right));
    check(VecNorm(product, NORM_INFINITY, &residual));
    check(VecNorm(right, NORM_INFINITY, &given));
    if (reason < 0 || !std::isfinite(size) || !(residual <= 1e-6 * std::max(given, least_exact)))
      throw RunError(singular_start + undetermined(system_, kept_));
    check(VecPointwiseMult(x, x, scale_));
    return x;
  }

 private:
  const System& system_;
  petsc::VecHandle scale_;
  petsc::MatHandle kept_;
  petsc::KspHandle ksp_;
};

/// Splits a solution of the saddle: accelerations (multipliers zero) and multipliers (into U).
void split(const System& system, Vec x, Vec U, Vec A) {
  check(VecCopy(x, A));
  petsc::Values from(x), a(A);
  for (PetscInt row : system.coordinates().owned_multipliers()) a[row] = 0;
  if (!U) return;
  petsc::Values u(U);
  for (PetscInt row : system.coordinates().owned_multipliers()) u[row] = from[row];
}

/// Keeps only the multiplier rows (`multipliers`), or only the others.
void keep_rows(const System& system, Vec f, bool multipliers) {
  petsc::Values values(f);
  const auto& rows = system.coordinates().owned_multipliers();  // ascending
  auto next = rows.begin();
  for (PetscInt i = values.first; i < values.end; ++i) {
    const bool is = next != rows.end() && *next == i;
    if (is) ++next;
    if (is != multipliers) values[i] = 0;
  }
}

}  // namespace

void consistent_start(const System& system, double t, Vec U, Vec V, Vec A) {
  const AtBase at_base(system, U, V, t);
  keep_rows(system, U, false);
  check(VecSet(A, 0));
  const petsc::VecHandle F = system.create_vector();
  system.residual(t, U, V, A, ConstraintLevel::acceleration, F);
  check(VecScale(F, -1));
  const petsc::MatHandle J = system.create_tangent();
  system.tangent(t, U, V, A, {0, 0, 1}, J);
  const petsc::VecHandle x = Saddle(system, J).solve(F);
  split(system, x, U, A);
}

double consistent_velocities(const System& system, double t, Vec U, Vec V, Vec impulses) {
  if (impulses) check(VecSet(impulses, 0));
  if (system.coordinates().multiplier_count() == 0) return 0;
  const AtBase at_base(system, U, V, t);
  const petsc::VecHandle F = system.create_vector(), A = system.create_vector();
  system.residual(t, U, V, A, ConstraintLevel::velocity, F);
  keep_rows(system, F, true);
  check(VecScale(F, -1));
  double wrong = 0, size = 0, change = 0;
  check(VecNorm(F, NORM_INFINITY, &wrong));
  if (wrong == 0) return 0;
  const petsc::MatHandle J = system.create_tangent();
  system.tangent(t, U, V, A, {0, 0, 1}, J);
  const petsc::VecHandle x = Saddle(system, J).solve(F);
  split(system, x, impulses, A);
  check(VecNorm(V, NORM_2, &size));
  check(VecNorm(A, NORM_2, &change));
  check(VecAXPY(V, 1, A));
  if (size > 0) return change / size;
  return wrong > 1e-12 ? 1 : 0;  // bodies at rest, and drives whose rates are round-off: nothing to tell of
}

petsc::VecHandle accelerations_at(const System& system, double t, Vec U, Vec V) {
  petsc::VecHandle A = system.create_vector();
  int found = 1;
  try {
    consistent_start(system, t, U, V, A);
  } catch (const RunError&) {
    found = 0;
  }
  check(MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPI_INT, MPI_MIN, system.comm()));
  return found != 0 ? std::move(A) : petsc::VecHandle();
}

namespace {

/// Of motions w that joints allow, what strongly damped vibrations have of them, C at rest.
class DampedPart {
 public:
  DampedPart(const System& system, double t, double h, Vec U)
      : system_(system), t_(t), h_(h), U_(U), mass_(system.create_tangent()), damped_(system.create_tangent()) {
    system.damped_mass(t, U, 0, mass_);
    system.damped_mass(t, U, h, damped_);
    check(MatDuplicate(damped_, MAT_COPY_VALUES, J_.out()));
    saddle_.emplace(system, J_);
  }
  /// w <- J^-1 h C w, J = M + h C with the rows of the joints, whose multipliers come into `held`: 1 - R.
  void damp(Vec w, Vec held) const { damp_by(damped_, w, held); }
  /// The same with the C of what lasts (System::damped_mass) in h C.
  void damp_lasting(Vec w, Vec held) const {
    const petsc::MatHandle lasting = system_.create_tangent();
    system_.damped_mass(t_, U_, h_, lasting, true);
    damp_by(lasting, w, held);
  }
  /// w <- J^-1 M w: R.
  void keep(Vec w, Vec held) const {
    const petsc::VecHandle b = system_.create_vector();
    check(MatMult(mass_, w, b));
    solve(b, w, held);
  }

 private:
  void damp_by(Mat damped, Vec w, Vec held) const {
    const petsc::VecHandle b = system_.create_vector(), undamped = system_.create_vector();
    check(MatMult(damped, w, b));
    check(MatMult(mass_, w, undamped));
    check(VecAXPY(b, -1, undamped));
    solve(b, w, held);
  }
  void solve(Vec b, Vec w, Vec held) const {
    keep_rows(system_, b, false);
    split(system_, saddle_->solve(b), held, w);
  }

  const System& system_;
  double t_, h_;
  Vec U_;
  petsc::MatHandle mass_, damped_, J_;
  std::optional<Saddle> saddle_;
};

}  // namespace

double damp_jump(const System& system, double t, double h, Vec U, Vec before, Vec V, Vec impulses) {
  if (!(h > 0) || !system.damps_strains()) return 0;
  const double kinetic = system.energy(t, U, V).kinetic;
  const AtBase at_base(system, U, V, t);
  const petsc::VecHandle w = system.create_vector(), held = system.create_vector();
  const DampedPart damped_part(system, t, h, U);
  check(VecWAXPY(w, -1, before, V));
  keep_rows(system, w, false);
  for (int i = 0; i < 2; ++i) damped_part.damp(w, held);
  check(VecAXPY(V, -1, w));
  if (impulses) {
    keep_rows(system, held, true);
    check(VecAXPY(impulses, -1, held));
  }
  return kinetic - system.energy(t, U, V).kinetic;
}

double give_way(const System& system, double t, double h, Vec U, Vec before, Vec V) {
  if (!before || !(h > 0) || !system.damps_strains()) return 0;
  const petsc::VecHandle held = system.create_vector();
  check(VecCopy(U, held));
  const petsc::VecHandle w = accelerations_at(system, t, held, V);
  if (!w) return 0;
  const double kinetic = system.energy(t, U, V).kinetic;
  const AtBase at_base(system, U, V, t);
  const DampedPart damped_part(system, t, h, U);
  check(VecAXPY(w, -1, before));
  keep_rows(system, w, false);
  damped_part.damp(w, held);
  damped_part.damp_lasting(w, held);
  damped_part.keep(w, held);
  check(VecAXPY(V, h, w));
  return system.energy(t, U, V).kinetic - kinetic;
}

double constraint_violation(const System& system, double t, Vec U, Vec V, ConstraintLevel level) {
  return system.constraint_violation(t, U, V, level);
}

}  // namespace floe::solve
