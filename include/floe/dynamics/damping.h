#pragma once
#include "floe/body/viscosity.h"
#include "floe/dynamics/term.h"

namespace floe::dynamics {

/// r += C q' with a constant C, symmetric and not negative: on coordinates that no rigid motion changes.
class LinearDamping final : public Term {
 public:
  LinearDamping(std::vector<int> coordinates, Eigen::MatrixXd C)
      : coordinates_(std::move(coordinates)), C_(std::move(C)) {}
  const std::vector<int>& coordinates() const override { return coordinates_; }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override { r.noalias() += C_ * motion.v; }
  void tangent(const Motion&, Weights weights, Eigen::MatrixXd& J) const override { J += weights.v * C_; }

 private:
  std::vector<int> coordinates_;
  Eigen::MatrixXd C_;
};

/// Stiffness-proportional damping of an elastic body, or of one element: beta times the Kelvin-Voigt force of its
/// strain rates (body::add_viscous_force), on its elastic coordinates in body axes. [s]
class StrainRateDamping final : public Term {
 public:
  StrainRateDamping(std::vector<int> coordinates, body::Elasticity elasticity, double beta)
      : coordinates_(std::move(coordinates)), elasticity_(std::move(elasticity)), beta_(beta) {}
  const std::vector<int>& coordinates() const override { return coordinates_; }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override {
    body::add_viscous_force(elasticity_, motion.q, motion.v, beta_, work_, r);
  }
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override {
    body::add_viscous_tangent(elasticity_, motion.q, motion.v, beta_ * weights.q, beta_ * weights.v, work_, J);
  }
  double strain_damping() const override { return beta_; }

 private:
  std::vector<int> coordinates_;
  body::Elasticity elasticity_;
  double beta_;
  mutable body::ViscosityWork work_;
};

}  // namespace floe::dynamics
