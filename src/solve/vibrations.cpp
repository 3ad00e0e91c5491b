#include <fmt/format.h>
#include <slepcpep.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "exponents.h"
#include "floe/petsc/options.h"
#include "floe/solve/steady_rotation.h"
#include "null_space.h"

namespace floe::solve {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using petsc::check;

namespace {

using PepHandle = petsc::Handle<PEP, PEPDestroy>;

petsc::MatHandle dense(const MatrixXd& X) {
  petsc::MatHandle mat;
  double* values = nullptr;
  check(MatCreateSeqDense(PETSC_COMM_SELF, X.rows(), X.cols(), nullptr, mat.out()));
  check(MatDenseGetArrayWrite(mat, &values));
  std::copy(X.data(), X.data() + X.size(), values);
  check(MatDenseRestoreArrayWrite(mat, &values));
  check(MatAssemblyBegin(mat, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(mat, MAT_FINAL_ASSEMBLY));
  return mat;
}

VectorXd entries_of(Vec x) {
  PetscInt n = 0;
  const double* values = nullptr;
  check(VecGetLocalSize(x, &n));
  check(VecGetArrayRead(x, &values));
  VectorXd copy = Eigen::Map<const VectorXd>(values, n);
  check(VecRestoreArrayRead(x, &values));
  return copy;
}

/// Greatest |K_ii| / M_ii, the square of about the highest frequency.
double fastest(const Quadratic& problem) {
  double greatest = 0;
  for (Index i = 0; i < problem.K.rows(); ++i)
    if (problem.M(i, i) > 0) greatest = std::max(greatest, std::abs(problem.K(i, i)) / problem.M(i, i));
  return greatest;
}

/// Frequencies that are zero but for round-off: a double zero of a matrix with errors of eps |K| splits by the root.
double noise_of(const Quadratic& problem) {
  return 4 * std::sqrt(std::numeric_limits<double>::epsilon()) * std::sqrt(fastest(problem));
}

/// Of so many first vibrations, about: inverse iteration with a block, without C.
double typical_of(const Quadratic& problem, Index block) {
  const Index n = problem.K.rows();
  const MatrixXd K = (problem.K + problem.K.transpose()) / 2, M = (problem.M + problem.M.transpose()) / 2;
  const Eigen::PartialPivLU<MatrixXd> factor(K + 1e-13 * fastest(problem) * M);
  MatrixXd X(n, block);
  for (Index j = 0; j < block; ++j)
    for (Index i = 0; i < n; ++i)
      X(i, j) = std::sin(1 + 1.7 * static_cast<double>(i) + 2.3 * static_cast<double>(j * i));
  for (int sweep = 0; sweep < 4; ++sweep) {
    X = factor.solve(M * X);
    if (!X.allFinite()) return 0;
    X = Eigen::HouseholderQR<MatrixXd>(X).householderQ() * MatrixXd::Identity(n, block);
  }
  const VectorXd squares =
      Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(X.transpose() * K * X, X.transpose() * M * X).eigenvalues();
  const double middle = std::sqrt(std::abs(squares[block / 2]));
  return std::isfinite(middle) ? middle : 0;
}

/// About the frequency of the slower ones of the first vibrations; those of free motions, which are none, do not count.
/// 0: there are no others.
double typical(const Quadratic& problem) {
  const Index n = problem.K.rows();
  for (Index block = std::min<Index>(6, n);; block = std::min(2 * block, n)) {
    const double found = typical_of(problem, block);
    if (found > noise_of(problem)) return found;
    if (block == n) return 0;
  }
}

Quadratic on(const AllowedMotions& allowed, const RotatingTangent& at) {
  return {allowed.restrict_both(MatrixXd(at.M)), allowed.restrict_both(MatrixXd(at.C)),
          allowed.restrict_both(MatrixXd(at.K))};
}

/// Scales coordinates until round-off of the stiffest does not reach the slow vibrations: those on coordinates of unit
/// mass have errors of eps K_ii / M_ii in their squares, those on coordinates of unit K_ii / w^2 + M_ii of eps w^2.
/// @return  w, typical of the slow vibrations, or the speed
double resolve(const RotatingTangent& at, double speed, AllowedMotions& allowed, Quadratic& problem) {
  constexpr double wanted = 1e-9;
  constexpr double round_off = 1e-18;  // of the greatest stiffness
  const VectorXd mass = VectorXd(at.M.diagonal()).cwiseMax(0);
  VectorXd stiffness = VectorXd(at.K.diagonal()).cwiseAbs();
  for (Index i = 0; i < mass.size(); ++i)  // of axes that follow others (a place of several nodes)
    if (mass[i] == 0 && stiffness[i] < round_off * stiffness.maxCoeff()) stiffness[i] = 0;
  double fast = fastest(problem), swing = std::max(typical(problem), speed);
  while (std::numeric_limits<double>::epsilon() * fast > wanted * swing * swing && swing > 0) {
    fast = swing * swing;
    allowed.rescale((mass + stiffness / fast).cwiseSqrt());
    problem = on(allowed, at);
    swing = std::max(typical(problem), speed);
  }
  return swing;
}

/// All exponents s of (s^2 M + s C + K) y = 0, by its linearisation in (y, s y / shift), shifted and inverted:
///
///   T = [-P (C' + M'), -P M'; I - P (C' + M'), -P M'],  C' = shift C, M' = shift^2 M, P = (K + C' + M')^-1
///
/// with eigenvalues 1 / (s / shift - 1): the slow ones are the greatest, and round-off is small beside them. Those that
/// it reaches to a ten-thousandth are far faster than the first, and are left out: they would come as growth.
Exponents all_exponents(const Quadratic& problem, double shift) {
  const Index n = problem.K.rows();
  const MatrixXd M = shift * shift * problem.M, CM = shift * problem.C + M;
  const Eigen::PartialPivLU<MatrixXd> P(problem.K + CM);
  MatrixXd T(2 * n, 2 * n);
  T.topLeftCorner(n, n) = T.bottomLeftCorner(n, n) = -P.solve(CM);
  T.topRightCorner(n, n) = T.bottomRightCorner(n, n) = -P.solve(M);
  T.bottomLeftCorner(n, n) += MatrixXd::Identity(n, n);
  const Eigen::EigenSolver<MatrixXd> solver(T, false);
  if (!T.allFinite() || solver.info() != Eigen::Success) throw RunError("vibrations not found: no finite eigenvalues");
  Exponents found;
  const double least = 1e4 * std::numeric_limits<double>::epsilon() * static_cast<double>(n) * T.norm();
  for (const std::complex<double>& theta : solver.eigenvalues())
    if (std::abs(theta) > least) found.push_back(shift * (1.0 + 1.0 / theta));
  return found;
}

/// Those nearest to `shift` > 0, which for swings are the slowest; solved for s / shift, so that a linearisation's
/// halves weigh alike.
/// @param y  their eigenvectors, n x as many
Exponents first_exponents(const Quadratic& problem, double shift, int count, Eigen::MatrixXcd& y) {
  const PetscInt n = static_cast<PetscInt>(problem.K.rows());
  const petsc::MatHandle K = dense(problem.K), C = dense(shift * problem.C), M = dense(shift * shift * problem.M);
  Mat all[3] = {K, C, M};
  PepHandle pep;
  ST st = nullptr;
  check(PEPCreate(PETSC_COMM_SELF, pep.out()));
  check(PEPSetOptionsPrefix(pep, "campbell_"));
  check(PEPSetOperators(pep, 3, all));
  check(PEPSetType(pep, PEPTOAR));
  check(PEPGetST(pep, &st));
  check(STSetType(st, STSINVERT));
  check(PEPSetTarget(pep, 1));
  check(PEPSetWhichEigenpairs(pep, PEP_TARGET_MAGNITUDE));
  check(PEPSetDimensions(pep, std::min<PetscInt>(2 * count + 8, n), PETSC_DEFAULT, PETSC_DEFAULT));
  check(PEPSetTolerances(pep, 1e-11, 1000));
  petsc::check_options(PEPSetFromOptions(pep), "campbell_");
  check(PEPSolve(pep));
  PEPConvergedReason reason = PEP_CONVERGED_ITERATING;
  PetscInt converged = 0;
  check(PEPGetConvergedReason(pep, &reason));
  check(PEPGetConverged(pep, &converged));
  if (reason < 0 && converged < 2 * count)
    throw RunError(fmt::format("vibrations not found (options -campbell_pep_...): {}, {} converged",
                               PEPConvergedReasons[reason], converged));
  Exponents found(converged);
  y.resize(n, converged);
  petsc::VecHandle real, imaginary;
  check(MatCreateVecs(K, real.out(), imaginary.out()));
  for (PetscInt i = 0; i < converged; ++i) {
    double re = 0, im = 0;
    check(PEPGetEigenpair(pep, i, &re, &im, real, imaginary));
    found[i] = {shift * re, shift * im};
    y.col(i).real() = entries_of(real), y.col(i).imag() = entries_of(imaginary);
  }
  return found;
}

}  // namespace

std::vector<Vibration> vibrations(const RotatingSystem& rotating, double speed, Vec U, int count) {
  const RotatingTangent at = rotating_tangent(rotating, speed, U);
  AllowedMotions allowed(rotating.system, at, mass_scale(rotating, at.M).root);
  if (allowed.size() == 0) return {};
  Quadratic problem = on(allowed, at);
  const double swing = resolve(at, std::abs(speed), allowed, problem);
  const double scale = swing > 0 ? swing : 1;
  const double noise = std::clamp(noise_of(problem), 1e-6 * scale, 1e-2 * scale);
  constexpr Index small = 150;
  Eigen::MatrixXcd vectors;
  const double shift = 0.8 * scale;  // the typical frequency itself may be a growth: s^2 M + s C + K would be singular
  const Exponents found = allowed.size() <= small && !petsc::user_sets("campbell_")
                              ? all_exponents(problem, shift)
                              : first_exponents(problem, shift, count, vectors);
  std::vector<Vibration> slowest = slowest_vibrations(problem, found, noise, 1e-6 * scale, count);
  const Eigen::MatrixXcd y = vectors.size() > 0 ? shapes(problem, slowest, found, vectors) : shapes(problem, slowest);
  for (std::size_t i = 0; i < slowest.size(); ++i) {
    const Eigen::VectorXcd own = y.col(static_cast<Index>(i));
    if (own.isZero(0)) continue;
    slowest[i].shape.resize(at.M.rows());
    slowest[i].shape.real() = allowed.expand(own.real(), at.M.rows());
    slowest[i].shape.imag() = allowed.expand(own.imag(), at.M.rows());
    slowest[i].momentum.resize(at.M.rows());
    slowest[i].momentum.real() = at.M * slowest[i].shape.real();
    slowest[i].momentum.imag() = at.M * slowest[i].shape.imag();
  }
  return slowest;
}

}  // namespace floe::solve
