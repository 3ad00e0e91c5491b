#include "floe/reduction/statics.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "floe/fem/field_rows.h"
#include "floe/petsc/factorisation.h"
#include "floe/petsc/options.h"
#include "floe/petsc/stage.h"
#include "floe/petsc/values.h"
#include "multigrid.h"
#include "subdomains.h"

namespace floe::reduction {

using petsc::check;

bool holds_frame(const fem::ReferenceFrame& frame, const fem::Conditions& constrained) {
  return !frame.conditions.empty() &&
         std::includes(constrained.begin(), constrained.end(), frame.conditions.begin(), frame.conditions.end());
}

Statics::Statics(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding)
    : frame_(frame),
      conditions_(holding.statics),
      K_(fem::stiffness(structure, holding.statics)),
      elements_(std::make_shared<fem::ElementStiffness>(structure)),
      exact_(fem::stiffness_operator(elements_, holding.statics)),
      ksp_(direct_solver(K_, "derivatives_")) {
  petsc::refuse_preconditioner_alone(ksp_);
  if (factors(ksp_)) return;
  K_ = for_iteration(ksp_, {structure, frame, conditions_, 0, K_});
  check(KSPSetOperators(ksp_, K_, K_));
}

double Statics::factor_error() const {
  if (factor_error_ < 0) solver();
  return factor_error_;
}

void Statics::factor() const {
  const petsc::Stage stage("factorisation");
  check(KSPSetUp(ksp_));
  const petsc::FactorFault fault = petsc::factor_fault(ksp_);
  if (fault.singular) throw too_fine(elements_->structure(), "its stiffness matrix is singular");
  if (!fault.text.empty()) throw RunError(fault.text);
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
  if (!std::isfinite(missing)) throw too_fine(structure, "its stiffness matrix is singular to working precision");
  return whole > 0 ? missing / whole : 0;
}

KSP Statics::solver() const {
  if (factor_error_ >= 0) return ksp_;
  factor();
  factor_error_ = measured_error();
  if (iterates()) {
    check(KSPSetOperators(ksp_, exact_, K_));
    iterate(ksp_, KSPGMRES);
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
void exact_residual(const fem::ElementStiffness& K, const fem::Conditions& constrained, Mat loads, Mat u,
                    Mat residual) {
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
    fem::hold(column, constrained);
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
    if (left > 0.5 * before) break;
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

namespace {

/// X with K X = B for a tangent; nothing where it has no factor. @throws RunError  any other fault
std::optional<Columns> solve_tangent(Mat K, const Columns& B) {
  const petsc::KspHandle ksp = direct_solver(K, "derivatives_");
  const petsc::MatHandle loads = dense_of(B), X = dense_like(B[0], B.size());
  try {
    block_solve(ksp, loads, X);
  } catch (const RunError&) {
    if (petsc::factor_fault(ksp).text.empty()) throw;
    return {};
  }
  Columns u = columns_of(X);
  for (const auto& column : u) {
    double size = 0;
    check(VecNorm(column, NORM_INFINITY, &size));
    if (!std::isfinite(size)) return {};
  }
  return u;
}

/// The matrix of low rank by which P' K P differs from K: W C W', W = [f G, K Phi], C = [Phi'K Phi, -1; -1, 0], with
/// P = 1 - Phi (f G)'.
struct FrameTerms {
  Columns W;
  Eigen::MatrixXd C;
};

FrameTerms frame_terms(const fem::Structure& structure, const fem::ReferenceFrame& frame, Mat K) {
  const auto r = static_cast<Eigen::Index>(frame.rigid.size());
  const double length = fem::extent(structure);  // rotations as displacements
  const auto unit = [&](Eigen::Index i) { return i < structure.dimension() ? 1 : 1 / length; };
  FrameTerms terms;
  for (Eigen::Index j = 0; j < r; ++j) {
    terms.W.push_back(fem::field(structure));
    for (Eigen::Index i = 0; i < r; ++i)
      check(VecAXPY(terms.W[j], frame.inverse(j, i) / unit(j), frame.functionals[i]));
  }
  for (Eigen::Index j = 0; j < r; ++j) {
    terms.W.push_back(fem::field(structure));
    check(MatMult(K, frame.rigid[j], terms.W.back()));
    check(VecScale(terms.W.back(), unit(j)));
  }
  terms.C = Eigen::MatrixXd::Zero(2 * r, 2 * r);
  for (Eigen::Index i = 0; i < r; ++i)
    for (Eigen::Index j = 0; j < r; ++j) {
      check(VecDot(frame.rigid[i], terms.W[r + j], &terms.C(i, j)));
      terms.C(i, j) *= unit(i);
    }
  terms.C.topRightCorner(r, r).diagonal().setConstant(-1);
  terms.C.bottomLeftCorner(r, r).diagonal().setConstant(-1);
  return terms;
}

Eigen::MatrixXd dot_products(const Columns& a, const Columns& b) {
  const std::vector<Vec> bare(a.begin(), a.end());
  Eigen::MatrixXd values(static_cast<Eigen::Index>(a.size()), static_cast<Eigen::Index>(b.size()));
  for (std::size_t j = 0; j < b.size(); ++j)
    check(VecMDot(b[j], static_cast<PetscInt>(a.size()), bare.data(), values.col(static_cast<Eigen::Index>(j)).data()));
  return values;
}

/// u <- u - X (1 + C W'X)^-1 C W'u: of K's solutions those of K + W C W', X = K^-1 W.
void add_low_rank(const FrameTerms& terms, const Columns& X, const Columns& u) {
  const Eigen::Index n = terms.C.rows(), r = n / 2;
  const Eigen::MatrixXd WX = dot_products(terms.W, X), Wu = dot_products(terms.W, u);
  // the first half are forces, the second displacements: brought to one size
  const double stiffness = terms.C.topLeftCorner(r, r).cwiseAbs().maxCoeff();
  Eigen::VectorXd size = Eigen::VectorXd::Ones(n);
  if (stiffness > 0) size.head(r).setConstant(stiffness);
  const Eigen::MatrixXd A =
      size.cwiseInverse().asDiagonal() * (Eigen::MatrixXd::Identity(n, n) + terms.C * WX) * size.asDiagonal();
  const Eigen::MatrixXd y =
      size.asDiagonal() *
      Eigen::FullPivLU<Eigen::MatrixXd>(A).solve(size.cwiseInverse().asDiagonal() * (terms.C * Wu)).eval();
  const std::vector<Vec> bare(X.begin(), X.end());
  for (std::size_t j = 0; j < u.size(); ++j) {
    const Eigen::VectorXd weights = -y.col(static_cast<Eigen::Index>(j));
    check(VecMAXPY(u[j], static_cast<PetscInt>(n), weights.data(), const_cast<Vec*>(bare.data())));
  }
}

}  // namespace

Columns Statics::solve_bent(Vec q, const Columns& loads) const {
  if (loads.empty() || !factors(solver()) || iterates()) return {};
  const fem::Structure& structure = elements_->structure();
  const bool in_frame = holds_frame(frame_, conditions_);
  Columns all;
  for (const auto& load : loads) {
    all.push_back(copy(load));
    if (!in_frame) fem::balance(frame_, all.back());
  }
  FrameTerms terms;
  if (!in_frame) terms = frame_terms(structure, frame_, fem::tangent_stiffness(structure, {}, q));
  for (auto& column : terms.W) all.push_back(copy(column));
  for (const auto& column : all) fem::hold(column, conditions_);
  std::optional<Columns> found = solve_tangent(fem::tangent_stiffness(structure, conditions_, q), all);
  if (!found) return {};
  Columns X;
  std::move(found->begin() + std::ssize(loads), found->end(), std::back_inserter(X));
  found->resize(loads.size());
  if (in_frame) return std::move(*found);
  for (const auto& column : terms.W) fem::hold(column, conditions_);
  add_low_rank(terms, X, *found);
  finish(*found);
  return std::move(*found);
}

Columns Statics::displaced(const Columns& moved) const {
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
  for (std::size_t i = 0; i < modes.size(); ++i) check(VecAXPY(modes[i], 1, moved[i]));
  return modes;
}

Columns Statics::constraint_modes(const Columns& moved) const {
  Columns modes = displaced(moved);
  for (std::size_t i = 0; i < modes.size(); ++i) {
    double whole = 0, bent = 0;
    check(VecNorm(modes[i], NORM_2, &whole));
    fem::to_frame(frame_, modes[i]);
    check(VecNorm(modes[i], NORM_2, &bent));
    if (!(bent > 1e-9 * whole)) check(VecSet(modes[i], 0));
  }
  return modes;
}

}  // namespace floe::reduction
