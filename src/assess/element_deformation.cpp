#include "element_deformation.h"

#include "floe/math/rotation.h"

namespace floe::assess {

using Eigen::Vector3d;

void take_deformation(const std::vector<Vector3d>& X, const Eigen::Matrix3d& axes, Eigen::Ref<Eigen::VectorXd> q) {
  const auto n = static_cast<Eigen::Index>(X.size());
  Vector3d centre = Vector3d::Zero(), at = Vector3d::Zero();
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  std::vector<Eigen::Matrix3d> rotations;
  for (Eigen::Index i = 0; i < n; ++i) {
    rotations.push_back(math::rotation(q.segment<3>(6 * i + 3)) * axes);  // from the body's axes to the node's
    sum += rotations.back();
    centre += X[static_cast<std::size_t>(i)] / static_cast<double>(n),
        at += q.segment<3>(6 * i) / static_cast<double>(n);
  }
  const Eigen::Matrix3d mean = math::nearest_rotation(sum);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Matrix3d own = mean.transpose() * rotations[static_cast<std::size_t>(i)];
    const Vector3d u = mean.transpose() * (q.segment<3>(6 * i) - at) - (X[static_cast<std::size_t>(i)] - centre);
    q.segment<3>(6 * i) = u;
    q.segment<3>(6 * i + 3) = math::rotation_vector(Eigen::Quaterniond(own).normalized());
  }
}

void take_planar_deformation(const std::vector<Vector3d>& X, double start, Eigen::Ref<Eigen::VectorXd> q) {
  const double mean = (q[2] + q[5]) / 2;
  const Eigen::Rotation2Dd into(-mean - start), body(start);
  const Eigen::Vector2d centre = (X[0] + X[1]).head<2>() / 2, at = (q.segment<2>(0) + q.segment<2>(3)) / 2;
  for (Eigen::Index i = 0; i < 2; ++i) {
    const Eigen::Vector2d from = X[static_cast<std::size_t>(i)].head<2>() - centre;
    q.segment<2>(3 * i) = into * (q.segment<2>(3 * i) - at + body * from) - from;
    q[3 * i + 2] -= mean;
  }
}

}  // namespace floe::assess
