#include "floe/reference/facet_pressure.h"

#include "floe/math/rotation.h"

namespace floe::reference {

using dynamics::EvaluationLevel;
using Eigen::Index;
using Eigen::Vector3d;
using math::skew;

FacetPressure::FacetPressure(std::vector<dynamics::SpatialMarker> places, std::function<double(double)> value,
                             double share, const Vector3d* dead)
    : value_(std::move(value)), share_(share), follower_(dead == nullptr), places_(std::move(places)) {
  if (dead) dead_ = *dead;
}

/// Minus the forces: what stands in the residual.
void FacetPressure::push(const dynamics::Motion& motion) const {
  const Vector3d one = places_[1].p - places_[0].p, two = places_[2].p - places_[0].p;
  const Vector3d area = follower_ ? Vector3d(0.5 * one.cross(two)) : dead_;
  for (Index i = 0; i < 3; ++i) wrenches_.segment<3>(6 * i) = -share_ * value_(motion.t) / 3 * area;
}

void FacetPressure::residual(const dynamics::Motion& motion, Eigen::VectorXd& r) const {
  places_.see(motion, EvaluationLevel::position);
  push(motion);
  places_.add(wrenches_, r);
}

void FacetPressure::tangent(const dynamics::Motion& motion, dynamics::Weights weights, Eigen::MatrixXd& J) const {
  places_.see(motion, EvaluationLevel::jacobian);
  push(motion);
  if (follower_) {
    const Vector3d one = places_[1].p - places_[0].p, two = places_[2].p - places_[0].p;
    const double factor = -share_ * value_(motion.t) / 6;
    for (Index i = 0; i < 3; ++i) {
      Y_.block<3, 3>(6 * i, 6) = -factor * skew(two);
      Y_.block<3, 3>(6 * i, 12) = factor * skew(one);
      Y_.block<3, 3>(6 * i, 0) = factor * (skew(two) - skew(one));
    }
  }
  places_.add_tangent(wrenches_, Y_, nullptr, weights, J);
}

}  // namespace floe::reference
