#pragma once
#include <Eigen/Core>
#include <functional>

namespace floe::testing {

/// df/dt by the five-point formula: exact for quartics, error h^4 f^(5)/30 otherwise. f gives numbers or vectors.
template <class Function>
auto derivative(const Function& f, double t, double h) {
  using Value = std::decay_t<decltype(f(t))>;
  return Value((8 * (f(t + h) - f(t - h)) - (f(t + 2 * h) - f(t - 2 * h))) / (12 * h));
}

/// Column j is df/dx_j, five-point.
Eigen::MatrixXd jacobian(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& f, const Eigen::VectorXd& x,
                         double h);
/// df/dx of a scalar function, five-point.
Eigen::VectorXd gradient(const std::function<double(const Eigen::VectorXd&)>& f, const Eigen::VectorXd& x, double h);

/// Greatest difference against the greatest entry of `expected`.
double relative_error(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected);

}  // namespace floe::testing
