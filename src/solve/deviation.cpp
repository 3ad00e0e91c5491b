#include "floe/solve/deviation.h"

#include <cmath>

#include "floe/petsc/values.h"
#include "floe/solve/start.h"

namespace floe::solve {

using Eigen::VectorXd;
using petsc::check;

State state_of(const System& system, double t, Vec U, Vec V, Vec A) {
  State state{t, {}, {}, {}, {}};
  system.save(state.carried);
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
  if (!state.carried.empty()) system.load(state.carried);
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

DeviationStart deviation_between(const System& system, const State& from, const State& to) {
  DeviationStart between{to.q - from.q, to.v - from.v};
  for (std::size_t i = 0; i < from.bases.size(); ++i) {
    const int first = system.attitudes()[i].first;
    const Eigen::Vector3d x = math::rotation_vector(from.bases[i].conjugate() * to.bases[i]);
    between.d.segment<3>(first) = x;
    between.rate.segment<3>(first) -= Eigen::Vector3d(from.v.segment<3>(first)).cross(x);
  }
  return between;
}

namespace {

/// d and what the scheme keeps of it at the end of a step: `mean` is the acceleration that positions and velocities
/// take, a mean of second_rate's in time.
struct Deviation {
  VectorXd d, rate, second_rate, mean;
};

/// The generalized-alpha scheme (Chung and Hulbert; Arnold and Bruels for constraints) from one state to the next in
/// terms of d, or implicit Euler from a start whose second_rate nobody knows:
/// rate = by_rate d + ..., second_rate = by_second_rate d + ....
struct Scheme {
  double by_rate, by_second_rate;

  Scheme(double h, bool start) : h_(h), start_(start) {
    by_rate = start ? 1 / h : gamma / (beta * h);
    by_second_rate = start ? 1 / (h * h) : (1 - alpha_m) / (1 - alpha_f) / (beta * h * h);
  }
  Deviation at(const VectorXd& d, const Deviation& last) const {
    Deviation now{d, {}, {}, {}};
    if (start_) {
      now.rate = (d - last.d) / h_;
      now.second_rate = (now.rate - last.rate) / h_;
      now.mean = now.second_rate;
      return now;
    }
    now.mean = (d - last.d - h_ * last.rate) / (beta * h_ * h_) - (0.5 - beta) / beta * last.mean;
    now.rate = last.rate + h_ * ((1 - gamma) * last.mean + gamma * now.mean);
    now.second_rate = ((1 - alpha_m) * now.mean + alpha_m * last.mean - alpha_f * last.second_rate) / (1 - alpha_f);
    return now;
  }

 private:
  static constexpr double radius = 0.5;  // at infinite frequency
  static constexpr double alpha_m = (2 * radius - 1) / (radius + 1), alpha_f = radius / (radius + 1);
  static constexpr double gamma = 0.5 + alpha_f - alpha_m, beta = 0.25 * (gamma + 0.5) * (gamma + 0.5);
  double h_;
  bool start_;
};

class Follower {
 public:
  Follower(const System& system, const DeviationStart& start)
      : system_(system),
        multiplier_(system.coordinates().multiplier()),
        U_(system.create_vector()),
        V_(system.create_vector()),
        A_(system.create_vector()),
        F_(system.create_vector()),
        X_(system.create_vector()),
        J_(system.create_tangent()),
        ksp_(tangent_solver(J_, "estimate_")) {
    const VectorXd zero = VectorXd::Zero(system.coordinates().local_size());
    last_ = {start.d.size() > 0 ? start.d : zero, start.d.size() > 0 ? start.rate : zero, zero, zero};
    last_.rate = without_multipliers(std::move(last_.rate));
  }

  /// d of one more state. @return false  not converged
  bool step(const State& known, const Scheme& by, double h) {
    set_state(system_, known, U_, V_, A_);
    system_.rebase(U_, V_, known.t);  // springs take over their rotations
    VectorXd d = last_.d + h * last_.rate;
    if (!newton(known, by, d) && !newton(known, by, d = last_.d, true)) return false;
    last_ = with_rates(by, d);
    return true;
  }
  const Deviation& last() const { return last_; }
  DeviationReport report;

 private:
  VectorXd without_multipliers(VectorXd values) const {
    for (Eigen::Index i = 0; i < values.size(); ++i)
      if (multiplier_[i]) values[i] = 0;
    return values;
  }
  Deviation with_rates(const Scheme& by, const VectorXd& d) const {
    Deviation now = by.at(d, last_);
    for (VectorXd* rates : {&now.rate, &now.second_rate, &now.mean}) *rates = without_multipliers(std::move(*rates));
    return now;
  }
  void set(const State& known, const Scheme& by, const VectorXd& d) {
    const Deviation now = with_rates(by, d);
    set_state(system_, deviated(system_, known, d, now.rate, now.second_rate), U_, V_, A_);
  }
  void factor(double t, const Scheme& by) {
    system_.tangent(t, U_, V_, A_, {1, by.by_rate, by.by_second_rate}, J_);
    check(KSPSetOperators(ksp_, J_, J_));
    check(KSPSetUp(ksp_));
    factored_for_ = by.by_rate, ++report.factorisations;
  }
  VectorXd correction(double t) {
    system_.residual(t, U_, V_, A_, ConstraintLevel::position, F_);
    check(KSPSolve(ksp_, F_, X_));
    VectorXd x;
    system_.gather(X_, x);
    ++report.iterations;
    return -x;
  }

  /// A factor is made for a new step size, and where corrections do not fall to a fifth; in every iteration if `renew`,
  /// which finds what Newton's method does not from where stiff motions would go (d = last_.d). What counts is the
  /// error beside the distance from the extrapolation, h^2 d'': a part of d itself would be differenced twice.
  bool newton(const State& known, const Scheme& by, VectorXd& d, bool renew = false) {
    bool stale = std::abs(factored_for_ - by.by_rate) > 0.05 * by.by_rate;
    const double round_off =
        1e-9 * (without_multipliers(known.q).norm() + without_multipliers(known.v).norm() / by.by_rate);
    const VectorXd predicted = d;
    double before = 0;
    for (int i = 0; i < 12; ++i) {
      set(known, by, d);
      if (stale || renew) factor(known.t, by);
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
  Deviation last_;
  double factored_for_ = 0;
};

}  // namespace

DeviationReport deviation(const System& system, double begin, const std::vector<State>& known,
                          const std::function<void(const State&, const Eigen::VectorXd&, const Eigen::VectorXd&,
                                                   const Eigen::VectorXd&)>& observe,
                          const DeviationStart& start) {
  Follower follower(system, start);
  double before = begin;
  follower.report.end = begin;
  for (const State& state : known) {
    const double h = state.t - before;
    if (!follower.step(state, Scheme(h, follower.report.steps == 0), h)) break;
    observe(state, follower.last().d, follower.last().rate, follower.last().second_rate);
    before = state.t;
    ++follower.report.steps, follower.report.end = state.t;
  }
  return follower.report;
}

}  // namespace floe::solve
