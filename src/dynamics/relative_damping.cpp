#include "floe/dynamics/relative_damping.h"

#include <algorithm>

#include "floe/dynamics/local_indices.h"
#include "floe/math/rotation.h"
#include "seen_axes.h"

namespace floe::dynamics {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using math::skew;

std::vector<int> MovingAxes::coordinates() const {
  std::vector<int> all;
  for (int i = 0; i < (spatial() ? 3 : 2); ++i) all.push_back(position + i);
  for (int i = 0; i < (spatial() ? 3 : 1); ++i) all.push_back(rotation + i);
  return all;
}

SeenAxes see(const MovingAxes& axes, const std::vector<int>& coordinates, const Motion& motion) {
  const auto row = [&](int index) {
    return static_cast<int>(std::find(coordinates.begin(), coordinates.end(), index) - coordinates.begin());
  };
  SeenAxes at;
  at.p = row(axes.position), at.o = row(axes.rotation);
  at.d = axes.spatial() ? 3 : 2, at.n = axes.spatial() ? 3 : 1;
  at.R = axes.origin;
  at.R.head(at.d) += motion.q.segment(at.p, at.d);
  at.v.head(at.d) = motion.v.segment(at.p, at.d), at.vd.head(at.d) = motion.a.segment(at.p, at.d);
  if (axes.spatial()) {
    const Vector3d x = motion.q.segment<3>(at.o);
    at.A = axes.attitude->axes(x);
    at.E = at.A;
    at.T = math::rotation_tangent(x);
  } else {
    at.A = Eigen::AngleAxisd(axes.angle + motion.q[at.o], Vector3d::UnitZ()).toRotationMatrix();
    at.E = Vector3d::UnitZ();
    at.T = MatrixXd::Identity(1, 1);
  }
  at.w = at.E * motion.v.segment(at.o, at.n), at.wd = at.E * motion.a.segment(at.o, at.n);
  return at;
}

RelativeDamping::RelativeDamping(std::unique_ptr<const Term> inertia, std::vector<MovingAxes> moving,
                                 std::optional<MovingAxes> f, double alpha)
    : inertia_(std::move(inertia)),
      moving_(std::move(moving)),
      f_(std::move(f)),
      alpha_(alpha),
      coordinates_(inertia_->coordinates()) {
  if (f_) place_all(f_->coordinates(), coordinates_);
}

VectorXd RelativeDamping::relative(const Motion& motion) const {
  VectorXd v = motion.v.head(static_cast<Index>(inertia_->coordinates().size()));
  if (!f_) return v;
  const SeenAxes f = see(*f_, coordinates_, motion);
  for (const MovingAxes& axes : moving_) {
    const SeenAxes at = see(axes, coordinates_, motion);
    v.segment(at.p, at.d) -= (f.v + f.w.cross(at.R - f.R)).head(at.d);
    v.segment(at.o, at.n) -= at.E.transpose() * f.w;
  }
  return v;
}

void RelativeDamping::residual(const Motion& motion, VectorXd& r) const {
  const VectorXd v = relative(motion), q = motion.q.head(v.size()), none = VectorXd::Zero(v.size());
  VectorXd force = none;
  inertia_->residual({motion.t, q, none, v}, force);
  force *= alpha_;
  r.head(v.size()) += force;
  if (!f_) return;
  const SeenAxes f = see(*f_, coordinates_, motion);
  for (const MovingAxes& axes : moving_) {
    const SeenAxes at = see(axes, coordinates_, motion);
    Vector3d F = Vector3d::Zero();
    F.head(at.d) = force.segment(at.p, at.d);
    const Vector3d moment = (at.R - f.R).cross(F) + at.E * force.segment(at.o, at.n);
    r.segment(f.p, f.d) -= F.head(f.d);
    r.segment(f.o, f.n) -= f.E.transpose() * moment;
  }
}

void RelativeDamping::tangent(const Motion& motion, Weights weights, MatrixXd& J) const {
  if (weights.q == 0 && weights.v == 0) return;
  const VectorXd v = relative(motion), q = motion.q.head(v.size()), none = VectorXd::Zero(v.size());
  const Index n = v.size(), all = motion.q.size();
  MatrixXd M = MatrixXd::Zero(n, n), K = M, by = MatrixXd::Zero(n, all);
  VectorXd force = none;
  inertia_->tangent({motion.t, q, none, v}, {0, 0, 1}, M);
  inertia_->residual({motion.t, q, none, v}, force);
  force *= alpha_;
  by.leftCols(n).diagonal().setConstant(weights.v);  // of v - Phi s
  const auto rotation = [&](const SeenAxes& at) {    // dphi on all coordinates
    MatrixXd dphi = MatrixXd::Zero(3, all);
    dphi.middleCols(at.o, at.n) = at.E * at.T;
    return dphi;
  };
  const auto offset = [&](const SeenAxes& at, const SeenAxes& f) {  // d(R - R_f)
    MatrixXd drho = MatrixXd::Zero(3, all);
    drho.topRows(at.d).middleCols(at.p, at.d).diagonal().array() += 1;
    drho.topRows(f.d).middleCols(f.p, f.d).diagonal().array() -= 1;
    return drho;
  };
  SeenAxes f;
  if (f_) {
    f = see(*f_, coordinates_, motion);
    MatrixXd spin = -weights.q * skew(f.w) * rotation(f);
    spin.middleCols(f.o, f.n) += weights.v * f.E;
    for (const MovingAxes& axes : moving_) {
      const SeenAxes at = see(axes, coordinates_, motion);
      by.block(at.p, f.p, at.d, f.d).diagonal().array() -= weights.v;
      by.middleRows(at.p, at.d) += (skew(at.R - f.R) * spin - weights.q * skew(f.w) * offset(at, f)).topRows(at.d);
      by.middleRows(at.o, at.n) -= at.E.transpose() * (spin + weights.q * skew(f.w) * rotation(at));
    }
  }
  MatrixXd change = M * by;
  if (weights.q != 0) {
    inertia_->tangent({motion.t, q, none, v}, {1, 0, 0}, K);
    change.leftCols(n) += weights.q * K;
  }
  change *= alpha_;
  J.topRows(n) += change;
  if (!f_) return;
  MatrixXd on_f = MatrixXd::Zero(3, all);
  Vector3d sum = Vector3d::Zero();
  for (const MovingAxes& axes : moving_) {
    const SeenAxes at = see(axes, coordinates_, motion);
    Vector3d F = Vector3d::Zero();
    F.head(at.d) = force.segment(at.p, at.d);
    const Vector3d moment = at.E * force.segment(at.o, at.n);
    MatrixXd dF = MatrixXd::Zero(3, all);
    dF.topRows(at.d) = change.middleRows(at.p, at.d);
    J.middleRows(f.p, f.d) -= dF.topRows(f.d);
    on_f += skew(at.R - f.R) * dF + at.E * change.middleRows(at.o, at.n) -
            weights.q * (skew(F) * offset(at, f) + skew(moment) * rotation(at));
    sum += (at.R - f.R).cross(F) + moment;
  }
  J.middleRows(f.o, f.n) -= f.E.transpose() * (on_f + weights.q * skew(sum) * rotation(f));
}

}  // namespace floe::dynamics
