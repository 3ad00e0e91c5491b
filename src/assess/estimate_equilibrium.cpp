#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "estimate_parts.h"
#include "floe/assembly/lift.h"
#include "floe/petsc/factorisation.h"
#include "floe/petsc/values.h"
#include "floe/solve/start.h"

namespace floe::assess {

using Eigen::VectorXd;
using petsc::check;
using solve::State;

namespace {

constexpr int most_steps = 12;       // of Newton's method, for each equilibrium
constexpr double short_step = 0.01;  // of what all steps together have changed: the next one is far shorter
constexpr double round_off = 1e-8;   // of the deformations: what an equilibrium may leave open, and less

/// The full order about the equilibria of a reduced model.
class FullOrder {
 public:
  FullOrder(const Model& reduced, Offline& offline)
      : reduced_(reduced),
        offline_(offline),
        full_(full_order(offline)),
        system_(*full_.system),
        U_(system_.create_vector()),
        V_(system_.create_vector()),
        A_(system_.create_vector()),
        F_(system_.create_vector()),
        X_(system_.create_vector()),
        J_(system_.create_tangent()),
        ksp_(solve::tangent_solver(J_, "estimate_")) {
    for (const PlannedBody& body : offline.plan.bodies)
      mass_.push_back(has_structure(body) ? fem::mass(body.structure, {}) : petsc::MatHandle());
  }

  const Model& model() const { return full_; }
  std::vector<double> values() const { return probe_values(full_, t_, U_, V_, V_); }

  /// Those of the reduced model itself: forces of the state lifted to full order, which is not in equilibrium, are
  /// others (of supports, and stresses).
  std::vector<double> reduced_values(const State& state) const {
    const dynamics::System& system = *reduced_.system;
    const petsc::VecHandle U = system.create_vector(), none = system.create_vector();
    solve::set_state(system, state, U, none, none);
    return probe_values(reduced_, state.t, U, none, none);
  }

  /// Takes over a reduced equilibrium.
  void put(const State& state) {
    t_ = state.t;
    lift_to_full_order(state, reduced_, offline_, full_, U_, V_, A_);
    system_.rebase(U_);
  }

  /// What terms carry from one equilibrium to the next.
  std::vector<double> carried() const {
    std::vector<double> numbers;
    system_.save(numbers);
    return numbers;
  }
  void take_up(const std::vector<double>& carried) { system_.load(carried); }

  /// The forces that are left over, -F. Collective.
  void residual() {
    system_.residual(t_, U_, V_, A_, dynamics::ConstraintLevel::position, F_);
    check(VecScale(F_, -1));
  }

  /// One step of Newton's method with the tangent here; what it adds to U. @throws RunError  it has no factor.
  /// Collective.
  VectorXd step() {
    system_.tangent(t_, U_, V_, A_, {1, 0, 0}, J_);
    check(KSPSetOperators(ksp_, J_, J_));
    std::string fault;
    try {
      check(KSPSolve(ksp_, F_, X_));
      fault = petsc::why_failed(ksp_);
    } catch (const petsc::Error& error) {
      if (!solve::is_singular(error.code())) throw;
      fault = petsc::why_failed(ksp_);
      if (fault.empty()) fault = error.what();
    }
    double size = 0;
    check(VecNorm(X_, NORM_INFINITY, &size));
    if (fault.empty() && !std::isfinite(size)) fault = "it is singular";
    if (!fault.empty())
      throw RunError(fmt::format("the tangent of the full-order model at t = {:.6g} was not factored: {}", t_, fault));
    check(VecAXPY(U_, 1, X_));
    VectorXd x;
    system_.gather(X_, x);
    return x;
  }

  VectorXd state() const {
    VectorXd q;
    system_.gather(U_, q);
    return q;
  }

  /// Square of the deformations in q, mass-weighted over all bodies. Collective.
  double square(const VectorXd& q) const {
    double sum = 0;
    for (std::size_t b = 0; b < full_.bodies.size(); ++b) {
      const BodyReport& body = full_.bodies[b];
      if (body.first_dof < 0) {  // from a file: its columns are normalised by mass
        sum += q.segment(body.first_elastic, body.columns).squaredNorm();
        continue;
      }
      const fem::Structure& structure = offline_.plan.bodies[b].structure;
      const petsc::VecHandle field = fem::field(structure), force = fem::field(structure);
      {
        petsc::Values own(field);
        std::copy_n(q.data() + body.first_dof, own.end - own.first, own.begin());
      }
      double square = 0;
      check(MatMult(mass_[b], field, force));
      check(VecDot(field, force, &square));
      sum += square;
    }
    return sum;
  }

  /// |V'r| of the reduced equilibrium against the elastic forces that V carries, the greatest of the bodies.
  /// Collective.
  double unbalanced(const State& state) const {
    double left = 0, carried = 0;
    for (std::size_t b = 0; b < full_.bodies.size(); ++b) {
      if (!has_structure(offline_.plan.bodies[b])) continue;
      const ReducedBody& body = offline_.reduced[b];
      const petsc::VecHandle load = fem::field(offline_.plan.bodies[b].structure);
      {
        petsc::Values all(F_), own(load);
        const std::vector<PetscInt>& global = system_.coordinates().global();
        const int first = full_.bodies[b].first_dof;  // behind the last one where this rank owns no dofs
        for (PetscInt i = 0; i < own.end - own.first; ++i) own.begin()[i] = all[global[first + i]];
      }
      const BodyReport& report = reduced_.bodies[b];
      left = std::max(left, products(*body.basis, load).norm());
      carried = std::max(
          carried,
          (body.body.elasticity.linear_stiffness() * state.q.segment(report.first_elastic, report.columns)).norm());
    }
    return carried > 0 ? left / carried : 0;
  }

 private:
  const Model& reduced_;
  Offline& offline_;
  Model full_;
  const dynamics::System& system_;
  petsc::VecHandle U_, V_, A_, F_, X_;
  petsc::MatHandle J_;
  petsc::KspHandle ksp_;
  std::vector<petsc::MatHandle> mass_;
  double t_ = 0;
};

/// What came of one equilibrium.
struct Gap {
  double t = 0;
  std::vector<double> error, value;   // of each probe column: full order less reduced; full order
  double deformation = 0, whole = 0;  // squares
  bool open = false, late = false;    // Newton's method did not come to its end, or not in time
};

/// From a reduced equilibrium towards that of full order, at least one step.
void approach(FullOrder& full, const State& state, const TimeBudget& time, VectorXd& d, Gap& gap, Estimate& estimate) {
  for (int i = 0; i < most_steps; ++i) {
    if (i > 0 && time.left() == 0) {
      gap.late = true;
      return;
    }
    full.residual();
    ++estimate.samples;
    if (i == 0) estimate.unbalanced = std::max(estimate.unbalanced, full.unbalanced(state));
    const VectorXd x = full.step();
    d = i == 0 ? x : d + x;
    const double size = full.square(x);
    if (size <= std::pow(short_step, 2) * full.square(d) || size <= std::pow(round_off, 2) * full.square(full.state()))
      return;
  }
  gap.open = true;
}

Gap gap_of(FullOrder& full, const State& state, const std::vector<double>& rotations, const TimeBudget& time,
           Estimate& estimate) {
  full.put(state);
  full.take_up(rotations);
  const std::vector<double> was = full.reduced_values(state);
  Gap gap;
  VectorXd d;
  gap.t = state.t;
  approach(full, state, time, d, gap, estimate);
  gap.error = gap.value = full.values();
  for (std::size_t i = 0; i < was.size(); ++i) gap.error[i] -= was[i];
  gap.deformation = full.square(d), gap.whole = full.square(full.state());
  return gap;
}

/// The last equilibrium, and as many of the others as there is time for, in their order.
std::vector<Gap> gaps(const std::vector<State>& states, const TimeBudget& time, FullOrder& full, Estimate& estimate) {
  std::vector<std::vector<double>> rotations;  // of springs, which are counted from one equilibrium to the next
  for (const State& state : states) full.put(state), rotations.push_back(full.carried());
  const double before = time.spent();
  std::vector<Gap> all = {gap_of(full, states.back(), rotations.back(), time, estimate)};
  const double each = std::max(time.spent() - before, 1e-9);
  std::vector<std::size_t> others(states.size() - 1);
  std::iota(others.begin(), others.end(), 0);
  const auto count = static_cast<std::size_t>(time.of_first(std::min(1e6, time.left() / each)));
  if (count < others.size())
    estimate.notes.push_back(fmt::format("{} equilibria instead of {}, to save time", count + 1, states.size()));
  for (const std::size_t i : count > 0 ? spread(others, count) : std::vector<std::size_t>())
    all.insert(all.end() - 1, gap_of(full, states[i], rotations[i], time, estimate));
  return all;
}

void make(const Model& model, const std::vector<State>& states, const TimeBudget& time, Estimate& estimate) {
  FullOrder full(model, *model.offline);
  const std::vector<Gap> all = gaps(states, time, full, estimate);
  const auto count = static_cast<double>(all.size());
  const double smallest = count * round_off_of(*model.offline);
  ProbeErrors probes(probe_columns(full.model()));
  double error = 0, whole = 0;
  std::string open, late;
  const auto add = [](std::string& times, double t) { times += fmt::format("{}{:.6g}", times.empty() ? "" : ", ", t); };
  for (const Gap& gap : all) {
    probes.add(gap.error, gap.value);
    error += gap.deformation, whole += gap.whole;
    estimate.t.push_back(gap.t);
    estimate.errors.push_back(gap.error);
    if (gap.open) add(open, gap.t);
    if (gap.late) add(late, gap.t);
  }
  const bool nothing = std::max(error, whole) <= smallest;
  for (const Gap& gap : all)
    estimate.relative.push_back(nothing || gap.deformation == 0 ? 0 : std::sqrt(gap.deformation / (whole / count)));
  estimate.deformation = nothing ? 0 : known(std::sqrt(error / whole));
  estimate.probes = known(probes.relative(0));
  if (!open.empty())
    estimate.notes.push_back(
        fmt::format("Newton's method for the full-order model did not converge at t = {}; only the order of magnitude "
                    "of the error is known",
                    open));
  if (!late.empty())
    estimate.notes.push_back(
        fmt::format("only a few Newton steps of the full-order model at t = {}, to save time; only the order of "
                    "magnitude of the error is known",
                    late));
}

}  // namespace

Estimate estimate_error_at_rest(const Model& model, const std::vector<State>& states, double seconds) {
  Estimate estimate;
  estimate.none.clear();
  if (!model.offline || !is_reduced(model.formulation)) {
    estimate.none = "it applies to reduced models only (vm, vm+md)";
    return estimate;
  }
  const TimeBudget time(model.offline->plan.comm, seconds);
  estimate.none = states.empty() ? "there is no equilibrium" : without_estimate(*model.offline);
  if (const PetscInt elements = assembly::elements_of(*model.offline); elements >= assembly::many_elements)
    estimate.none = fmt::format("the tangent of the full-order model has {} elements (limit {})", elements,
                                assembly::many_elements);
  if (!estimate.none.empty()) return estimate;
  note_files(*model.offline, estimate);
  fill_in(estimate, model.offline->plan.comm, time, seconds, [&] { make(model, states, time, estimate); });
  return estimate;
}

}  // namespace floe::assess
