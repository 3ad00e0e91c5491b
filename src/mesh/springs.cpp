#include "springs.h"

namespace floe::mesh {

Eigen::Matrix3d axes_along(const Eigen::Vector3d& first) {
  Eigen::Matrix3d axes;
  axes.col(0) = first.normalized();
  axes.col(1) = axes.col(0).unitOrthogonal();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

NodeSpring line_spring(const Eigen::Vector3d& along, double stiffness, long long label) {
  return {{}, {stiffness}, axes_along(along), 0.5, label, SpringKind::line};
}

}  // namespace floe::mesh
