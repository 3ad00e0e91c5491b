#pragma once
#include <cmath>
#include <functional>
#include <vector>

#include "floe/petsc/handle.h"
#include "floe/solve/generalized_alpha.h"

namespace floe::solve::problems {

using petsc::check;
using Numbers = std::vector<double>;

/// F(t, u, v, a) = 0 for few unknowns, written on plain arrays; tangent(...) adds to J (row-major, zero at entry).
struct Problem {
  int size = 0;
  std::vector<PetscInt> multipliers;
  std::function<void(double t, const double* u, const double* v, const double* a, double* f)> residual;
  std::function<void(double t, const double* u, const double* v, const double* a, double sv, double sa, double* J)>
      tangent;
  std::function<void(double t, double* u, const double* v, double* a)> start;  // may be empty
};

/// A TS of type generalized-alpha on one rank with a dense Jacobian, and what its steps ended at.
struct Run {
  Run(const Problem& of, Numbers u0, Numbers v0, double h, double end);
  Run(const Run&) = delete;
  void solve() { check(TSSolve(ts, U)); }

  Problem problem;
  petsc::TsHandle ts;
  petsc::VecHandle U, V;
  petsc::MatHandle J;
  std::vector<double> t;
  std::vector<Numbers> u, v, a;
};

inline Numbers numbers(Vec vec) {
  const PetscScalar* x;
  PetscInt n;
  check(VecGetLocalSize(vec, &n));
  check(VecGetArrayRead(vec, &x));
  Numbers copy(x, x + n);
  check(VecRestoreArrayRead(vec, &x));
  return copy;
}

inline petsc::VecHandle vector(const Numbers& values) {
  petsc::VecHandle vec;
  check(VecCreateSeq(PETSC_COMM_SELF, static_cast<PetscInt>(values.size()), vec.out()));
  for (size_t i = 0; i < values.size(); ++i)
    check(VecSetValue(vec, static_cast<PetscInt>(i), values[i], INSERT_VALUES));
  check(VecAssemblyBegin(vec));
  check(VecAssemblyEnd(vec));
  return vec;
}

inline void fill(Vec vec, const Numbers& values) {
  PetscScalar* x;
  check(VecGetArray(vec, &x));
  std::copy(values.begin(), values.end(), x);
  check(VecRestoreArray(vec, &x));
}

inline PetscErrorCode residual(TS, PetscReal t, Vec U, Vec V, Vec A, Vec F, void* context) {
  Numbers f(numbers(U).size(), 0.0);
  static_cast<Problem*>(context)->residual(t, numbers(U).data(), numbers(V).data(), numbers(A).data(), f.data());
  fill(F, f);
  return 0;
}

inline PetscErrorCode tangent(TS, PetscReal t, Vec U, Vec V, Vec A, PetscReal sv, PetscReal sa, Mat, Mat P,
                              void* context) {
  const auto n = static_cast<PetscInt>(numbers(U).size());
  Numbers J(static_cast<size_t>(n * n), 0.0);
  static_cast<Problem*>(context)->tangent(t, numbers(U).data(), numbers(V).data(), numbers(A).data(), sv, sa, J.data());
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j < n; ++j) check(MatSetValue(P, i, j, J[static_cast<size_t>(i * n + j)], INSERT_VALUES));
  check(MatAssemblyBegin(P, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(P, MAT_FINAL_ASSEMBLY));
  return 0;
}

inline PetscErrorCode call_start(TS, PetscReal t, Vec U, Vec V, Vec A, void* context) {
  Numbers u = numbers(U), a(u.size(), 0.0);
  static_cast<Problem*>(context)->start(t, u.data(), numbers(V).data(), a.data());
  fill(U, u);
  fill(A, a);
  return 0;
}

inline PetscErrorCode record(TS ts) {
  Run* run;
  PetscReal t;
  Vec U, V, A;
  TSConvergedReason reason;
  check(TSGetConvergedReason(ts, &reason));
  if (reason < 0) return 0;
  check(TSGetApplicationContext(ts, &run));
  check(TSGetTime(ts, &t));
  check(TS2GetSolution(ts, &U, &V));
  check(TSGeneralizedAlphaGetAcceleration(ts, &A));
  run->t.push_back(t);
  run->u.push_back(numbers(U));
  run->v.push_back(numbers(V));
  run->a.push_back(numbers(A));
  return 0;
}

inline Run::Run(const Problem& of, Numbers u0, Numbers v0, double h, double end)
    : problem(of), U(vector(u0)), V(vector(v0)) {
  check(MatCreateSeqDense(PETSC_COMM_SELF, problem.size, problem.size, nullptr, J.out()));
  check(TSCreate(PETSC_COMM_SELF, ts.out()));
  check(TSSetType(ts, generalized_alpha));
  check(TSSetApplicationContext(ts, this));
  check(TSSetI2Function(ts, nullptr, residual, &problem));
  check(TSSetI2Jacobian(ts, J, J, tangent, &problem));
  check(TS2SetSolution(ts, U, V));
  if (problem.start) check(TSGeneralizedAlphaSetStart(ts, call_start, &problem));
  if (!problem.multipliers.empty()) {
    petsc::IsHandle multipliers;
    check(ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(problem.multipliers.size()),
                          problem.multipliers.data(), PETSC_COPY_VALUES, multipliers.out()));
    check(TSGeneralizedAlphaSetMultipliers(ts, multipliers));
  }
  check(TSSetTimeStep(ts, h));
  check(TSSetMaxTime(ts, end));
  check(TSSetMaxSteps(ts, 10000000));
  check(TSSetExactFinalTime(ts, TS_EXACTFINALTIME_MATCHSTEP));
  check(TSSetPostStep(ts, record));
}

/// A point mass on a rod, in Cartesian coordinates: u = (x, y, tension), C = (x^2 + y^2 - L^2)/(2 L).
struct Pendulum {
  double mass = 1, length = 1, gravity = 1;

  Problem problem() const {
    const auto [m, L, g] = *this;
    Problem p;
    p.size = 3;
    p.multipliers = {2};
    p.residual = [=](double, const double* u, const double*, const double* a, double* f) {
      f[0] = m * a[0] + u[2] * u[0] / L;
      f[1] = m * a[1] + u[2] * u[1] / L + m * g;
      f[2] = (u[0] * u[0] + u[1] * u[1] - L * L) / (2 * L);
    };
    p.tangent = [=](double, const double* u, const double*, const double*, double, double sa, double* J) {
      J[0] = J[4] = sa * m + u[2] / L;
      J[2] = J[6] = u[0] / L;
      J[5] = J[7] = u[1] / L;
    };
    p.start = [=](double, double* u, const double* v, double* a) {
      u[2] = m * L * (v[0] * v[0] + v[1] * v[1] - g * u[1]) / (u[0] * u[0] + u[1] * u[1]);
      a[0] = -u[2] * u[0] / (m * L);
      a[1] = -u[2] * u[1] / (m * L) - g;
    };
    return p;
  }

  /// (x, y, tension, x', y') at t, released at `angle` from the vertical with `rate`: Runge-Kutta of order 4 in the
  /// angle, 4000 steps to each time (error under 1e-12 for some periods).
  Numbers exact(double angle, double rate, double t) const {
    const int steps = 4000;
    const double h = t / steps, w = gravity / length;
    double q = angle, v = rate;
    for (int i = 0; i < steps; ++i) {
      const double a1 = -w * std::sin(q), v2 = v + h / 2 * a1, a2 = -w * std::sin(q + h / 2 * v);
      const double v3 = v + h / 2 * a2, a3 = -w * std::sin(q + h / 2 * v2), v4 = v + h * a3;
      const double a4 = -w * std::sin(q + h * v3);
      q += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
      v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    return {length * std::sin(q), -length * std::cos(q), mass * (length * v * v + gravity * std::cos(q)),
            length * v * std::cos(q), length * v * std::sin(q)};
  }
  Numbers position(double angle) const { return {length * std::sin(angle), -length * std::cos(angle), 0}; }
  Numbers velocity(double angle, double rate) const {
    return {length * rate * std::cos(angle), length * rate * std::sin(angle), 0};
  }
  double time_unit() const { return std::sqrt(length / gravity); }
};

/// m q'' + c q' + k q = load(t)
inline Problem oscillator(
    double m, double c, double k, std::function<double(double)> load = [](double) { return 0.; }) {
  Problem p;
  p.size = 1;
  p.residual = [=](double t, const double* u, const double* v, const double* a, double* f) {
    f[0] = m * a[0] + c * v[0] + k * u[0] - load(t);
  };
  p.tangent = [=](double, const double*, const double*, const double*, double sv, double sa, double* J) {
    J[0] = sa * m + sv * c + k;
  };
  return p;
}

}  // namespace floe::solve::problems
