#include "floe/dynamics/state_force.h"

#include "floe/dynamics/local_indices.h"

namespace floe::dynamics {

using Eigen::Index;

Motion StateForce::Part::of(const Motion& motion) {
  pick(where, motion.q, q), pick(where, motion.v, v), pick(where, motion.a, a);
  return {motion.t, q, v, a, motion.level};
}

StateForce::StateForce(std::unique_ptr<Term> unit, std::shared_ptr<StateFormula> formula)
    : unit_(std::move(unit)), formula_(std::move(formula)) {
  of_unit_.where = place_all(unit_->coordinates(), coordinates_);
  of_formula_.where = place_all(formula_->coordinates(), coordinates_);
}

void StateForce::residual(const Motion& motion, Eigen::VectorXd& r) const {
  const double size = formula_->value(of_formula_.of(motion));
  const Motion part = of_unit_.of(motion);
  rows_.setZero(part.q.size());
  unit_->residual(part, rows_);
  for (std::size_t i = 0; i < of_unit_.where.size(); ++i) r[of_unit_.where[i]] += size * rows_[i];
}

void StateForce::tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const {
  const double size = formula_->gradient(of_formula_.of(motion), by_q_, by_v_);
  const Motion part = of_unit_.of(motion);
  const Index n = part.q.size();
  block_.setZero(n, n), rows_.setZero(n);
  unit_->tangent(part, weights, block_);
  unit_->residual(part, rows_);
  for (Index column = 0; column < n; ++column)
    for (Index row = 0; row < n; ++row) J(of_unit_.where[row], of_unit_.where[column]) += size * block_(row, column);
  for (Index column = 0; column < by_q_.size(); ++column) {
    const double by = weights.q * by_q_[column] + weights.v * by_v_[column];
    for (Index row = 0; by != 0 && row < n; ++row) J(of_unit_.where[row], of_formula_.where[column]) += rows_[row] * by;
  }
}

Wrench StateForce::on_second(const Motion& motion) const {
  const auto* connection = dynamic_cast<const Connection*>(unit_.get());
  if (!connection) return Wrench::Zero();
  return formula_->value(of_formula_.of(motion)) * connection->on_second(of_unit_.of(motion));
}

void StateForce::begin_step(const Motion& motion) {
  unit_->begin_step(of_unit_.of(motion));
  formula_->begin_step(of_formula_.of(motion));
}

void StateForce::save(std::vector<double>& carried) const {
  formula_->save(carried);
  unit_->save(carried);
}

void StateForce::load(std::span<const double> carried) { unit_->load(formula_->load(carried)); }

}  // namespace floe::dynamics
