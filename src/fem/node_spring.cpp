#include "floe/fem/node_spring.h"

#include <cmath>

#include "floe/error.h"
#include "floe/fem/transform.h"

namespace floe::fem {

ElementMaps node_spring(const Eigen::Vector3d& first, const Eigen::Vector3d& second, const NodeSpring& spring) {
  if (!spring.stiffness.allFinite() || spring.stiffness.minCoeff() < 0)
    throw InputError("the stiffnesses of a spring between two nodes must be finite and not negative");
  if (!std::isfinite(spring.at) || !((spring.axes.transpose() * spring.axes).isIdentity(1e-9)))
    throw InputError("the axes of a spring between two nodes are not a rotation");
  const Eigen::Vector3d along = second - first;
  Eigen::Matrix<double, 6, 12> relative;  // of the motion at p, in body axes
  relative << -rigid_arm(Eigen::Vector3d(spring.at * along)), rigid_arm(Eigen::Vector3d((spring.at - 1) * along));
  Eigen::Matrix<double, 6, 12> own;
  own << spring.axes.transpose() * relative.topRows<3>(), spring.axes.transpose() * relative.bottomRows<3>();
  ElementMaps maps;
  maps.bending = own.transpose() * spring.stiffness.asDiagonal() * own;
  maps.mass.push_back({0, first, Eigen::MatrixXd::Zero(3, 12)});  // for the dimension of space
  return maps;
}

}  // namespace floe::fem
