#include "floe/body/floating_frame.h"

#include <catch2/catch.hpp>

#include "differences.h"
#include "random.h"

using namespace floe;
using Eigen::Vector2d;
using Eigen::VectorXd;
using testing::Random;

namespace {

constexpr int k = 3;

/// Eleven point masses, each moved by three elastic coordinates in its own way.
std::vector<body::MassPoint> points(int dimension = 2) {
  Random random(11);
  std::vector<body::MassPoint> all;
  for (int i = 0; i < 11; ++i)
    all.push_back({1.5 + random.number(), random.vector(dimension), 0.4 * random.matrix(dimension, k)});
  return all;
}

body::Inertia integrated(int dimension = 2) {
  body::Inertia inertia(dimension, k);
  for (const auto& point : points(dimension)) inertia.add(point);
  return inertia;
}

/// A section with two points at +-arm of its centre that rotates by psi = rotation . e.
const Vector2d arm(0.3, -0.7);
VectorXd rotation() { return Random(16).vector(k); }
body::MassPoint centre() {
  Random random(17);
  return {1.3, random.vector(2), 0.4 * random.matrix(2, k)};
}

body::PlanarInertia section() {
  body::Inertia inertia(2, k);
  const body::MassPoint c = centre();
  for (const double side : {-1., 1.})
    inertia.add({c.mass / 2, c.x + side * arm, c.N + side * Vector2d(-arm.y(), arm.x()) * rotation().transpose()});
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  moments.topLeftCorner<2, 2>() = c.mass * arm * arm.transpose();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(3, k);
  rows.row(2) = rotation().transpose();
  inertia.add(body::RotatingMass(body::RotatingForms(moments), rows));
  return body::planar(inertia);
}

/// A point on an arm from that centre, which rotates alike.
body::PlanarInertia arm_of_centre() {
  body::Inertia inertia(2, k);
  const body::MassPoint c = centre();
  inertia.add({c.mass, c.x + arm, c.N + Vector2d(-arm.y(), arm.x()) * rotation().transpose()});
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(3, k);
  rows.row(2) = rotation().transpose();
  body::RotatingForms forms;
  forms.add(c.mass, c.x + arm, Eigen::Matrix2d::Identity(), Eigen::Vector3d(arm.x(), arm.y(), 0));
  inertia.add(body::RotatingMass(forms, rows));
  return body::planar(inertia);
}

body::PlanarInertia inertia() { return body::planar(integrated()); }

/// Where a point of the body is: R + A (x + N q).
Vector2d position(const body::MassPoint& point, const VectorXd& q) {
  return q.head<2>() + Eigen::Rotation2Dd(q[2]) * Vector2d(point.x + point.N * q.tail(k));
}

/// 1/2 sum m |dr/dt|^2 with the velocities of the points by differences along q + t v.
double quadrature(const VectorXd& q, const VectorXd& v) {
  double sum = 0;
  for (const auto& point : points()) {
    const auto r = [&](double t) { return position(point, q + t * v); };
    sum += 0.5 * point.mass * testing::derivative(r, 0, 1e-3).squaredNorm();
  }
  return sum;
}

VectorXd force(const VectorXd& q, const VectorXd& v, const VectorXd& a, const body::PlanarInertia& in = inertia()) {
  VectorXd r = VectorXd::Zero(k + 3);
  body::InertiaWork work;
  body::add_inertia_force(in, q, v, a, work, r);
  return r;
}

}  // namespace

TEST_CASE("inertia constants are the sums over the mass") {
  const int d = GENERATE(2, 3);
  const body::Inertia in = integrated(d);
  double m = 0, C = 0;
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(d, k), M = Eigen::MatrixXd::Zero(k, k);
  VectorXd s0 = VectorXd::Zero(d), h = VectorXd::Zero(k);
  const int a = 0, b = d - 1;
  for (const auto& p : points(d)) {
    m += p.mass, s0 += p.mass * p.x, S += p.mass * p.N;
    C += p.mass * p.x[a] * p.x[b];
    h += p.mass * p.x[a] * p.N.row(b).transpose();
    M += p.mass * p.N.row(a).transpose() * p.N.row(b);
  }
  CHECK(in.m == Approx(m).epsilon(1e-14));
  CHECK(testing::relative_error(in.s0, s0) < 1e-14);
  CHECK(testing::relative_error(in.S, S) < 1e-14);
  CHECK(in.C0(a, b) == Approx(C).epsilon(1e-12));
  CHECK(testing::relative_error(in.h[a][b], h) < 1e-14);
  CHECK(testing::relative_error(in.M[a][b], M) < 1e-14);
  CHECK(testing::relative_error(in.M[b][a], in.M[a][b].transpose()) < 1e-14);
  body::Inertia twice = in;
  twice += in;
  CHECK(twice.m == Approx(2 * m));
  CHECK(testing::relative_error(twice.M[a][b], 2 * M) < 1e-14);
  CHECK(testing::relative_error(twice.h[a][b], 2 * h) < 1e-14);
}

TEST_CASE("kinetic energy is that of the deformed body, point by point") {
  Random random(12);
  for (int i = 0; i < 5; ++i) {
    const VectorXd q = 2 * random.vector(k + 3), v = random.vector(k + 3);
    CHECK(body::kinetic_energy(inertia(), q, v) == Approx(quadrature(q, v)).epsilon(1e-10));
  }
}

TEST_CASE("a section's kinetic energy is m/2 |r'|^2 + rhoI/2 (theta' + psi')^2 at any rotation") {
  Random random(18);
  const body::MassPoint c = centre();
  for (int i = 0; i < 5; ++i) {
    const VectorXd q = 2 * random.vector(k + 3), v = random.vector(k + 3);
    const auto r = [&](double t) { return position(c, q + t * v); };
    const double rate = v[2] + rotation().dot(v.tail(k)), moment = c.mass * arm.squaredNorm();
    const double exact = 0.5 * c.mass * testing::derivative(r, 0, 1e-3).squaredNorm() + 0.5 * moment * rate * rate;
    CHECK(body::kinetic_energy(section(), q, v) == Approx(exact).epsilon(1e-10));
  }
}

TEST_CASE("the kinetic energy of mass on an arm is that of its point, to second order") {
  Random random(19);
  const VectorXd q = 2 * random.vector(k + 3), v = random.vector(k + 3);
  const body::MassPoint c = centre();
  const auto exact = [&](double s) {  // e, e' times s
    const auto r = [&](double t) {
      VectorXd at = q + t * v;
      at.tail(k) *= s;
      const double psi = rotation().dot(at.tail(k));
      const Vector2d rotated = arm + psi * Vector2d(-arm.y(), arm.x()) - psi * psi / 2 * arm;
      return Vector2d(at.head<2>() + Eigen::Rotation2Dd(at[2]) * Vector2d(c.x + c.N * at.tail(k) + rotated));
    };
    return 0.5 * c.mass * testing::derivative(r, 0, 1e-3).squaredNorm();
  };
  const double none = exact(0), up = exact(1), down = exact(-1), far_up = exact(2), far_down = exact(-2);
  const double first = (8 * (up - down) / 2 - (far_up - far_down) / 2) / 6,
               second = (16 * ((up + down) / 2 - none) - ((far_up + far_down) / 2 - none)) / 12;
  CHECK(body::kinetic_energy(arm_of_centre(), q, v) == Approx(none + first + second).epsilon(1e-8));
}

TEST_CASE("inertia force is d/dt(dT/dv) - dT/dq of the deformed body") {
  const body::PlanarInertia in = GENERATE(inertia(), section(), arm_of_centre());
  Random random(13);
  for (int i = 0; i < 3; ++i) {
    const VectorXd q = random.vector(k + 3), v = random.vector(k + 3), a = random.vector(k + 3);
    const auto T = [&](const VectorXd& x, const VectorXd& xd) { return body::kinetic_energy(in, x, xd); };
    const auto momentum = [&](double t) {
      return testing::gradient([&](const VectorXd& xd) { return T(q + t * v + t * t / 2 * a, xd); }, v + t * a, 0.1);
    };
    const VectorXd by_place = testing::gradient([&](const VectorXd& x) { return T(x, v); }, q, 1e-3);
    CHECK(testing::relative_error(force(q, v, a, in), testing::derivative(momentum, 0, 1e-3) - by_place) < 1e-9);
  }
}

TEST_CASE("inertia force of the frame is the rate of the points' momentum and moment of momentum") {
  Random random(14);
  const VectorXd q = random.vector(k + 3), v = random.vector(k + 3), a = random.vector(k + 3);
  Vector2d resultant = Vector2d::Zero();
  double moment = 0;  // about the frame's origin
  for (const auto& point : points()) {
    const auto r = [&](double t) { return position(point, q + t * v + t * t / 2 * a); };
    const auto rd = [&](double t) { return testing::derivative(r, t, 1e-2); };
    const Vector2d f = point.mass * testing::derivative(rd, 0, 1e-2), arm = r(0) - q.head<2>();
    resultant += f;
    moment += arm.x() * f.y() - arm.y() * f.x();
  }
  CHECK(testing::relative_error(force(q, v, a).head<2>(), resultant) < 1e-6);
  CHECK(force(q, v, a)[2] == Approx(moment).epsilon(1e-6));
}

TEST_CASE("inertia tangents in q, v and a are the differences of the force") {
  const body::PlanarInertia in = GENERATE(inertia(), section(), arm_of_centre());
  Random random(15);
  const VectorXd q = random.vector(k + 3), v = random.vector(k + 3), a = random.vector(k + 3);
  const auto by_q = testing::jacobian([&](const VectorXd& x) { return force(x, v, a, in); }, q, 1e-3);
  const auto by_v = testing::jacobian([&](const VectorXd& x) { return force(q, x, a, in); }, v, 1e-3);
  const auto by_a = testing::jacobian([&](const VectorXd& x) { return force(q, v, x, in); }, a, 1e-3);
  const auto tangent = [&](double wq, double wv, double wa) {
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(k + 3, k + 3);
    body::InertiaWork work;
    body::add_inertia_tangent(in, q, v, a, wq, wv, wa, work, J);
    return J;
  };
  CHECK(testing::relative_error(tangent(1, 0, 0), by_q) < 1e-9);
  CHECK(testing::relative_error(tangent(0, 1, 0), by_v) < 1e-9);
  CHECK(testing::relative_error(tangent(0, 0, 1), by_a) < 1e-9);
  CHECK(testing::relative_error(tangent(1, 30, 900), by_q + 30 * by_v + 900 * by_a) < 1e-9);
  CHECK(testing::relative_error(tangent(0, 0, 1), tangent(0, 0, 1).transpose()) < 1e-14);  // the mass matrix
}
