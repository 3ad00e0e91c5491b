#pragma once
#include <slepcbv.h>

#include <Eigen/Core>

/// Products of tall blocks of vectors with small dense matrices that all ranks have alike. All but normaliser() are
/// collective on the blocks; their active columns take part. They return PETSc's error codes, for use inside an EPS.
namespace floe::reduction::block_vectors {

/// Y <- Y + factor X A
PetscErrorCode add_product(BV Y, double factor, BV X, Eigen::MatrixXd& A);

/// W <- W A, for its columns from `first` on.
PetscErrorCode multiply(BV W, Eigen::MatrixXd& A, PetscInt first = 0);

/// A = X'Y
PetscErrorCode dot(BV X, BV Y, Eigen::MatrixXd& A);

/// T with T'G T = 1 up to the round-off of G, and R with T R = 1. Directions that a block W with W'W = G lacks, up to
/// round-off, have no row in R and a T of their scaled noise.
struct Normaliser {
  Eigen::MatrixXd T, R;
};

Normaliser normaliser(const Eigen::MatrixXd& G);

/// Columns of W that are zero on the diagonal of G become random ones, of which W had nothing: *some, and their rows of
/// R are zero.
PetscErrorCode replace_zeros(BV W, const Eigen::MatrixXd& G, Eigen::MatrixXd& R, bool* some);

}  // namespace floe::reduction::block_vectors
