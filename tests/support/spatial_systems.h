#pragma once
#include "floe/dynamics/spatial_body.h"
#include "floe/solve/simulation.h"
#include "floe/solve/start.h"
#include "systems.h"

namespace floe::testing {

/// A rigid body with its mass centre at the frame's origin and the given principal moments of inertia.
inline body::SpatialInertia rigid(double m, const Eigen::Vector3d& moments) {
  body::Inertia in(3, 0);
  in.m = m;
  in.C0 = (moments.sum() / 2 * Eigen::Vector3d::Ones() - moments).asDiagonal();
  return body::spatial(in);
}

inline body::Elasticity no_elasticity() { return {Eigen::MatrixXd(0, 0), Eigen::MatrixXd(0, 0), {}}; }

/// The place p of the body (R, x, three multipliers) stays at the origin: C = R + A p. Its weight m g acts at the
/// frame's origin, -z.
struct HeavyOnPoint final : dynamics::Term {
  std::vector<int> indices{0, 1, 2, 3, 4, 5, 6, 7, 8};
  std::shared_ptr<const dynamics::Attitude> attitude;
  Eigen::Vector3d p;
  double weight;

  HeavyOnPoint(std::shared_ptr<const dynamics::Attitude> of, const Eigen::Vector3d& place, double force)
      : attitude(std::move(of)), p(place), weight(force) {}
  const std::vector<int>& coordinates() const override { return indices; }
  void residual(const dynamics::Motion& m, Eigen::VectorXd& r) const override {
    const Eigen::Matrix3d A = attitude->axes(m.q.segment<3>(3));
    const Eigen::Vector3d w = m.v.segment<3>(3), wd = m.a.segment<3>(3), constrained = m.q.tail<3>();
    r.head<3>() += constrained + weight * Eigen::Vector3d::UnitZ();
    r.segment<3>(3) += p.cross(A.transpose() * constrained);
    if (m.level == dynamics::ConstraintLevel::position) r.tail<3>() += m.q.head<3>() + A * p;
    if (m.level == dynamics::ConstraintLevel::velocity) r.tail<3>() += m.v.head<3>() + A * w.cross(p);
    if (m.level == dynamics::ConstraintLevel::acceleration)
      r.tail<3>() += m.a.head<3>() + A * (wd.cross(p) + w.cross(w.cross(p)));
  }
  void tangent(const dynamics::Motion& m, dynamics::Weights weights, Eigen::MatrixXd& J) const override {
    using math::skew;
    const Eigen::Vector3d x = m.q.segment<3>(3), constrained = m.q.tail<3>();
    const Eigen::Matrix3d A = attitude->axes(x), T = math::rotation_tangent(x), I = Eigen::Matrix3d::Identity();
    J.block<3, 3>(0, 6) += I;
    J.block<3, 3>(3, 6) += skew(p) * A.transpose();
    J.block<3, 3>(3, 3) += weights.q * skew(p) * skew(A.transpose() * constrained) * T;
    J.block<3, 3>(6, 0) += I;
    J.block<3, 3>(6, 3) -= A * skew(p) * T;
  }
};

/// Potential c tr(I - B'A): a spring that rotates the frame (its unknowns from 3) towards the attitude B.
struct TorsionalSpring final : dynamics::Term {
  std::vector<int> indices{3, 4, 5};
  std::shared_ptr<const dynamics::Attitude> attitude;
  Eigen::Matrix3d B;
  double c;

  TorsionalSpring(std::shared_ptr<const dynamics::Attitude> of, const Eigen::Matrix3d& towards, double stiffness)
      : attitude(std::move(of)), B(towards), c(stiffness) {}
  const std::vector<int>& coordinates() const override { return indices; }
  void residual(const dynamics::Motion& m, Eigen::VectorXd& r) const override {
    const Eigen::Matrix3d M = B.transpose() * attitude->axes(m.q.head<3>());
    r += c * Eigen::Vector3d(M(2, 1) - M(1, 2), M(0, 2) - M(2, 0), M(1, 0) - M(0, 1));
  }
  void tangent(const dynamics::Motion& m, dynamics::Weights weights, Eigen::MatrixXd& J) const override {
    const Eigen::Matrix3d M = B.transpose() * attitude->axes(m.q.head<3>()), I = Eigen::Matrix3d::Identity();
    J += weights.q * c * (M.trace() * I - M.transpose()) * math::rotation_tangent(m.q.head<3>());
  }
};

/// A rigid body about a point that stands still, by Runge-Kutta of order 4 for a quaternion and omega: 1e-12 and less
/// for the motions here. moments about that point; `gravity_arm` is the mass centre from it times weight, body axes.
struct Rotating {
  Eigen::Vector3d moments, gravity_arm = Eigen::Vector3d::Zero();
  Eigen::Quaterniond attitude;
  Eigen::Vector3d w;

  Eigen::Vector3d acceleration(const Eigen::Quaterniond& q, const Eigen::Vector3d& spin) const {
    const Eigen::Vector3d down = q.inverse() * Eigen::Vector3d(0, 0, -1), momentum = moments.asDiagonal() * spin;
    return (gravity_arm.cross(down) - spin.cross(momentum)).cwiseQuotient(moments);
  }
  Rotating after(double t, int steps = 20000) const {
    using State = Eigen::Matrix<double, 7, 1>;
    const auto rate = [this](const State& s) {
      const Eigen::Quaterniond q(s[0], s[1], s[2], s[3]), spin(0, s[4], s[5], s[6]);
      const Eigen::Quaterniond change = q * spin;
      const Eigen::Vector3d wd = acceleration(q.normalized(), s.tail<3>());
      return State((State() << change.w() / 2, change.vec() / 2, wd).finished());
    };
    const double h = t / steps;
    State s;
    s << attitude.w(), attitude.vec(), w;
    for (int i = 0; i < steps; ++i) {
      const State k1 = rate(s), k2 = rate(s + h / 2 * k1), k3 = rate(s + h / 2 * k2), k4 = rate(s + h * k3);
      s += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    Rotating end = *this;
    end.attitude = Eigen::Quaterniond(s[0], s[1], s[2], s[3]).normalized();
    end.w = s.tail<3>();
    return end;
  }
};

}  // namespace floe::testing
