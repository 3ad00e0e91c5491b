#include "floe/reference/corotational_element.h"

#include <algorithm>
#include <cmath>

#include "floe/error.h"
#include "floe/math/rotation.h"

namespace floe::reference {

using dynamics::EvaluationLevel;
using dynamics::Motion;
using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using math::rotation_tangent;
using math::rotation_tangent_derivative;
using math::skew;

namespace {

/// Gamma, rotations and displacements over a length both of order one.
MatrixXd conditions_of(bool line, const Eigen::Matrix3Xd& X) {
  const Index n = X.cols();
  MatrixXd G = MatrixXd::Zero(3, 6 * n);
  const Vector3d first = X.col(1) - X.col(0);
  if (!(first.norm() > 0)) throw InputError("a corotational element has two places that coincide");
  if (line) {
    const Vector3d t = first.normalized(), a = t.unitOrthogonal(), b = t.cross(a);
    G.block<1, 3>(0, 6) = a.transpose() / first.norm(), G.block<1, 3>(0, 0) = -G.block<1, 3>(0, 6);
    G.block<1, 3>(1, 6) = b.transpose() / first.norm(), G.block<1, 3>(1, 0) = -G.block<1, 3>(1, 6);
    G.block<1, 3>(2, 3) = G.block<1, 3>(2, 9) = t.transpose() / 2;
    return G;
  }
  const Vector3d second = X.col(2) - X.col(0), normal = first.cross(second);
  const double size = std::max(first.norm(), second.norm());
  if (!(normal.norm() > 1e-12 * size * size)) throw InputError("a corotational triangle has its places on a line");
  const Vector3d z = normal.normalized(), C = X.rowwise().mean();
  if (n > 3) {
    for (Index i = 0; i < n; ++i) G.block<3, 3>(0, 6 * i) = skew(Vector3d(X.col(i) - C)) / (size * size);
    return G;
  }
  for (Index i = 1; i < 3; ++i) {
    G.block<1, 3>(i - 1, 6 * i) = z.transpose() / size;
    G.block<1, 3>(i - 1, 0) = -z.transpose() / size;
  }
  for (Index i = 0; i < 3; ++i)  // z.((X - C) x u)
    G.block<1, 3>(2, 6 * i) = z.cross(Vector3d(X.col(i) - C)).transpose() / (size * size);
  return G;
}

Matrix3d triad(const Vector3d& first, const Vector3d& second) {
  Matrix3d E;
  E.col(0) = first.normalized();
  E.col(2) = first.cross(second).normalized();
  E.col(1) = E.col(2).cross(E.col(0));
  return E;
}

}  // namespace

CorotationalElement::CorotationalElement(fem::CellKind kind, std::vector<dynamics::SpatialMarker> places,
                                         Eigen::Matrix3Xd X, body::Elasticity elasticity, double viscosity)
    : line_(mesh::is_line(kind)),
      X_(std::move(X)),
      elasticity_(std::move(elasticity)),
      viscosity_(viscosity),
      conditions_(conditions_of(line_, X_)),
      places_(std::move(places)),
      r_(3, X_.cols()),
      n_(3, X_.cols()),
      velocity_(3, X_.cols()),
      rotating_(3, X_.cols()) {
  d_.setZero(size()), rate_.setZero(size()), f_.setZero(size()), wrenches_.setZero(size());
  W_.setZero(size(), 3);
}

Eigen::Quaterniond CorotationalElement::guess() const {
  const Vector3d first = places_[1].p - places_[0].p;
  if (!line_) {
    const Matrix3d now = triad(first, places_[2].p - places_[0].p);
    return Eigen::Quaterniond(now * triad(X_.col(1) - X_.col(0), X_.col(2) - X_.col(0)).transpose());
  }
  const Eigen::Quaterniond one(places_[0].D), two(places_[1].D);
  const Eigen::Quaterniond middle =
      one * math::quaternion(0.5 * math::rotation_vector((one.conjugate() * two).normalized()));
  return math::rotation_between(middle * Vector3d(X_.col(1) - X_.col(0)), first) * middle;
}

/// d, W and R at Q. @return  whether all is finite
bool CorotationalElement::measure(const Matrix3d& Q) const {
  for (Index i = 0; i < X_.cols(); ++i) {
    r_.col(i) = Q.transpose() * (places_[i].p - places_[0].p);
    const Vector3d theta =
        math::rotation_vector(Eigen::Quaterniond(Matrix3d(Q.transpose() * places_[i].D)).normalized());
    d_.segment<3>(6 * i) = r_.col(i) - (X_.col(i) - X_.col(0));
    d_.segment<3>(6 * i + 3) = theta;
    H_[i] = rotation_tangent(-theta).inverse();
    W_.middleRows<3>(6 * i) = skew(r_.col(i));
    W_.middleRows<3>(6 * i + 3) = -H_[i];
  }
  const Matrix3d by_rotation = conditions_ * W_;
  R_ = by_rotation.inverse() * conditions_;
  return d_.allFinite() && R_.allFinite();
}

void CorotationalElement::see(const Motion& motion, EvaluationLevel level) const {
  places_.see(motion, level);
  Eigen::Quaterniond Q = guess().normalized();
  double last = INFINITY;
  for (int iteration = 0; iteration < 40; ++iteration) {
    Q_ = Q.toRotationMatrix();
    if (!measure(Q_)) break;
    const Vector3d rotation = -(R_ * d_);
    const double size = rotation.norm();
    if (size < 1e-15 || (size < 1e-12 && size >= last)) return;
    last = size;
    Q = (Q * math::quaternion(rotation)).normalized();
  }
  if (!(last < 1e-9)) d_.setConstant(std::nan(""));
}

/// Rates of d and of Q, after see(EvaluationLevel::velocity).
void CorotationalElement::see_rates() const {
  for (Index i = 0; i < X_.cols(); ++i)
    velocity_.col(i) = Q_.transpose() * places_[i].velocity, rotating_.col(i) = Q_.transpose() * places_[i].spin;
  for (Index i = 0; i < X_.cols(); ++i) {
    rate_.segment<3>(6 * i) = velocity_.col(i) - velocity_.col(0);
    rate_.segment<3>(6 * i + 3) = H_[i] * rotating_.col(i);
  }
  spin_ = -(R_ * rate_);
  rate_ += W_ * spin_;
}

void CorotationalElement::balance() const {
  const Vector3d open = W_.transpose() * f_;
  f_ -= R_.transpose() * open;
  f_.head<3>().setZero();
  for (Index i = 1; i < X_.cols(); ++i) f_.head<3>() -= f_.segment<3>(6 * i);
  for (Index i = 0; i < X_.cols(); ++i) {
    n_.col(i) = H_[i].transpose() * f_.segment<3>(6 * i + 3);
    wrenches_.segment<3>(6 * i) = Q_ * f_.segment<3>(6 * i);
    wrenches_.segment<3>(6 * i + 3) = Q_ * n_.col(i);
  }
}

CorotationalElement::Square CorotationalElement::of_places() const {
  Square Z = Square::Zero(size(), size());
  for (Index i = 0; i < X_.cols(); ++i) {
    if (i > 0) Z.block<3, 3>(6 * i, 6 * i).setIdentity(), Z.block<3, 3>(6 * i, 0) = -Matrix3d::Identity();
    Z.block<3, 3>(6 * i + 3, 6 * i + 3) = H_[i];
  }
  return Z;
}

void CorotationalElement::residual(const Motion& motion, VectorXd& r) const {
  see(motion, viscosity_ != 0 ? EvaluationLevel::velocity : EvaluationLevel::position);
  f_.setZero();
  body::add_force(elasticity_, d_, work_, f_);
  if (viscosity_ != 0) {
    see_rates();
    body::add_viscous_force(elasticity_, d_, rate_, viscosity_, viscous_work_, f_);
  }
  balance();
  places_.add(wrenches_, r);
}

/// Change of the wrenches with what changes f on d by `stiffness` and by d' at fixed rates of the places.
CorotationalElement::Square CorotationalElement::by_places(const Square& K, const Square& C) const {
  const Index n = size();
  const Square Z = of_places();
  const Matrix3x S = -(R_ * Z);  // rotation of Q
  const Square P = Z + W_ * S;
  Square df = K * P;
  if (viscosity_ != 0) {
    Square rates = Square::Zero(n, n);
    for (Index i = 0; i < X_.cols(); ++i) {
      const Vector3d theta = d_.segment<3>(6 * i + 3), rotating = rate_.segment<3>(6 * i + 3);
      if (i > 0)
        rates.middleRows<3>(6 * i) =
            skew(velocity_.col(i) - velocity_.col(0)) * S - skew(spin_) * P.middleRows<3>(6 * i);
      rates.middleRows<3>(6 * i + 3) =
          H_[i] *
          (skew(rotating_.col(i)) * S + rotation_tangent_derivative(-theta, rotating) * P.middleRows<3>(6 * i + 3));
    }
    rates -= (W_ * (R_ * rates)).eval();
    df += C * rates;
  }
  std::array<Matrix3d, mesh::most_nodes> bent;  // d(T n)/dtheta
  Matrix3x rotated = W_.transpose() * df;
  for (Index i = 0; i < X_.cols(); ++i) {
    bent[i] = rotation_tangent_derivative(d_.segment<3>(6 * i + 3), n_.col(i));
    rotated += skew(f_.segment<3>(6 * i)) * P.middleRows<3>(6 * i);
    rotated += H_[i].transpose() * bent[i] * P.middleRows<3>(6 * i + 3);
  }
  df -= R_.transpose() * rotated;
  Square Y = Square::Zero(n, n);
  for (Index i = 0; i < X_.cols(); ++i) {
    if (i > 0) {
      Y.middleRows<3>(6 * i) = df.middleRows<3>(6 * i) - skew(f_.segment<3>(6 * i)) * S;
      Y.topRows<3>() -= Y.middleRows<3>(6 * i);
    }
    Y.middleRows<3>(6 * i + 3) =
        H_[i].transpose() * (df.middleRows<3>(6 * i + 3) - bent[i] * P.middleRows<3>(6 * i + 3)) - skew(n_.col(i)) * S;
  }
  return Y;
}

void CorotationalElement::tangent(const Motion& motion, dynamics::Weights weights, MatrixXd& J) const {
  const bool damped = viscosity_ != 0;
  if (weights.q == 0 && !(damped && weights.v != 0)) return;
  see(motion, damped ? EvaluationLevel::velocity : EvaluationLevel::jacobian);
  K_.setZero(size(), size()), C_.setZero(size(), size()), f_.setZero();
  body::add_force(elasticity_, d_, work_, f_);
  body::add_tangent(elasticity_, d_, 1, work_, K_);
  if (damped) {
    see_rates();
    body::add_viscous_force(elasticity_, d_, rate_, viscosity_, viscous_work_, f_);
    body::add_viscous_tangent(elasticity_, d_, rate_, viscosity_, 0, viscous_work_, K_);
    body::add_viscous_tangent(elasticity_, d_, rate_, 0, viscosity_, viscous_work_, C_);
  }
  balance();
  Square rotation = Square::Zero(size(), size());
  for (Index i = 0; i < size() / 3; ++i) rotation.block<3, 3>(3 * i, 3 * i) = Q_;
  Y_ = rotation * by_places(K_, C_) * rotation.transpose();
  if (damped) {
    const Square Z = of_places(), P = Z - W_ * (R_ * Z);
    Square df = C_ * P;
    df -= (R_.transpose() * (W_.transpose() * df)).eval();
    df.topRows<3>().setZero();
    for (Index i = 1; i < X_.cols(); ++i) df.topRows<3>() -= df.middleRows<3>(6 * i).eval();
    for (Index i = 0; i < X_.cols(); ++i)
      df.middleRows<3>(6 * i + 3) = (H_[i].transpose() * df.middleRows<3>(6 * i + 3)).eval();
    Yd_ = rotation * df * rotation.transpose();
  }
  places_.add_tangent(wrenches_, Y_, damped ? &Yd_ : nullptr, weights, J);
}

dynamics::Energy CorotationalElement::energy(const Motion& motion) const {
  see(motion, EvaluationLevel::position);
  return {0, body::energy(elasticity_, d_), 0};
}

}  // namespace floe::reference
