#pragma once
#include <memory>

#include "floe/dynamics/connection.h"
#include "floe/dynamics/state_formula.h"

namespace floe::dynamics {

/// A load whose size is a formula of time and of what sensors measure:
///
///   r = f(t, s_1(q, v), ..., s_n(q, v)) d(q)
///
/// with d the rows of the load of size 1. Its tangent is exact, by the derivatives of the formula:
///
///   f dd/dq + d sum_i df/ds_i (ds_i/dq, ds_i/dv)
///
/// It has no energy: its work counts as that of loads.
class StateForce final : public Connection {
 public:
  /// @param unit     the load of size 1, which may depend on the configuration alone
  /// @param formula  which several parts of one load have in common
  StateForce(std::unique_ptr<Term> unit, std::shared_ptr<StateFormula> formula);
  const std::vector<int>& coordinates() const override { return coordinates_; }
  /// @throws math::FormulaError  its value or one of its derivatives is not finite
  void residual(const Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override;
  /// Of a load on a joint; else zero.
  Wrench on_second(const Motion& motion) const override;
  void begin_step(const Motion& motion) override;
  void save(std::vector<double>& carried) const override;
  void load(std::span<const double> carried) override;

 private:
  /// The motion of some of the coordinates.
  struct Part {
    std::vector<int> where;
    Eigen::VectorXd q, v, a;
    Motion of(const Motion& motion);
  };
  std::unique_ptr<Term> unit_;
  std::shared_ptr<StateFormula> formula_;
  std::vector<int> coordinates_;
  mutable Part of_unit_, of_formula_;
  mutable Eigen::VectorXd rows_, by_q_, by_v_;
  mutable Eigen::MatrixXd block_;
};

}  // namespace floe::dynamics
