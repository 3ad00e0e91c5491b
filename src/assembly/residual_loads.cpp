#include "floe/assembly/residual_loads.h"

#include <algorithm>
#include <utility>

#include "floe/assembly/body_stage.h"
#include "floe/assembly/combination.h"
#include "floe/assembly/damping.h"
#include "floe/assembly/lift.h"
#include "floe/petsc/values.h"

namespace floe::assembly {

using Eigen::VectorXd;
using petsc::check;
using solve::State;

Model full_order(Offline& offline) {
  std::vector<ReducedBody> compact(offline.reduced.size());
  std::vector<std::vector<double>> modal;
  std::vector<double> mass;
  for (std::size_t b = 0; b < compact.size(); ++b) {
    PlannedBody& body = offline.plan.bodies[b];
    if (!has_structure(body)) compact[b] = offline.reduced[b];
    modal.push_back(std::exchange(body.spec.damping.modal, {}));
    mass.push_back(std::exchange(body.spec.damping.mass, 0));
  }
  const auto restore = [&] {
    for (std::size_t b = 0; b < modal.size(); ++b) {
      DampingSpec& damping = offline.plan.bodies[b].spec.damping;
      damping.modal = modal[b], damping.mass = mass[b];
    }
  };
  try {
    Model model = assemble(offline.plan, Formulation::nlffr, compact);
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

Residuals::Residuals(const Model& reduced, Offline& offline, Model full)
    : reduced_(reduced),
      offline_(offline),
      full_(std::move(full)),
      U_(full_.system->create_vector()),
      V_(full_.system->create_vector()),
      A_(full_.system->create_vector()),
      F_(full_.system->create_vector()),
      loads_(reduced.bodies.size()) {}

void Residuals::add(const State& state) {
  lift_to_full_order(state, reduced_, offline_, full_, U_, V_, A_);
  full_.system->rebase(U_);
  full_.system->residual(state.t, U_, V_, A_, dynamics::ConstraintLevel::position, F_);
  for (std::size_t b = 0; b < loads_.size(); ++b)
    if (has_structure(offline_.plan.bodies[b])) take(static_cast<int>(b), state);
  ++samples;
}

void Residuals::take(int b, const State& state) {
  const PlannedBody& body = offline_.plan.bodies[b];
  const ReducedBody& reduced = offline_.reduced[b];
  petsc::VecHandle load = fem::field(body.structure);
  {
    petsc::Values all(F_), own(load);
    const std::vector<PetscInt>& global = full_.system->coordinates().global();
    const int first = full_.bodies[b].first_dof;  // behind the last one where this rank owns no dofs
    for (PetscInt i = 0; i < own.end - own.first; ++i) own.begin()[i] = -all[global[first + i]];
  }
  const bool several = whole_name(body.spec) != body.spec.name;  // frames, whose damping acts on the body as one
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
