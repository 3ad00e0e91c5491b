#pragma once
#include <functional>

#include "floe/fem/pressure.h"
#include "floe/reference/spatial_places.h"

namespace floe::reference {

/// A pressure on the surface x = sum N_i x_i of a shell between places:
///
///   force at place i = p(t) sum_g N_i a,   a = w x_r x x_s in the configuration (follower),
///   or as it was undeformed, in world axes (dead)
///
/// at the points g of fem::surface_shapes. A closed surface under a follower pressure has no resultant, since N sum to
/// one and the area vectors are integrated exactly. The tangent is exact.
class SurfacePressure final : public dynamics::Term {
 public:
  /// @param value  along the normal [N/m2]
  /// @param dead   of a dead pressure, places undeformed, world axes [m]; empty: follower
  SurfacePressure(std::vector<dynamics::SpatialMarker> places, std::vector<fem::SurfaceShape> points,
                  std::function<double(double)> value, const std::vector<Eigen::Vector3d>& dead);
  const std::vector<int>& coordinates() const override { return places_.coordinates(); }
  void residual(const dynamics::Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const dynamics::Motion& motion, dynamics::Weights weights, Eigen::MatrixXd& J) const override;

 private:
  Eigen::Vector3d along(Eigen::Index direction, const fem::SurfaceShape& point) const;
  void push(const dynamics::Motion& motion) const;
  std::vector<fem::SurfaceShape> points_;
  std::function<double(double)> value_;
  std::vector<Eigen::Vector3d> dead_;  // area vectors of the points
  mutable SpatialPlaces places_;
  mutable Eigen::VectorXd wrenches_;
  mutable Eigen::MatrixXd Y_;
};

}  // namespace floe::reference
