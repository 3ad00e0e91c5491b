#include "undetermined.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <numeric>

#include "at_base.h"
#include "floe/dynamics/start.h"

namespace floe::dynamics {
namespace {

using petsc::check;

/// The whole matrix on every rank. Collective.
Eigen::MatrixXd everywhere(Mat J) {
  PetscInt n = 0;
  check(MatGetSize(J, &n, nullptr));
  petsc::IsHandle all;
  check(ISCreateStride(PETSC_COMM_SELF, n, 0, 1, all.out()));
  Mat* part = nullptr;
  IS rows = all;
  check(MatCreateSubMatrices(J, 1, &rows, &rows, MAT_INITIAL_MATRIX, &part));
  Eigen::MatrixXd dense(n, n);
  std::vector<PetscInt> index(n);
  std::iota(index.begin(), index.end(), 0);
  check(MatGetValues(part[0], n, index.data(), n, index.data(), dense.data()));
  check(MatDestroySubMatrices(1, &part));
  return dense.transpose();  // values come row by row
}

/// D_1 J D_2 with rows and columns of greatest entry one. Source: Ruiz 2001, RAL-TR-2001-034.
Eigen::MatrixXd scaled(Eigen::MatrixXd J) {
  const auto root = [](double greatest) { return greatest > 0 ? 1 / std::sqrt(greatest) : 1.0; };
  for (int sweep = 0; sweep < 10; ++sweep) {
    const Eigen::VectorXd left = J.cwiseAbs().rowwise().maxCoeff().unaryExpr(root),
                          right = J.cwiseAbs().colwise().maxCoeff().transpose().unaryExpr(root);
    J = (left.asDiagonal() * J * right.asDiagonal()).eval();
  }
  return J;
}

}  // namespace

int unstable_directions(const System& system, double t, Vec U, Vec V) {
  const Coordinates& coordinates = system.coordinates();
  if (coordinates.global_size() > 500) return 0;
  const AtBase at_base(system, U);
  const petsc::MatHandle J = system.create_tangent();
  const petsc::VecHandle A = system.create_vector();
  system.tangent(t, U, V, A, {1, 0, 0}, J);
  Eigen::MatrixXd K = everywhere(J);
  if (!K.allFinite()) return 0;
  K = (K + K.transpose()).eval() / 2;
  const auto root = [](double greatest) { return greatest > 0 ? 1 / std::sqrt(greatest) : 1.0; };
  for (int sweep = 0; sweep < 10; ++sweep) {  // D K D has the signs of K
    const Eigen::VectorXd D = K.cwiseAbs().rowwise().maxCoeff().unaryExpr(root);
    K = (D.asDiagonal() * K * D.asDiagonal()).eval();
  }
  const Eigen::VectorXd signs = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K, Eigen::EigenvaluesOnly).eigenvalues();
  const int negative = static_cast<int>((signs.array() < -1e-10 * signs.cwiseAbs().maxCoeff()).count());
  return std::max(0, negative - static_cast<int>(coordinates.multiplier_count()));
}

std::string undetermined(const System& system, Mat J) {
  const Coordinates& coordinates = system.coordinates();
  const std::vector<std::string>& owners = coordinates.owners();
  if (owners.empty() || coordinates.global_size() > 1000) return "";
  const Eigen::MatrixXd dense = everywhere(J);
  if (!dense.allFinite()) return "";
  const Eigen::MatrixXd J_scaled = scaled(dense);
  const Eigen::VectorXd pivots = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(J_scaled).matrixQR().diagonal().cwiseAbs();
  const double nothing = 1e-15 * static_cast<double>(dense.rows()) * pivots.maxCoeff();  // slender bodies come near it
  if (pivots.minCoeff() > nothing) return "";
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(J_scaled, Eigen::ComputeFullV);
  const Eigen::VectorXd& size = svd.singularValues();
  std::vector<double> share(owners.size(), 0);
  const std::vector<int> owner = coordinates.owner_of_local();
  std::vector<char> counted(dense.rows(), 0);
  for (std::size_t i = 0; i < owner.size(); ++i) {
    const PetscInt global = coordinates.global()[i];
    if (owner[i] < 0 || counted[global]) continue;
    counted[global] = 1;
    for (Eigen::Index v = 0; v < size.size(); ++v)
      if (size[v] <= std::max(10 * nothing, 1.001 * size.minCoeff()))
        share[owner[i]] = std::max(share[owner[i]], std::abs(svd.matrixV()(global, v)));
  }
  MPI_Allreduce(MPI_IN_PLACE, share.data(), static_cast<int>(share.size()), MPI_DOUBLE, MPI_MAX, system.comm());
  std::vector<std::string> named;
  for (std::size_t o = 0; o < owners.size(); ++o)
    if (share[o] > 1e-3) named.push_back(owners[o]);
  return named.empty() ? "" : fmt::format(" ({})", fmt::join(named, ", "));
}

}  // namespace floe::dynamics
