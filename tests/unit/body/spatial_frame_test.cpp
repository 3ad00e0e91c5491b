#include "floe/body/spatial_frame.h"

#include <catch2/catch.hpp>

#include "differences.h"
#include "floe/body/floating_frame.h"
#include "floe/math/rotation.h"
#include "random.h"

using namespace floe;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::Random;

namespace {

const Eigen::Quaterniond base = math::quaternion({0.7, -1.1, 0.4});

Matrix3d axes(const VectorXd& q) { return (base * math::quaternion(q.segment<3>(3))).toRotationMatrix(); }

/// Eleven point masses moved by k elastic coordinates; of those directions only that `moves` says.
std::vector<body::MassPoint> points(int k, const Vector3d& moves = Vector3d::Ones()) {
  Random random(21);
  std::vector<body::MassPoint> all;
  for (int i = 0; i < 11; ++i)
    all.push_back({1.5 + random.number(), random.vector(3), moves.asDiagonal() * (0.4 * random.matrix(3, k))});
  return all;
}

/// A mass of six points that rotates rigidly, theta = rotation e, about its centre or, with an odd seed, about a point
/// beside it.
struct Rotor {
  body::MassPoint centre;
  Eigen::MatrixXd rotation;
  std::vector<Vector3d> arms;
  explicit Rotor(int k, unsigned seed) {
    Random random(seed);
    centre = {1.2, random.vector(3), 0.4 * random.matrix(3, k)};
    rotation = random.matrix(3, k);
    for (int i = 0; i < 3; ++i) {
      arms.push_back(random.vector(3));
      arms.push_back(-arms.back());
    }
    if (seed % 2 == 0) return;
    const Vector3d beside = random.vector(3);
    for (Vector3d& arm : arms) arm += beside;
  }
  bool about_centre() const { return (arms[0] + arms[1]).isZero(); }
  void add_to(body::Inertia& sum) const {
    Matrix3d second = Matrix3d::Zero();
    body::RotatingForms forms;
    for (const Vector3d& arm : arms) {
      second += centre.mass * arm * arm.transpose();
      forms.add(centre.mass, centre.x + arm, Matrix3d::Identity(), arm);
      sum.add({centre.mass, centre.x + arm, centre.N - math::skew(arm) * rotation});
    }
    sum.add(body::RotatingMass(about_centre() ? body::RotatingForms(second) : forms, rotation));
  }
};

body::SpatialInertia with_rotors(int k) {
  body::Inertia sum(3, k);
  for (unsigned seed : {31u, 32u}) Rotor(k, seed).add_to(sum);
  return body::spatial(sum);
}

body::Inertia summed(const std::vector<body::MassPoint>& mass) {
  body::Inertia sum(3, static_cast<int>(mass.front().N.cols()));
  for (const auto& point : mass) sum.add(point);
  return sum;
}

VectorXd force(const body::SpatialInertia& in, const VectorXd& q, const VectorXd& v, const VectorXd& a) {
  VectorXd r = VectorXd::Zero(q.size());
  body::SpatialInertiaWork work;
  body::add_spatial_inertia_force(in, axes(q), q, v, a, work, r);
  return r;
}

/// q(t) = q + t q' + t^2/2 q'' with x among q, and the rates that belong to it: omega = T(x) x'.
struct Path {
  VectorXd q0, q1, q2;
  Path(Random& random, int size) : q0(random.vector(size)), q1(random.vector(size)), q2(random.vector(size)) {}
  VectorXd q(double t) const { return q0 + t * q1 + t * t / 2 * q2; }
  VectorXd v(double t) const {
    VectorXd rate = q1 + t * q2;
    rate.segment<3>(3) = math::rotation_tangent(q(t).segment<3>(3)) * Vector3d(rate.segment<3>(3));
    return rate;
  }
  VectorXd a(double t) const {
    const Vector3d x = q(t).segment<3>(3), xd = (q1 + t * q2).segment<3>(3);
    VectorXd rate = q2;
    rate.segment<3>(3) = math::rotation_tangent(x) * q2.segment<3>(3) + math::rotation_tangent_derivative(x, xd) * xd;
    return rate;
  }
};

/// Where a point is, R + A (x + N e).
Vector3d position(const body::MassPoint& point, const VectorXd& q) {
  return q.head<3>() + axes(q) * (point.x + point.N * q.tail(q.size() - 6));
}

}  // namespace

TEST_CASE("inertia force in space: the points' mass times acceleration, energies and momenta theirs, by differences") {
  const int k = GENERATE(0, 1, 4);
  const Vector3d moves = GENERATE(Vector3d(1, 1, 1), Vector3d(0, 0, 1), Vector3d(0, 1, 1));
  const auto mass = points(k, moves);
  const body::SpatialInertia in = body::spatial(summed(mass));
  Random random(22);
  const Path path(random, k + 6);
  const VectorXd q = path.q(0), v = path.v(0);
  const Matrix3d A = axes(q);
  VectorXd expected = VectorXd::Zero(k + 6);
  Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
  double kinetic = 0;
  for (const auto& point : mass) {
    const auto r = [&](double t) { return position(point, path.q(t)); };
    const auto rd = [&](double t) { return testing::derivative(r, t, 1e-3); };
    const Vector3d f = point.mass * testing::derivative(rd, 0, 1e-3);
    expected.head<3>() += f;
    expected.segment<3>(3) += A.transpose() * (r(0) - q.head<3>()).cross(f);
    expected.tail(k) += (A * point.N).transpose() * f;
    linear += point.mass * rd(0);
    angular += point.mass * r(0).cross(rd(0));
    kinetic += 0.5 * point.mass * rd(0).squaredNorm();
  }
  CHECK(testing::relative_error(force(in, q, v, path.a(0)), expected) < 1e-8);
  CHECK(testing::relative_error(body::momentum(in, A, q, v).linear, linear) < 1e-10);
  CHECK(testing::relative_error(body::momentum(in, A, q, v).angular, angular) < 1e-10);
  CHECK(body::kinetic_energy(in, A, q, v) == Approx(kinetic).epsilon(1e-10));
}

TEST_CASE("power of the inertia force in space is the rate of the kinetic energy, its wrench that of the momenta") {
  const int k = 5;
  const body::SpatialInertia in = GENERATE(false, true) ? with_rotors(k) : body::spatial(summed(points(k)));
  Random random(23);
  const Path path(random, k + 6);
  const VectorXd f = force(in, path.q(0), path.v(0), path.a(0));
  const auto energy = [&](double t) { return body::kinetic_energy(in, axes(path.q(t)), path.q(t), path.v(t)); };
  CHECK(f.dot(path.v(0)) == Approx(testing::derivative(energy, 0, 1e-3)).epsilon(1e-9));
  const auto linear = [&](double t) { return body::momentum(in, axes(path.q(t)), path.q(t), path.v(t)).linear; };
  const auto angular = [&](double t) { return body::momentum(in, axes(path.q(t)), path.q(t), path.v(t)).angular; };
  const Vector3d R = path.q(0).head<3>(), resultant = f.head<3>(), moment = f.segment<3>(3);
  CHECK(testing::relative_error(resultant, testing::derivative(linear, 0, 1e-3)) < 1e-9);
  CHECK(testing::relative_error(Vector3d(R.cross(resultant) + axes(path.q(0)) * moment),
                                testing::derivative(angular, 0, 1e-3)) < 1e-9);
}

TEST_CASE("inertia tangents in space are the differences of the force along base exp(x), x not zero") {
  const int k = GENERATE(0, 4);
  const Vector3d moves = GENERATE(Vector3d(1, 1, 1), Vector3d(0, 0, 1), Vector3d(0, 0, 0));  // 0: what rotates
  const body::SpatialInertia in = moves.isZero() ? with_rotors(k) : body::spatial(summed(points(k, moves)));
  Random random(24);
  const VectorXd q = random.vector(k + 6), v = random.vector(k + 6), a = random.vector(k + 6);
  const auto by_q = testing::jacobian([&](const VectorXd& y) { return force(in, y, v, a); }, q, 1e-3);
  const auto by_v = testing::jacobian([&](const VectorXd& y) { return force(in, q, y, a); }, v, 1e-3);
  const auto by_a = testing::jacobian([&](const VectorXd& y) { return force(in, q, v, y); }, a, 1e-3);
  body::SpatialInertiaWork work;
  const auto tangent = [&](double wq, double wv, double wa) {
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(k + 6, k + 6);
    body::add_spatial_inertia_tangent(in, axes(q), q, v, a, wq, wv, wa, work, J);
    return J;
  };
  CHECK(testing::relative_error(tangent(1, 0, 0), by_q) < 1e-9);
  CHECK(testing::relative_error(tangent(0, 1, 0), by_v) < 1e-9);
  CHECK(testing::relative_error(tangent(0, 0, 1), by_a) < 1e-9);
  CHECK(testing::relative_error(tangent(1, 30, 900), by_q + 30 * by_v + 900 * by_a) < 1e-9);
  CHECK(testing::relative_error(tangent(0, 0, 1), tangent(0, 0, 1).transpose()) < 1e-14);  // the mass matrix
}

// With u = theta x a + 1/2 theta x (theta x a) the kinetic energy is a quartic in (e, e'), of which the terms to the
// second order are kept: those of a rotation exp(theta).
TEST_CASE("masses that rotate have the kinetic energy of their points to second order, and its Lagrangian force") {
  const int k = 4;
  const body::SpatialInertia in = with_rotors(k);
  Random random(26);
  const Path path(random, k + 6);
  const auto scaled = [&](VectorXd y, double s) {
    y.tail(k) *= s;
    return y;
  };
  const auto exact = [&](double s) {
    double sum = 0;
    for (unsigned seed : {31u, 32u}) {
      const Rotor rotor(k, seed);
      for (const Vector3d& arm : rotor.arms) {
        const auto r = [&](double t) {
          const VectorXd q = scaled(path.q(t), s), e = q.tail(k);
          const Vector3d theta = rotor.rotation * e;
          return Vector3d(q.head<3>() + axes(q) * (rotor.centre.x + rotor.centre.N * e + arm + theta.cross(arm) +
                                                   theta.cross(theta.cross(arm)) / 2));
        };
        sum += 0.5 * rotor.centre.mass * testing::derivative(r, 0, 1e-3).squaredNorm();
      }
    }
    return sum;
  };
  const double none = exact(0), up = exact(1), down = exact(-1), far_up = exact(2), far_down = exact(-2);
  const double first = (8 * (up - down) / 2 - (far_up - far_down) / 2) / 6,
               second = (16 * ((up + down) / 2 - none) - ((far_up + far_down) / 2 - none)) / 12;
  const VectorXd q = path.q(0), v = path.v(0), a = path.a(0);
  CHECK(body::kinetic_energy(in, axes(q), q, v) == Approx(none + first + second).epsilon(1e-9));

  const auto momenta = [&](double t) {
    const VectorXd at = path.q(t), rate = path.v(t);
    return testing::gradient([&](const VectorXd& y) { return body::kinetic_energy(in, axes(at), at, y); }, rate, 0.1);
  };
  const VectorXd by_place =
      testing::gradient([&](const VectorXd& y) { return body::kinetic_energy(in, axes(q), y, v); }, q, 1e-3);
  const VectorXd expected = testing::derivative(momenta, 0, 1e-3) - by_place;
  CHECK(testing::relative_error(force(in, q, v, a).tail(k), expected.tail(k)) < 1e-9);
}

TEST_CASE("a body that moves in the plane has the inertia force of the planar frame") {
  const int k = 3;
  body::Inertia sum = summed(points(k, {1, 1, 0}));
  Eigen::MatrixXd rotation = Eigen::MatrixXd::Zero(3, k);
  rotation.row(2) = Random(27).vector(k);
  body::RotatingForms forms(Matrix3d(Vector3d(0.3, 0.7, 0).asDiagonal()));
  forms.add(0.4, Vector3d(0.3, -0.8, 0.2), Matrix3d::Identity(), Vector3d(0.5, 0.2, 0));
  sum.add(body::RotatingMass(forms, rotation));
  Random random(25);
  const VectorXd q = random.vector(k + 3), v = random.vector(k + 3), a = random.vector(k + 3);
  VectorXd planar = VectorXd::Zero(k + 3), found = VectorXd::Zero(k + 6);
  body::add_inertia_force(body::planar(sum), q, v, a, planar);
  const auto in_space = [&](const VectorXd& y) {
    VectorXd z = VectorXd::Zero(k + 6);
    z.head<2>() = y.head<2>(), z[5] = y[2], z.tail(k) = y.tail(k);
    return z;
  };
  const VectorXd x = in_space(q);
  body::SpatialInertiaWork work;
  const Matrix3d A = math::rotation(x.segment<3>(3));
  body::add_spatial_inertia_force(body::spatial(sum), A, x, in_space(v), in_space(a), work, found);
  VectorXd kept(k + 3);
  kept << found.head<2>(), found[5], found.tail(k);
  CHECK(testing::relative_error(kept, planar) < 1e-14);
  CHECK(body::kinetic_energy(body::spatial(sum), A, x, in_space(v)) ==
        Approx(body::kinetic_energy(body::planar(sum), q, v)).epsilon(1e-14));
}

TEST_CASE("forms that vanish are left out: a flat plate that bends has one, a straight beam in two planes four") {
  CHECK(body::spatial(summed(points(4, {0, 0, 1}))).kinds == std::vector<int>{2});
  CHECK(body::spatial(summed(points(4, {0, 1, 1}))).kinds == std::vector<int>{1, 2, 3, 6});
  CHECK(body::spatial(summed(points(4, {1e-16, 1, 1}))).kinds == std::vector<int>{1, 2, 3, 6});  // round-off
  CHECK(body::spatial(summed(points(4))).kinds.size() == 9);
  CHECK(body::spatial(summed(points(1))).kinds.size() == 6);  // a single coordinate has no skew forms
  CHECK(body::spatial(summed(points(0))).kinds.empty());
  CHECK(with_rotors(4).kinds.size() == 12);
}
