#include "differences.h"

namespace floe::testing {

Eigen::MatrixXd jacobian(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& f, const Eigen::VectorXd& x,
                         double h) {
  Eigen::MatrixXd J(f(x).size(), x.size());
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    const auto along = [&](double shift) {
      Eigen::VectorXd moved = x;
      moved[j] += shift;
      return f(moved);
    };
    J.col(j) = derivative(along, 0, h);
  }
  return J;
}

Eigen::VectorXd gradient(const std::function<double(const Eigen::VectorXd&)>& f, const Eigen::VectorXd& x, double h) {
  const auto as_vector = [&](const Eigen::VectorXd& y) { return Eigen::VectorXd::Constant(1, f(y)).eval(); };
  return jacobian(as_vector, x, h).transpose();
}

double relative_error(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected) {
  const double scale = expected.cwiseAbs().maxCoeff();
  return (found - expected).cwiseAbs().maxCoeff() / (scale > 0 ? scale : 1);
}

}  // namespace floe::testing
