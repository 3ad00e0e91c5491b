#pragma once
#include <string>

#include "floe/dynamics/revolutions.h"
#include "floe/dynamics/spatial_pair.h"

namespace floe::dynamics {

/// Spring and damper between two places in space: along the line that joins them, and torsional about z.
///
///   f = stiffness (l - length) + viscosity l.,  m = torsional_stiffness (phi - angle - rest) + torsional_viscosity
///   phi.
///
/// Coinciding places have no line and carry no line force; of length 0 the spring is linear there, f = stiffness (p_2 -
/// p_1), and its stiffness is the same in all directions. phi is the twist of D1'D2 about z, the angle that is left
/// when the shortest rotation that takes z_1 to z_2 is undone (between places on one axis: their relative angle):
///
///   tan phi = (y_1.x_2 - x_1.y_2) / (x_1.x_2 + y_1.y_2),   phi. = h.(w_2 - w_1),   h = (z_1 + z_2) / (1 + z_1.z_2)
///
/// Torsion throws RunError where z_2 = -z_1: there is no twist.
struct SpatialSpringProperties {
  double stiffness = 0, viscosity = 0, length = 0;
  double torsional_stiffness = 0, torsional_viscosity = 0, angle = 0, rest = 0;
};
/// See SpatialSpringProperties.
class SpatialSpring final : public Connection {
 public:
  SpatialSpring(SpatialMarker first, SpatialMarker second, SpatialSpringProperties properties);
  const std::vector<int>& coordinates() const override { return pair_.coordinates; }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override;
  Energy energy(const Motion& motion) const override;
  Wrench on_second(const Motion& motion) const override;
  /// Counts revolutions (Revolutions); before the first call, phi is the twist nearest to `angle`.
  ///
  /// Positions determine phi only up to whole revolutions, and a term is a function of its motion: so they are counted
  /// once a step, between evaluations.
  void begin_step(const Motion& motion) override;
  void save(std::vector<double>& carried) const override { revolutions_.save(carried); }
  void load(std::span<const double> carried) override { revolutions_.load(carried); }

 private:
  mutable SpatialPair pair_;
  SpatialSpringProperties properties_;
  Revolutions revolutions_;
};

/// Six springs and dampers in the axes of the first place.
///
///   u = D1'(p_2 - p_1) - rest,  exp(~rho) = D1'D2,   f = K_f u + V_f u.,  m = K_m rho + V_m rho.
///
/// f works on u and m on the rotation vector rho: the moment on the places is D1 T(rho)^-1 m. Diagonals: stiffness =
/// (K_f, K_m) [N/m, N m/rad], viscosity = (V_f, V_m). rho is the rotation vector nearest to the one at which the step
/// began; it ends at a whole turn, where the moment does.
struct BushingProperties {
  Wrench stiffness = Wrench::Zero(), viscosity = Wrench::Zero();
  Eigen::Vector3d rest = Eigen::Vector3d::Zero();  ///< from the first place to the second without force [m]
  std::string name = {};                           ///< for messages
};
/// See BushingProperties.
class SpatialBushing final : public Connection {
 public:
  SpatialBushing(SpatialMarker first, SpatialMarker second, BushingProperties properties);
  const std::vector<int>& coordinates() const override { return pair_.coordinates; }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override;
  Energy energy(const Motion& motion) const override;
  Wrench on_second(const Motion& motion) const override;
  /// Takes rho over. @throws RunError  it is more than 0.8 of a turn, and carries a moment
  void begin_step(const Motion& motion) override;
  void save(std::vector<double>& carried) const override {
    carried.insert(carried.end(), nearest_.data(), nearest_.data() + 3);
  }
  void load(std::span<const double> carried) override { nearest_ = Eigen::Map<const Eigen::Vector3d>(carried.data()); }

 private:
  mutable SpatialPair pair_;
  BushingProperties properties_;
  Eigen::Vector3d nearest_ = Eigen::Vector3d::Zero();
};

}  // namespace floe::dynamics
