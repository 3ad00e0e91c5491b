#include <algorithm>
#include <cmath>
#include <optional>

#include "at_base.h"
#include "floe/petsc/values.h"
#include "floe/solve/start.h"

namespace floe::solve {

using petsc::check;

namespace {

/// J <- D J D with rows of greatest entry one, which keeps symmetry and signs. Source: Ruiz 2001, RAL-TR-2001-034.
void scale_symmetrically(Mat J) {
  petsc::VecHandle D;
  check(MatCreateVecs(J, nullptr, D.out()));
  for (int sweep = 0; sweep < 10; ++sweep) {
    check(MatGetRowMaxAbs(J, D, nullptr));
    {
      petsc::Values d(D);
      for (PetscInt i = d.first; i < d.end; ++i) d[i] = d[i] > 0 ? 1 / std::sqrt(d[i]) : 1;
    }
    check(MatDiagonalScale(J, D, D));
  }
}

/// Of a scaled matrix: whether J - J' is round-off.
bool is_symmetric(Mat J) {
  petsc::MatHandle difference;
  double size = 0;
  check(MatTranspose(J, MAT_INITIAL_MATRIX, difference.out()));
  check(MatAXPY(difference, -1, J, DIFFERENT_NONZERO_PATTERN));
  check(MatNorm(difference, NORM_INFINITY, &size));
  return size <= 1e-9;
}

/// By MUMPS' LDL', whose inertia is complete without its parallel root (ICNTL(13)).
std::optional<int> negative_eigenvalues(Mat given) {
  petsc::MatHandle J, factor;
  MatFactorInfo info;
  check(MatConvert(given, MATAIJ, MAT_INITIAL_MATRIX, J.out()));
  check(MatSetOption(J, MAT_SYMMETRIC, PETSC_TRUE));
  check(MatGetFactor(J, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, factor.out()));
  check(MatMumpsSetIcntl(factor, 13, 1));
  check(MatFactorInfoInitialize(&info));
  check(MatCholeskyFactorSymbolic(factor, J, nullptr, &info));
  check(MatCholeskyFactorNumeric(factor, J, &info));
  PetscInt fault = 0, negative = 0;
  check(MatMumpsGetInfog(factor, 1, &fault));
  if (fault < 0) return {};
  check(MatMumpsGetInfog(factor, 12, &negative));
  return static_cast<int>(negative);
}

}  // namespace

std::optional<int> unstable_directions(const System& system, double t, Vec U, Vec V) {
  const AtBase at_base(system, U, V, t);
  const petsc::MatHandle J = system.create_tangent();
  const petsc::VecHandle A = system.create_vector();
  double size = 0;
  system.tangent(t, U, V, A, {1, 0, 0}, J);
  check(MatNorm(J, NORM_FROBENIUS, &size));
  if (!std::isfinite(size)) return {};
  scale_symmetrically(J);
  if (!is_symmetric(J)) return {};
  const std::optional<int> negative = negative_eigenvalues(J);
  if (!negative) return {};
  return std::max(0, *negative - static_cast<int>(system.coordinates().multiplier_count()));
}

}  // namespace floe::solve
