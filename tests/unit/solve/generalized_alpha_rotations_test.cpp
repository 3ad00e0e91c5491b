#include <catch2/catch.hpp>
#include <cmath>

#include "generalized_alpha_problem.h"
#include "spatial_systems.h"

using namespace floe::dynamics;
using namespace floe::solve;
using namespace floe::solve::problems;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using floe::testing::Rotating;

namespace {

const Rotating start_of_top{{1, 1.6, 2.2}, Vector3d::Zero(), floe::math::quaternion({0.3, -0.8, 0.5}), {0.4, 2, -0.6}};

Vector3d three(const Numbers& x) { return {x[0], x[1], x[2]}; }

/// Euler's top: u = x, A = base exp(x).
Problem euler(const Vector3d& J) {
  Problem p;
  p.size = 3;
  p.residual = [=](double, const double*, const double* v, const double* a, double* f) {
    const Eigen::Map<const Vector3d> w(v), wd(a);
    Eigen::Map<Vector3d>{f} = J.cwiseProduct(wd) + w.cross(J.cwiseProduct(w));
  };
  p.tangent = [=](double, const double*, const double* v, const double*, double sv, double sa, double* rows) {
    const Eigen::Map<const Vector3d> w(v);
    using floe::math::skew;
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{rows} =
        Eigen::Matrix3d(sa * J.asDiagonal()) + sv * (skew(w) * J.asDiagonal() - skew(Vector3d(J.cwiseProduct(w))));
  };
  return p;
}

struct Top {
  Attitude attitude{start_of_top.attitude};
  int rebased = 0;
  Run run;
  double hit = 0;

  Top(double h, double end)
      : run(euler(start_of_top.moments), {0, 0, 0}, {start_of_top.w[0], start_of_top.w[1], start_of_top.w[2]}, h, end) {
    const TSGeneralizedAlphaRotations rotations{rebase, bracket, this};
    check(TSGeneralizedAlphaSetRotations(run.ts, &rotations));
  }
  static PetscErrorCode rebase(TS, Vec U, void* context) {
    auto& top = *static_cast<Top*>(context);
    ++top.rebased;
    top.attitude.advance(three(numbers(U)));
    fill(U, {0, 0, 0});
    return 0;
  }
  static PetscErrorCode bracket(TS, Vec a, Vec b, Vec W, void*) {
    const Vector3d cross = three(numbers(a)).cross(three(numbers(b)));
    fill(W, {cross[0], cross[1], cross[2]});
    return 0;
  }
  Quaterniond now(Vec U) const { return attitude.base * floe::math::quaternion(three(numbers(U))); }
};

/// Where the body's z axis passes the world's xy plane the spin is reversed, and the top rotates back the way it came.
PetscErrorCode height(TS, PetscReal, Vec U, PetscScalar* value, void* context) {
  value[0] = (static_cast<Top*>(context)->now(U) * Vector3d::UnitZ()).z();
  return 0;
}
PetscErrorCode reverse(TS ts, PetscInt, PetscInt*, PetscReal t, Vec U, PetscBool, void* context) {
  Vec V;
  static_cast<Top*>(context)->hit = t;
  check(TS2GetSolution(ts, nullptr, &V));
  check(VecScale(V, -1));
  check(VecScale(U, 1));
  return 0;
}

double distance(const Quaterniond& a, const Quaterniond& b) {
  return (a.toRotationMatrix() - b.toRotationMatrix()).norm();
}

}  // namespace

TEST_CASE("rotations: the base is taken over once a step, tried again or not, and nothing of the motion jumps") {
  Top top(2, 6);  // a first step far too long: it is tried again
  TSAdapt adapt;
  PetscInt steps, rejected;
  check(TSGetAdapt(top.run.ts, &adapt));
  check(TSAdaptSetType(adapt, TSADAPTBASIC));
  check(TSSetTolerances(top.run.ts, PETSC_DECIDE, nullptr, 1e-6, nullptr));
  top.run.solve();
  check(TSGetStepNumber(top.run.ts, &steps));
  check(TSGetStepRejections(top.run.ts, &rejected));
  CHECK(rejected > 0);
  CHECK(top.rebased == steps);
  CHECK(distance(top.now(top.run.U), start_of_top.after(6).attitude) < 1e-2);
}

TEST_CASE("rotations: an event is located within a step that is rolled back, and the motion goes on from there") {
  double low = 0.1, high = 1.5;  // where the reference's axis passes: it begins above
  const auto above = [](double t) { return (start_of_top.after(t, 2000).attitude * Vector3d::UnitZ()).z() > 0; };
  REQUIRE((above(low) && !above(high)));
  for (int i = 0; i < 40; ++i) (above((low + high) / 2) ? low : high) = (low + high) / 2;
  struct Errors {
    double time, attitude;
  };
  const auto errors = [&](double h) {
    Top top(h, 1.9 * low);
    PetscInt direction = 0, steps;
    PetscBool terminate = PETSC_FALSE;
    check(TSSetEventHandler(top.run.ts, 1, &direction, &terminate, height, reverse, &top));
    check(TSSetEventTolerances(top.run.ts, 1e-11, nullptr));
    top.run.solve();
    check(TSGetStepNumber(top.run.ts, &steps));
    CHECK(top.rebased == steps);
    return Errors{std::abs(top.hit - low), distance(top.now(top.run.U), start_of_top.after(0.1 * low).attitude)};
  };
  const Errors coarse = errors(0.02), fine = errors(0.01);
  INFO(low << ": " << coarse.time << " " << fine.time << ", " << coarse.attitude << " " << fine.attitude);
  CHECK(fine.time < 1e-4);
  CHECK(std::log2(coarse.time / fine.time) == Approx(2).margin(0.15));
  CHECK(std::log2(coarse.attitude / fine.attitude) == Approx(2).margin(0.3));
}

TEST_CASE("rotations: what is interpolated in a step is of order 4 about the scheme's own path") {
  // its error in the middle is half that of the step's end, and O(h^4)
  const auto about_path = [](double h) {
    Top top(h, h);
    top.run.solve();
    const floe::petsc::VecHandle middle = vector({0, 0, 0});
    check(TSInterpolate(top.run.ts, h / 2, middle));
    const auto exact = [](double t) {
      return floe::math::rotation_vector(start_of_top.attitude.inverse() * start_of_top.after(t, 100).attitude);
    };
    const Vector3d at_end = three(numbers(top.run.U)) - exact(h), halfway = three(numbers(middle)) - exact(h / 2);
    return (halfway - at_end / 2).norm();
  };
  const double coarse = about_path(0.1), fine = about_path(0.05);
  INFO(coarse << " " << fine);
  CHECK(std::log2(coarse / fine) > 3.7);
}

TEST_CASE("rotations: the estimate of a step's error is its error, relative to all that was turned since the start") {
  const double h = 0.02, rtol = 1e-3;
  const int steps = GENERATE(1, 10);
  Top top(h, steps * h);
  check(TSGeneralizedAlphaSetRadius(top.run.ts, 0.99));  // the estimate is Newmark's error: damping adds 1 - rho to it
  check(TSSetTolerances(top.run.ts, PETSC_DECIDE, nullptr, rtol, nullptr));
  top.run.solve();
  const auto size = [](const Vector3d& x) { return std::sqrt(start_of_top.moments.dot(x.cwiseAbs2())); };
  Rotating last{start_of_top.moments, Vector3d::Zero(), Quaterniond::Identity(), start_of_top.w};
  if (steps > 1) last.w = three(top.run.v[steps - 2]);
  const Vector3d error = three(top.run.u.back()) - floe::math::rotation_vector(last.after(h, 100).attitude);
  Vector3d rotated = Vector3d::Zero();
  for (const Numbers& x : top.run.u) rotated += three(x);
  PetscInt order;
  PetscReal estimate;
  check(TSEvaluateWLTE(top.run.ts, NORM_2, &order, &estimate));
  CHECK(estimate * rtol * size(rotated) == Approx(size(error)).epsilon(0.05));
}

TEST_CASE("rotations need both rebase and bracket") {
  Top top(0.1, 1);
  const TSGeneralizedAlphaRotations half{Top::rebase, nullptr, nullptr};
  CHECK_THROWS_WITH(check(TSGeneralizedAlphaSetRotations(top.run.ts, &half)), Catch::Contains("or neither"));
}
