#include <algorithm>
#include <cmath>

#include "floe/body/spatial_frame.h"

namespace floe::body {
namespace {

/// Whether a form adds nothing to M beyond its round-off: |F_ij| < 1e-15 sqrt(M_ii M_jj).
bool vanishes(const Eigen::MatrixXd& form, const Eigen::MatrixXd& M) {
  const Eigen::ArrayXd root = M.diagonal().array().max(0).sqrt();
  return (form.array().abs() <= 1e-15 * (root.matrix() * root.matrix().transpose()).array()).all();
}

Eigen::MatrixXd form_of(const Inertia& in, int kind) {
  const int a = kind % 3, b = (a + 1) % 3, c = (a + 2) % 3;
  const auto with = [&](const Eigen::MatrixXd& form, auto&& of_W) {
    return in.W.empty() ? form : Eigen::MatrixXd(form + of_W());
  };
  if (kind < 3) return with(in.M[a][a], [&] { return in.W[a][a]; });
  if (kind < 6) return with(in.M[b][c] + in.M[c][b], [&] { return Eigen::MatrixXd(in.W[b][c] + in.W[c][b]); });
  if (kind < 9) return in.M[c][b] - in.M[b][c];
  return in.W[b][c] - in.W[c][b];
}

/// dJ/de and G at e = 0.
void set_linear(const Inertia& in, SpatialInertia& s) {
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    s.linear.col(a) = 2 * (in.h[b][b] + in.h[c][c]);
    s.linear.col(3 + a) = -(in.h[b][c] + in.h[c][b]);
    s.linear.col(6 + a) = in.h[b][c] - in.h[c][b];
  }
}

}  // namespace

SpatialInertia spatial(const Inertia& in) {
  const int k = in.coordinates();
  SpatialInertia s;
  s.m = in.m;
  s.s0 = in.s0;
  s.J0 = in.C0.trace() * Eigen::Matrix3d::Identity() - in.C0;
  s.S = in.S;
  s.Q = in.Q;
  s.linear.resize(k, 9);
  set_linear(in, s);
  s.M = in.M[0][0] + in.M[1][1] + in.M[2][2];
  std::vector<Eigen::MatrixXd> kept;
  for (int kind = 0; kind < (in.W.empty() ? 9 : 12); ++kind) {
    const Eigen::MatrixXd form = form_of(in, kind);
    if (vanishes(form, s.M)) continue;
    kept.push_back(form);
    s.kinds.push_back(kind);
    s.symmetric += kind < 6;
  }
  s.forms.resize(k, k * static_cast<Eigen::Index>(kept.size()));
  for (std::size_t i = 0; i < kept.size(); ++i) s.forms.middleCols(static_cast<Eigen::Index>(i) * k, k) = kept[i];
  return s;
}

}  // namespace floe::body
