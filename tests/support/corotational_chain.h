#pragma once
#include <Eigen/Dense>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "floe/reference/corotational_beam.h"

/// A straight beam of corotational elements along x from the origin, constrained at its first node; dense, without
/// PETSc.
///
/// Unknowns: three a node, in the order of the nodes, without the first `constrained` ones (3: clamped, 2: hinged).
class CorotationalChain {
 public:
  using Beam = floe::reference::CorotationalBeam;

  CorotationalChain(int count, double length, Beam::Properties properties, int constrained = 3,
                    Eigen::Vector2d gravity = Eigen::Vector2d::Zero())
      : held_(constrained), size_(3 * (count + 1) - constrained) {
    for (int i = 0; i < count; ++i) {
      std::vector<int> coordinates(6);
      std::iota(coordinates.begin(), coordinates.end(), 3 * i);
      elements_.emplace_back(coordinates, Eigen::Vector2d(i * length / count, 0),
                             Eigen::Vector2d((i + 1) * length / count, 0), properties, gravity);
    }
  }

  int size() const { return size_; }
  Eigen::VectorXd zero() const { return Eigen::VectorXd::Zero(size_); }

  Eigen::VectorXd residual(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(size_ + held_), r(6);
    each(q, v, a, [&](const Beam& beam, int first, const floe::dynamics::Motion& motion) {
      r.setZero();
      beam.residual(motion, r);
      sum.segment<6>(first) += r;
    });
    return sum.tail(size_);
  }

  Eigen::MatrixXd tangent(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a,
                          floe::dynamics::Weights weights) const {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size_ + held_, size_ + held_), J(6, 6);
    each(q, v, a, [&](const Beam& beam, int first, const floe::dynamics::Motion& motion) {
      J.setZero();
      beam.tangent(motion, weights, J);
      sum.block<6, 6>(first, first) += J;
    });
    return sum.bottomRightCorner(size_, size_);
  }

  double energy(const Eigen::VectorXd& q, const Eigen::VectorXd& v) const {
    double sum = 0;
    each(q, v, v, [&](const Beam& beam, int, const floe::dynamics::Motion& motion) {
      const auto energy = beam.energy(motion);
      sum += energy.kinetic + energy.elastic + energy.potential;
    });
    return sum;
  }

  /// Equilibrium under a dead load by Newton from q. @throws std::runtime_error after 40 iterations
  Eigen::VectorXd equilibrium(const Eigen::VectorXd& load, Eigen::VectorXd q) const {
    for (int iteration = 0; iteration < 40; ++iteration) {
      const Eigen::VectorXd out_of_balance = load - residual(q, zero(), zero());
      const Eigen::VectorXd step = tangent(q, zero(), zero(), {1, 0, 0}).partialPivLu().solve(out_of_balance);
      q += step;
      if (step.norm() < 1e-10 * (1 + q.norm())) return q;
    }
    throw std::runtime_error("no equilibrium");
  }

 private:
  template <class Sink>
  void each(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a, Sink sink) const {
    const auto with_constrained = [&](const Eigen::VectorXd& x) {
      Eigen::VectorXd all = Eigen::VectorXd::Zero(size_ + held_);
      all.tail(size_) = x;
      return all;
    };
    const Eigen::VectorXd q_all = with_constrained(q), v_all = with_constrained(v), a_all = with_constrained(a);
    Eigen::VectorXd qe(6), ve(6), ae(6);
    for (size_t i = 0; i < elements_.size(); ++i) {
      const int first = 3 * static_cast<int>(i);
      qe = q_all.segment<6>(first), ve = v_all.segment<6>(first), ae = a_all.segment<6>(first);
      sink(elements_[i], first, floe::dynamics::Motion{0, qe, ve, ae});
    }
  }

  int held_, size_;
  std::vector<Beam> elements_;
};
