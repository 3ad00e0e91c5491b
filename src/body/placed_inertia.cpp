#include "floe/body/placed_inertia.h"

namespace floe::body {
namespace {

/// sum_cd R_ac R_bd X_cd.
template <class Form>
std::vector<std::vector<Form>> rotated(const std::vector<std::vector<Form>>& X, const Eigen::MatrixXd& R) {
  std::vector<std::vector<Form>> Y = X;
  const int d = static_cast<int>(X.size());
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b) {
      Y[a][b].setZero();
      for (int c = 0; c < d; ++c)
        for (int e = 0; e < d; ++e) Y[a][b] += R(a, c) * R(b, e) * X[c][e];
    }
  return Y;
}

}  // namespace

Inertia placed(const Inertia& inertia, const Eigen::MatrixXd& R, const Eigen::VectorXd& r) {
  const int d = inertia.dimension();
  Inertia result = inertia;
  const Eigen::VectorXd s = R * inertia.s0;
  result.s0 = s + inertia.m * r;
  result.C0 = R * inertia.C0 * R.transpose() + s * r.transpose() + r * s.transpose() + inertia.m * r * r.transpose();
  result.S = R * inertia.S;
  for (std::size_t a = 0; a < inertia.Q.size(); ++a) {
    result.Q[a].setZero();
    for (std::size_t c = 0; c < inertia.Q.size(); ++c) result.Q[a] += R(a, c) * inertia.Q[c];
  }
  result.h = rotated(inertia.h, R);
  result.M = rotated(inertia.M, R);
  result.W = rotated(inertia.W, R);
  if (!result.Q.empty()) result.allocate_rotary();
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b) {
      result.h[a][b] += r[a] * result.S.row(b).transpose();
      if (!result.Q.empty()) result.W[a][b] += r[a] * result.Q[b];
    }
  return result;
}

}  // namespace floe::body
