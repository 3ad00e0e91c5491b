#include "floe/fem/beam_releases.h"

#include <vector>

namespace floe::fem {
namespace {

/// A^+ of a symmetric matrix of no negative directions, whose dofs have different units.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A) {
  constexpr double least = 1e-10;  // of the scaled matrix: a direction without stiffness
  const Eigen::VectorXd scale = A.diagonal().cwiseSqrt().unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * A * scale.asDiagonal());
  const Eigen::VectorXd inverse =
      eigen.eigenvalues().unaryExpr([&](double value) { return value > least ? 1 / value : 0.0; });
  return scale.asDiagonal() * eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose() *
         scale.asDiagonal();
}

}  // namespace

Matrix12 released(const BeamPlace& place, const SpatialBeamSection& section, const BeamReleases& releases) {
  Matrix12 axes = Matrix12::Zero();  // from body axes to those of the element
  for (int i = 0; i < 12; i += 3) axes.block<3, 3>(i, i) = element_axes(place).transpose();
  const Matrix12 K = axes * stiffness(fixed_spatial_beam(place, section)) * axes.transpose();
  std::vector<int> free, kept;
  for (int i = 0; i < 12; ++i) (releases[static_cast<std::size_t>(i)] ? free : kept).push_back(i);
  Matrix12 T = Matrix12::Identity();
  T(free, Eigen::all).setZero();
  T(free, kept) = -pseudo_inverse(K(free, free)) * K(free, kept);
  return axes.transpose() * T * axes;
}

}  // namespace floe::fem
