#include "floe/reduction/stiffness_change.h"

#include <cmath>

#include "floe/petsc/values.h"

namespace floe::reduction {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using petsc::check;

constexpr int least_steps = 12, most_steps = 24;

VectorXd eigenvalues_of(const MatrixXd& A) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

bool is_positive(const MatrixXd& D) { return eigenvalues_of(D)[0] > 0; }

/// Forces and moments of all signs and sizes up to 1, moments times the body's extent, that ranks do not change.
petsc::VecHandle mixed_load(const fem::Structure& structure) {
  petsc::VecHandle load = fem::field(structure);
  const double arm = fem::extent(structure);
  petsc::Values values(load);
  const int n = structure.dofs_per_node, forces = structure.dimension();
  for (PetscInt i = 0; i < structure.owned_dofs(); ++i)
    values.begin()[i] = std::sin(1 + 12.9898 * static_cast<double>(structure.original_dof(static_cast<int>(i)))) *
                        (i % n < forces ? 1 : arm);
  return load;
}

double dot(Vec a, Vec b) {
  double product = 0;
  check(VecDot(a, b, &product));
  return product;
}

/// Vectors v of the frame, K-orthonormal, and loads f with v = K^-1 f.
struct Subspace {
  Columns v, f;

  /// Takes out what lies along those before, and returns the K-norm that is left.
  double orthogonalise(Vec u, Vec w, VectorXd& along) const {
    along.setZero(static_cast<Eigen::Index>(v.size()));
    for (int pass = 0; pass < 2; ++pass)
      for (std::size_t i = 0; i < v.size(); ++i) {
        const double h = dot(f[i], u);
        check(VecAXPY(u, -h, v[i])), check(VecAXPY(w, -h, f[i]));
        along[static_cast<Eigen::Index>(i)] += h;
      }
    return std::sqrt(std::max(dot(w, u), 0.0));
  }
  void add(petsc::VecHandle u, petsc::VecHandle w, double norm) {
    check(VecScale(u, 1 / norm)), check(VecScale(w, 1 / norm));
    v.push_back(std::move(u)), f.push_back(std::move(w));
  }
};

/// K-orthonormal, from the load on, until the extreme values of v'A v settle.
Columns lanczos(const Statics& statics, petsc::VecHandle load, const Operator& A) {
  const auto solve = [&](Vec f) {
    Columns one;
    one.push_back(copy(f));
    return std::move(statics.solve(one)[0]);
  };
  Subspace space;
  VectorXd along;
  petsc::VecHandle w = std::move(load), u = solve(w);
  double norm = space.orthogonalise(u, w, along), least = 0, greatest = 0;
  MatrixXd H = MatrixXd::Zero(most_steps, most_steps);
  for (int step = 0; step < most_steps && norm > 1e-10 * std::max(-least, greatest); ++step) {
    space.add(std::move(u), std::move(w), norm);
    w = copy(space.v.back());
    A(space.v.back(), w);
    u = solve(w);
    norm = space.orthogonalise(u, w, along);
    H.col(step).head(step + 1) = along, H.row(step).head(step + 1) = along.transpose();
    const VectorXd values = eigenvalues_of(H.topLeftCorner(step + 1, step + 1));
    const double change = std::abs(values[0] - least) + std::abs(values[step] - greatest);
    least = values[0], greatest = values[step];
    if (step >= least_steps && change < 1e-3 * std::max(-least, greatest)) break;
  }
  return std::move(space.v);
}

MatrixXd projected(const Columns& v, const Operator& A) {
  const std::vector<Vec> bare(v.begin(), v.end());
  const auto n = static_cast<Eigen::Index>(v.size());
  MatrixXd R(n, n);
  const petsc::VecHandle y = copy(v[0]);
  for (Eigen::Index j = 0; j < n; ++j) {
    A(v[static_cast<std::size_t>(j)], y);
    check(VecMDot(y, static_cast<PetscInt>(n), bare.data(), R.col(j).data()));
  }
  return (R + R.transpose()) / 2;
}

}  // namespace

StiffnessChange stiffness_change(const fem::Structure& structure, const Statics& statics, const Operator& A,
                                 const Operator& more) {
  const Columns v = lanczos(statics, mixed_load(structure), A);
  StiffnessChange result;
  if (v.empty()) return result;
  const auto n = static_cast<Eigen::Index>(v.size());
  const MatrixXd one = MatrixXd::Identity(n, n), change = projected(v, A);
  MatrixXd D = one + projected(v, more);
  double sign = 1;
  if (!is_positive(D) && is_positive(D + change)) D += change, sign = -1;
  if (!is_positive(D)) D = one;
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(sign * change, D);
  const VectorXd& mu = eigen.eigenvalues();
  result.relative = sign * ((1 + std::min(mu[0], 0.0)) * (1 + std::max(mu[n - 1], 0.0)) - 1);
  for (const Eigen::Index i : {Eigen::Index(0), n - 1}) {
    result.shapes.push_back(copy(v[0]));
    check(VecSet(result.shapes.back(), 0));
    if ((i == 0) != (mu[i] < 0)) continue;
    for (Eigen::Index j = 0; j < n; ++j)
      check(VecAXPY(result.shapes.back(), eigen.eigenvectors()(j, i), v[static_cast<std::size_t>(j)]));
  }
  return result;
}

}  // namespace floe::reduction
