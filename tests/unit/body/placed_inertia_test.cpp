#include "floe/body/placed_inertia.h"

#include <catch2/catch.hpp>

#include "floe/math/rotation.h"
#include "random.h"

using namespace floe;

namespace {

/// Points and rotating masses of a body that lies at x -> R x + r.
body::Inertia inertia_at(const Eigen::Matrix3d& R, const Eigen::Vector3d& r) {
  testing::Random random(3);
  const int k = 4;
  body::Inertia inertia(3, k);
  for (int p = 0; p < 5; ++p) {
    const Eigen::Vector3d x = random.matrix(3, 1);
    const Eigen::MatrixXd N = random.matrix(3, k), rotation = random.matrix(3, k);
    inertia.add(body::MassPoint{1. + p, R * x + r, R * N});
    body::RotatingForms forms;
    forms.add(0.5, R * x + r, Eigen::Matrix3d::Identity(), R * Eigen::Vector3d(random.matrix(3, 1)));
    inertia.add(body::RotatingMass(forms, R * rotation));
  }
  return inertia;
}

double apart(const body::Inertia& a, const body::Inertia& b) {
  double worst = (a.s0 - b.s0).norm() + (a.C0 - b.C0).norm() + (a.S - b.S).norm() + std::abs(a.m - b.m);
  for (int i = 0; i < 3; ++i) {
    worst += (a.Q[i] - b.Q[i]).norm();
    for (int j = 0; j < 3; ++j)
      worst += (a.h[i][j] - b.h[i][j]).norm() + (a.M[i][j] - b.M[i][j]).norm() + (a.W[i][j] - b.W[i][j]).norm();
  }
  return worst;
}

}  // namespace

TEST_CASE("placed inertia: constants of a body that was moved and rotated, from those of the body") {
  const Eigen::Matrix3d R = math::rotation({0.4, -1.1, 0.7});
  const Eigen::Vector3d r(2, -1, 0.5);
  const body::Inertia at_home = inertia_at(Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
  CHECK(apart(body::placed(at_home, R, r), inertia_at(R, r)) < 1e-12);
  CHECK(apart(at_home, inertia_at(R, r)) > 1);
  CHECK(apart(body::placed(body::placed(at_home, R, r), R.transpose(), -R.transpose() * r), at_home) < 1e-12);
}
