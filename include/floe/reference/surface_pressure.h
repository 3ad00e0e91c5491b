#pragma once
#include <functional>

#include "floe/reference/spatial_places.h"

namespace floe::reference {

/// A pressure on a flat triangle between three places, a third of its force at each:
///
///   force at a place = share p(t) a / 3,   a = 1/2 (p_2 - p_1) x (p_3 - p_1) in the configuration (follower),
///   or as it was undeformed, in world axes (dead)
///
/// The forces are those of a uniform pressure on the facets of the deformed mesh; a closed surface under a follower
/// pressure has no resultant. The tangent is exact.
class FacetPressure final : public dynamics::Term {
 public:
  /// @param value  along the normal [N/m2]
  /// @param share  of the triangle: a half for each of a quadrilateral's four
  /// @param dead   area normal [m2] of a dead pressure, world axes; null: follower
  FacetPressure(std::vector<dynamics::SpatialMarker> places, std::function<double(double)> value, double share,
                const Eigen::Vector3d* dead);
  const std::vector<int>& coordinates() const override { return places_.coordinates(); }
  void residual(const dynamics::Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const dynamics::Motion& motion, dynamics::Weights weights, Eigen::MatrixXd& J) const override;

 private:
  void push(const dynamics::Motion& motion) const;
  std::function<double(double)> value_;
  double share_;
  bool follower_;
  Eigen::Vector3d dead_ = Eigen::Vector3d::Zero();
  mutable SpatialPlaces places_;
  mutable Eigen::VectorXd wrenches_ = Eigen::VectorXd::Zero(18);
  mutable Eigen::MatrixXd Y_ = Eigen::MatrixXd::Zero(18, 18);
};

}  // namespace floe::reference
