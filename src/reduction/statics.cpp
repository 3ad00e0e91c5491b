#include "floe/reduction/statics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "floe/fem/field_rows.h"
#include "floe/petsc/factorisation.h"
#include "floe/petsc/stage.h"
#include "floe/petsc/values.h"
#include "multigrid.h"

namespace floe::reduction {

using petsc::check;

bool holds_frame(const fem::ReferenceFrame& frame, const fem::Conditions& held) {
  return !frame.conditions.empty() &&
         std::includes(held.begin(), held.end(), frame.conditions.begin(), frame.conditions.end());
}

namespace {

/// @throws InputError  the user's options leave a preconditioner alone
void check_solver(KSP ksp) {
  PC pc = nullptr;
  PetscBool direct = PETSC_FALSE;
  PCType preconditioner = nullptr;
  check(KSPGetPC(ksp, &pc));
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(ksp), KSPPREONLY, &direct));
  check(PCGetType(pc, &preconditioner));
  if (direct && !factors(ksp))
    throw InputError(
        fmt::format("option -derivatives_pc_type {}: is no solver by itself; expected a factorisation "
                    "(cholesky, lu), or an iteration besides (-derivatives_ksp_type cg)",
                    preconditioner));
}

}  // namespace

Statics::Statics(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding)
    : frame_(frame),
      conditions_(holding.statics),
      K_(fem::stiffness(structure, holding.statics)),
      elements_(std::make_shared<fem::ElementStiffness>(structure)),
      exact_(fem::stiffness_operator(elements_, holding.statics)),
      ksp_(direct_solver(K_, "derivatives_")) {
  check_solver(ksp_);
  if (factors(ksp_)) return;
  K_ = for_multigrid(K_, frame, conditions_);
  check(KSPSetOperators(ksp_, K_, K_));
}

double Statics::factor_error() const {
  if (factor_error_ < 0) solver();
  return factor_error_;
}

void Statics::factor() const {
  const petsc::Stage stage("factorisation");
  check(KSPSetUp(ksp_));
  if (const std::string why = petsc::why_failed(ksp_); !why.empty()) throw RunError(why);
}

double Statics::measured_error() const {
  const fem::Structure& structure = elements_->structure();
  Columns load;
  load.push_back(fem::field(structure));
  PetscInt first = 0, end = 0;
  double* values = nullptr;
  check(VecGetOwnershipRange(load[0], &first, &end));
  check(VecGetArrayWrite(load[0], &values));
  for (PetscInt i = 0; i < end - first; ++i)  // smooth, not balanced by rigid accelerations, the same on any ranks
    values[i] = i % structure.dofs_per_node >= structure.dimension()
                    ? 0
                    : std::cos(3. * double(structure.original_dof(static_cast<int>(i))) / double(structure.dofs()));
  check(VecRestoreArrayWrite(load[0], &values));
  fem::balance(frame_, load[0]);
  fem::hold(load[0], conditions_);
  const Columns u = block_solve(ksp_, load);
  Columns residual;
  residual.push_back(copy(load[0]));
  elements_->multiply(u[0], residual[0]);
  check(VecAYPX(residual[0], -1, load[0]));
  fem::hold(residual[0], conditions_);
  const Columns correction = block_solve(ksp_, residual);
  double whole = 0, missing = 0;
  check(VecNorm(u[0], NORM_2, &whole));
  check(VecNorm(correction[0], NORM_2, &missing));
  if (!std::isfinite(missing)) throw too_fine(structure, "its stiffness has no factor in rounded numbers");
  return whole > 0 ? missing / whole : 0;
}

KSP Statics::solver() const {
  if (factor_error_ >= 0) return ksp_;
  factor();
  factor_error_ = measured_error();
  if (iterates()) {
    check(KSPSetOperators(ksp_, exact_, K_));
    iterate(ksp_, KSPCG);
    petsc::check_options(KSPSetFromOptions(ksp_), "derivatives_");
  }
  return ksp_;
}

/// What a random combination of the solutions misses, of it: |K^-1 (f - K_exact u)| / |u|.
double Statics::missing(Mat loads, Mat solutions) const {
  Columns f, u, correction;
  f.push_back(fem::field(elements_->structure())), u.push_back(copy(f[0]));
  const petsc::VecHandle force = copy(f[0]);
  PetscInt count = 0;
  check(MatGetSize(loads, nullptr, &count));
  for (PetscInt j = 0; j < count; ++j) {
    Vec load = nullptr, solution = nullptr;
    double size = 0;
    check(MatDenseGetColumnVecRead(loads, j, &load));
    check(MatDenseGetColumnVecRead(solutions, j, &solution));
    check(VecNorm(solution, NORM_2, &size));
    const double weight = size > 0 ? std::sin(12.9898 * double(j + 1)) / size : 0;
    check(VecAXPY(f[0], weight, load));
    check(VecAXPY(u[0], weight, solution));
    check(MatDenseRestoreColumnVecRead(solutions, j, &solution));
    check(MatDenseRestoreColumnVecRead(loads, j, &load));
  }
  elements_->multiply(u[0], force);
  check(VecAXPY(f[0], -1, force));
  fem::hold(f[0], conditions_);
  correction = block_solve(ksp_, f);
  double whole = 0, left = 0;
  check(VecNorm(u[0], NORM_2, &whole));
  check(VecNorm(correction[0], NORM_2, &left));
  return whole > 0 ? left / whole : 0;
}

namespace {

/// residual = loads - K_exact u, in blocks. Collective.
void exact_residual(const fem::ElementStiffness& K, const fem::Conditions& held, Mat loads, Mat u, Mat residual) {
  const fem::Structure& structure = K.structure();
  PetscInt count = 0;
  check(MatGetSize(u, nullptr, &count));
  const fem::FieldRows X = fem::gather(structure, count, [&](Eigen::Index j, double* local) {
    Vec column = nullptr;
    check(MatDenseGetColumnVecRead(u, static_cast<PetscInt>(j), &column));
    structure.exchange.gather(column, local);
    check(MatDenseRestoreColumnVecRead(u, static_cast<PetscInt>(j), &column));
  });
  fem::FieldRows sums = fem::FieldRows::Zero(X.rows(), X.cols());
  K.add_forces(X, sums);
  check(MatZeroEntries(residual));
  fem::add(structure, sums, residual);
  check(MatAYPX(residual, -1, loads, SAME_NONZERO_PATTERN));
  for (PetscInt j = 0; j < count; ++j) {
    Vec column = nullptr;
    check(MatDenseGetColumnVec(residual, j, &column));
    fem::hold(column, held);
    check(MatDenseRestoreColumnVec(residual, j, &column));
  }
}

}  // namespace

/// Corrects u with the exact K until nothing misses, or what misses is round-off of the correction itself.
void Statics::correct(Mat loads, Mat u) const {
  const fem::Structure& structure = elements_->structure();
  PetscInt count = 0;
  check(MatGetSize(loads, nullptr, &count));
  double left = missing(loads, u);
  while (left > 1e-10) {
    const petsc::MatHandle residual = dense_like(fem::field(structure), count),
                           more = dense_like(fem::field(structure), count);
    exact_residual(*elements_, conditions_, loads, u, residual);
    block_solve(ksp_, residual, more);
    check(MatAXPY(u, 1, more, SAME_NONZERO_PATTERN));
    const double before = left;
    left = missing(loads, u);
    if (left > 0.1 * before) break;
  }
  // forces of the exact K are rounded, too: of thin folds eps (L/h)^2 (L/r)^2, which is 1e-5 at r/L = 1e-6
  if (!(left < 1e-4)) throw too_fine(structure, "its static solutions do not converge");
}

/// u with K u = loads; where round-off touches the factor, corrected with the exact K until nothing misses.
Columns Statics::corrected(petsc::MatHandle loads) const {
  const KSP ksp = solver();
  const fem::Structure& structure = elements_->structure();
  PetscInt count = 0;
  check(MatGetSize(loads, nullptr, &count));
  const petsc::MatHandle u = dense_like(fem::field(structure), count);
  try {
    block_solve(ksp, loads, u);
  } catch (const RunError&) {
    if (!refines()) throw;
    throw too_fine(structure, "its static solutions do not converge");
  }
  if (refines() && !iterates()) correct(loads, u);
  loads = petsc::MatHandle();
  return columns_of(u);
}

Columns Statics::solve(const Columns& loads) const {
  if (loads.empty()) return {};
  return solve(dense_of(loads));
}

/// P' f of each column, under the conditions.
void Statics::prepare(Mat loads) const {
  const bool in_frame = holds_frame(frame_, conditions_);
  PetscInt count = 0;
  check(MatGetSize(loads, nullptr, &count));
  for (PetscInt j = 0; j < count; ++j) {
    Vec column = nullptr;
    check(MatDenseGetColumnVec(loads, j, &column));
    if (!in_frame) fem::balance(frame_, column);
    fem::hold(column, conditions_);
    check(MatDenseRestoreColumnVec(loads, j, &column));
  }
}

/// P u.
void Statics::finish(const Columns& u) const {
  if (holds_frame(frame_, conditions_)) return;
  for (const auto& column : u) fem::to_frame(frame_, column);
}

Columns Statics::solve(petsc::MatHandle loads) const {
  prepare(loads);
  Columns u = corrected(std::move(loads));
  finish(u);
  return u;
}

Columns Statics::solve_bent(Vec q, const Columns& loads) const {
  if (loads.empty() || !factors(solver()) || iterates()) return {};
  const petsc::MatHandle K = fem::tangent_stiffness(elements_->structure(), conditions_, q), B = dense_of(loads),
                         X = dense_like(loads[0], loads.size());
  const petsc::KspHandle ksp = direct_solver(K, "estimate_");
  prepare(B);
  try {
    block_solve(ksp, B, X);
  } catch (const RunError&) {
    return {};
  }
  Columns u = columns_of(X);
  for (const auto& column : u) {
    double size = 0;
    check(VecNorm(column, NORM_INFINITY, &size));
    if (!std::isfinite(size)) return {};
  }
  finish(u);
  return u;
}

Columns Statics::constraint_modes(const Columns& moved) const {
  if (moved.empty()) return {};
  const fem::Structure& structure = elements_->structure();
  Columns loads, modes;
  for (const auto& shape : moved) {
    loads.push_back(fem::field(structure));
    elements_->multiply(shape, loads.back());
    check(VecScale(loads.back(), -1));
    fem::hold(loads.back(), conditions_);
  }
  modes = corrected(dense_of(loads));
  for (std::size_t i = 0; i < modes.size(); ++i) {
    double whole = 0, bent = 0;
    check(VecAXPY(modes[i], 1, moved[i]));
    check(VecNorm(modes[i], NORM_2, &whole));
    fem::to_frame(frame_, modes[i]);
    check(VecNorm(modes[i], NORM_2, &bent));
    if (!(bent > 1e-9 * whole)) check(VecSet(modes[i], 0));
  }
  return modes;
}

}  // namespace floe::reduction
