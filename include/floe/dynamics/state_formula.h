#pragma once
#include <memory>

#include "floe/dynamics/sensor.h"
#include "floe/math/formula.h"

namespace floe::dynamics {

/// A formula of time and of what sensors measure: f(t, s_1(q, v), ..., s_n(q, v)).
class StateFormula {
 public:
  /// @param formula  of t and then the sensors in their order
  StateFormula(math::Formula formula, std::vector<std::unique_ptr<Sensor>> sensors);
  /// Of all sensors, each once; the motions below are theirs.
  const std::vector<int>& coordinates() const { return coordinates_; }
  /// @throws math::FormulaError  not finite
  double value(const Motion& motion) const;
  /// Returns f, and sets its derivatives by the coordinates at fixed velocities, and by the velocities:
  /// sum_i df/ds_i (ds_i/dq, ds_i/dv). @throws math::FormulaError
  double gradient(const Motion& motion, Eigen::VectorXd& by_q, Eigen::VectorXd& by_v) const;
  /// As of Term; `load` returns what it leaves over.
  void begin_step(const Motion& motion);
  void save(std::vector<double>& carried) const;
  std::span<const double> load(std::span<const double> carried);

 private:
  /// The motion of one sensor's coordinates.
  struct Part {
    std::vector<int> where;
    Eigen::VectorXd q, v, a;
    Motion of(const Motion& motion);
  };
  math::Formula formula_;
  std::vector<std::unique_ptr<Sensor>> sensors_;
  std::vector<int> coordinates_;
  mutable std::vector<Part> parts_;
  mutable std::vector<double> arguments_, derivatives_;
  mutable Eigen::VectorXd by_q_, by_v_;
};

/// Lets the sensors of a formula that nothing depends on take part in the steps: it has no rows.
class Watch final : public Term {
 public:
  explicit Watch(std::shared_ptr<StateFormula> formula) : formula_(std::move(formula)) {}
  const std::vector<int>& coordinates() const override { return formula_->coordinates(); }
  void residual(const Motion&, Eigen::VectorXd&) const override {}
  void tangent(const Motion&, Weights, Eigen::MatrixXd&) const override {}
  void begin_step(const Motion& motion) override { formula_->begin_step(motion); }
  void save(std::vector<double>& carried) const override { formula_->save(carried); }
  void load(std::span<const double> carried) override { formula_->load(carried); }

 private:
  std::shared_ptr<StateFormula> formula_;
};

}  // namespace floe::dynamics
