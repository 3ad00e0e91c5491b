#include "floe/fem/transform.h"

#include <map>

#include "floe/error.h"
#include "floe/math/rotation.h"

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

Eigen::Matrix<double, 6, 6> spin_arm(const Eigen::Vector3d& arm, const Eigen::Matrix3d& S) {
  Eigen::Matrix<double, 6, 6> T = rigid_arm(arm);
  T.bottomRightCorner<3, 3>() -= S * S.transpose();
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
        P.bottomRightCorner<3, 3>() += math::arm_form(point.L.row(s).segment<3>(arm->point), arm->arm);
    }
  }
}

/// Adds what moves with the arm: mass points on the dofs of the element, rotation on those of the result.
void add_mass(const std::vector<body::MassPoint>& points, const RigidArm& arm, Eigen::Index dofs,
              std::vector<body::RotatingMass>& rotary) {
  body::RotatingForms forms;
  Eigen::MatrixXd rotation = Eigen::MatrixXd::Zero(3, dofs);
  for (const body::MassPoint& point : points) {
    const Eigen::Index d = point.x.size();
    forms.add(point.mass, point.x, point.N.middleCols(arm.point, d), arm.arm);
    rotation.block(d == 2 ? 2 : 0, arm.rotation, 2 * d - 3, 2 * d - 3).setIdentity();
  }
  if (!forms.empty()) rotary.emplace_back(forms, rotation);
}

}  // namespace

ElementMaps transformed(const ElementMaps& maps, const Eigen::MatrixXd& T, const std::vector<RigidArm>& arms,
                        bool strained) {
  expect_rows(T, maps.bending.rows());
  ElementMaps result = maps;
  result.bending = T.transpose() * maps.bending * T;
  for (StrainPoint& g : result.membrane) {
    g.G = (g.G * T).eval();
    if (strained) add_arms(arms, g);
    g.L = (g.L * T).eval();
  }
  result.mass = transformed(maps.mass, T);
  for (body::RotatingMass& mass : result.rotary) mass.rotation = (mass.rotation * T).eval();
  for (const RigidArm& arm : arms) add_mass(maps.mass, arm, T.cols(), result.rotary);
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
