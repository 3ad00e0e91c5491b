#include "floe/fem/beam_releases.h"

#include <vector>

namespace floe::fem {
namespace {

/// A^+ of a symmetric matrix of no negative directions, whose dofs have different units.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A) {
  constexpr double least = 1e-10;  // of the scaled matrix: a direction without stiffness
  const Eigen::VectorXd scale = A.diagonal().cwiseSqrt().unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
  const Eigen::MatrixXd scaled = scale.asDiagonal() * A * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  const Eigen::VectorXd inverse =
      eigen.eigenvalues().unaryExpr([&](double value) { return value > least ? 1 / value : 0.0; });
  return scale.asDiagonal() * eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose() *
         scale.asDiagonal();
}

/// From body axes to those of the element.
Matrix12 axes_of(const BeamPlace& place) {
  Matrix12 axes = Matrix12::Zero();
  for (int i = 0; i < 12; i += 3) axes.block<3, 3>(i, i) = element_axes(place).transpose();
  return axes;
}

}  // namespace

Matrix12 released(const BeamPlace& place, const SpatialBeamSection& section, const BeamReleases& releases) {
  const Matrix12 axes = axes_of(place);
  const Matrix12 K = axes * stiffness(fixed_spatial_beam(place, section)) * axes.transpose();
  std::vector<int> free, kept;
  for (int i = 0; i < 12; ++i) (releases[static_cast<std::size_t>(i)] ? free : kept).push_back(i);
  Matrix12 T = Matrix12::Identity();
  T(free, Eigen::all).setZero();
  T(free, kept) = -pseudo_inverse(K(free, free)) * K(free, kept);
  return axes.transpose() * T * axes;
}

Matrix12 rod_rotations(const BeamPlace& place, const SpatialBeamSection& section, const BeamReleases& releases,
                       std::bitset<2> alone) {
  const double length = (place.to - place.from).norm();
  Eigen::Matrix<double, 5, 12> rows = Eigen::Matrix<double, 5, 12>::Zero();
  for (int end : {0, 1}) {
    if (!alone[static_cast<std::size_t>(end)]) continue;
    rows(2 * end, 6 * end + 4) = rows(2 * end + 1, 6 * end + 5) = 1;
    rows(2 * end, 2) = -1 / length, rows(2 * end, 8) = 1 / length;
    rows(2 * end + 1, 1) = 1 / length, rows(2 * end + 1, 7) = -1 / length;
  }
  if (releases[3] || releases[9]) rows(4, 3) = 1, rows(4, 9) = -1;
  const Eigen::Matrix<double, 5, 12> own = rows * axes_of(place);
  return 1e-10 * section.EA * length * own.transpose() * own;
}

}  // namespace floe::fem
