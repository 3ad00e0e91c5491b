#include "floe/assembly/lift.h"

#include <algorithm>

#include "floe/assembly/combination.h"
#include "floe/petsc/values.h"

namespace floe::assembly {

using Eigen::VectorXd;
using solve::State;

namespace {

int frame_size(const BodyReport& body) { return body.first_coordinate < 0 ? 0 : body.dimension == 2 ? 3 : 6; }

/// Visits pairs (from, to) of local indices: frames, and the multipliers of the rows that both models have, with the
/// axes of damping among them, which full-order models lack here.
template <class Visit>
void for_each_shared(const Model& from, const Model& to, Visit&& visit) {
  for (std::size_t b = 0; b < from.bodies.size(); ++b)
    for (int i = 0; i < frame_size(from.bodies[b]); ++i)
      visit(from.bodies[b].first_coordinate + i, to.bodies[b].first_coordinate + i);
  for (std::size_t j = 0; j < std::min(from.joints.size(), to.joints.size()); ++j) {
    const std::vector<int>&mine = from.joints[j].rows, &theirs = to.joints[j].rows;
    if (from.joints[j].at_nodes.size() != to.joints[j].at_nodes.size()) continue;  // spread_cuts
    for (std::size_t i = 0; i < mine.size(); ++i)
      if (const auto at = std::find(theirs.begin(), theirs.end(), mine[i]); at != theirs.end())
        visit(from.joints[j].first + static_cast<int>(i), to.joints[j].first + static_cast<int>(at - theirs.begin()));
  }
}

State zero_state(const State& like, const Model& model) {
  const VectorXd zero = VectorXd::Zero(model.system->coordinates().local_size());
  return {like.t, zero, zero, zero, like.bases};
}

/// Multipliers at the nodes of cuts.
void spread_cuts(const State& from, const Model& reduced, const Model& full, State& to) {
  for (std::size_t j = 0; j < std::min(reduced.joints.size(), full.joints.size()); ++j) {
    const Eigen::MatrixXd& spread = reduced.joints[j].at_nodes;
    if (spread.size() == 0) continue;
    const int mine = reduced.joints[j].first, theirs = full.joints[j].first;
    for (const auto& [a, b] : {std::pair(&from.q, &to.q), {&from.v, &to.v}, {&from.a, &to.a}})
      b->segment(theirs, spread.rows()) = spread * a->segment(mine, spread.cols());
  }
}

void copy_entry(const State& from, int i, State& to, int j) {
  to.q[j] = from.q[i], to.v[j] = from.v[i], to.a[j] = from.a[i];
}

}  // namespace

State lifted_to_more_columns(const State& state, const Model& reduced, const Model& more) {
  State lifted = zero_state(state, more);
  for_each_shared(reduced, more, [&](int i, int j) { copy_entry(state, i, lifted, j); });
  for (std::size_t b = 0; b < reduced.bodies.size(); ++b)
    for (int i = 0; i < reduced.bodies[b].columns; ++i)
      copy_entry(state, reduced.bodies[b].first_elastic + i, lifted, more.bodies[b].first_elastic + i);
  return lifted;
}

void lift_to_full_order(const State& state, const Model& reduced, const Offline& offline, const Model& full, Vec U,
                        Vec V, Vec A, bool relieved) {
  State lifted = zero_state(state, full);
  lifted.bases.resize(full.system->attitudes().size());  // without those of damping
  for_each_shared(reduced, full, [&](int i, int j) { copy_entry(state, i, lifted, j); });
  spread_cuts(state, reduced, full, lifted);
  for (std::size_t b = 0; b < reduced.bodies.size(); ++b) {
    const BodyReport &mine = reduced.bodies[b], &theirs = full.bodies[b];
    if (theirs.first_dof < 0) {  // as it is in both: rigid, or from a file
      for (int i = 0; i < mine.columns; ++i)
        copy_entry(state, mine.first_elastic + i, lifted, theirs.first_elastic + i);
      continue;
    }
    const petsc::VecHandle field = fem::field(offline.plan.bodies[b].structure);
    for (const auto& [from, to] : {std::pair(&state.q, &lifted.q), {&state.v, &lifted.v}, {&state.a, &lifted.a}}) {
      const VectorXd eta = from->segment(mine.first_elastic, mine.columns);
      if (relieved && from == &state.q)
        combine_relieved(offline.reduced[b], eta, field);
      else
        combine(*offline.reduced[b].basis, eta, field);
      petsc::Values own(field);
      std::copy(own.begin(), own.begin() + (own.end - own.first), to->data() + theirs.first_dof);
    }
  }
  solve::set_state(*full.system, lifted, U, V, A);
}

}  // namespace floe::assembly
