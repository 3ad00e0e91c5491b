#pragma once
#include <Eigen/Dense>
#include <algorithm>
#include <complex>
#include <numeric>
#include <vector>

#include "eigenvalues.h"
#include "scene_motion.h"

namespace floe::test {

/// d(residual)/d(q, v or a) of a system as a dense matrix, on every rank. Collective.
inline Eigen::MatrixXd dense_tangent(const dynamics::System& system, Vec U, Vec V, dynamics::Weights weights) {
  const petsc::MatHandle J = system.create_tangent();
  const petsc::VecHandle A = system.create_vector();
  system.tangent(0, U, V, A, weights, J);
  const PetscInt n = system.coordinates().global_size();
  std::vector<PetscInt> all(n);
  std::iota(all.begin(), all.end(), 0);
  PetscInt first = 0, end = 0;
  petsc::check(MatGetOwnershipRange(J, &first, &end));
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows(n, n);
  rows.setZero();
  petsc::check(MatGetValues(J, end - first, all.data() + first, n, all.data(), rows.data() + first * n));
  MPI_Allreduce(MPI_IN_PLACE, rows.data(), static_cast<int>(rows.size()), MPI_DOUBLE, MPI_SUM, system.comm());
  return rows;
}

/// Exponents s of small motions e^(st) about a steady motion: (s^2 M + s C + K) x = 0 with C_q x = 0.
///
/// Constraints are met by x = Z y, Z an orthonormal basis of the null space of their gradient. Coordinates that a frame
/// holds at zero (rows that do not depend on the weights) are left out.
inline std::vector<std::complex<double>> characteristic_exponents(const dynamics::System& system, Vec U, Vec V) {
  const Eigen::MatrixXd K = dense_tangent(system, U, V, {1, 0, 0}), C = dense_tangent(system, U, V, {0, 1, 0}),
                        M = dense_tangent(system, U, V, {0, 0, 1});
  const std::vector<PetscInt> constrained = multipliers(system);
  std::vector<Eigen::Index> free, multipliers;
  for (Eigen::Index i = 0; i < K.rows(); ++i) {
    const bool unused = K.row(i) == C.row(i) && K.row(i) == M.row(i);
    if (std::binary_search(constrained.begin(), constrained.end(), static_cast<PetscInt>(i)))
      multipliers.push_back(i);
    else if (!unused)
      free.push_back(i);
  }
  const Eigen::MatrixXd G = K(multipliers, free);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(G.transpose());
  const Eigen::MatrixXd Q = qr.householderQ();
  const Eigen::Index n = static_cast<Eigen::Index>(free.size() - multipliers.size());
  const Eigen::MatrixXd Z = Q.rightCols(n);
  const Eigen::LDLT<Eigen::MatrixXd> mass(Z.transpose() * M(free, free) * Z);
  Eigen::MatrixXd first_order = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  first_order.topRightCorner(n, n).setIdentity();
  first_order.bottomLeftCorner(n, n) = -mass.solve(Z.transpose() * K(free, free) * Z);
  first_order.bottomRightCorner(n, n) = -mass.solve(Z.transpose() * C(free, free) * Z);
  const Eigen::VectorXcd s = testing::complex_eigenvalues(first_order);
  return {s.data(), s.data() + s.size()};
}

/// Angular frequencies of the exponents that swing faster than `least`, ascending.
inline std::vector<double> oscillations(const std::vector<std::complex<double>>& exponents, double least = 0.1) {
  std::vector<double> omega;
  for (const auto& s : exponents)
    if (s.imag() > least) omega.push_back(s.imag());
  std::sort(omega.begin(), omega.end());
  return omega;
}

}  // namespace floe::test
