#include "floe/assembly/residual_loads.h"

#include <algorithm>
#include <utility>

#include "floe/assembly/body_stage.h"
#include "floe/assembly/combination.h"
#include "floe/assembly/damping.h"
#include "floe/assembly/lift.h"
#include "floe/petsc/together.h"
#include "floe/petsc/values.h"
#include "floe/reference/spatial_full_order.h"

namespace floe::assembly {

using Eigen::VectorXd;
using petsc::check;
using solve::State;

PetscInt elements_of(const Offline& offline) {
  PetscInt count = 0;
  for (const PlannedBody& body : offline.plan.bodies)
    if (has_structure(body)) count += body.structure.mesh.cell_count;
  return count;
}

Model full_order(Offline& offline, bool apart) {
  std::vector<ReducedBody> compact(offline.reduced.size());
  std::vector<std::vector<double>> modal;
  std::vector<double> mass;
  for (std::size_t b = 0; b < compact.size(); ++b) {
    PlannedBody& body = offline.plan.bodies[b];
    if (!has_structure(body)) compact[b] = offline.reduced[b];
    modal.push_back(std::exchange(body.spec.damping.modal, {}));
    mass.push_back(std::exchange(body.spec.damping.mass, 0));
  }
  std::vector<WholeModes> whole_modes = std::exchange(offline.plan.whole_modes, {});
  const auto restore = [&] {
    offline.plan.whole_modes = std::move(whole_modes);
    for (std::size_t b = 0; b < modal.size(); ++b) {
      DampingSpec& damping = offline.plan.bodies[b].spec.damping;
      damping.modal = modal[b], damping.mass = mass[b];
    }
  };
  try {
    Model model = assemble(offline.plan, Formulation::nlffr, compact,
                           apart ? Purpose::residuals_of_elements_apart : Purpose::residuals);
    restore();
    return model;
  } catch (...) {
    restore();
    throw;
  }
}

VectorXd products(const reduction::Basis& basis, Vec r) {
  VectorXd all(basis.columns);
  for (int i = 0; i < basis.columns; ++i) {
    Vec column = nullptr;
    check(BVGetColumn(basis.V, i, &column));
    check(VecDot(column, r, &all[i]));
    check(BVRestoreColumn(basis.V, i, &column));
  }
  return all;
}

Residuals::Residuals(const Model& reduced, Offline& offline, PetscInt apart_from, bool relieved)
    : reduced_(reduced),
      offline_(offline),
      relieved_(relieved),
      full_(full_order(offline, elements_of(offline) >= apart_from)),
      U_(full_.system->create_vector()),
      V_(full_.system->create_vector()),
      A_(full_.system->create_vector()),
      loads_(reduced.bodies.size()) {}

void Residuals::add(const std::vector<State>& states) {
  std::vector<Lifted> all;
  for (const State& state : states) all.push_back(lifted(state));
  if (apart()) add_elements(all);
  for (std::size_t i = 0; i < states.size(); ++i)
    for (std::size_t b = 0; b < loads_.size(); ++b)
      if (has_structure(offline_.plan.bodies[b])) take(static_cast<int>(b), states[i], all[i].F);
  samples += static_cast<int>(states.size());
}

/// With the rows of the system's terms.
Residuals::Lifted Residuals::lifted(const State& state) {
  const dynamics::System& system = *full_.system;
  Lifted one{state.t, {}, {}, {}, {}, system.create_vector()};
  lift_to_full_order(state, reduced_, offline_, full_, U_, V_, A_, relieved_);
  system.rebase(U_, V_, state.t);
  system.residual(state.t, U_, V_, A_, dynamics::ConstraintLevel::position, one.F);
  if (!apart()) return one;
  system.gather(U_, one.q), system.gather(V_, one.v), system.gather(A_, one.a);
  for (const auto& attitude : system.attitudes()) one.bases.push_back(attitude.second->base);
  return one;
}

/// The rows of elements: of each at all states, then of the next.
void Residuals::add_elements(std::vector<Lifted>& all) {
  const dynamics::System& system = *full_.system;
  const dynamics::Attitudes& attitudes = system.attitudes();
  std::vector<VectorXd> sums(all.size(), VectorXd::Zero(system.coordinates().local_size()));
  petsc::agree(system.comm(), [&] {
    double stiffest = 0;
    for (const auto& elements : full_.elements)
      for (std::size_t c = 0; c < elements->count(); ++c) {
        const auto terms = elements->terms(c, stiffest);
        for (std::size_t i = 0; i < all.size(); ++i) {
          const Lifted& one = all[i];
          for (std::size_t k = 0; k < attitudes.size(); ++k) attitudes[k].second->base = one.bases[k];
          for (const auto& term : terms) {
            const std::vector<int>& at = term->coordinates();
            const VectorXd q = one.q(at), v = one.v(at), a = one.a(at);
            VectorXd r = VectorXd::Zero(q.size());
            term->residual({one.t, q, v, a}, r);
            sums[i](at) += r;
          }
        }
      }
  });
  const petsc::VecHandle rows = system.create_vector();
  for (std::size_t i = 0; i < all.size(); ++i) {
    system.give(sums[i], rows);
    check(VecAXPY(all[i].F, 1, rows));
  }
}

void Residuals::take(int b, const State& state, Vec F) {
  const PlannedBody& body = offline_.plan.bodies[b];
  const ReducedBody& reduced = offline_.reduced[b];
  petsc::VecHandle load = fem::field(body.structure);
  {
    petsc::Values all(F), own(load);
    const std::vector<PetscInt>& global = full_.system->coordinates().global();
    const int first = full_.bodies[b].first_dof;  // behind the last one where this rank owns no dofs
    for (PetscInt i = 0; i < own.end - own.first; ++i) own.begin()[i] = -all[global[first + i]];
  }
  const bool several = body.spec.piece > 0;  // frames, whose damping acts on the body as one
  if (body.spec.damping.mass != 0 && !several) add_mass_damping(b, state, load);
  VectorXd along = products(*reduced.basis, load);
  if (!body.spec.damping.modal.empty() || (body.spec.damping.mass != 0 && several)) {
    const petsc::VecHandle field = fem::field(body.structure), force = fem::field(body.structure);
    combine(*reduced.basis, along, field);
    check(MatMult(fem::mass(body.structure, {}), field, force));
    check(VecAXPY(load, -1, force));
    along.setZero();
  }
  const BodyReport& report = reduced_.bodies[b];
  const VectorXd eta = state.q.segment(report.first_elastic, report.columns);
  unbalanced_ = std::max(unbalanced_, along.norm());
  forces_ = std::max(forces_, (reduced.body.elasticity.linear_stiffness() * eta).norm());
  loads_[b].push_back({std::move(load), eta});
}

/// load -= alpha P'MP q', which the full-order terms leave to this (full_order()).
void Residuals::add_mass_damping(int b, const State& state, Vec load) {
  const PlannedBody& body = offline_.plan.bodies[b];
  const BodyReport& report = reduced_.bodies[b];
  const fem::ReferenceFrame joints = damping_frame(offline_.plan, b);
  const petsc::VecHandle rate = fem::field(body.structure), force = fem::field(body.structure);
  combine(*offline_.reduced[b].basis, state.v.segment(report.first_elastic, report.columns), rate);
  fem::to_frame(joints, rate);
  check(MatMult(fem::mass(body.structure, {}), rate, force));
  fem::balance(joints, force);
  check(VecAXPY(load, -body.spec.damping.mass, force));
}

}  // namespace floe::assembly
