#include "floe/dynamics/state_formula.h"

#include "floe/dynamics/local_indices.h"

namespace floe::dynamics {

Motion StateFormula::Part::of(const Motion& motion) {
  pick(where, motion.q, q), pick(where, motion.v, v), pick(where, motion.a, a);
  return {motion.t, q, v, a, motion.level};
}

StateFormula::StateFormula(math::Formula formula, std::vector<std::unique_ptr<Sensor>> sensors)
    : formula_(std::move(formula)),
      sensors_(std::move(sensors)),
      arguments_(sensors_.size() + 1),
      derivatives_(arguments_.size()) {
  for (const auto& sensor : sensors_) parts_.push_back({place_all(sensor->coordinates(), coordinates_), {}, {}, {}});
}

double StateFormula::value(const Motion& motion) const {
  arguments_[0] = motion.t;
  for (std::size_t i = 0; i < sensors_.size(); ++i) arguments_[i + 1] = sensors_[i]->value(parts_[i].of(motion));
  return formula_.value(arguments_);
}

double StateFormula::gradient(const Motion& motion, Eigen::VectorXd& by_q, Eigen::VectorXd& by_v) const {
  value(motion);
  const double f = formula_.gradient(arguments_, derivatives_);
  by_q.setZero(motion.q.size()), by_v.setZero(motion.q.size());
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    const double by_sensor = derivatives_[i + 1];
    if (by_sensor == 0) continue;
    const Motion part = parts_[i].of(motion);
    by_q_.setZero(part.q.size()), by_v_.setZero(part.q.size());
    sensors_[i]->add_gradient(part, by_q_, by_v_);
    for (std::size_t k = 0; k < parts_[i].where.size(); ++k) {
      by_q[parts_[i].where[k]] += by_sensor * by_q_[k];
      by_v[parts_[i].where[k]] += by_sensor * by_v_[k];
    }
  }
  return f;
}

void StateFormula::begin_step(const Motion& motion) {
  for (std::size_t i = 0; i < sensors_.size(); ++i) sensors_[i]->begin_step(parts_[i].of(motion));
}

void StateFormula::save(std::vector<double>& carried) const {
  for (const auto& sensor : sensors_) sensor->save(carried);
}

std::span<const double> StateFormula::load(std::span<const double> carried) {
  for (const auto& sensor : sensors_) carried = sensor->load(carried);
  return carried;
}

}  // namespace floe::dynamics
