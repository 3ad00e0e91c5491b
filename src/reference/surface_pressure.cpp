#include "floe/reference/surface_pressure.h"

#include "floe/math/rotation.h"

namespace floe::reference {

using dynamics::EvaluationLevel;
using Eigen::Index;
using Eigen::Vector3d;
using math::skew;

SurfacePressure::SurfacePressure(std::vector<dynamics::SpatialMarker> places, std::vector<fem::SurfaceShape> points,
                                 std::function<double(double)> value, const std::vector<Vector3d>& dead)
    : points_(std::move(points)),
      value_(std::move(value)),
      places_(std::move(places)),
      wrenches_(Eigen::VectorXd::Zero(6 * places_.size())),
      Y_(Eigen::MatrixXd::Zero(6 * places_.size(), 6 * places_.size())) {
  if (dead.empty()) return;
  for (const fem::SurfaceShape& point : points_) {
    Vector3d r = Vector3d::Zero(), s = Vector3d::Zero();
    for (Index i = 0; i < places_.size(); ++i)
      r += point.dN(0, i) * dead[static_cast<std::size_t>(i)], s += point.dN(1, i) * dead[static_cast<std::size_t>(i)];
    dead_.emplace_back(point.weight * r.cross(s));
  }
}

/// x_r or x_s
Vector3d SurfacePressure::along(Index direction, const fem::SurfaceShape& point) const {
  Vector3d sum = Vector3d::Zero();
  for (Index i = 0; i < places_.size(); ++i) sum += point.dN(direction, i) * places_[i].p;
  return sum;
}

/// Minus the forces: what stands in the residual.
void SurfacePressure::push(const dynamics::Motion& motion) const {
  const double value = value_(motion.t);
  wrenches_.setZero();
  for (std::size_t g = 0; g < points_.size(); ++g) {
    const fem::SurfaceShape& point = points_[g];
    const Vector3d area = dead_.empty() ? Vector3d(point.weight * along(0, point).cross(along(1, point))) : dead_[g];
    for (Index i = 0; i < places_.size(); ++i) wrenches_.segment<3>(6 * i) -= value * point.N[i] * area;
  }
}

void SurfacePressure::residual(const dynamics::Motion& motion, Eigen::VectorXd& r) const {
  places_.see(motion, EvaluationLevel::position);
  push(motion);
  places_.add(wrenches_, r);
}

void SurfacePressure::tangent(const dynamics::Motion& motion, dynamics::Weights weights, Eigen::MatrixXd& J) const {
  places_.see(motion, EvaluationLevel::jacobian);
  push(motion);
  if (dead_.empty()) {
    const double value = value_(motion.t);
    Y_.setZero();
    for (const fem::SurfaceShape& point : points_) {
      const Eigen::Matrix3d by_r = skew(along(1, point)), by_s = skew(along(0, point));
      for (Index j = 0; j < places_.size(); ++j) {  // d (x_r x x_s) by x_j
        const Eigen::Matrix3d change = value * point.weight * (point.dN(1, j) * by_s - point.dN(0, j) * by_r);
        for (Index i = 0; i < places_.size(); ++i) Y_.block<3, 3>(6 * i, 6 * j) -= point.N[i] * change;
      }
    }
  }
  places_.add_tangent(wrenches_, Y_, nullptr, weights, J);
}

}  // namespace floe::reference
