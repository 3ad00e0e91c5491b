#include "floe/dynamics/spatial_joint.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "floe/error.h"
#include "spatial_rows.h"

namespace floe::dynamics {
namespace {

using Rows = std::vector<SpatialRow>;

Rows point() { return {Coincide{0}, Coincide{1}, Coincide{2}}; }
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

SpatialConstraint pick_rows(const SpatialConstraint& constraint, const std::vector<int>& standing) {
  SpatialConstraint picked{{}, constraint.angle};
  for (int row : standing) picked.rows.push_back(constraint.rows.at(row));
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
    throw InputError("the length of a distance joint is not positive (a spherical joint holds places together)");
  return {{Separation{length}}};
}

SpatialConstraint SpatialConstraint::driven_revolute(TimeFunction angle) {
  return {point() + axes(), std::move(angle)};
}

SpatialConstraint SpatialConstraint::driven_prismatic(TimeFunction position) {
  return {line() + axes() + Rows{Along{2, 0, std::move(position)}}};
}

int rows(const SpatialConstraint& constraint) { return static_cast<int>(constraint.rows.size()); }

SpatialJoint::SpatialJoint(SpatialMarker first, SpatialMarker second, const SpatialConstraint& constraint,
                           int multipliers, const std::vector<int>& standing, double unit)
    : SpatialJoint(std::move(first), std::move(second), pick_rows(constraint, standing), multipliers) {
  find_aligned(constraint, aligned_);  // rows that are left out are met by others, on the same branch
  if (standing.empty()) pair_.coordinates.push_back(multipliers);  // by which it is known
  unit_ = unit;
  for (int row = 0; row < rows(constraint); ++row)
    if (!std::binary_search(standing.begin(), standing.end(), row)) left_out_.push_back(constraint.rows[row]);
}

SpatialJoint::SpatialJoint(SpatialMarker first, SpatialMarker second, SpatialConstraint constraint, int multipliers)
    : pair_(std::move(first), std::move(second)),
      constraint_(std::move(constraint)),
      multiplier_(static_cast<int>(pair_.coordinates.size())) {
  for (int i = 0; i < rows(constraint_); ++i) pair_.coordinates.push_back(multipliers + i);
  find_aligned(constraint_, aligned_);
}

Standing SpatialJoint::standing(const Motion& motion) const {
  pair_.evaluate(motion);
  const SeenPair seen(pair_, constraint_.angle, motion);
  for (int axis = 0; axis < 3; ++axis)
    if (aligned_[axis] && seen.first.D.col(axis).dot(seen.turned.col(axis)) < 0) return Standing::half_turn;
  for (const SpatialRow& row : left_out_) {
    const double unit = std::holds_alternative<Product>(row) ? 1 : unit_;
    if (!(std::abs(evaluate(row, seen).C) <= 1e-3 * unit)) return Standing::open;
  }
  return Standing::met;
}

void SpatialJoint::residual(const Motion& motion, Eigen::VectorXd& r) const {
  if (constraint_.rows.empty()) return;
  pair_.evaluate(motion);
  const SeenPair seen(pair_, constraint_.angle, motion);
  Vector12 wrench = Vector12::Zero();
  for (int i = 0; i < rows(constraint_); ++i) {
    const RowValue row = evaluate(constraint_.rows[i], seen);
    wrench += motion.q[multiplier_ + i] * row.gradient;
    r[multiplier_ + i] += row.C;
  }
  pair_.add(wrench, r);
}

void SpatialJoint::tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const {
  if (constraint_.rows.empty()) return;
  pair_.evaluate(motion);
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

}  // namespace floe::dynamics
