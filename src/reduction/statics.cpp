#include "floe/reduction/statics.h"

#include <fmt/format.h>

#include <cmath>

#include "floe/petsc/values.h"

namespace floe::reduction {

using petsc::check;

petsc::VecHandle copy(Vec vector) {
  petsc::VecHandle twin;
  check(VecDuplicate(vector, twin.out()));
  check(VecCopy(vector, twin));
  return twin;
}

petsc::KspHandle direct_solver(Mat A, const char* prefix) {
  petsc::KspHandle ksp;
  PC pc = nullptr;
  check(KSPCreate(PetscObjectComm(reinterpret_cast<PetscObject>(A)), ksp.out()));
  check(KSPSetOptionsPrefix(ksp, prefix));
  check(KSPSetOperators(ksp, A, A));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCCHOLESKY));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  petsc::check_options(KSPSetFromOptions(ksp), prefix);
  return ksp;
}

void iterate(KSP ksp, KSPType type) {
  check(KSPSetType(ksp, type));
  check(KSPSetNormType(ksp, KSP_NORM_PRECONDITIONED));
  check(KSPSetTolerances(ksp, 1e-12, PETSC_DEFAULT, PETSC_DEFAULT, 30));
}

RunError too_fine(const fem::Structure& structure, const std::string& what) {
  return RunError(
      fmt::format("the mesh of {} elements is finer than double precision resolves: {}; take fewer elements",
                  structure.mesh.cell_count, what));
}

namespace {

void check_converged(KSP ksp) {
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  check(KSPGetConvergedReason(ksp, &reason));
  if (reason >= 0) return;
  const char* prefix = nullptr;
  check(KSPGetOptionsPrefix(ksp, &prefix));
  throw RunError(fmt::format("a linear solve (options -{}ksp_...) did not converge: {}", prefix ? prefix : "",
                             KSPConvergedReasons[reason]));
}

}  // namespace

Columns block_solve(KSP ksp, const Columns& B) {
  Columns X;
  if (B.empty()) return X;
  PetscBool direct = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(ksp), KSPPREONLY, &direct));
  if (!direct) {  // KSPMatSolve would tell how the last column went only
    for (const auto& b : B) {
      X.push_back(copy(b));
      check(KSPSolve(ksp, b, X.back()));
      check_converged(ksp);
    }
    return X;
  }
  PetscInt local = 0, global = 0;
  check(VecGetLocalSize(B[0], &local));
  check(VecGetSize(B[0], &global));
  const PetscInt count = static_cast<PetscInt>(B.size());
  petsc::MatHandle right, left;
  const MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(ksp));
  check(MatCreateDense(comm, local, PETSC_DECIDE, global, count, nullptr, right.out()));
  check(MatCreateDense(comm, local, PETSC_DECIDE, global, count, nullptr, left.out()));
  for (PetscInt j = 0; j < count; ++j) {
    Vec column = nullptr;
    check(MatDenseGetColumnVecWrite(right, j, &column));
    check(VecCopy(B[j], column));
    check(MatDenseRestoreColumnVecWrite(right, j, &column));
  }
  check(MatAssemblyBegin(right, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(right, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyBegin(left, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(left, MAT_FINAL_ASSEMBLY));
  check(KSPMatSolve(ksp, right, left));
  check_converged(ksp);
  for (PetscInt j = 0; j < count; ++j) {
    X.push_back(copy(B[j]));
    Vec column = nullptr;
    check(MatDenseGetColumnVecRead(left, j, &column));
    check(VecCopy(column, X.back()));
    check(MatDenseRestoreColumnVecRead(left, j, &column));
  }
  return X;
}

Statics::Statics(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding)
    : frame_(frame),
      conditions_(holding.statics),
      K_(fem::stiffness(structure, holding.statics)),
      elements_(std::make_shared<fem::ElementStiffness>(structure)),
      exact_(fem::stiffness_operator(elements_, holding.statics)),
      ksp_(direct_solver(K_, "derivatives_")) {}

bool Statics::refines() const {
  if (factor_error_ < 0) solver();
  return factor_error_ > 1e-8;
}

double Statics::measured_error() const {
  const fem::Structure& structure = elements_->structure();
  Columns load;
  load.push_back(fem::field(structure));
  PetscInt first = 0, end = 0;
  double* values = nullptr;
  check(VecGetOwnershipRange(load[0], &first, &end));
  check(VecGetArrayWrite(load[0], &values));
  for (PetscInt i = first; i < end; ++i)  // smooth, not balanced by rigid accelerations
    values[i - first] =
        i % structure.dofs_per_node >= structure.dimension() ? 0 : std::cos(3. * double(i) / double(structure.dofs()));
  check(VecRestoreArrayWrite(load[0], &values));
  fem::balance(frame_, load[0]);
  fem::hold(load[0], conditions_);
  const Columns u = block_solve(ksp_, load);
  Columns residual;
  residual.push_back(copy(load[0]));
  check(MatMult(exact_, u[0], residual[0]));
  check(VecAYPX(residual[0], -1, load[0]));
  const Columns correction = block_solve(ksp_, residual);
  double whole = 0, missing = 0;
  check(VecNorm(u[0], NORM_2, &whole));
  check(VecNorm(correction[0], NORM_2, &missing));
  if (!std::isfinite(missing)) throw too_fine(structure, "its stiffness has no factor in rounded numbers");
  return whole > 0 ? missing / whole : 0;
}

KSP Statics::solver() const {
  if (factor_error_ >= 0) return ksp_;
  factor_error_ = measured_error();
  if (refines()) {
    check(KSPSetOperators(ksp_, exact_, K_));
    iterate(ksp_, KSPCG);
    petsc::check_options(KSPSetFromOptions(ksp_), "derivatives_");
  }
  return ksp_;
}

Columns Statics::solve(const Columns& loads) const {
  Columns balanced;
  for (const auto& load : loads) {
    balanced.push_back(copy(load));
    fem::balance(frame_, balanced.back());
    fem::hold(balanced.back(), conditions_);
  }
  Columns u;
  const KSP ksp = solver();
  try {
    u = block_solve(ksp, balanced);
  } catch (const RunError&) {
    if (!refines()) throw;
    throw too_fine(elements_->structure(), "its static solutions do not converge");
  }
  for (const auto& column : u) fem::to_frame(frame_, column);
  return u;
}

Columns Statics::constraint_modes(const fem::Structure& structure, const std::vector<PetscInt>& dofs) const {
  if (dofs.empty()) return {};
  const petsc::MatHandle K = fem::stiffness(structure, {});
  Columns loads, units;
  for (PetscInt dof : dofs) {
    units.push_back(fem::field(structure));
    {
      petsc::Values unit(units.back());
      if (dof >= unit.first && dof < unit.end) unit[dof] = -1;
    }
    loads.push_back(fem::field(structure));
    check(MatMult(K, units.back(), loads.back()));
  }
  Columns modes = solve(loads);
  for (std::size_t i = 0; i < modes.size(); ++i) {
    fem::to_frame(frame_, units[i]);
    check(VecAXPY(modes[i], -1, units[i]));
  }
  return modes;
}

}  // namespace floe::reduction
