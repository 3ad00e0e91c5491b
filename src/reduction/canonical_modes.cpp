#include "canonical_modes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "floe/petsc/values.h"

namespace floe::reduction {

using petsc::check;

namespace {

/// This rank's rows of the columns [first, end).
Eigen::MatrixXd rows_of(const Columns& phi, int first, int end) {
  petsc::Values size(phi[first]);
  Eigen::MatrixXd rows(size.end - size.first, end - first);
  for (int j = first; j < end; ++j) {
    petsc::Values values(phi[j]);
    rows.col(j - first) = Eigen::Map<const Eigen::VectorXd>(values.begin(), rows.rows());
  }
  return rows;
}

/// phi'M phi of the columns [first, end).
Eigen::MatrixXd gram(Mat M, const Columns& phi, int first, int end) {
  const petsc::VecHandle product = copy(phi[first]);
  Eigen::MatrixXd G(end - first, end - first);
  for (int i = first; i < end; ++i) {
    check(MatMult(M, phi[i], product));
    for (int j = first; j < end; ++j) check(VecDot(phi[j], product, &G(i - first, j - first)));
  }
  return (G + G.transpose()) / 2;
}

/// The pivot's row. `rows` are of an orthonormal basis, those of this rank.
Eigen::VectorXd pivot_row(const fem::Structure& structure, const Eigen::MatrixXd& rows) {
  const int n = structure.dofs_per_node;
  const Eigen::VectorXd size = rows.rowwise().norm();
  const auto translation = [&](Eigen::Index i) { return i % n < structure.dimension(); };
  double greatest = 0;
  for (Eigen::Index i = 0; i < size.size(); ++i)
    if (translation(i)) greatest = std::max(greatest, size[i]);
  MPI_Allreduce(MPI_IN_PLACE, &greatest, 1, MPI_DOUBLE, MPI_MAX, structure.mesh.comm);
  PetscInt mine = PETSC_MAX_INT;
  Eigen::VectorXd row = Eigen::VectorXd::Zero(rows.cols());
  for (Eigen::Index i = 0; i < size.size(); ++i) {
    const PetscInt dof = structure.original_dof(static_cast<int>(i));
    if (translation(i) && dof < mine && size[i] > 0.5 * greatest) mine = dof, row = rows.row(i);
  }
  PetscInt lowest = mine;
  MPI_Allreduce(MPI_IN_PLACE, &lowest, 1, MPIU_INT, MPI_MIN, structure.mesh.comm);
  if (mine != lowest) row.setZero();
  MPI_Allreduce(MPI_IN_PLACE, row.data(), static_cast<int>(row.size()), MPI_DOUBLE, MPI_SUM, structure.mesh.comm);
  return row;
}

/// Orthogonal, its first column along `row`.
Eigen::MatrixXd leading_with(const Eigen::VectorXd& row) {
  const Eigen::Index c = row.size();
  Eigen::MatrixXd Q = Eigen::HouseholderQR<Eigen::MatrixXd>(row).householderQ() * Eigen::MatrixXd::Identity(c, c);
  if (Q.col(0).dot(row) < 0) Q.col(0) *= -1;
  return Q;
}

}  // namespace

std::vector<std::pair<int, int>> clusters(const std::vector<double>& lambda) {
  std::vector<std::pair<int, int>> runs;
  const int count = static_cast<int>(lambda.size());
  for (int first = 0, end = 0; first < count; first = end) {
    for (end = first + 1; end < count && std::abs(lambda[end] - lambda[end - 1]) <= 1e-8 * lambda[end];) ++end;
    runs.push_back({first, end});
  }
  return runs;
}

void make_canonical(const fem::Structure& structure, Mat M, Columns& phi, std::vector<double>& lambda) {
  for (const auto& [first, end] : clusters(lambda)) {
    const int c = end - first;
    if (c == 1) continue;
    const Eigen::MatrixXd L = Eigen::LLT<Eigen::MatrixXd>(gram(M, phi, first, end)).matrixL();
    Eigen::MatrixXd T = L.transpose().triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(c, c));
    const Eigen::MatrixXd given = rows_of(phi, first, end);
    for (int k = 0; k + 1 < c; ++k) {
      const Eigen::VectorXd row = pivot_row(structure, given * T.rightCols(c - k));
      if (row.norm() > 0) T.rightCols(c - k) = (T.rightCols(c - k) * leading_with(row)).eval();
    }
    const Eigen::MatrixXd combined = given * T;
    const Eigen::VectorXd values = Eigen::Map<const Eigen::VectorXd>(lambda.data() + first, c);
    for (int j = 0; j < c; ++j) {
      petsc::Values column(phi[first + j]);
      std::copy(combined.col(j).data(), combined.col(j).data() + combined.rows(), column.begin());
      const Eigen::VectorXd weights = T.col(j).array().square();
      lambda[first + j] = weights.dot(values) / weights.sum();
    }
  }
}

}  // namespace floe::reduction
