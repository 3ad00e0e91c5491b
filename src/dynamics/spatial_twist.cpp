#include "spatial_twist.h"

#include <cmath>

#include "floe/error.h"

namespace floe::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using math::skew;

Twist twist(const SpatialPair& pair, double nearest) {
  const Matrix3d &one = pair.pose[0].D, &two = pair.pose[1].D;
  const Vector3d &z1 = one.col(2), &z2 = two.col(2);
  const double aligned = 1 + z1.dot(z2);
  if (!(aligned > 1e-12)) throw RunError("the z axes of a joint's places are opposite; its twist is undefined");
  const double sine = one.col(1).dot(two.col(0)) - one.col(0).dot(two.col(1)),
               cosine = one.col(0).dot(two.col(0)) + one.col(1).dot(two.col(1));
  const Vector3d h = (z1 + z2) / aligned, slip = pair.pose[1].spin - pair.pose[0].spin;
  const Matrix3d shared = h * z1.cross(z2).transpose() / aligned;
  return {nearest + std::remainder(std::atan2(sine, cosine) - nearest, 2 * M_PI),
          h.dot(slip),
          h,
          slip,
          {-skew(z1) / aligned - shared, -skew(z2) / aligned + shared}};
}

void begin(Revolutions& revolutions, const SpatialPair& pair, double t) {
  const double rate = twist(pair, 0).rate;
  revolutions.begin(t, twist(pair, revolutions.expected(t, rate)).angle, rate);
}

}  // namespace floe::dynamics
