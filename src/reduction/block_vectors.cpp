#include "block_vectors.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace floe::reduction::block_vectors {
namespace {

// A view of dense numbers that all ranks have alike.
PetscErrorCode view(Eigen::MatrixXd& A, Mat* matrix) {
  PetscFunctionBegin;
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, A.rows(), A.cols(), A.data(), matrix));
  PetscFunctionReturn(0);
}

}  // namespace

PetscErrorCode add_product(BV Y, double factor, BV X, Eigen::MatrixXd& A) {
  Mat matrix;

  PetscFunctionBegin;
  PetscCall(view(A, &matrix));
  PetscCall(BVMult(Y, factor, 1, X, matrix));
  PetscCall(MatDestroy(&matrix));
  PetscFunctionReturn(0);
}

PetscErrorCode multiply(BV W, Eigen::MatrixXd& A, PetscInt first) {
  Mat matrix;

  PetscFunctionBegin;
  PetscCall(view(A, &matrix));
  PetscCall(BVMultInPlace(W, matrix, first, static_cast<PetscInt>(A.cols())));
  PetscCall(MatDestroy(&matrix));
  PetscFunctionReturn(0);
}

PetscErrorCode dot(BV X, BV Y, Eigen::MatrixXd& A) {
  PetscInt rows, columns;
  Mat matrix;

  PetscFunctionBegin;
  PetscCall(BVGetActiveColumns(X, nullptr, &rows));
  PetscCall(BVGetActiveColumns(Y, nullptr, &columns));
  A.setZero(rows, columns);
  if (rows == 0) PetscFunctionReturn(0);
  PetscCall(view(A, &matrix));
  PetscCall(BVDot(Y, X, matrix));
  PetscCall(MatDestroy(&matrix));
  PetscFunctionReturn(0);
}

Normaliser normaliser(const Eigen::MatrixXd& G) {
  const Eigen::Index b = G.cols();
  const Eigen::VectorXd size = G.diagonal().cwiseMax(0).cwiseSqrt();
  const Eigen::VectorXd inverse = (size.array() > 0).select(size.cwiseInverse(), 0);
  const Eigen::MatrixXd scaled = inverse.asDiagonal() * (G + G.transpose()) / 2 * inverse.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> pairs(scaled);
  const double least = 1e-15 * double(b) * std::max(pairs.eigenvalues()[b - 1], 1e-300);
  const Eigen::VectorXd root = pairs.eigenvalues().cwiseMax(least).cwiseSqrt();
  const Eigen::MatrixXd& Q = pairs.eigenvectors();
  return {inverse.asDiagonal() * Q * root.cwiseInverse().asDiagonal(),
          root.asDiagonal() * Q.transpose() * size.asDiagonal()};
}

PetscErrorCode replace_zeros(BV W, const Eigen::MatrixXd& G, Eigen::MatrixXd& R, bool* some) {
  PetscFunctionBegin;
  *some = false;
  for (Eigen::Index j = 0; j < G.cols(); ++j) {
    if (G(j, j) > 0) continue;
    PetscCall(BVSetRandomColumn(W, static_cast<PetscInt>(j)));
    R.row(j).setZero();
    *some = true;
  }
  PetscFunctionReturn(0);
}

}  // namespace floe::reduction::block_vectors
