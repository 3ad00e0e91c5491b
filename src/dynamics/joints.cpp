#include "floe/dynamics/joints.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "open_rows.h"

namespace floe::dynamics {
namespace {

using Eigen::Vector2d;

/// A constraint at one instant, in poses: C at the asked level, dC/dy, and the Hessian of lambda . C.
struct Evaluation {
  Eigen::Vector3d C = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, 6> gradient = Eigen::Matrix<double, 3, 6>::Zero();
  Matrix6 hessian = Matrix6::Zero();
};

Vector6 at_level(ConstraintLevel level, const MarkerPair& pair) {
  return level == ConstraintLevel::position ? pair.y() : level == ConstraintLevel::velocity ? pair.yd() : pair.ydd();
}

void coincide(const Vector6& y, Evaluation& e) {
  e.C.head<2>() = y.segment<2>(3) - y.head<2>();
  e.gradient(0, 0) = e.gradient(1, 1) = -1;
  e.gradient(0, 3) = e.gradient(1, 4) = 1;
}

struct Evaluate {
  const Motion& motion;
  const MarkerPair& pair;
  const Eigen::Vector3d& lambda;

  Evaluation operator()(const Revolute&) const {
    Evaluation e;
    coincide(at_level(motion.level, pair), e);
    return e;
  }
  Evaluation operator()(const Clamp& clamp) const {
    Evaluation e;
    const Vector6 y = at_level(motion.level, pair);
    coincide(y, e);
    e.C[2] = y[5] - y[2] - at_level(motion.level, clamp.angle, motion.t);
    if (motion.level == ConstraintLevel::position) e.C[2] -= clamp.offset;
    e.gradient(2, 2) = -1, e.gradient(2, 5) = 1;
    return e;
  }
  Evaluation operator()(const Prismatic& slide) const {
    Evaluation e;
    const Vector6 y = pair.y(), level = at_level(motion.level, pair);
    const double c = std::cos(y[2]), s = std::sin(y[2]);
    const Vector2d n(c * slide.normal.x() - s * slide.normal.y(), s * slide.normal.x() + c * slide.normal.y());
    const Vector2d m(-n.y(), n.x());  // dn/dangle
    const Vector2d d = y.segment<2>(3) - y.head<2>();
    const Vector2d d_level = level.segment<2>(3) - level.head<2>();
    e.C[0] = n.dot(d_level);
    e.C[1] = level[5] - level[2];
    if (motion.level == ConstraintLevel::position) {
      e.C[0] -= slide.gap;
      e.C[1] -= slide.offset;
    } else {
      e.C[0] += level[2] * m.dot(d);
    }
    if (motion.level == ConstraintLevel::acceleration) {
      const Vector6 yd = pair.yd();
      const Vector2d dd = yd.segment<2>(3) - yd.head<2>();
      e.C[0] += 2 * yd[2] * m.dot(dd) - yd[2] * yd[2] * n.dot(d);
    }
    e.gradient.block<1, 2>(0, 0) = -n.transpose();
    e.gradient(0, 2) = m.dot(d);
    e.gradient.block<1, 2>(0, 3) = n.transpose();
    e.gradient(1, 2) = -1, e.gradient(1, 5) = 1;
    e.hessian(2, 2) = -lambda[0] * n.dot(d);
    e.hessian.block<2, 1>(0, 2) = -lambda[0] * m;
    e.hessian.block<2, 1>(3, 2) = lambda[0] * m;
    e.hessian.block<1, 2>(2, 0) = -lambda[0] * m.transpose();
    e.hessian.block<1, 2>(2, 3) = lambda[0] * m.transpose();
    return e;
  }
};

}  // namespace

int rows(const Constraint& constraint) { return std::holds_alternative<Clamp>(constraint) ? 3 : 2; }

namespace {

/// Positions need no rates, nor do their derivatives.
EvaluationLevel wanted(const Motion& motion) {
  return motion.level == ConstraintLevel::position ? EvaluationLevel::position : EvaluationLevel::velocity;
}

std::vector<int> all_rows(const Constraint& constraint) {
  std::vector<int> all(rows(constraint));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace

Joint::Joint(Marker first, Marker second, Constraint constraint, int multipliers, std::vector<int> independent,
             std::shared_ptr<ConstraintSwitch> constraint_switch, bool captures)
    : pair_(std::move(first), std::move(second)),
      constraint_(std::move(constraint)),
      independent_(std::move(independent)),
      multiplier_(static_cast<int>(pair_.coordinates.size())),
      constraint_switch_(std::move(constraint_switch)),
      captures_(captures) {
  for (std::size_t i = 0; i < independent_.size(); ++i) pair_.coordinates.push_back(multipliers + static_cast<int>(i));
}

Joint::Joint(Marker first, Marker second, const Constraint& constraint, int multipliers)
    : Joint(std::move(first), std::move(second), constraint, multipliers, all_rows(constraint)) {}

Eigen::Vector3d Joint::multipliers(const Motion& motion) const {
  Eigen::Vector3d lambda = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < independent_.size(); ++i) lambda[independent_[i]] = motion.q[multiplier_ + i];
  return lambda;
}

void Joint::residual(const Motion& motion, Eigen::VectorXd& r) const {
  if (!holds()) return add_open_rows(motion, multiplier_, static_cast<int>(independent_.size()), r);
  const Eigen::Vector3d lambda = multipliers(motion);
  pair_.evaluate(motion, wanted(motion));
  const Evaluation e = std::visit(Evaluate{motion, pair_, lambda}, constraint_);
  pair_.add(e.gradient.transpose() * lambda, r);
  for (std::size_t i = 0; i < independent_.size(); ++i) r[multiplier_ + i] += e.C[independent_[i]];
}

ConstraintStatus Joint::constraint_status(const Motion& motion) const {
  if (!holds() || !has_left_out_rows()) return ConstraintStatus::satisfied;
  pair_.evaluate(motion, EvaluationLevel::position);
  const Evaluation e = std::visit(Evaluate{motion, pair_, Eigen::Vector3d::Zero()}, constraint_);
  const int lengths = std::holds_alternative<Prismatic>(constraint_) ? 1 : 2;  // the rows before those of angles
  for (int row = 0; row < rows(constraint_); ++row)
    if (!std::binary_search(independent_.begin(), independent_.end(), row) &&
        !(std::abs(e.C[row]) <= 1e-3 * (row < lengths ? extent : 1)))
      return ConstraintStatus::violated;
  return ConstraintStatus::satisfied;
}

Wrench Joint::on_second(const Motion& motion) const {
  if (!holds()) return Wrench::Zero();
  const Eigen::Vector3d lambda = multipliers(motion);
  pair_.evaluate(motion, wanted(motion));
  return on_second_place(std::visit(Evaluate{motion, pair_, lambda}, constraint_).gradient.transpose() * lambda);
}

void Joint::tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const {
  if (!holds()) return add_open_tangent(multiplier_, static_cast<int>(independent_.size()), J);
  const Eigen::Vector3d lambda = multipliers(motion);
  pair_.evaluate(motion, wanted(motion));
  const Evaluation e = std::visit(Evaluate{motion, pair_, lambda}, constraint_);
  pair_.add_tangent(e.gradient.transpose() * lambda, e.hessian, Matrix6::Zero(), weights, J);
  for (std::size_t i = 0; i < independent_.size(); ++i) {
    row_.setZero(J.rows());
    pair_.add(e.gradient.row(independent_[i]).transpose(), row_);
    J.row(multiplier_ + i) += row_.transpose();
    J.col(multiplier_ + i) += row_;
  }
}

void Joint::add_corotated(std::vector<Corotated>& corotated) const {
  const bool whole = independent_.size() >= 2 && independent_[0] == 0 && independent_[1] == 1;
  const Marker& by = pair_.second.framed ? pair_.second : pair_.first;
  if (std::holds_alternative<Prismatic>(constraint_) || !whole || !by.framed) return;
  corotated.push_back({pair_.coordinates[multiplier_], by.coordinates[2]});
}

void Joint::begin_step(const Motion& motion) {
  if (!captures_) return;
  if (!constraint_switch_->closed) captured_ = false;
  if (captured_ || !constraint_switch_->closed) return;
  captured_ = true;
  pair_.evaluate(motion);
  const Vector6 y = pair_.y();
  if (auto* clamp = std::get_if<Clamp>(&constraint_)) *clamp = {y[5] - y[2], {}};
  if (auto* slide = std::get_if<Prismatic>(&constraint_)) {
    slide->gap = (Eigen::Rotation2Dd(y[2]) * slide->normal).dot(y.segment<2>(3) - y.head<2>());
    slide->offset = y[5] - y[2];
  }
}

void Joint::save(std::vector<double>& carried) const {
  if (!constraint_switch_) return;
  const auto* clamp = std::get_if<Clamp>(&constraint_);
  const auto* slide = std::get_if<Prismatic>(&constraint_);
  carried.push_back(constraint_switch_->closed), carried.push_back(captured_);
  carried.push_back(slide ? slide->gap : 0), carried.push_back(slide ? slide->offset : clamp ? clamp->offset : 0);
}

void Joint::load(std::span<const double> carried) {
  constraint_switch_->closed = carried[0] != 0, captured_ = carried[1] != 0;
  if (auto* clamp = std::get_if<Clamp>(&constraint_)) clamp->offset = carried[3];
  if (auto* slide = std::get_if<Prismatic>(&constraint_)) slide->gap = carried[2], slide->offset = carried[3];
}

}  // namespace floe::dynamics
