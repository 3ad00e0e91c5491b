#pragma once
#include <variant>

#include "floe/dynamics/event.h"
#include "floe/dynamics/spatial_pair.h"
#include "floe/dynamics/time_function.h"

namespace floe::dynamics {

// What a constraint in space is made of, one row each. D1, D2: axes of the two places in columns x, y, z = 0, 1, 2.

/// C = e_axis.(p_2 - p_1), a world axis. [m]
struct PointCoincidence {
  int axis;
};
/// C = D1_axis.(p_2 - p_1) - offset - position(t). [m]
struct Along {
  int axis;
  double offset = 0;
  TimeFunction position = {};  ///< empty: 0
};
/// C = Q_ij = D1_i.(D2 E(t)')_j, with E the rotation by the constraint's angle(t) about z.
struct Product {
  int i, j;
};
/// C = |p_2 - p_1| - length. [m]
struct Separation {
  double length;
};
using SpatialRow = std::variant<PointCoincidence, Along, Product, Separation>;

/// The rows that a joint holds. Its axes are those of the first place: x, y, z; D1 = D2 is its undisplaced state.
///
/// Multipliers of Coincide, Along and Separation are forces, those of Product moments: where the constraint is met,
/// Q_21, Q_32, Q_13 of fixed places go with moments about z, x, y; Q_31 and Q_32 with moments about -y and x of the
/// second place. Products also vanish at rotations by 180 degrees: see SpatialJoint::constraint_status.
struct SpatialConstraint {
  std::vector<SpatialRow> rows;
  TimeFunction angle = {};  ///< of E, of any size; empty: 0

  static SpatialConstraint fixed();        ///< p_2 - p_1; Q_21, Q_32, Q_13
  static SpatialConstraint revolute();     ///< about z: p_2 - p_1; Q_31, Q_32
  static SpatialConstraint prismatic();    ///< along z: D1_x, D1_y; Q_21, Q_32, Q_13
  static SpatialConstraint cylindrical();  ///< along and about z: D1_x, D1_y; Q_31, Q_32
  static SpatialConstraint spherical();    ///< p_2 - p_1
  static SpatialConstraint universal();    ///< z of the first place stays normal to x of the second: p_2 - p_1; Q_31
  static SpatialConstraint planar();       ///< in the plane normal to z: D1_z; Q_31, Q_32
  /// @throws InputError  length <= 0: places that are to coincide are constrained by a spherical joint
  static SpatialConstraint distance(double length);
  /// D2 = D1 rotated by angle(t) about z: as fixed, with E(t).
  static SpatialConstraint driven_revolute(TimeFunction angle);
  /// As prismatic, with D1_z.(p_2 - p_1) = position(t) as its last row.
  static SpatialConstraint driven_prismatic(TimeFunction position);
};

int rows(const SpatialConstraint& constraint);

/// The rows that a joint leaves free, which hold its places as they are when its constraint switch closes; none: the
/// joint holds all, or cannot be locked (distance, universal).
SpatialConstraint lock_of(const SpatialConstraint& joint);

/// Constraint rows in space at a level with multipliers: r += P' C_y' lambda, r_lambda = C (or its time derivatives).
///
/// Positive multipliers pull the second place against the directions of C. Both places may belong to one body.
/// Residual and tangent throw RunError where the places of a Separation coincide: no direction holds them apart.
class SpatialJoint final : public Connection {
 public:
  /// @param multipliers  local index of the first of as many multipliers as rows stand
  /// @param independent  rows of the constraint that are kept, ascending; the others are redundant
  /// @param unit         of lengths in rows that are left out [m]
  SpatialJoint(SpatialMarker first, SpatialMarker second, const SpatialConstraint& constraint, int multipliers,
               const std::vector<int>& independent, double unit = 1,
               std::shared_ptr<ConstraintSwitch> constraint_switch = {});
  /// All rows stand.
  /// @param constraint_switch     if given, whether the rows hold
  /// @param captures  the places as they are when the constraint switch closes are the undisplaced state: D1 = D2,
  /// offsets as found
  SpatialJoint(SpatialMarker first, SpatialMarker second, SpatialConstraint constraint, int multipliers,
               std::shared_ptr<ConstraintSwitch> constraint_switch = {}, bool captures = false);
  const std::vector<int>& coordinates() const override { return pair_.coordinates; }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override;
  Wrench on_second(const Motion& motion) const override;
  /// Axes that Products keep parallel have to point the same way, and rows that are left out to vanish: up to 1e-3 of
  /// a radian and of the length unit.
  ConstraintStatus constraint_status(const Motion& motion) const override;
  /// The force that holds a point, with the second place's frame (or the first's, where that has none).
  void add_corotated(std::vector<Corotated>& corotated) const override;
  void begin_step(const Motion& motion) override;
  void save(std::vector<double>& carried) const override;
  void load(std::span<const double> carried) override;

 private:
  bool holds() const { return !constraint_switch_ || constraint_switch_->closed; }
  mutable SpatialPair pair_;
  std::shared_ptr<ConstraintSwitch> constraint_switch_;
  bool captures_, captured_ = false;
  SpatialConstraint constraint_;  // the rows that stand
  std::vector<SpatialRow> left_out_;
  double unit_ = 1;
  bool aligned_[3] = {};  // axes of both places that all rows together keep parallel
  int multiplier_;        // position among coordinates
  mutable Eigen::VectorXd row_;
};

}  // namespace floe::dynamics
