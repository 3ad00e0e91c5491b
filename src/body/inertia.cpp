#include "floe/body/inertia.h"

#include <algorithm>

#include "floe/math/rotation.h"

namespace floe::body {
RotatingForms::RotatingForms() {
  first.fill(Form::Zero());
  for (auto& row : moments) row.fill(Form::Zero());
}

RotatingForms::RotatingForms(const Eigen::Matrix3d& second) : RotatingForms() {
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) moments[a][b] = math::arm_form(Eigen::Vector3d::Unit(b), second.row(a));
}

void RotatingForms::add(double mass, const Eigen::VectorXd& x, const Eigen::MatrixXd& N, const Eigen::Vector3d& arm) {
  for (Eigen::Index b = 0; b < N.rows(); ++b) {
    Eigen::Vector3d row = Eigen::Vector3d::Zero();
    row.head(N.cols()) = N.row(b);
    const Form form = mass * math::arm_form(row, arm);
    first[b] += form;
    for (Eigen::Index a = 0; a < x.size(); ++a) moments[a][b] += x[a] * form;
  }
}

void RotatingForms::rotate(const Eigen::Matrix3d& R) {
  const RotatingForms before = *this;
  *this = RotatingForms();
  for (int a = 0; a < 3; ++a)
    for (int c = 0; c < 3; ++c) {
      first[a] += R(a, c) * before.first[c];
      for (int b = 0; b < 3; ++b)
        for (int d = 0; d < 3; ++d) moments[a][b] += R(a, c) * R(b, d) * before.moments[c][d];
    }
}

namespace {

bool zero(const Eigen::Matrix3d& form) { return form.isZero(0); }

}  // namespace

bool RotatingForms::has_first() const { return !std::all_of(first.begin(), first.end(), zero); }

bool RotatingForms::empty() const {
  return !has_first() && std::all_of(moments.begin(), moments.end(),
                                     [](const auto& row) { return std::all_of(row.begin(), row.end(), zero); });
}

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

void Inertia::allocate_first() {
  if (Q.empty()) Q.assign(dimension(), Eigen::MatrixXd::Zero(coordinates(), coordinates()));
}

void Inertia::allocate_rotary() {
  const int d = dimension(), k = coordinates();
  if (W.empty()) W.assign(d, std::vector<Eigen::MatrixXd>(d, Eigen::MatrixXd::Zero(k, k)));
}

void Inertia::add(const RotatingMass& mass) {
  const bool arms = mass.has_first();
  if (arms) allocate_first();
  allocate_rotary();
  const auto add_form = [&](const RotatingMass::Form& form, Eigen::MatrixXd& to) {
    to.noalias() += mass.rotation.transpose() * (form * mass.rotation);
  };
  for (int a = 0; a < dimension(); ++a) {
    if (arms) add_form(mass.first[a], Q[a]);
    for (int b = 0; b < dimension(); ++b) add_form(mass.moments[a][b], W[a][b]);
  }
}

Inertia& Inertia::operator+=(const Inertia& other) {
  m += other.m, s0 += other.s0, C0 += other.C0, S += other.S;
  for (int a = 0; a < dimension(); ++a)
    for (int b = 0; b < dimension(); ++b) h[a][b] += other.h[a][b], M[a][b] += other.M[a][b];
  if (!other.Q.empty()) {
    allocate_first();
    for (int a = 0; a < dimension(); ++a) Q[a] += other.Q[a];
  }
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
  if (!inertia.Q.empty()) p.Q = {inertia.Q[0], inertia.Q[1]}, p.Y = inertia.W[0][1] - inertia.W[1][0];
  return p;
}

}  // namespace floe::body
