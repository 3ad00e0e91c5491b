#include "floe/dynamics/spatial_joint.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "floe/error.h"
#include "open_rows.h"
#include "spatial_rows.h"

namespace floe::dynamics {
namespace {

using Rows = std::vector<SpatialRow>;

Rows point() { return {PointCoincidence{0}, PointCoincidence{1}, PointCoincidence{2}}; }
/// The second place on the z of the first.
Rows line() { return {Along{0}, Along{1}}; }
Rows axes() { return {Product{1, 0}, Product{2, 1}, Product{0, 2}}; }
Rows axis_z() { return {Product{2, 0}, Product{2, 1}}; }

Rows operator+(Rows rows, const Rows& more) {
  rows.insert(rows.end(), more.begin(), more.end());
  return rows;
}

/// Which axes of both places Products keep parallel: all by three of them, z by two, none by one.
void find_aligned(const SpatialConstraint& constraint, bool (&aligned)[3]) {
  const auto products = std::count_if(constraint.rows.begin(), constraint.rows.end(),
                                      [](const SpatialRow& row) { return std::holds_alternative<Product>(row); });
  aligned[0] = aligned[1] = products >= 3;
  aligned[2] = products >= 2;
}

SpatialConstraint pick_rows(const SpatialConstraint& constraint, const std::vector<int>& independent) {
  SpatialConstraint picked{{}, constraint.angle};
  for (int row : independent) picked.rows.push_back(constraint.rows.at(row));
  return picked;
}

}  // namespace

SpatialConstraint SpatialConstraint::fixed() { return {point() + axes()}; }
SpatialConstraint SpatialConstraint::revolute() { return {point() + axis_z()}; }
SpatialConstraint SpatialConstraint::prismatic() { return {line() + axes()}; }
SpatialConstraint SpatialConstraint::cylindrical() { return {line() + axis_z()}; }
SpatialConstraint SpatialConstraint::spherical() { return {point()}; }
SpatialConstraint SpatialConstraint::universal() { return {point() + Rows{Product{2, 0}}}; }
SpatialConstraint SpatialConstraint::planar() { return {Rows{Along{2}} + axis_z()}; }

SpatialConstraint SpatialConstraint::distance(double length) {
  if (!(length > 0))
    throw InputError("the length of a distance joint is not positive; use a spherical joint for coinciding places");
  return {{Separation{length}}};
}

SpatialConstraint SpatialConstraint::driven_revolute(TimeFunction angle) {
  return {point() + axes(), std::move(angle)};
}

SpatialConstraint SpatialConstraint::driven_prismatic(TimeFunction position) {
  return {line() + axes() + Rows{Along{2, 0, std::move(position)}}};
}

SpatialConstraint lock_of(const SpatialConstraint& joint) {
  bool places[3] = {true, true, true}, rotations[3] = {true, true, true};  // free: along and about x, y, z
  int products = 0;
  for (const SpatialRow& row : joint.rows) {
    if (const auto* coincide = std::get_if<PointCoincidence>(&row)) places[coincide->axis] = false;
    if (const auto* along = std::get_if<Along>(&row)) places[along->axis] = false;
    if (std::holds_alternative<Product>(row)) ++products;
    if (std::holds_alternative<Separation>(row)) return {};
  }
  if (products == 1) return {};  // universal: what it leaves free rotates about axes of both places
  if (products >= 2) rotations[0] = rotations[1] = false;
  if (products == 3) rotations[2] = false;
  SpatialConstraint lock;
  for (int axis = 0; axis < 3; ++axis)
    if (places[axis]) lock.rows.push_back(Along{axis});
  if (rotations[2]) lock.rows.push_back(Product{1, 0});
  if (rotations[0]) lock.rows.push_back(Product{2, 1});
  if (rotations[1]) lock.rows.push_back(Product{0, 2});
  return lock;
}

int rows(const SpatialConstraint& constraint) { return static_cast<int>(constraint.rows.size()); }

SpatialJoint::SpatialJoint(SpatialMarker first, SpatialMarker second, const SpatialConstraint& constraint,
                           int multipliers, const std::vector<int>& independent, double unit,
                           std::shared_ptr<ConstraintSwitch> constraint_switch)
    : SpatialJoint(std::move(first), std::move(second), pick_rows(constraint, independent), multipliers,
                   std::move(constraint_switch)) {
  find_aligned(constraint, aligned_);  // rows that are left out are met by others, on the same branch
  if (independent.empty()) pair_.coordinates.push_back(multipliers);  // by which it is known
  unit_ = unit;
  for (int row = 0; row < rows(constraint); ++row)
    if (!std::binary_search(independent.begin(), independent.end(), row)) left_out_.push_back(constraint.rows[row]);
}

SpatialJoint::SpatialJoint(SpatialMarker first, SpatialMarker second, SpatialConstraint constraint, int multipliers,
                           std::shared_ptr<ConstraintSwitch> constraint_switch, bool captures)
    : pair_(std::move(first), std::move(second)),
      constraint_switch_(std::move(constraint_switch)),
      captures_(captures),
      constraint_(std::move(constraint)),
      multiplier_(static_cast<int>(pair_.coordinates.size())) {
  for (int i = 0; i < rows(constraint_); ++i) pair_.coordinates.push_back(multipliers + i);
  find_aligned(constraint_, aligned_);
}

ConstraintStatus SpatialJoint::constraint_status(const Motion& motion) const {
  if (!holds() || (captures_ && !captured_)) return ConstraintStatus::satisfied;
  pair_.evaluate(motion, EvaluationLevel::position);
  const SeenPair seen(pair_, constraint_.angle, motion);
  for (int axis = 0; axis < 3; ++axis)
    if (aligned_[axis] && seen.first.D.col(axis).dot(seen.rotated.col(axis)) < 0)
      return ConstraintStatus::flipped_branch;
  for (const SpatialRow& row : left_out_) {
    const double unit = std::holds_alternative<Product>(row) ? 1 : unit_;
    if (!(std::abs(evaluate(row, seen).C) <= 1e-3 * unit)) return ConstraintStatus::violated;
  }
  return ConstraintStatus::satisfied;
}

void SpatialJoint::residual(const Motion& motion, Eigen::VectorXd& r) const {
  if (constraint_.rows.empty()) return;
  if (!holds()) return add_open_rows(motion, multiplier_, rows(constraint_), r);
  pair_.evaluate(motion,
                 motion.level == ConstraintLevel::position ? EvaluationLevel::position : EvaluationLevel::velocity);
  const SeenPair seen(pair_, constraint_.angle, motion);
  Vector12 wrench = Vector12::Zero();
  for (int i = 0; i < rows(constraint_); ++i) {
    const RowValue row = evaluate(constraint_.rows[i], seen);
    wrench += motion.q[multiplier_ + i] * row.gradient;
    r[multiplier_ + i] += row.C;
  }
  pair_.add(wrench, r);
}

Wrench SpatialJoint::on_second(const Motion& motion) const {
  if (!holds()) return Wrench::Zero();
  pair_.evaluate(motion, EvaluationLevel::position);
  const SeenPair seen(pair_, constraint_.angle, motion);
  Wrench wrench = Wrench::Zero();
  for (int i = 0; i < rows(constraint_); ++i)
    wrench -= motion.q[multiplier_ + i] * evaluate(constraint_.rows[i], seen).gradient.tail<6>();
  return wrench;
}

void SpatialJoint::tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const {
  if (constraint_.rows.empty()) return;
  if (!holds()) return add_open_tangent(multiplier_, rows(constraint_), J);
  pair_.evaluate(motion,
                 motion.level == ConstraintLevel::position ? EvaluationLevel::jacobian : EvaluationLevel::velocity);
  const SeenPair seen(pair_, constraint_.angle, motion);
  Vector12 wrench = Vector12::Zero();
  Matrix12 Y = Matrix12::Zero();
  for (int i = 0; i < rows(constraint_); ++i) {
    const double lambda = motion.q[multiplier_ + i];
    const Vector12 gradient = evaluate(constraint_.rows[i], seen).gradient;
    wrench += lambda * gradient;
    add_curvature(constraint_.rows[i], seen, lambda, Y);
    row_.setZero(J.rows());
    pair_.add(gradient, row_);
    J.col(multiplier_ + i) += row_;
    row_.setZero();
    pair_.add_gradient(gradient, row_);
    J.row(multiplier_ + i) += row_.transpose();
  }
  pair_.add_tangent(wrench, Y, Matrix12::Zero(), weights, J);
}

void SpatialJoint::add_corotated(std::vector<Corotated>& corotated) const {
  const auto holds_axis = [&](int row, int axis) {
    const auto* coincide = row < rows(constraint_) ? std::get_if<PointCoincidence>(&constraint_.rows[row]) : nullptr;
    return coincide && coincide->axis == axis;
  };
  const SpatialMarker& by = pair_.marker[pair_.marker[1].framed() ? 1 : 0];
  if (!by.framed()) return;
  for (int row = 0; row < rows(constraint_); ++row)
    if (holds_axis(row, 0) && holds_axis(row + 1, 1) && holds_axis(row + 2, 2))
      corotated.push_back({pair_.coordinates[multiplier_ + row], by.coordinates[3]});
}

void SpatialJoint::begin_step(const Motion& motion) {
  if (!captures_) return;
  if (!constraint_switch_->closed) captured_ = false;
  if (captured_ || !constraint_switch_->closed) return;
  captured_ = true;
  pair_.evaluate(motion);
  const SpatialPose &one = pair_.pose[0], &two = pair_.pose[1];
  pair_.marker[1].D0 *= two.D.transpose() * one.D;
  for (SpatialRow& row : constraint_.rows)
    if (auto* along = std::get_if<Along>(&row)) along->offset = one.D.col(along->axis).dot(two.p - one.p);
}

void SpatialJoint::save(std::vector<double>& carried) const {
  if (!constraint_switch_) return;
  carried.push_back(constraint_switch_->closed), carried.push_back(captured_);
  if (!captures_) return;
  for (const double entry : pair_.marker[1].D0.reshaped()) carried.push_back(entry);
  for (const SpatialRow& row : constraint_.rows)
    if (const auto* along = std::get_if<Along>(&row)) carried.push_back(along->offset);
}

void SpatialJoint::load(std::span<const double> carried) {
  constraint_switch_->closed = carried[0] != 0, captured_ = carried[1] != 0;
  if (!captures_) return;
  pair_.marker[1].D0 = Eigen::Map<const Eigen::Matrix3d>(carried.data() + 2);
  std::size_t next = 11;
  for (SpatialRow& row : constraint_.rows)
    if (auto* along = std::get_if<Along>(&row)) along->offset = carried[next++];
}

}  // namespace floe::dynamics
