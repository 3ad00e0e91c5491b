#include "floe/solve/motion_state.h"

#include <petsc/private/snesimpl.h>

#include "floe/petsc/values.h"
#include "generalized_alpha_data.h"

namespace floe::solve {

using petsc::check;

namespace {

std::vector<std::pair<const char*, Vec>> vectors_of(TS ts) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  return {{"U", ts->vec_sol},
          {"V", ts->vec_dot},
          {"A", data->A1},
          {"a", data->a1},
          {"a_before", data->a0},
          {"A_before", data->A_before},
          {"origin", data->origin},
          {"stiffness", data->stiffness},
          {"mass", data->mass},
          {"row", data->row},
          {"tangent_U", data->tangent_U},
          {"tangent_V", data->tangent_V},
          {"tangent_A", data->tangent_A}};
}

template <class Visit>
void each_number(TS ts, Visit&& visit) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  SNES snes = ts->snes;
  visit(ts->ptime), visit(ts->ptime_prev), visit(ts->time_step), visit(ts->steps), visit(ts->snes_its);
  visit(ts->ksp_its), visit(ts->reject), visit(ts->num_snes_failures), visit(ts->steprestart);
  visit(ts->adapt->timestepjustdecreased);
  visit(snes->lagjacobian), visit(snes->lagpreconditioner), visit(snes->jac_iter), visit(snes->pre_iter);
  visit(data->h), visit(data->h_a0), visit(data->t_event), visit(data->h_scale), visit(data->started);
  visit(data->equal_steps), visit(data->unresolved), visit(data->after_event);
  visit(data->rate), visit(data->rate_update), visit(data->rate_of_old_jacobian);
  visit(data->reach), visit(data->reach_tried), visit(data->start_reach), visit(data->start_tried),
      visit(data->start_h), visit(data->start_until), visit(data->start_attempts), visit(data->start_falls);
  visit(data->tangent_t), visit(data->tangent_shift_v), visit(data->tangent_shift_a);
}

}  // namespace

void save_motion(TS ts, const System& system, MotionState& state) {
  state.vectors.clear();
  for (const auto& [name, vector] : vectors_of(ts)) {
    const Entries entries(vector);
    const PetscInt n = local_size(vector);
    auto& [of, values] = state.vectors.emplace_back(name, std::vector<double>(n));
    for (PetscInt i = 0; i < n; ++i) values[i] = entries[i];
  }
  state.numbers.clear();
  each_number(ts, [&](const auto& number) { state.numbers.push_back(static_cast<double>(number)); });
  system.save(state.carried);
}

void load_motion(TS ts, const System& system, const MotionState& state) {
  GeneralizedAlpha* data = generalized_alpha_data(ts);
  const auto vectors = vectors_of(ts);
  std::size_t next = 0;
  petsc::agree(system.comm(), [&] {
    bool fits = vectors.size() == state.vectors.size();
    for (std::size_t i = 0; fits && i < vectors.size(); ++i)
      fits = state.vectors[i].first == vectors[i].first &&
             static_cast<PetscInt>(state.vectors[i].second.size()) == local_size(vectors[i].second);
    each_number(ts, [&](const auto&) { ++next; });
    if (!fits || next != state.numbers.size())
      throw RunError("the saved state belongs to another system: its unknowns differ");
  });
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    Changed entries(vectors[i].second);
    for (std::size_t j = 0; j < state.vectors[i].second.size(); ++j)
      entries[static_cast<PetscInt>(j)] = state.vectors[i].second[j];
  }
  const auto take = [&] {
    next = 0;
    each_number(ts, [&](auto& number) {
      number = static_cast<std::remove_reference_t<decltype(number)>>(state.numbers[next++]);
    });
  };
  check(SNESSetSolution(ts->snes, data->U1));
  check(SNESSetUp(ts->snes));  // else the first solve does, and forgets how old the Jacobian is
  take();
  if (data->started) {  // the scales and the factorised Jacobian
    set_step(data, data->h_scale);
    check(set_scales(ts));
    Mat J = nullptr, P = nullptr;
    check(SNESGetJacobian(ts->snes, &J, &P, nullptr, nullptr));
    const bool formed = data->tangent_shift_a > 0;
    petsc::agree(system.comm(), [&] { system.load(formed ? state.carried_of_tangent : state.carried); });
    if (!formed) {  // by no step, as nothing has moved since the start: it is the one here
      check(VecCopy(ts->vec_sol, data->tangent_U));
      check(VecCopy(ts->vec_dot, data->tangent_V));
      check(VecCopy(data->A1, data->tangent_A));
      data->tangent_t = ts->ptime, data->tangent_shift_v = data->shift_v, data->tangent_shift_a = data->shift_a;
    }
    check(TSComputeI2Jacobian(ts, data->tangent_t, data->tangent_U, data->tangent_V, data->tangent_A,
                              data->tangent_shift_v, data->tangent_shift_a, J, P));
    check(scale_jacobian(ts, P));
    take();  // set_scales asked for a new Jacobian
    set_step(data, data->h);
  }
  petsc::agree(system.comm(), [&] { system.load(state.carried); });
}

}  // namespace floe::solve
