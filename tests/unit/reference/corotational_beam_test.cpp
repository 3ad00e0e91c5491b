#include "floe/reference/corotational_beam.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "floe/error.h"

using namespace floe;
using dynamics::Motion;
using dynamics::Weights;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;
using reference::CorotationalBeam;

namespace {

const CorotationalBeam::Properties stocky{3.0e3, 40, 1.7, 0.3};
const Vector2d X1(0.4, -0.2), X2(1.5, 0.6), gravity(1.3, -9.81);
const double length = (X2 - X1).norm();

/// Phi = 12 EI / (GA l^2) = 1.73.
const CorotationalBeam::Properties sheared{3.0e3, 40, 1.7, 0.3, 0, 150};

CorotationalBeam stocky_beam() { return {{0, 1, 2, 3, 4, 5}, X1, X2, stocky, gravity}; }

CorotationalBeam sheared_beam() { return {{0, 1, 2, 3, 4, 5}, X1, X2, sheared, gravity}; }

CorotationalBeam viscous_beam() { return {{0, 1, 2, 3, 4, 5}, X1, X2, {3.0e3, 40, 1.7, 0.3, 0.04}, gravity}; }

struct State {
  VectorXd q, v, a;
};

/// Deflected by tenths of a radian, rotated by `rotation`, moving.
State some_state(unsigned seed, double rotation) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  const auto vector = [&](double size) {
    return VectorXd(VectorXd::NullaryExpr(6, [&] { return size * number(random); }));
  };
  State state{vector(0.2), vector(3), vector(20)};
  const Vector2d d = X2 - X1;
  state.q.segment<2>(3) += Eigen::Rotation2Dd(rotation) * d - d;
  state.q[2] += rotation;
  state.q[5] += rotation;
  return state;
}

VectorXd residual(const CorotationalBeam& beam, const State& s) {
  VectorXd r = VectorXd::Zero(6);
  beam.residual(Motion{0, s.q, s.v, s.a}, r);
  return r;
}

MatrixXd tangent(const CorotationalBeam& beam, const State& s, Weights weights) {
  MatrixXd J = MatrixXd::Zero(6, 6);
  beam.tangent(Motion{0, s.q, s.v, s.a}, weights, J);
  return J;
}

dynamics::Energy energy(const CorotationalBeam& beam, const State& s) { return beam.energy(Motion{0, s.q, s.v, s.a}); }

/// Jacobian by central differences of step h.
MatrixXd differences(const std::function<VectorXd(const VectorXd&)>& f, VectorXd x, double h) {
  MatrixXd J(f(x).size(), x.size());
  for (int i = 0; i < x.size(); ++i) {
    const double at = x[i];
    x[i] = at + h;
    const VectorXd ahead = f(x);
    x[i] = at - h;
    J.col(i) = (ahead - f(x)) / (2 * h);
    x[i] = at;
  }
  return J;
}

/// `exact` is the derivative of f: central differences tend to it at order 2, their extrapolation equals it.
void check_derivative(const MatrixXd& exact, const std::function<VectorXd(const VectorXd&)>& f, const VectorXd& x) {
  const MatrixXd coarse = differences(f, x, 4e-3), fine = differences(f, x, 2e-3);
  CHECK((coarse - exact).norm() / (fine - exact).norm() == Approx(4).epsilon(0.02));
  CHECK(((4 * fine - coarse) / 3 - exact).norm() < 1e-7 * exact.norm());
}

}  // namespace

TEST_CASE("corotational beam: the static force is the gradient of the energy", "[corotational]") {
  const auto beam = GENERATE(true, false) ? sheared_beam() : stocky_beam();
  for (const double rotation : {0.3, 3.1, -7.9}) {
    State s = some_state(1, rotation);
    s.v.setZero(), s.a.setZero();
    check_derivative(
        residual(beam, s).transpose(),
        [&](const VectorXd& q) {
          const auto e = energy(beam, {q, s.v, s.a});
          return VectorXd::Constant(1, e.elastic + e.potential);
        },
        s.q);
  }
}

TEST_CASE("corotational beam: the tangent is the derivative of the residual", "[corotational]") {
  auto viscous_shear = sheared;
  viscous_shear.viscosity = 0.04;
  const int kind = GENERATE(0, 1, 2);
  const auto beam = kind == 0   ? viscous_beam()
                    : kind == 1 ? sheared_beam()
                                : CorotationalBeam({0, 1, 2, 3, 4, 5}, X1, X2, viscous_shear, gravity);
  for (const double rotation : {0.3, 3.1, -7.9}) {
    const State s = some_state(2, rotation);
    check_derivative(
        tangent(beam, s, {1, 0, 0}),
        [&](const VectorXd& q) {
          return residual(beam, {q, s.v, s.a});
        },
        s.q);
    // quadratic in v and linear in a: central differences are exact
    const MatrixXd C = differences([&](const VectorXd& v) { return residual(beam, {s.q, v, s.a}); }, s.v, 0.1);
    const MatrixXd M = differences([&](const VectorXd& a) { return residual(beam, {s.q, s.v, a}); }, s.a, 1);
    CHECK((tangent(beam, s, {0, 1, 0}) - C).norm() < 1e-9 * C.norm());
    CHECK((tangent(beam, s, {0, 0, 1}) - M).norm() < 1e-10 * M.norm());
    const MatrixXd sum = tangent(beam, s, {2, 0, 0}) / 2 + 3 * C - 5 * M;
    CHECK((tangent(beam, s, {1, 3, -5}) - sum).norm() < 1e-9 * sum.norm());
  }
}

TEST_CASE("corotational beam: viscous forces take power from strain rates alone", "[corotational]") {
  const auto beam = stocky_beam(), damped = viscous_beam();
  State s = some_state(4, 2.3);
  const auto power = [&] { return (residual(damped, s) - residual(beam, s)).dot(s.v); };
  const auto strain = [&](double t) {  // eps and the local rotations
    const VectorXd q = s.q + t * s.v;
    const Vector2d d = X2 - X1, now = d + q.segment<2>(3) - q.head<2>();
    const double beta = std::atan2(d[0] * now[1] - d[1] * now[0], d.dot(now)), whole = 2 * std::numbers::pi;
    const double rotations = beta + whole * std::round(((q[2] + q[5]) / 2 - beta) / whole);
    const double a1 = q[2] - rotations, a2 = q[5] - rotations;
    return Eigen::Vector3d(now.norm() / length - 1 + (2 * a1 * a1 - a1 * a2 + 2 * a2 * a2) / 30, a1, a2);
  };
  const double h = 1e-4;
  const Eigen::Vector3d rate = (8 * (strain(h) - strain(-h)) - (strain(2 * h) - strain(-2 * h))) / (12 * h);
  const double bending = 4 * rate[1] * rate[1] + 4 * rate[1] * rate[2] + 4 * rate[2] * rate[2];
  CHECK(power() == Approx(0.04 * (3.0e3 * length * rate[0] * rate[0] + 40 / length * bending)).epsilon(1e-8));
  const Vector2d at(0.3, -1.2), second = X2 + s.q.segment<2>(3), first = X1 + s.q.head<2>();
  const double w = 1.7;  // a rigid motion
  s.v << at[0] - w * first[1], at[1] + w * first[0], w, at[0] - w * second[1], at[1] + w * second[0], w;
  CHECK((residual(damped, s) - residual(beam, s)).norm() < 1e-12 * residual(beam, s).norm());
}

TEST_CASE("corotational beam: its mass is that of its inertia forces", "[corotational]") {
  const CorotationalBeam::Properties properties = GENERATE(true, false) ? sheared : stocky;
  const CorotationalBeam beam({0, 1, 2, 3, 4, 5}, X1, X2, properties, gravity);
  const reference::CorotationalBeamMass mass({0, 1, 2, 3, 4, 5}, X1, X2, properties);
  State s = some_state(5, -1.3);
  s.v.setZero();
  const auto force = [&](const State& at) {
    VectorXd r = VectorXd::Zero(6);
    mass.residual(Motion{0, at.q, at.v, at.a}, r);
    return r;
  };
  MatrixXd M = MatrixXd::Zero(6, 6), K = M;
  mass.tangent(Motion{0, s.q, s.v, s.a}, {0, 0, 1}, M);
  CHECK((M - tangent(beam, s, {0, 0, 1})).norm() < 1e-14 * M.norm());
  CHECK((force(s) - M * s.a).norm() < 1e-13 * force(s).norm());
  mass.tangent(Motion{0, s.q, s.v, s.a}, {1, 0, 0}, K);
  check_derivative(
      K,
      [&](const VectorXd& q) {
        return force({q, s.v, s.a});
      },
      s.q);
}

TEST_CASE("corotational beam: kinetic energy equals quadrature of the moving body", "[corotational]") {
  const CorotationalBeam::Properties properties = GENERATE(true, false) ? sheared : stocky;
  const CorotationalBeam beam({0, 1, 2, 3, 4, 5}, X1, X2, properties, gravity);
  const State s = some_state(3, 1.1);
  const double Phi = 12 * properties.EI / (properties.GA * length * length), c = Phi / (2 * (1 + Phi));
  const auto place = [&](double xi,
                         double t) -> Eigen::Vector3d {  // of a point of the line, and rotation of its section
    const VectorXd q = s.q + t * s.v;
    const Vector2d r1 = X1 + q.head<2>(), r2 = X2 + q.segment<2>(3), e = (r2 - r1).normalized(), d = X2 - X1;
    const double beta = std::atan2(e[1], e[0]) - std::atan2(d[1], d[0]);
    const double gamma = -c * (q[2] + q[5] - 2 * beta), a1 = q[2] - beta + gamma, a2 = q[5] - beta + gamma;
    const double w = length * (xi * (1 - xi) * (1 - xi) * a1 - xi * xi * (1 - xi) * a2);
    const double slope = (1 - xi) * (1 - 3 * xi) * a1 + xi * (3 * xi - 2) * a2;
    const Vector2d r = (1 - xi) * r1 + xi * r2 + w * Vector2d(-e[1], e[0]);
    return {r[0], r[1], beta + slope - gamma};
  };
  const double points[] = {0.8611363115940526, 0.3399810435848563},
               weights[] = {0.3478548451374538, 0.6521451548625461};
  double T = 0;
  for (int g = 0; g < 4; ++g) {
    const double xi = 0.5 + (g % 2 ? 0.5 : -0.5) * points[g / 2], h = 1e-4;
    const Eigen::Vector3d rate =
        (8 * (place(xi, h) - place(xi, -h)) - (place(xi, 2 * h) - place(xi, -2 * h))) / (12 * h);
    T += length * weights[g / 2] / 4 *
         (properties.rhoA * rate.head<2>().squaredNorm() + properties.rhoI * rate[2] * rate[2]);
  }
  CHECK(energy(beam, s).kinetic == Approx(T).epsilon(1e-10));
}

TEST_CASE("corotational beam: the inertia force is Lagrange's derivative of the kinetic energy", "[corotational]") {
  const auto beam = GENERATE(true, false) ? sheared_beam() : stocky_beam();
  const State s = some_state(4, 2.2);
  const State still{s.q, VectorXd::Zero(6), VectorXd::Zero(6)};
  const VectorXd inertia = residual(beam, s) - residual(beam, still);
  const auto kinetic = [&](const VectorXd& q, const VectorXd& v) { return energy(beam, {q, v, s.a}).kinetic; };

  const auto along = [&](double t) { return State{s.q + t * s.v + t * t / 2 * s.a, s.v + t * s.a, s.a}; };
  const auto momentum = [&](double t) -> VectorXd {  // T is quadratic in v: exact
    const State at = along(t);
    return differences([&](const VectorXd& v) { return VectorXd::Constant(1, kinetic(at.q, v)); }, at.v, 0.5)
        .transpose();
  };
  const double h = 2e-4;
  const VectorXd rate = (8 * (momentum(h) - momentum(-h)) - (momentum(2 * h) - momentum(-2 * h))) / (12 * h);
  const auto by_place = [&](double step) -> VectorXd {
    return differences([&](const VectorXd& q) { return VectorXd::Constant(1, kinetic(q, s.v)); }, s.q, step)
        .transpose();
  };
  const VectorXd lagrange = rate - (4 * by_place(1e-3) - by_place(2e-3)) / 3;
  CHECK((inertia - lagrange).norm() < 1e-8 * inertia.norm());

  const auto energy_at = [&](double t) { return kinetic(along(t).q, along(t).v); };
  const double power = (8 * (energy_at(h) - energy_at(-h)) - (energy_at(2 * h) - energy_at(-2 * h))) / (12 * h);
  CHECK(s.v.dot(inertia) == Approx(power).epsilon(1e-9));
}

TEST_CASE("corotational beam: rigid motion by any angle strains nothing and has a rigid bar's energy",
          "[corotational]") {
  const auto beam = GENERATE(true, false) ? sheared_beam() : stocky_beam();
  const Vector2d d = X2 - X1, shift(3, -2), velocity(0.7, -1.9);
  const double spin = 2.3, mass = stocky.rhoA * length, J = mass * length * length / 12 + stocky.rhoI * length;
  for (const double angle : {0.0, 1.0, std::numbers::pi, 6.2, -3.0, 20.0, -1234.5}) {
    const Vector2d rotated = Eigen::Rotation2Dd(angle) * d, half(-spin * rotated[1] / 2, spin * rotated[0] / 2);
    State s{VectorXd::Zero(6), VectorXd::Zero(6), VectorXd::Zero(6)};
    s.q << shift, angle, shift + rotated - d, angle;
    s.v << velocity - half, spin, velocity + half, spin;
    CHECK(energy(beam, s).elastic < 1e-18);
    CHECK(energy(beam, s).kinetic == Approx(mass * velocity.squaredNorm() / 2 + J * spin * spin / 2).epsilon(1e-12));
    CHECK(energy(beam, s).potential == Approx(-mass * gravity.dot(X1 + shift + rotated / 2)).epsilon(1e-12));

    // steady rotation: each half is constrained by its centripetal force, and gravity by half the weight at each end
    s.a << spin * spin * rotated / 2, 0, -spin * spin * rotated / 2, 0;
    VectorXd expected = VectorXd::Zero(6);
    const Vector2d pull = mass * spin * spin * rotated / 12, weight = mass * gravity / 2;
    const double moment = mass / 12 * (gravity[1] * rotated[0] - gravity[0] * rotated[1]);
    expected << pull - weight, -moment, -pull - weight, moment;
    CHECK((residual(beam, s) - expected).norm() < 1e-10 * expected.norm());
  }
}

// Small end load F and moment M of a clamped beam: v = F L^3/3EI + F L/GA + M L^2/2EI, theta = F L^2/2EI + M L/EI.
TEST_CASE("corotational beam: a clamped element with shear bends as Timoshenko's beam", "[corotational]") {
  const double L = 2, EI = 40, GA = 150, F = 1e-6, M = 3e-6;
  const CorotationalBeam beam({0, 1, 2, 3, 4, 5}, {0, 0}, {L, 0}, {3e3, EI, 1.7, 0.3, 0, GA});
  const VectorXd none = VectorXd::Zero(6);
  const MatrixXd K = tangent(beam, {none, none, none}, {1, 0, 0}).bottomRightCorner(3, 3);
  const Eigen::Vector3d u = K.ldlt().solve(Eigen::Vector3d(0, F, M));
  CHECK(u[1] == Approx(F * L * L * L / (3 * EI) + F * L / GA + M * L * L / (2 * EI)).epsilon(1e-12));
  CHECK(u[2] == Approx(F * L * L / (2 * EI) + M * L / EI).epsilon(1e-12));
}

TEST_CASE("corotational beam: what cannot be an element is refused, all faults at once", "[corotational]") {
  const std::vector<int> six{0, 1, 2, 3, 4, 5};
  CHECK_THROWS_AS(CorotationalBeam(six, X1, X1, stocky), InputError);
  CHECK_THROWS_AS(CorotationalBeam({0, 1, 2, 3, 4, 4}, X1, X2, stocky), InputError);
  CHECK_THROWS_AS(CorotationalBeam(six, X1, X2, stocky, {0, NAN}), InputError);
  CHECK_NOTHROW(CorotationalBeam(six, X1, X2, {1, 1, 1, 0}));
  try {
    CorotationalBeam(six, X1, X2, {0, -1, NAN, -1});
    FAIL("accepted");
  } catch (const InputError& error) {
    CHECK(error.faults().size() == 4);
  }
  CHECK_THROWS_AS(CorotationalBeam(six, X1, X2, {1, 1, 1, 0, 0, 0}), InputError);
}
