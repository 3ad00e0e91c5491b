#include "floe/math/rotation.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace floe;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

const Vector3d axis = Vector3d(0.3, -0.5, 0.8).normalized();

Vector3d axial(const Matrix3d& A) { return {A(2, 1), A(0, 2), A(1, 0)}; }

}  // namespace

TEST_CASE("rotations by vectors are orthogonal, and their logarithm is the vector again up to half a turn") {
  for (const double angle : {0.0, 1e-12, 1e-6, 1e-3, 0.1, 1.0, 3.0, M_PI - 1e-9}) {
    const Vector3d x = angle * axis;
    const Matrix3d A = math::rotation(x);
    CHECK((A.transpose() * A - Matrix3d::Identity()).norm() < 1e-15);
    CHECK((A * axis - axis).norm() < 1e-15);
    CHECK(A.trace() == Approx(1 + 2 * std::cos(angle)).margin(1e-15));
    CHECK((math::rotation_vector(math::quaternion(x)) - x).norm() <= 4e-16 * std::max(angle, 1.0));
  }
}

TEST_CASE("beyond half a turn the logarithm is the shorter way") {
  const Vector3d x = math::rotation_vector(math::quaternion(4.0 * axis));
  CHECK((x - (4.0 - 2 * M_PI) * axis).norm() < 1e-15);
}

TEST_CASE("the rotation between two directions maps one to the other, to round-off, also opposite ones") {
  const Vector3d a(0.3, -0.5, 0.8), across = a.unitOrthogonal();
  for (const double angle :
       {0.0, 1e-12, 1e-6, 0.1, 1.5, 3.0, M_PI - 1e-3, M_PI - 1e-5, M_PI - 1e-9, M_PI - 1e-13, M_PI}) {
    INFO(angle);
    const Vector3d b = 3 * (std::cos(angle) * a.normalized() + std::sin(angle) * across);
    const Eigen::Quaterniond q = math::rotation_between(a, b);
    CHECK((q.toRotationMatrix() * a.normalized() - b.normalized()).norm() < 1e-15);
    CHECK(math::rotation_vector(q).norm() == Approx(angle).margin(1e-15));
  }
}

TEST_CASE("the nearest rotation of a stretched one is that rotation, and proper for a reflection") {
  const Matrix3d R = math::rotation(2.5 * axis);
  const Matrix3d S = (Matrix3d() << 2, 0.3, 0.1, 0.3, 1, -0.2, 0.1, -0.2, 0.5).finished();
  CHECK((math::nearest_rotation(R * S) - R).norm() < 1e-14);
  CHECK(math::nearest_rotation(-R * S).determinant() == Approx(1));
}

TEST_CASE("T(x) is the spin in rotated axes of a change of x, and its derivative is exact") {
  for (const double angle : {1e-9, 1e-3, 0.0999, 0.1001, 0.5, 2.0, 6.0}) {
    const Vector3d x = angle * axis, w(1, 2, -0.5);
    const double h = 1e-5;
    for (int i = 0; i < 3; ++i) {
      const Vector3d up = x + h * Vector3d::Unit(i), down = x - h * Vector3d::Unit(i);
      const Matrix3d spin = math::rotation(x).transpose() * (math::rotation(up) - math::rotation(down)) / (2 * h);
      CHECK((axial(spin) - math::rotation_tangent(x).col(i)).norm() < 1e-9);
      const Vector3d change = (math::rotation_tangent(up) * w - math::rotation_tangent(down) * w) / (2 * h);
      CHECK((change - math::rotation_tangent_derivative(x, w).col(i)).norm() < 1e-9);
    }
    CHECK((math::rotation_tangent(-x) - math::rotation_tangent(x).transpose()).norm() < 1e-15);
  }
}
