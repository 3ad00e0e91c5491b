#include "floe/math/rotation.h"

#include <Eigen/SVD>
#include <cmath>

namespace floe::math {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// b = (1 - cos p)/p^2, c = (p - sin p)/p^3, and their derivatives by p divided by p.
struct Factors {
  double b, c, db, dc;
};

Factors factors(double square) {
  if (square < 1e-2) {  // series to p^8: 1e-17 and less is left out
    const double s = square;
    return {1. / 2 - s / 24 * (1 - s / 30 * (1 - s / 56 * (1 - s / 90))),
            1. / 6 - s / 120 * (1 - s / 42 * (1 - s / 72 * (1 - s / 110))),
            -1. / 12 + s / 180 * (1 - s / 56 * 1.5 * (1 - s / 90 * (4. / 3))),
            -1. / 60 + s / 1260 * (1 - s / 72 * 1.5 * (1 - s / 110 * (4. / 3)))};
  }
  const double p = std::sqrt(square), sine = std::sin(p), half = std::sin(p / 2);
  const double b = 2 * half * half / square, c = (p - sine) / (square * p);
  return {b, c, (sine / p - 2 * b) / square, (b - 3 * c) / square};
}

}  // namespace

Matrix3d skew(const Vector3d& a) {
  return (Matrix3d() << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0).finished();
}

Eigen::Matrix3d arm_form(const Eigen::Vector3d& l, const Eigen::Vector3d& c) {
  const Eigen::Matrix3d product = l * c.transpose();
  return (product + product.transpose()) / 2 - l.dot(c) * Eigen::Matrix3d::Identity();
}

Matrix3d rotation(const Vector3d& x) { return quaternion(x).toRotationMatrix(); }

Eigen::Quaterniond quaternion(const Vector3d& x) {
  const double half = 0.5 * x.norm();
  const double factor = half < 1e-4 ? 0.5 - half * half / 12 : std::sin(half) / (2 * half);
  Eigen::Quaterniond q(std::cos(half), factor * x.x(), factor * x.y(), factor * x.z());
  q.normalize();
  return q;
}

Vector3d rotation_vector(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0 ? -1 : 1, sine = rotation.vec().norm();
  const double half = std::atan2(sine, sign * rotation.w());
  const double factor = sine < 1e-6 ? 2 : 2 * half / sine;
  return sign * factor * rotation.vec();
}

Eigen::Quaterniond rotation_between(const Vector3d& a, const Vector3d& b) {
  const Vector3d from = a.normalized(), to = b.normalized();
  Eigen::Quaterniond q;
  if (from.dot(to) > -0.5) {
    const Vector3d middle = (from + to).normalized();
    q.w() = from.dot(middle), q.vec() = from.cross(middle);
  } else {  // across both; near opposite ones it has round-off along `from`
    const Vector3d across = from.cross(to);
    const double length = across.norm();
    Vector3d axis = length > 0 ? Vector3d(across / length) : from.unitOrthogonal();
    axis -= from * from.dot(axis);
    if (axis.norm() < 0.5) axis = from.unitOrthogonal();
    const double half = 0.5 * std::atan2(length, from.dot(to));
    q.w() = std::cos(half), q.vec() = std::sin(half) * axis.normalized();
  }
  q.normalize();
  return q;
}

Matrix3d nearest_rotation(const Matrix3d& A) {
  const Eigen::JacobiSVD<Matrix3d> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix3d &U = svd.matrixU(), &V = svd.matrixV();
  return U * Vector3d(1, 1, U.determinant() * V.determinant()).asDiagonal() * V.transpose();
}

Matrix3d rotation_tangent(const Vector3d& x) {
  const auto [b, c, db, dc] = factors(x.squaredNorm());
  return (1 - c * x.squaredNorm()) * Matrix3d::Identity() - b * skew(x) + c * x * x.transpose();
}

Matrix3d rotation_tangent_derivative(const Vector3d& x, const Vector3d& w) {
  // T w = w - b x x w + c x x (x x w),  x x (x x w) = x (x.w) - w x.x
  const auto [b, c, db, dc] = factors(x.squaredNorm());
  const Vector3d cross = x.cross(w), twice = x.cross(cross);
  return b * skew(w) + (-db * cross + dc * twice) * x.transpose() +
         c * (x.dot(w) * Matrix3d::Identity() + x * w.transpose() - 2 * w * x.transpose());
}

}  // namespace floe::math
