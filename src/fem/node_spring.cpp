#include "floe/fem/node_spring.h"

#include <cmath>

#include "floe/error.h"
#include "floe/fem/transform.h"
#include "floe/math/rotation.h"

namespace floe::fem {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Motion = Eigen::Matrix<double, 6, 12>;

/// Rows of strains with a stiffness; of G and P none yet.
StrainPoint rows_of(const Motion& strain, const Eigen::Matrix<double, 6, 1>& stiffness, std::vector<Index>& kept) {
  for (Index i = 0; i < 6; ++i)
    if (stiffness[i] > 0) kept.push_back(i);
  return {1, stiffness(kept).asDiagonal(), strain(kept, Eigen::all), {}, {}};
}

/// @param d  the displacement of the second node relative to the first, both carried to p
StrainPoint bushing(const NodeSpring& spring, const std::array<Vector3d, 2>& arms, const Motion& relative,
                    const Motion& own) {
  std::vector<Index> kept;
  StrainPoint point = rows_of(own, spring.stiffness, kept);
  point.G = Eigen::MatrixXd::Zero(9, 12);  // theta_1, theta_2, d
  point.G.block<3, 3>(0, 3).setIdentity(), point.G.block<3, 3>(3, 9).setIdentity();
  point.G.bottomRows<3>() = relative.topRows<3>();
  for (const Index i : kept) {
    const Vector3d e = spring.axes.col(i % 3);
    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(9, 9);
    if (i < 3) {
      P.block<3, 3>(0, 0) = -math::arm_form(e, arms[0]), P.block<3, 3>(3, 3) = math::arm_form(e, arms[1]);
      P.block<3, 3>(0, 6) = math::skew(e), P.block<3, 3>(6, 0) = -math::skew(e);  // -e . theta_1 x d = theta_1 . e x d
    } else {
      P.block<3, 3>(0, 3) = math::skew(e) / 2, P.block<3, 3>(3, 0) = -math::skew(e) / 2;
    }
    point.P.push_back(P);
  }
  return point;
}

StrainPoint line(const NodeSpring& spring, const Vector3d& along) {
  const double length = along.norm();
  if (!(length > 0) || !((spring.axes.col(0) - along / length).norm() < 1e-6))
    throw InputError("a spring along the line between two nodes has another direction, or no length");
  StrainPoint point{1, spring.stiffness.head<1>(), Eigen::MatrixXd::Zero(1, 12), Eigen::MatrixXd::Zero(3, 12), {}};
  point.G.leftCols<3>() = -Matrix3d::Identity(), point.G.middleCols<3>(6).setIdentity();
  const Vector3d e = spring.axes.col(0);
  point.L = e.transpose() * point.G;
  point.P.emplace_back((Matrix3d::Identity() - e * e.transpose()) / length);
  return point;
}

}  // namespace

ElementMaps node_spring(const Vector3d& first, const Vector3d& second, const NodeSpring& spring) {
  if (!spring.stiffness.allFinite() || spring.stiffness.minCoeff() < 0)
    throw InputError("the stiffnesses of a spring between two nodes must be finite and not negative");
  if (!std::isfinite(spring.at) || !((spring.axes.transpose() * spring.axes).isIdentity(1e-9)))
    throw InputError("the axes of a spring between two nodes are not a rotation");
  const std::array<Vector3d, 2> arms{spring.at * (second - first), (spring.at - 1) * (second - first)};
  Motion relative;  // of the motion at p, in body axes
  relative << -rigid_arm(arms[0]), rigid_arm(arms[1]);
  Motion own;
  own << spring.axes.transpose() * relative.topRows<3>(), spring.axes.transpose() * relative.bottomRows<3>();
  ElementMaps maps;
  maps.bending = Eigen::MatrixXd::Zero(12, 12);
  if (spring.kind == mesh::SpringKind::linear)
    maps.bending = own.transpose() * spring.stiffness.asDiagonal() * own;
  else
    maps.membrane.push_back(spring.kind == mesh::SpringKind::line ? line(spring, second - first)
                                                                  : bushing(spring, arms, relative, own));
  maps.mass.push_back({0, first, Eigen::MatrixXd::Zero(3, 12)});  // for the dimension of space
  return maps;
}

}  // namespace floe::fem
