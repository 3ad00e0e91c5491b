#include "floe/plan/ground_axes.h"

#include <catch2/catch.hpp>

#include "floe/math/rotation.h"

using namespace floe;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// How far a direction is from the nearest of the axes.
double off(const Matrix3d& axes, const Vector3d& direction) {
  return 1 - (axes.transpose() * direction).cwiseAbs().maxCoeff();
}

void check_rotation(const Matrix3d& axes) {
  CHECK((axes.transpose() * axes - Matrix3d::Identity()).norm() < 1e-14);
  CHECK(axes.determinant() == Approx(1));
}

}  // namespace

TEST_CASE("axes along directions: the first, and those at right angles with it") {
  const Matrix3d I = Matrix3d::Identity(), Q = math::rotation(Vector3d(0.4, -0.9, 0.7));
  const Vector3d a = Q.col(0), b = (Q.col(1) + 2 * Q.col(2)).normalized(), c = (Q.col(0) + Q.col(1)).normalized();
  for (const Vector3d& sign : {Vector3d(1, 1, 1), Vector3d(-1, 1, -1)}) {
    const Matrix3d one = plan::axes_along(I, -1, {sign[0] * a}), two = plan::axes_along(I, -1, {sign[0] * a, c, b});
    check_rotation(one), check_rotation(two);
    CHECK(off(one, a) < 1e-15);
    CHECK(off(two, a) < 1e-15);
    CHECK(off(two, b) < 1e-15);
    CHECK(off(two, c) > 0.1);  // comes before b, and is oblique to a
  }
  CHECK(plan::axes_along(I, -1, {}) == I);
  CHECK(plan::axes_along(I, -1, {Vector3d::UnitY(), -Vector3d::UnitX(), a}) == I);
}

TEST_CASE("axes along directions: about a column that has to stay") {
  const Matrix3d Q = math::rotation(Vector3d(0.4, -0.9, 0.7));
  for (int kept = 0; kept < 3; ++kept) {
    const Vector3d across = (Q.col((kept + 1) % 3) - 3 * Q.col((kept + 2) % 3)).normalized(),
                   oblique = (Q.col(kept) + Q.col((kept + 1) % 3)).normalized();
    const Matrix3d rotated = plan::axes_along(Q, kept, {oblique, across});
    check_rotation(rotated);
    CHECK(rotated.col(kept) == Q.col(kept));
    CHECK(off(rotated, across) < 1e-15);
    CHECK(plan::axes_along(Q, kept, {oblique}) == Q);
  }
}
