#pragma once
#include <Eigen/Dense>
#include <stdexcept>

/// Generalised-alpha without constraints and without PETSc: a second integrator, independent of floe's, for the tests.
///     q+ = q + h v + h^2 ((1/2 - beta) s + beta s+),   v+ = v + h ((1 - gamma) s + gamma s+)
///     (1 - alpha_m) s+ + alpha_m s = (1 - alpha_f) a+ + alpha_f a,   residual(t+, q+, v+, a+) = 0
/// residual(t, q, v, a) gives a vector, tangent(q, v, a, w) the matrix w0 dr/dq + w1 dr/dv + w2 dr/da.
/// Source: Arnold & Bruels 2007, Multibody System Dynamics 18.
template <class Residual, class Tangent>
class DenseGeneralizedAlpha {
 public:
  /// From rest at q = 0, with the accelerations that the equations demand there.
  DenseGeneralizedAlpha(Eigen::Index size, double step, double radius, Residual residual, Tangent tangent)
      : h_(step),
        alpha_m_((2 * radius - 1) / (radius + 1)),
        alpha_f_(radius / (radius + 1)),
        residual_(residual),
        tangent_(tangent) {
    q = v = a_ = Eigen::VectorXd::Zero(size);
    s_ = a_ = -tangent_(q, v, a_, Eigen::Vector3d(0, 0, 1)).partialPivLu().solve(residual_(0, q, v, a_));
  }

  Eigen::VectorXd q, v;

  /// @throws std::runtime_error when Newton's method does not converge in 20 iterations
  void step() {
    const double gamma = 0.5 + alpha_f_ - alpha_m_, beta = (gamma + 0.5) * (gamma + 0.5) / 4;
    const double by_a = (1 - alpha_f_) / (1 - alpha_m_);  // ds+/da+
    const Eigen::Vector3d weights(h_ * h_ * beta * by_a, h_ * gamma * by_a, 1);
    const Eigen::VectorXd s_fixed = (alpha_f_ * a_ - alpha_m_ * s_) / (1 - alpha_m_);
    const Eigen::VectorXd q_fixed = q + h_ * v + h_ * h_ * (0.5 - beta) * s_, v_fixed = v + h_ * (1 - gamma) * s_;
    const auto follow = [&] {
      s_ = s_fixed + by_a * a_;
      q = q_fixed + h_ * h_ * beta * s_;
      v = v_fixed + h_ * gamma * s_;
    };
    follow();
    const double t = ++steps_ * h_;
    for (int iteration = 0; iteration < 20; ++iteration) {
      const Eigen::VectorXd change = tangent_(q, v, a_, weights).partialPivLu().solve(residual_(t, q, v, a_));
      a_ -= change;
      follow();
      if (h_ * h_ * change.norm() <= 1e-13 * (1 + q.norm())) return;
    }
    throw std::runtime_error("generalised-alpha: Newton did not converge");
  }

 private:
  double h_, alpha_m_, alpha_f_;
  Residual residual_;
  Tangent tangent_;
  Eigen::VectorXd a_, s_;
  long steps_ = 0;
};
