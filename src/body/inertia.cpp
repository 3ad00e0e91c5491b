#include "floe/body/inertia.h"

namespace floe::body {

Inertia::Inertia(int d, int k)
    : s0(Eigen::VectorXd::Zero(d)),
      C0(Eigen::MatrixXd::Zero(d, d)),
      S(Eigen::MatrixXd::Zero(d, k)),
      h(d, std::vector<Eigen::VectorXd>(d, Eigen::VectorXd::Zero(k))),
      M(d, std::vector<Eigen::MatrixXd>(d, Eigen::MatrixXd::Zero(k, k))) {}

void Inertia::add(const MassPoint& point) {
  const int d = dimension();
  m += point.mass;
  s0 += point.mass * point.x;
  C0 += point.mass * point.x * point.x.transpose();
  S += point.mass * point.N;
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b) {
      h[a][b] += point.mass * point.x[a] * point.N.row(b).transpose();
      M[a][b].noalias() += point.mass * point.N.row(a).transpose() * point.N.row(b);
    }
}

void Inertia::allocate_rotary() {
  const int d = dimension(), k = coordinates();
  if (W.empty()) W.assign(d, std::vector<Eigen::MatrixXd>(d, Eigen::MatrixXd::Zero(k, k)));
}

Eigen::Matrix3d rotary_form(const Eigen::Matrix3d& E, int a, int b) {
  Eigen::Matrix3d T = -E(a, b) * Eigen::Matrix3d::Identity();
  T.row(b) += E.row(a) / 2;
  T.col(b) += E.col(a) / 2;
  return T;
}

void Inertia::add(const RotatingMass& mass) {
  allocate_rotary();
  for (int a = 0; a < dimension(); ++a)
    for (int b = 0; b < dimension(); ++b)
      W[a][b].noalias() += mass.turn.transpose() * (rotary_form(mass.moments, a, b) * mass.turn);
}

Inertia& Inertia::operator+=(const Inertia& other) {
  m += other.m, s0 += other.s0, C0 += other.C0, S += other.S;
  for (int a = 0; a < dimension(); ++a)
    for (int b = 0; b < dimension(); ++b) h[a][b] += other.h[a][b], M[a][b] += other.M[a][b];
  if (other.W.empty()) return *this;
  allocate_rotary();
  for (int a = 0; a < dimension(); ++a)
    for (int b = 0; b < dimension(); ++b) W[a][b] += other.W[a][b];
  return *this;
}

PlanarInertia planar(const Inertia& inertia) {
  PlanarInertia p;
  p.m = inertia.m;
  p.s0 = inertia.s0.head<2>();
  p.C0 = inertia.C0(0, 0) + inertia.C0(1, 1);
  p.S = inertia.S.topRows<2>();
  p.h = inertia.h[0][0] + inertia.h[1][1];
  p.g = inertia.h[0][1] - inertia.h[1][0];
  p.M = inertia.M[0][0] + inertia.M[1][1];
  p.B = inertia.M[0][1] - inertia.M[1][0];  // N'J'N with J' = [[0,1],[-1,0]]
  p.D = p.M;
  if (!inertia.W.empty()) p.D += inertia.W[0][0] + inertia.W[1][1];
  return p;
}

}  // namespace floe::body
