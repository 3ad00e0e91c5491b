#include <fmt/format.h>

#include <cmath>

#include "floe/dynamics/spatial_spring.h"
#include "floe/error.h"

namespace floe::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using math::rotation_tangent_derivative;
using math::skew;

/// What stretches a bushing: u and rho with their rates, and what they are made of.
struct Strain {
  Matrix3d D;          ///< axes of the first place
  Vector3d d, g;       ///< p_2 - p_1, and its rate as the first place sees it: (p_2 - p_1). - w_1 x d
  Vector3d w, dw;      ///< w_1, w_2 - w_1
  Matrix3d T_inverse;  ///< T(rho)^-1
  Vector3d u, u_rate, rho, rho_rate;
};

/// Of the rotation vectors that differ by whole turns about their line, the one nearest to another.
Vector3d nearest_vector(const Vector3d& rho, const Vector3d& nearest) {
  const double angle = rho.norm();
  if (angle < 1e-6) return rho;
  const Vector3d other = rho * (1 - 2 * M_PI / angle);
  return (rho - nearest).squaredNorm() <= (other - nearest).squaredNorm() ? rho : other;
}

Strain strain(const SpatialPair& pair, const BushingProperties& properties, const Vector3d& nearest) {
  const SpatialPose &one = pair.pose[0], &two = pair.pose[1];
  Strain s;
  s.D = one.D, s.w = one.spin, s.dw = two.spin - one.spin;
  s.d = two.p - one.p;
  s.g = two.velocity - one.velocity - s.w.cross(s.d);
  s.rho = nearest_vector(math::rotation_vector(Eigen::Quaterniond(Matrix3d(one.D.transpose() * two.D))), nearest);
  s.T_inverse = math::rotation_tangent(s.rho).inverse();
  s.u = s.D.transpose() * s.d - properties.rest, s.u_rate = s.D.transpose() * s.g;
  s.rho_rate = s.T_inverse.transpose() * s.D.transpose() * s.dw;  // exp(rho) T = T': in axes of the first place
  return s;
}

/// Force and moment in the bushing: f on u, m on rho.
Wrench inner(const BushingProperties& p, const Strain& s) {
  return (Wrench() << p.stiffness.head<3>().cwiseProduct(s.u) + p.viscosity.head<3>().cwiseProduct(s.u_rate),
          p.stiffness.tail<3>().cwiseProduct(s.rho) + p.viscosity.tail<3>().cwiseProduct(s.rho_rate))
      .finished();
}

Vector12 wrench_of(const Strain& s, const Wrench& in) {
  const Vector3d F = s.D * in.head<3>(), M = s.D * s.T_inverse * in.tail<3>();
  return (Vector12() << -F, -s.d.cross(F) - M, F, M).finished();
}

using Row = Eigen::Matrix<double, 3, 12>;  ///< change of a vector with the virtual motions or with their rates

/// The wrench's change with those of F and M at fixed d.
Matrix12 both_places(const Strain& s, const Row& dF, const Row& dM) {
  return (Matrix12() << -dF, -skew(s.d) * dF - dM, dF, dM).finished();
}

Matrix12 of_places(const BushingProperties& p, const Strain& s, const Wrench& in) {
  const Matrix3d inverse_D = s.D.transpose();
  Row du = Row::Zero(), du_rate = Row::Zero(), drho = Row::Zero(), dspin = Row::Zero(), rotation = Row::Zero();
  rotation.middleCols<3>(3).setIdentity();
  du.leftCols<3>() = -inverse_D, du.middleCols<3>(6) = inverse_D, du.middleCols<3>(3) = inverse_D * skew(s.d);
  du_rate.leftCols<3>() = inverse_D * skew(s.w), du_rate.middleCols<3>(6) = -inverse_D * skew(s.w);
  du_rate.middleCols<3>(3) = inverse_D * skew(s.g);
  const Matrix3d B = s.T_inverse.transpose() * inverse_D;
  drho.middleCols<3>(3) = -B, drho.rightCols<3>() = B;
  dspin.middleCols<3>(3) = B * skew(s.dw);
  // T(-rho) rho. = D1' dw, hence T' drho. = d(D1' dw) + [d(T(x) rho.)/dx at -rho] drho
  const Row drho_rate = dspin + s.T_inverse.transpose() * rotation_tangent_derivative(-s.rho, s.rho_rate) * drho;

  const Vector3d F = s.D * in.head<3>(), n = s.T_inverse * in.tail<3>(), M = s.D * n;
  const Row df = p.stiffness.head<3>().asDiagonal() * du + Row(p.viscosity.head<3>().asDiagonal() * du_rate);
  const Row dm = p.stiffness.tail<3>().asDiagonal() * drho + Row(p.viscosity.tail<3>().asDiagonal() * drho_rate);
  const Row dF = s.D * df - skew(F) * rotation;
  // T n = m, hence T dn = dm - [d(T n)/drho] drho
  const Row dM = s.D * s.T_inverse * (dm - rotation_tangent_derivative(s.rho, n) * drho) - skew(M) * rotation;
  Matrix12 Y = both_places(s, dF, dM);
  Y.block<3, 3>(3, 0) -= skew(F), Y.block<3, 3>(3, 6) += skew(F);
  return Y;
}

Matrix12 of_rates(const BushingProperties& p, const Strain& s) {
  Row u_rate = Row::Zero(), rho_rate = Row::Zero();
  u_rate.leftCols<3>() = -s.D.transpose(), u_rate.middleCols<3>(6) = s.D.transpose();
  u_rate.middleCols<3>(3) = s.D.transpose() * skew(s.d);
  const Matrix3d B = s.T_inverse.transpose() * s.D.transpose();
  rho_rate.middleCols<3>(3) = -B, rho_rate.rightCols<3>() = B;
  return both_places(s, s.D * p.viscosity.head<3>().asDiagonal() * u_rate,
                     B.transpose() * p.viscosity.tail<3>().asDiagonal() * rho_rate);
}

}  // namespace

SpatialBushing::SpatialBushing(SpatialMarker first, SpatialMarker second, BushingProperties properties)
    : pair_(std::move(first), std::move(second)), properties_(std::move(properties)) {}

void SpatialBushing::residual(const Motion& motion, Eigen::VectorXd& r) const {
  pair_.evaluate(motion);
  const Strain s = strain(pair_, properties_, nearest_);
  pair_.add(wrench_of(s, inner(properties_, s)), r);
}

Wrench SpatialBushing::on_second(const Motion& motion) const {
  pair_.evaluate(motion);
  const Strain s = strain(pair_, properties_, nearest_);
  return -wrench_of(s, inner(properties_, s)).tail<6>();
}

void SpatialBushing::tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const {
  pair_.evaluate(motion);
  const Strain s = strain(pair_, properties_, nearest_);
  const Wrench in = inner(properties_, s);
  pair_.add_tangent(wrench_of(s, in), of_places(properties_, s, in), of_rates(properties_, s), weights, J);
}

Energy SpatialBushing::energy(const Motion& motion) const {
  pair_.evaluate(motion);
  const Strain s = strain(pair_, properties_, nearest_);
  const Wrench strains = (Wrench() << s.u, s.rho).finished();
  return {0, 0.5 * properties_.stiffness.cwiseProduct(strains).dot(strains), 0};
}

void SpatialBushing::begin_step(const Motion& motion) {
  if (properties_.stiffness.tail<3>().isZero(0) && properties_.viscosity.tail<3>().isZero(0)) return;
  pair_.evaluate(motion);
  nearest_ = strain(pair_, properties_, nearest_).rho;
  if (nearest_.norm() < 0.8 * 2 * M_PI) return;
  throw RunError(
      fmt::format("bushing {} is rotated by {:.4g} rad (limit 1.6 pi). A spring's torsional_stiffness about "
                  "`axis` counts "
                  "full rotations",
                  properties_.name, nearest_.norm()));
}

}  // namespace floe::dynamics
