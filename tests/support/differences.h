#pragma once
#include <Eigen/Dense>

namespace floe::testing {

/// df/dt by the five-point formula: exact for quartics, error h^4 f^(5)/30 otherwise. f gives numbers or vectors.
template <class Function>
auto derivative(const Function& f, double t, double h) {
  using Value = std::decay_t<decltype(f(t))>;
  return Value((8 * (f(t + h) - f(t - h)) - (f(t + 2 * h) - f(t - 2 * h))) / (12 * h));
}

/// Column j is df/dx_j, five-point.
template <class Function>
Eigen::MatrixXd jacobian(const Function& f, const Eigen::VectorXd& x, double h) {
  Eigen::MatrixXd J(f(x).size(), x.size());
  for (Eigen::Index j = 0; j < x.size(); ++j)
    J.col(j) = derivative(
        [&](double shift) {
          Eigen::VectorXd moved = x;
          moved[j] += shift;
          return Eigen::VectorXd(f(moved));
        },
        0, h);
  return J;
}

/// df/dx of a scalar function, five-point.
template <class Function>
Eigen::VectorXd gradient(const Function& f, const Eigen::VectorXd& x, double h) {
  return jacobian([&](const Eigen::VectorXd& y) { return Eigen::VectorXd::Constant(1, f(y)); }, x, h).transpose();
}

/// Greatest difference against the greatest entry of `expected`.
template <class A, class B>
double relative_error(const A& found, const B& expected) {
  const double scale = expected.cwiseAbs().maxCoeff();
  return (found - expected).cwiseAbs().maxCoeff() / (scale > 0 ? scale : 1);
}

}  // namespace floe::testing
