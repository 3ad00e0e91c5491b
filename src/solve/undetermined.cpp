#include "undetermined.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>

#include "floe/solve/start.h"
#include "gather_to_all.h"

namespace floe::solve {
namespace {

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

/// For each row of J on this rank or another: whether it is of a multiplier. Collective.
std::vector<char> multiplier_rows(const System& system) {
  std::vector<char> is(system.coordinates().global_size(), 0);
  for (PetscInt row : system.coordinates().owned_multipliers()) is[row] = 1;
  MPI_Allreduce(MPI_IN_PLACE, is.data(), static_cast<int>(is.size()), MPI_CHAR, MPI_MAX, system.comm());
  return is;
}

/// Owners whose share, the greatest of any rank, is more than a thousandth.
std::string names_of(const System& system, std::vector<double> share) {
  MPI_Allreduce(MPI_IN_PLACE, share.data(), static_cast<int>(share.size()), MPI_DOUBLE, MPI_MAX, system.comm());
  std::vector<std::string> named;
  for (std::size_t o = 0; o < share.size(); ++o)
    if (const std::string& owner = system.coordinates().owners()[o];
        share[o] > 1e-3 && std::find(named.begin(), named.end(), owner) == named.end())
      named.push_back(owner);
  return named.empty() ? "" : fmt::format(" ({})", fmt::join(named, ", "));
}

/// Who takes part in the null vectors N (orthonormal columns) with unknowns of one kind.
std::string names_of(const System& system, const Eigen::MatrixXd& N, const std::vector<char>& multiplier, bool kind) {
  const Coordinates& coordinates = system.coordinates();
  std::vector<double> share(coordinates.owners().size(), 0);
  const std::vector<int> owner = coordinates.owner_of_local();
  for (std::size_t i = 0; i < owner.size(); ++i) {
    const PetscInt global = coordinates.global()[i];
    if (owner[i] >= 0 && (multiplier[global] != 0) == kind)
      share[owner[i]] = std::max(share[owner[i]], N.row(global).cwiseAbs().maxCoeff());
  }
  return names_of(system, std::move(share));
}

/// How many of the last vectors J, of greatest entries one, maps to round-off of the terms of J v: what is constrained,
/// however softly, is more.
Eigen::Index true_null_vectors(const Eigen::MatrixXd& J, const Eigen::MatrixXd& vectors) {
  constexpr double several = 128 * PETSC_MACHINE_EPSILON;
  Eigen::Index count = 0;
  for (Eigen::Index i = vectors.cols() - 1; i >= 0; --i, ++count) {
    const double terms = std::max(1.0, (J.cwiseAbs() * vectors.col(i).cwiseAbs()).maxCoeff());
    if ((J * vectors.col(i)).cwiseAbs().maxCoeff() > several * terms) break;
  }
  return count;
}

/// Orthonormal l with C'l = 0 among all unknowns: constraints that repeat one another. A null vector (q, l) of the
/// whole J = [K C'; C 0] need not be of this kind where l is not zero: K q = -C'l, as in a pendulum that is level. A
/// lock that is open has the equation l = 0 instead, and is none.
Eigen::MatrixXd repeated_rows(const Eigen::MatrixXd& J, const std::vector<char>& multiplier) {
  std::vector<Eigen::Index> rows, columns;
  for (std::size_t i = 0; i < multiplier.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (!multiplier[i])
      columns.push_back(row);
    else if (J(row, row) == 0)
      rows.push_back(row);
  }
  if (rows.empty()) return Eigen::MatrixXd(J.rows(), 0);
  const Eigen::MatrixXd Ct = J(rows, columns).transpose();
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(Ct, Eigen::ComputeFullV);
  const Eigen::Index count = true_null_vectors(Ct, svd.matrixV());
  Eigen::MatrixXd found = Eigen::MatrixXd::Zero(J.rows(), count);
  found(rows, Eigen::all) = svd.matrixV().rightCols(count);
  return found;
}

}  // namespace

bool can_look(const System& system) {
  return !system.coordinates().owners().empty() && system.coordinates().global_size() <= 1000;
}

Undetermined null_vectors(const System& system, Mat J) {
  if (!can_look(system)) return {};
  const Eigen::MatrixXd dense(gather_to_all(system, J));
  if (!dense.allFinite()) return {};
  const Eigen::MatrixXd J_scaled = scaled(dense);
  const Eigen::VectorXd pivots = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(J_scaled).matrixQR().diagonal().cwiseAbs();
  const double nothing = 1e-15 * static_cast<double>(dense.rows()) * pivots.maxCoeff();  // slender bodies come near it
  if (pivots.minCoeff() > nothing) return {};
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(J_scaled, Eigen::ComputeFullV);
  const Eigen::VectorXd& size = svd.singularValues();  // descending
  const Eigen::Index near = (size.array() <= std::max(10 * nothing, 1.001 * size[size.size() - 1])).count();
  const Eigen::Index count = true_null_vectors(J_scaled, svd.matrixV().rightCols(near));
  if (count == 0) return {};
  const Eigen::MatrixXd N = svd.matrixV().rightCols(count);
  const std::vector<char> multiplier = multiplier_rows(system);
  const Eigen::MatrixXd repeated = repeated_rows(J_scaled, multiplier);
  Undetermined open;
  open.repeated = repeated.cols() > 0;
  open.loose = count > repeated.cols();
  open.bodies = names_of(system, N, multiplier, false);
  if (open.repeated) open.joints = names_of(system, repeated, multiplier, true);
  return open;
}

std::string names_of_movers(const System& system, Vec step) {
  const Coordinates& coordinates = system.coordinates();
  Eigen::VectorXd by;
  system.gather(step, by);
  for (std::size_t i = 0; i < coordinates.global().size(); ++i)
    if (coordinates.multiplier()[i]) by[i] = 0;
  double greatest = by.size() > 0 ? by.cwiseAbs().maxCoeff() : 0;
  MPI_Allreduce(MPI_IN_PLACE, &greatest, 1, MPI_DOUBLE, MPI_MAX, system.comm());
  std::vector<double> share(coordinates.owners().size(), 0);
  const std::vector<int> owner = coordinates.owner_of_local();
  for (std::size_t i = 0; i < owner.size() && greatest > 0; ++i)
    if (owner[i] >= 0) share[owner[i]] = std::max(share[owner[i]], std::abs(by[i]) / greatest);
  return names_of(system, std::move(share));
}

std::string undetermined(const System& system, Mat J) {
  const Undetermined open = null_vectors(system, J);
  if (open.bodies.empty() || open.joints.empty()) return open.bodies + open.joints;
  return open.bodies.substr(0, open.bodies.size() - 1) + ", " + open.joints.substr(2);
}

}  // namespace floe::solve
