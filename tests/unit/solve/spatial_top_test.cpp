#include <catch2/catch.hpp>
#include <cmath>

#include "differences.h"
#include "spatial_systems.h"

using namespace floe;
using dynamics::ConstraintLevel;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::numbers_of;
using testing::vector_of;

namespace {

const double m = 2, l = 0.5, g = 9.81;
const Vector3d slender(0.2, 0.2, 0.3), centre(0, 0, l);

/// A heavy top: unknowns (R, x, lambda), the frame at the mass centre, the point -centre constrained at the origin.
struct Top {
  std::shared_ptr<dynamics::Attitude> attitude = std::make_shared<dynamics::Attitude>();
  std::unique_ptr<dynamics::System> system;

  explicit Top(const Vector3d& moments, const Eigen::Quaterniond& at, double spring = 0,
               const Matrix3d& towards = Matrix3d::Identity()) {
    attitude->base = at;
    dynamics::Coordinates coordinates(PETSC_COMM_SELF);
    coordinates.add_shared(6);
    coordinates.add_shared(3, true);
    coordinates.number();
    testing::Terms terms;
    if (spring > 0) terms.push_back(std::make_unique<testing::TorsionalSpring>(attitude, towards, spring));
    terms.push_back(std::make_unique<dynamics::SpatialBody>(std::vector<int>{0, 1, 2, 3, 4, 5}, attitude,
                                                            testing::rigid(m, moments), testing::no_elasticity()));
    terms.push_back(std::make_unique<testing::HeavyOnPoint>(attitude, -centre, m * g));
    system = std::make_unique<dynamics::System>(coordinates, std::move(terms), dynamics::Attitudes{{3, attitude}});
  }
  Matrix3d axes(const VectorXd& q) const { return attitude->axes(q.segment<3>(3)); }
};

Vector3d about_point(const Vector3d& moments) { return moments + m * l * l * Vector3d(1, 1, 0); }

testing::Rotating rotating(const Vector3d& moments, const Eigen::Quaterniond& at, const Vector3d& w) {
  return {about_point(moments), m * g * centre, at, w};
}

/// lambda = -m (R'' + g e_z) of a rotation about the origin.
Vector3d constrained(const testing::Rotating& now) {
  const Vector3d wd = now.acceleration(now.attitude, now.w);
  return -m * (now.attitude * (wd.cross(centre) + now.w.cross(now.w.cross(centre))) + Vector3d(0, 0, g));
}

struct Errors {
  double attitude = 0, w = 0, lambda = 0, constraint = 0;
  Matrix3d end = Matrix3d::Identity();
  PetscInt steps = 0;
};

/// Against the motion `exact` at a tenth of the horizon each (lambda from the first step on).
Errors spin(const Vector3d& moments, const testing::Rotating& start, const solve::Integration& how) {
  Top top(moments, start.attitude);
  const Vector3d R = start.attitude * centre, Rd = start.attitude * start.w.cross(centre);
  const petsc::VecHandle U = vector_of(*top.system, {R[0], R[1], R[2], 0, 0, 0, 0, 0, 0}),
                         V = vector_of(*top.system, {Rd[0], Rd[1], Rd[2], start.w[0], start.w[1], start.w[2], 0, 0, 0});
  Errors errors;
  testing::Rotating exact = start;
  double reached = 0;
  const auto report = solve::simulate(*top.system, how, U, V, [&](const solve::Instant& now) {
    if (now.step == 0) return;
    if (now.t > reached) exact = exact.after(now.t - reached, static_cast<int>(std::ceil((now.t - reached) / 2e-4)));
    reached = now.t;
    const VectorXd q = numbers_of(now.U), v = numbers_of(now.V);
    errors.attitude = std::max(errors.attitude, (top.axes(q) - exact.attitude.toRotationMatrix()).norm());
    errors.w = std::max(errors.w, (v.segment<3>(3) - exact.w).norm());
    errors.lambda = std::max(errors.lambda, (q.tail<3>() - constrained(exact)).norm());
    errors.constraint =
        std::max(errors.constraint, top.system->constraint_violation(now.t, now.U, now.V, ConstraintLevel::position));
  });
  errors.end = top.axes(numbers_of(U));
  errors.steps = report.steps;
  return errors;
}

const Eigen::Quaterniond tilted = math::quaternion({0.4, 0.6, 0.2});

}  // namespace

TEST_CASE("the steady heavy top precesses at the rate of the closed form") {
  // J' W^2 cos(tilt) - J_3 w_3 W + m g l = 0 with J' about the point: w_3 that suits a chosen W
  const double tilt = 0.6, W = 1.5, J = about_point(slender).x();
  const double w3 = (m * g * l + J * W * W * std::cos(tilt)) / (slender.z() * W), end = 2;
  const Eigen::Quaterniond at = math::quaternion({tilt, 0, 0});
  const testing::Rotating start = rotating(slender, at, {0, W * std::sin(tilt), w3});
  const auto rate_error = [&](double step, Errors& errors) {
    errors = spin(slender, start, {end, step, 0.8, {}});
    const Vector3d axis = errors.end.col(2), azimuth(std::sin(W * end), -std::cos(W * end), 0);  // begins at -y
    CHECK(axis.z() == Approx(std::cos(tilt)).epsilon(1e-3));
    return std::abs(azimuth.cross(axis).z() / std::sin(tilt)) / (W * end);
  };
  Errors coarse, fine;
  const double few = rate_error(0.004, coarse), many = rate_error(0.002, fine);
  INFO(few << " " << many << ", " << coarse.attitude << " " << fine.attitude << ", " << coarse.w << " " << fine.w
           << ", " << coarse.lambda << " " << fine.lambda);
  CHECK(many < 1e-3);
  CHECK(std::log2(few / many) == Approx(2).margin(0.1));
  CHECK(std::log2(coarse.lambda / fine.lambda) == Approx(2).margin(0.1));
}

TEST_CASE("a heavy top of three moments that nutates: order 2 in attitude, spin and multipliers from the first step") {
  const Vector3d moments(0.2, 0.25, 0.3);
  const testing::Rotating start = rotating(moments, tilted, {1, -2, 12});
  const double rho = GENERATE(0.8, 0.5, 0.0);
  const Errors coarse = spin(moments, start, {1.5, 0.004, rho, {}}), fine = spin(moments, start, {1.5, 0.002, rho, {}});
  INFO(rho << ": " << coarse.attitude << " " << fine.attitude << ", " << coarse.w << " " << fine.w << ", "
           << coarse.lambda << " " << fine.lambda);
  CHECK(std::log2(coarse.attitude / fine.attitude) == Approx(2).margin(0.1));
  CHECK(std::log2(coarse.w / fine.w) == Approx(2).margin(0.1));
  CHECK(std::log2(coarse.lambda / fine.lambda) == Approx(2).margin(0.15));
  CHECK(fine.constraint < 1e-12);
}

TEST_CASE("the multipliers of a heavy top have no error of order 1 in the first step") {
  const Vector3d moments(0.2, 0.25, 0.3);
  const testing::Rotating start = rotating(moments, tilted, {1, -2, 12});
  const double coarse = spin(moments, start, {0.002, 0.002, 0.8, {}}).lambda,
               fine = spin(moments, start, {0.001, 0.001, 0.8, {}}).lambda;
  INFO(coarse << " " << fine);
  CHECK(std::log2(coarse / fine) > 1.7);
}

TEST_CASE("adaptive steps of a heavy top: multipliers stay smooth through changes of the step") {
  const Vector3d moments(0.2, 0.25, 0.3);
  const testing::Rotating start = rotating(moments, tilted, {1, -2, 12});
  const Errors loose = spin(moments, start, {1.5, 1e-3, 0.8, 1e-4}),
               tight = spin(moments, start, {1.5, 1e-3, 0.8, 1e-6});
  INFO(loose.attitude << " " << tight.attitude << ", " << loose.lambda << " " << tight.lambda << ", " << loose.steps
                      << " " << tight.steps);
  CHECK(tight.attitude < 1e-2);
  CHECK(loose.attitude / tight.attitude > 10);
  CHECK(loose.lambda / tight.lambda > 8);
}

TEST_CASE("accelerations, multipliers and velocities at a start do not depend on the chart, which stays as it was") {
  const Vector3d moments(0.2, 0.25, 0.3), x(0.5, -0.9, 0.7), w(1, -2, 3);
  Top charted(moments, tilted), based(moments, tilted * math::quaternion(x));
  const Vector3d R = based.attitude->base * centre;
  const std::vector<double> rates{0.3, 0.1, -0.4, w[0], w[1], w[2], 0, 0, 0};
  const petsc::VecHandle U = vector_of(*charted.system, {R[0], R[1], R[2], x[0], x[1], x[2], 7, 7, 7}),
                         U0 = vector_of(*based.system, {R[0], R[1], R[2], 0, 0, 0, 7, 7, 7}),
                         V = vector_of(*charted.system, rates), V0 = vector_of(*based.system, rates),
                         A = charted.system->create_vector(), A0 = based.system->create_vector();
  CHECK(solve::consistent_velocities(*charted.system, 0, U, V) > 0.01);
  solve::consistent_velocities(*based.system, 0, U0, V0);
  CHECK(testing::relative_error(numbers_of(V), numbers_of(V0)) < 1e-13);
  CHECK(solve::constraint_violation(*charted.system, 0, U, V, ConstraintLevel::velocity) < 1e-13);
  solve::consistent_start(*charted.system, 0, U, V, A);
  solve::consistent_start(*based.system, 0, U0, V0, A0);
  CHECK(testing::relative_error(numbers_of(A), numbers_of(A0)) < 1e-13);
  CHECK(testing::relative_error(numbers_of(U).tail<3>(), numbers_of(U0).tail<3>()) < 1e-13);
  CHECK(numbers_of(U).segment<3>(3) == x);
  CHECK(charted.attitude->base.coeffs() == tilted.coeffs());
  const petsc::VecHandle F = charted.system->create_vector();
  charted.system->residual(0, U, V, A, ConstraintLevel::acceleration, F);
  CHECK(numbers_of(F).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("equilibrium far from its base: the tangent is exact and Newton's last steps are quadratic") {
  const Matrix3d towards = math::rotation({0.6, -0.9, 0.5});
  Top top(Vector3d(0.2, 0.25, 0.3), Eigen::Quaterniond::Identity(), 8, towards);
  const Vector3d x(0.3, -0.5, 0.8), R = math::rotation(x) * centre;
  const petsc::VecHandle U = vector_of(*top.system, {R[0], R[1], R[2], x[0], x[1], x[2], 0, 0, 0}),
                         V = top.system->create_vector(), F = top.system->create_vector();
  CHECK(solve::equilibrium(*top.system, 0, U, V) <= 8);
  const VectorXd q = numbers_of(U);
  CHECK(q.segment<3>(3).norm() > 1);
  CHECK((q.tail<3>() + m * g * Vector3d::UnitZ()).norm() < 1e-10);  // carries the weight
  const auto rows = [&](const VectorXd& at) {
    const petsc::VecHandle u = vector_of(*top.system, {at.data(), at.data() + at.size()});
    top.system->residual(0, u, V, V, ConstraintLevel::position, F);
    return numbers_of(F);
  };
  CHECK(rows(q).cwiseAbs().maxCoeff() < 1e-10);
  const petsc::MatHandle J = top.system->create_tangent();
  top.system->tangent(0, U, V, V, {1, 0, 0}, J);
  const Eigen::MatrixXd expected = testing::jacobian(rows, q, 1e-3);
  double error = 0;
  for (PetscInt i = 0; i < 9; ++i)
    for (PetscInt j = 0; j < 9; ++j) {
      double entry = 0;
      petsc::check(MatGetValue(J, i, j, &entry));
      error = std::max(error, std::abs(entry - expected(i, j)));
    }
  CHECK(error < 1e-9 * expected.cwiseAbs().maxCoeff());
}

TEST_CASE("a top that a spring holds upright gives way in two directions where weight wins, in any chart") {
  const auto [c, directions] = GENERATE(std::pair(30.0, 0), std::pair(3.0, 2));  // c against m g l / 2 = 4.9
  const Vector3d x = GENERATE(Vector3d(0, 0, 0), Vector3d(1, -0.5, 2));
  Top top(Vector3d(0.2, 0.25, 0.3), math::quaternion(-x), c, Matrix3d::Identity());
  const petsc::VecHandle U = vector_of(*top.system, {0, 0, l, x[0], x[1], x[2], 0, 0, -m * g}),
                         V = top.system->create_vector();
  CHECK(solve::unstable_directions(*top.system, 0, U, V) == directions);
}
