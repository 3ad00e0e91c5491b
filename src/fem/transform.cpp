#include "floe/fem/transform.h"

#include <map>

#include "floe/error.h"

namespace floe::fem {
namespace {

void expect_rows(const Eigen::MatrixXd& T, Eigen::Index dofs) {
  if (T.rows() != dofs)
    throw InputError("a transformation has " + std::to_string(T.rows()) + " rows, its element " + std::to_string(dofs) +
                     " dofs");
}

}  // namespace

Eigen::Matrix<double, 6, 6> rigid_arm(const Eigen::Vector3d& a) {
  Eigen::Matrix<double, 6, 6> T = Eigen::Matrix<double, 6, 6>::Identity();
  T.topRightCorner<3, 3>() << 0, a.z(), -a.y(), -a.z(), 0, a.x(), a.y(), -a.x(), 0;
  return T;
}

Eigen::Matrix<double, 6, 6> line_arm(const Eigen::Vector3d& arm, const Eigen::Vector3d& axis) {
  Eigen::Matrix<double, 6, 6> T = rigid_arm(arm);
  T.bottomRightCorner<3, 3>() -= axis * axis.transpose();
  return T;
}

Eigen::Matrix3d rigid_arm(const Eigen::Vector2d& a) {
  return (Eigen::Matrix3d() << 1, 0, -a.y(), 0, 1, a.x(), 0, 0, 1).finished();
}

Eigen::MatrixXd rigid_arms(const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(12, 12);
  T.topLeftCorner<6, 6>() = rigid_arm(first);
  T.bottomRightCorner<6, 6>() = rigid_arm(second);
  return T;
}

Eigen::Matrix3d second_order_arm(const Eigen::Vector3d& l, const Eigen::Vector3d& arm) {
  const Eigen::Matrix3d product = l * arm.transpose();
  return (product + product.transpose()) / 2 - l.dot(arm) * Eigen::Matrix3d::Identity();
}

namespace {

/// Adds the arms' terms to a point, whose L is on the dofs of the element and whose G on those of the result.
void add_arms(const std::vector<RigidArm>& arms, StrainPoint& point) {
  std::map<Eigen::Index, std::vector<const RigidArm*>> by_rotation;
  for (const RigidArm& arm : arms) by_rotation[arm.rotation].push_back(&arm);
  for (const auto& [rotation, moved] : by_rotation) {
    const Eigen::Index before = point.G.rows();
    point.G.conservativeResize(before + 3, Eigen::NoChange);
    point.G.bottomRows<3>().setZero();
    point.G.block<3, 3>(before, rotation).setIdentity();
    for (Eigen::Index s = 0; s < point.L.rows(); ++s) {
      Eigen::MatrixXd& P = point.P[static_cast<std::size_t>(s)];
      P.conservativeResizeLike(Eigen::MatrixXd::Zero(before + 3, before + 3));
      for (const RigidArm* arm : moved)
        P.bottomRightCorner<3, 3>() += second_order_arm(point.L.row(s).segment<3>(arm->point), arm->arm);
    }
  }
}

}  // namespace

ElementMaps transformed(const ElementMaps& maps, const Eigen::MatrixXd& T, const std::vector<RigidArm>& arms) {
  expect_rows(T, maps.bending.rows());
  ElementMaps result = maps;
  result.bending = T.transpose() * maps.bending * T;
  for (StrainPoint& g : result.membrane) {
    g.G = (g.G * T).eval();
    add_arms(arms, g);
    g.L = (g.L * T).eval();
  }
  result.mass = transformed(maps.mass, T);
  return result;
}

std::vector<body::MassPoint> transformed(const std::vector<body::MassPoint>& points, const Eigen::MatrixXd& T) {
  std::vector<body::MassPoint> result;
  for (const body::MassPoint& point : points) {
    expect_rows(T, point.N.cols());
    result.push_back({point.mass, point.x, point.N * T});
  }
  return result;
}

}  // namespace floe::fem
