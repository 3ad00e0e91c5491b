#pragma once
#include <functional>
#include <string>
#include <variant>

#include "floe/dynamics/connection.h"
#include "floe/dynamics/event.h"
#include "floe/dynamics/marker_pair.h"
#include "floe/dynamics/moving_axes.h"
#include "floe/dynamics/time_function.h"

namespace floe::dynamics {

/// C = p_2 - p_1 (2 rows).
struct Revolute {};
/// C = (p_2 - p_1, angle_2 - angle_1 - offset - angle(t)) (3 rows): a clamp; with a function of time, driven.
/// Angles of beams' nodes are slopes v' against the frame plus the frame's angle.
struct Clamp {
  double offset = 0;
  TimeFunction angle;  ///< empty: fixed
};
/// C = (n.(p_2 - p_1) - offset_n, angle_2 - angle_1 - offset) (2 rows); n rotates with the first place: n = normal at
/// angle_1 = 0.
struct Prismatic {
  Eigen::Vector2d normal{0, 1};
  double gap = 0, offset = 0;
};
using Constraint = std::variant<Revolute, Clamp, Prismatic>;

int rows(const Constraint& constraint);

/// Constraint rows at a level with multipliers: r_y += C_y' lambda, r_lambda = C (or its time derivatives).
///
/// Positive multipliers pull the second place against the directions of C. Both places may belong to one body.
class Joint final : public Connection {
 public:
  /// @param multipliers  local index of the first of as many multipliers as rows stand
  /// @param independent  rows of the constraint that are kept, ascending; the others are redundant
  /// @param constraint_switch        if given, whether the rows hold
  /// @param captures     the constraint is that of the places as they are when the constraint switch closes (angle(t)
  /// is not used)
  Joint(Marker first, Marker second, Constraint constraint, int multipliers, std::vector<int> independent,
        std::shared_ptr<ConstraintSwitch> constraint_switch = {}, bool captures = false);
  /// All rows stand.
  Joint(Marker first, Marker second, const Constraint& constraint, int multipliers);
  const std::vector<int>& coordinates() const override { return pair_.coordinates; }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override;
  Wrench on_second(const Motion& motion) const override;
  /// The force of a revolute or a clamp, with the second place's frame (or the first's, where that has none).
  void add_corotated(std::vector<Corotated>& corotated) const override;
  /// Of rows that were left out: violated beyond a thousandth of `extent` and of a radian.
  ConstraintStatus constraint_status(const Motion& motion) const override;
  bool has_left_out_rows() const override {
    return !captures_ && static_cast<int>(independent_.size()) < rows(constraint_);
  }
  double extent = 1;  ///< of the scene [m]
  void begin_step(const Motion& motion) override;
  void save(std::vector<double>& carried) const override;
  void load(std::span<const double> carried) override;

 private:
  Eigen::Vector3d multipliers(const Motion& motion) const;
  bool holds() const { return !constraint_switch_ || constraint_switch_->closed; }
  mutable MarkerPair pair_;
  Constraint constraint_;
  std::vector<int> independent_;
  int multiplier_;  // position among coordinates
  std::shared_ptr<ConstraintSwitch> constraint_switch_;
  bool captures_, captured_ = false;
  mutable Eigen::VectorXd row_;
};

/// Spring and damper between two places: along the line that joins them, and torsional.
///
///   f = stiffness (l - length) + viscosity l.,  m = torsional_stiffness (dangle - angle) + torsional_viscosity dangle.
struct SpringProperties {
  double stiffness = 0, viscosity = 0, length = 0;
  double torsional_stiffness = 0, torsional_viscosity = 0, angle = 0;
};
/// See SpringProperties.
class Spring final : public Connection {
 public:
  Spring(Marker first, Marker second, SpringProperties properties);
  const std::vector<int>& coordinates() const override { return pair_.coordinates; }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override;
  Energy energy(const Motion& motion) const override;
  Wrench on_second(const Motion& motion) const override;

 private:
  mutable MarkerPair pair_;
  SpringProperties properties_;
};

/// A force and moment of time on a marker (r_y -= (f, m)).
class Force final : public Term {
 public:
  /// World; rotating with the frame; rotating with the place, angle0 + theta + psi q; with other axes.
  enum class Axes { world, body, place, other };
  /// @param force  (f_x, f_y, m)(t)
  Force(Marker at, std::function<Eigen::Vector3d(double)> force, Axes axes);
  /// In other axes, whose angle follows the coordinates of the place.
  Force(Marker at, std::function<Eigen::Vector3d(double)> force, const MovingAxes& other);
  const std::vector<int>& coordinates() const override { return coordinates_; }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override;
  Energy energy(const Motion& motion) const override;
  /// Counts -f.p as potential energy: for forces constant in time and world axes (gravity).
  bool conservative = false;

 private:
  Eigen::Vector3d wrench(const Motion& motion) const;
  Marker at_;
  std::function<Eigen::Vector3d(double)> force_;
  Axes axes_;
  double angle_ = 0;  // of other axes
  std::vector<int> coordinates_;
  mutable Pose pose_;
};

}  // namespace floe::dynamics
