#pragma once
#include <Eigen/Core>

/// Eigen's dense solvers, compiled once: each of them takes a file of tests ten to forty seconds.
namespace floe::testing {

/// Of a symmetric matrix, ascending.
Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& K);
/// K phi = lambda M phi of symmetric matrices, M positive definite; ascending.
Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M);
/// Their vectors, phi' M phi = 1, in columns.
Eigen::MatrixXd eigenvectors(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M);
/// Of any square matrix.
Eigen::VectorXcd complex_eigenvalues(const Eigen::MatrixXd& A);
/// A phi = lambda B phi of any square matrices.
Eigen::VectorXcd complex_eigenvalues(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

}  // namespace floe::testing
