#include "floe/dynamics/deviation.h"

#include <cmath>

#include "floe/dynamics/start.h"
#include "floe/petsc/values.h"

namespace floe::dynamics {

using Eigen::VectorXd;
using petsc::check;

State state_of(const System& system, double t, Vec U, Vec V, Vec A) {
  State state{t, {}, {}, {}, {}};
  system.gather(U, state.q), system.gather(V, state.v), system.gather(A, state.a);
  const std::vector<char>& multiplier = system.coordinates().multiplier();
  for (Eigen::Index i = 0; i < state.q.size(); ++i)
    if (multiplier[i]) state.v[i] = state.a[i] = 0;
  for (const auto& [first, attitude] : system.attitudes()) {
    state.bases.push_back((attitude->base * math::quaternion(state.q.segment<3>(first))).normalized());
    state.q.segment<3>(first).setZero();
  }
  return state;
}

void set_state(const System& system, const State& state, Vec U, Vec V, Vec A) {
  const auto& global = system.coordinates().global();
  const auto set = [&](const VectorXd& local, Vec vector) {
    petsc::Values owned(vector);
    for (Eigen::Index i = 0; i < local.size(); ++i)
      if (global[i] >= owned.first && global[i] < owned.end) owned[global[i]] = local[i];
  };
  set(state.q, U), set(state.v, V), set(state.a, A);
  for (std::size_t i = 0; i < state.bases.size(); ++i) system.attitudes()[i].second->base = state.bases[i];
}

State deviated(const System& system, const State& state, const VectorXd& d, const VectorXd& rate,
               const VectorXd& second_rate) {
  State at{state.t, state.q + d, state.v + rate, state.a + second_rate, state.bases};
  for (const auto& attitude : system.attitudes()) {
    const int i = attitude.first;
    const Eigen::Vector3d omega = state.v.segment<3>(i), alpha = state.a.segment<3>(i), x = d.segment<3>(i),
                          xd = rate.segment<3>(i);
    at.v.segment<3>(i) += omega.cross(x);
    at.a.segment<3>(i) += alpha.cross(x) + omega.cross(xd);
  }
  return at;
}

namespace {

/// Backward differences of second order, of the first where h_before = 0: y' = now y_n + before y_(n-1) + earlier
/// y_(n-2).
struct Difference {
  double now, before, earlier;
  Difference(double h, double h_before) {
    const double r = h_before > 0 ? h / h_before : 0;
    now = (1 + 2 * r) / (1 + r) / h, before = -(1 + r) / h, earlier = r * r / (1 + r) / h;
  }
};

class Follower {
 public:
  explicit Follower(const System& system)
      : system_(system),
        multiplier_(system.coordinates().multiplier()),
        U_(system.create_vector()),
        V_(system.create_vector()),
        A_(system.create_vector()),
        F_(system.create_vector()),
        X_(system.create_vector()),
        J_(system.create_tangent()),
        ksp_(tangent_solver(J_, "estimate_")) {
    for (int i = 0; i < 2; ++i) d_[i] = rate_[i] = VectorXd::Zero(system.coordinates().local_size());
  }

  /// d of one more state. @return false  not converged
  bool step(const State& known, double h, double h_before) {
    const Difference by(h, h_before);
    set_state(system_, known, U_, V_, A_);
    system_.rebase(U_);  // springs take over their turns
    VectorXd d = d_[0] + h * rate_[0];
    if (!newton(known, by, d)) return false;
    VectorXd rate = rate_of(by, d);
    d_[1] = std::move(d_[0]), d_[0] = std::move(d);
    rate_[1] = std::move(rate_[0]), rate_[0] = std::move(rate);
    return true;
  }
  const VectorXd& d() const { return d_[0]; }
  const VectorXd& rate() const { return rate_[0]; }
  DeviationReport report;

 private:
  VectorXd without_multipliers(VectorXd values) const {
    for (Eigen::Index i = 0; i < values.size(); ++i)
      if (multiplier_[i]) values[i] = 0;
    return values;
  }
  VectorXd rate_of(const Difference& by, const VectorXd& d) const {
    return without_multipliers(by.now * d + by.before * d_[0] + by.earlier * d_[1]);
  }
  void set(const State& known, const Difference& by, const VectorXd& d) {
    const VectorXd rate = rate_of(by, d);
    const VectorXd second = by.now * rate + by.before * rate_[0] + by.earlier * rate_[1];
    set_state(system_, deviated(system_, known, d, rate, second), U_, V_, A_);
  }
  void factor(double t, const Difference& by) {
    system_.tangent(t, U_, V_, A_, {1, by.now, by.now * by.now}, J_);
    check(KSPSetOperators(ksp_, J_, J_));
    check(KSPSetUp(ksp_));
    factored_for_ = by.now, ++report.factorisations;
  }
  VectorXd correction(double t) {
    system_.residual(t, U_, V_, A_, ConstraintLevel::position, F_);
    check(KSPSolve(ksp_, F_, X_));
    VectorXd x;
    system_.gather(X_, x);
    ++report.iterations;
    return -x;
  }

  /// A factor is made for a new step size, and where corrections do not fall to a fifth. What counts is the error
  /// beside the distance from the extrapolation, h^2 d'': a part of d itself would be differenced twice.
  bool newton(const State& known, const Difference& by, VectorXd& d) {
    bool stale = std::abs(factored_for_ - by.now) > 0.05 * by.now;
    const double round_off =
        1e-9 * (without_multipliers(known.q).norm() + without_multipliers(known.v).norm() / by.now);
    const VectorXd predicted = d;
    double before = 0;
    for (int i = 0; i < 12; ++i) {
      set(known, by, d);
      if (stale) factor(known.t, by);
      const VectorXd x = correction(known.t);
      if (!x.allFinite()) return false;
      d += x;
      const double size = without_multipliers(x).norm(), whole = without_multipliers(d - predicted).norm();
      if (size <= std::max(1e-3 * whole, round_off)) return true;
      stale = i > 0 && size > 0.2 * before;
      before = size;
    }
    return false;
  }

  const System& system_;
  const std::vector<char>& multiplier_;
  petsc::VecHandle U_, V_, A_, F_, X_;
  petsc::MatHandle J_;
  petsc::KspHandle ksp_;
  VectorXd d_[2], rate_[2];  // of the last two states, the last one first
  double factored_for_ = 0;
};

}  // namespace

DeviationReport deviation(
    const System& system, double begin, const std::vector<State>& known,
    const std::function<void(const State&, const Eigen::VectorXd&, const Eigen::VectorXd&)>& observe) {
  Follower follower(system);
  double before = begin, h_before = 0;
  follower.report.end = begin;
  for (const State& state : known) {
    const double h = state.t - before;
    if (!follower.step(state, h, h_before)) break;
    observe(state, follower.d(), follower.rate());
    before = state.t, h_before = h;
    ++follower.report.steps, follower.report.end = state.t;
  }
  return follower.report;
}

}  // namespace floe::dynamics
