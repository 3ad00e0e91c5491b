#include "floe/dynamics/marker.h"

#include <catch2/catch.hpp>

#include "terms.h"

using namespace floe;
using dynamics::Marker;
using dynamics::Pose;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::Random;

namespace {

Pose at(const Marker& marker, const VectorXd& q, const VectorXd& v, const VectorXd& a) {
  Pose out;
  dynamics::pose(marker, q, v, a, out);
  return out;
}

/// A place with a frame, one whose frame carries a density, a node in world axes, and the ground.
std::vector<Marker> markers() {
  Random random(81);
  std::vector<Marker> all{testing::framed_marker(random, 0), testing::framed_marker(random, 0),
                          testing::node_marker(random, 0), Marker::ground({1, 2}, 0.4)};
  all[1].mass = 2.5;
  return all;
}

}  // namespace

TEST_CASE("pose of a place: p = mass R + A (x + S q), angle = angle0 + theta + psi q") {
  Random random(82);
  const Marker marker = markers()[1];
  const VectorXd q = random.vector(5), zero = VectorXd::Zero(5);
  const Vector3d y = at(marker, q, zero, zero).y;
  const double c = std::cos(q[2]), s = std::sin(q[2]);
  const Eigen::Vector2d u = marker.x + marker.S * q.tail(2);
  CHECK(y[0] == Approx(2.5 * q[0] + c * u.x() - s * u.y()).epsilon(1e-14));
  CHECK(y[1] == Approx(2.5 * q[1] + s * u.x() + c * u.y()).epsilon(1e-14));
  CHECK(y[2] == Approx(marker.angle0 + q[2] + marker.psi * q.tail(2)).epsilon(1e-14));
  const Vector3d ground = at(Marker::ground({1, 2}, 0.4), {}, {}, {}).y;
  CHECK(ground == Vector3d(1, 2, 0.4));
}

TEST_CASE("rates and linearisations of a pose are its derivatives") {
  for (const Marker& marker : markers()) {
    const Eigen::Index n = static_cast<Eigen::Index>(marker.coordinates.size());
    Random random(83);
    const testing::SmoothMotion m(random, n);
    const double t = 0.4;
    const Pose now = at(marker, m.q(t), m.v(t), m.a(t));
    const auto y = [&](double s) { return at(marker, m.q(s), m.v(s), m.a(s)).y; };
    const auto yd = [&](double s) { return at(marker, m.q(s), m.v(s), m.a(s)).yd; };
    CHECK((now.yd - testing::derivative(y, t, 1e-3)).norm() < 1e-10);
    CHECK((now.ydd - testing::derivative(yd, t, 1e-3)).norm() < 1e-10);
    if (n == 0) continue;
    const VectorXd q = m.q(t), v = m.v(t), a = m.a(t);
    const auto y_q = [&](const VectorXd& x) { return VectorXd(at(marker, x, v, a).y); };
    const auto yd_q = [&](const VectorXd& x) { return VectorXd(at(marker, x, v, a).yd); };
    const auto yd_v = [&](const VectorXd& x) { return VectorXd(at(marker, q, x, a).yd); };
    CHECK((now.P - testing::jacobian(y_q, q, 1e-3)).norm() < 1e-10);
    CHECK((now.P - testing::jacobian(yd_v, v, 1e-3)).norm() < 1e-10);
    CHECK((now.dyd - testing::jacobian(yd_q, q, 1e-3)).norm() < 1e-10);
    const Vector3d wrench = random.vector(3);
    const auto pulled_back = [&](const VectorXd& x) { return VectorXd(at(marker, x, v, a).P.transpose() * wrench); };
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
    dynamics::add_geometric_stiffness(marker, now, wrench, -3, K);
    CHECK((K + 3 * testing::jacobian(pulled_back, q, 1e-3)).norm() < 1e-9);
  }
}

TEST_CASE("a density marker with the body's mass constants weighs the whole body") {
  // two masses 1 and 3 at (1, 0) and (0, 2): gravity on the marker is gravity on both
  Marker body;
  body.framed = true;
  body.coordinates = {0, 1, 2};
  body.S.resize(2, 0);
  body.psi.resize(0);
  body.mass = 4;
  body.x << 1, 6;
  const Vector3d q(0.3, -0.2, 0.7);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const auto& [m, x] : {std::pair(1., Eigen::Vector2d(1, 0)), std::pair(3., Eigen::Vector2d(0, 2))})
    sum += m * (q.head<2>() + Eigen::Rotation2Dd(q[2]) * x);
  CHECK((at(body, q, Vector3d::Zero(), Vector3d::Zero()).y.head<2>() - sum).norm() < 1e-14);
}
