#include "floe/assess/validity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "floe/assembly/offline.h"
#include "floe/fem/field_rows.h"
#include "floe/math/rounded.h"
#include "floe/petsc/together.h"
#include "floe/petsc/values.h"
#include "validity_seen.h"

namespace floe::assess {

using Eigen::VectorXd;
using petsc::check;
using solve::State;

namespace {

constexpr std::size_t most_samples = 64;

double spin_of(const BodyReport& body, const State& state) {
  if (body.first_coordinate < 0) return 0;
  return body.dimension == 2 ? std::abs(state.v[body.first_coordinate + 2])
                             : state.v.segment<3>(body.first_coordinate + 3).norm();
}

/// Of a deformation, this rank's part.
struct Greatest {
  double rotation = 0, shift = 0;  // of a node [rad], [m]
};

Greatest greatest_of(int dimension, const double* values, PetscInt dofs) {
  const int n = dimension == 2 ? 3 : 6;
  Greatest most;
  for (PetscInt i = 0; i + n <= dofs; i += n) {
    most.shift = std::max(most.shift, Eigen::Map<const VectorXd>(values + i, dimension).norm());
    most.rotation = std::max(most.rotation, Eigen::Map<const VectorXd>(values + i + dimension, n - dimension).norm());
  }
  return most;
}

/// Of this rank's nodes of a body, three or six each.
PetscInt own_dofs(const BodyReport& body) {
  return static_cast<PetscInt>(body.positions.size()) / body.dimension * (body.dimension == 2 ? 3 : 6);
}

Greatest greatest_of(const BodyReport& body, const State& state) {
  if (body.first_dof >= 0) return greatest_of(body.dimension, state.q.data() + body.first_dof, own_dofs(body));
  const petsc::VecHandle field = deformation_of(body, state);
  if (!field.get()) return {};
  petsc::Values own(field);
  return greatest_of(body.dimension, own.begin(), own.end - own.first);
}

/// Diagonal of the box around its nodes. Collective.
double length_of(const BodyReport& body, MPI_Comm comm) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
  for (std::size_t i = 0; i + body.dimension <= body.positions.size(); i += body.dimension)
    for (int d = 0; d < body.dimension; ++d)
      low[d] = std::min(low[d], body.positions[i + d]), high[d] = std::max(high[d], body.positions[i + d]);
  MPI_Allreduce(MPI_IN_PLACE, low.data(), 3, MPI_DOUBLE, MPI_MIN, comm);
  MPI_Allreduce(MPI_IN_PLACE, high.data(), 3, MPI_DOUBLE, MPI_MAX, comm);
  return body.dimension == 2 ? std::hypot(high[0] - low[0], high[1] - low[1]) : (high - low).norm();
}

void see_deformation(const Model& model, std::size_t b, const State& state, Seen& seen) {
  const BodyReport& body = model.bodies[b];
  const bool full = body.first_dof >= 0;
  const Eigen::Index first = full ? body.first_dof : body.first_elastic;
  const Eigen::Index count =
      full ? static_cast<Eigen::Index>(body.positions.size()) / body.dimension * (body.dimension == 2 ? 3 : 6)
           : body.columns;
  seen.rate += state.v.segment(first, count).squaredNorm(), seen.size += state.q.segment(first, count).squaredNorm();
  if (full || !model.offline) return;
  const body::Elasticity& elasticity = model.offline->reduced[b].body.elasticity;
  const VectorXd eta = state.q.segment(first, count);
  // of the quadratic strains alone: the even part of the energy less that of the linear strains, so that tension counts
  // neither by itself nor by the stiffness that it adds
  const Eigen::MatrixXd K = elasticity.linear_stiffness();
  const double linear = 0.5 * eta.dot(K * eta),
               even = (body::energy(elasticity, eta) + body::energy(elasticity, -eta)) / 2,
               bending = elasticity.bending.isZero(0) ? linear : 0.5 * eta.dot(elasticity.bending * eta);
  const double membrane = even - linear;
  if (membrane > std::max(seen.membrane, 1e-9 * linear)) seen.membrane = membrane, seen.bending = bending;
}

/// Of the states, evenly.
std::vector<const State*> samples_of(const std::vector<State>& states) {
  const std::size_t count = std::min(most_samples, states.size());
  std::vector<const State*> some;
  for (std::size_t i = 1; i <= count; ++i) some.push_back(&states[i * states.size() / count - 1]);
  return some;
}

double intra_deflection_of(const BodyReport& body, const State& state) {
  if (body.dimension == 2) return 0;
  std::vector<petsc::VecHandle> fields;
  fields.push_back(deformation_of(body, state));
  return fields[0].get() ? fem::intra_deflections(*body.structure, fem::gather(*body.structure, fields))[0] : 0;
}

std::vector<Seen> look(const Model& model, const std::vector<State>& states, MPI_Comm comm) {
  const std::vector<const State*> some = samples_of(states);
  std::vector<Seen> all(model.bodies.size());
  for (std::size_t b = 0; b < all.size(); ++b) {
    if (model.bodies[b].rigid) continue;
    std::vector<double> slopes;
    double shift = 0;
    for (const State* state : some) {
      all[b].spin = std::max(all[b].spin, spin_of(model.bodies[b], *state));
      const Greatest most = greatest_of(model.bodies[b], *state);
      slopes.push_back(most.rotation), shift = std::max(shift, most.shift);
      see_deformation(model, b, *state, all[b]);
    }
    MPI_Allreduce(MPI_IN_PLACE, &shift, 1, MPI_DOUBLE, MPI_MAX, comm);
    MPI_Allreduce(MPI_IN_PLACE, slopes.data(), static_cast<int>(slopes.size()), MPI_DOUBLE, MPI_MAX, comm);
    const auto steepest = std::max_element(slopes.begin(), slopes.end());
    constexpr double round_off = 64 * PETSC_MACHINE_EPSILON;
    if (model.bodies[b].structure && *steepest <= round_off && shift <= round_off * length_of(model.bodies[b], comm)) {
      all[b] = {0, all[b].spin, 0, 0, 0, 0, 0};  // of where the body is: no deformation
      continue;
    }
    all[b].slope = *steepest;
    all[b].intra_deflection = intra_deflection_of(model.bodies[b], *some[steepest - slopes.begin()]);
    double sums[2] = {all[b].rate, all[b].size};  // of distributed dofs; replicated ones keep their quotient
    MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, comm);
    all[b].rate = sums[0], all[b].size = sums[1];
  }
  return all;
}

/// Whether the basis has derivatives, of its own or within the span of the other vectors; those that are zero have no
/// new part at all.
bool stretches(const BodyReport& body) {
  constexpr double within = 1e-4;  // of a derivative's norm is outside the span
  return std::any_of(body.origins.begin(), body.origins.end(), [](const reduction::ColumnOrigin& origin) {
    return origin.kind == reduction::ColumnOrigin::Kind::derivative &&
           (origin.kept || (origin.new_part > 0 && origin.new_part < within));
  });
}

void judge_shortening(const BodyReport& body, double slope, std::vector<OutOfRange>& out) {
  const double shortening = slope * slope / 2;
  if (shortening > 0.01)
    out.push_back({"shortening", body.name, shortening, 0.01,
                   fmt::format("body {}: foreshortening (slopes up to {:.2g}) of {} is not represented by "
                               "the linear elastic model (limit 1 %); use vm+md or nlffr",
                               body.name, slope, math::percent(shortening))});
}

/// Nothing can stretch with the bending: a linear elastic force, or no derivatives.
bool is_stiff(const BodyReport& body, bool linear) { return linear || !stretches(body); }

void judge_spin(const BodyReport& body, const Seen& seen, double omega, bool linear, std::vector<OutOfRange>& out) {
  if (!is_stiff(body, linear) || !(omega > 0 && seen.spin > 0.2 * omega)) return;
  out.push_back({"spin", body.name, seen.spin / omega, 0.2,
                 fmt::format("body {}: rotates at {:.3g} rad/s, {:.2g} of its first frequency (limit 0.2), without "
                             "centrifugal stiffening: error of the stiffness about {}; {}",
                             body.name, seen.spin, seen.spin / omega, math::percent(std::pow(seen.spin / omega, 2)),
                             linear ? "use vm+md or nlffr" : "add modal derivatives")});
}

void judge_stretching(const BodyReport& body, const Seen& seen, std::vector<OutOfRange>& out) {
  const bool bends = seen.bending > 1e-8 * seen.membrane;  // a truss does not
  if (!is_stiff(body, false) || !bends || !(seen.membrane > 0.02 * seen.bending)) return;
  out.push_back(
      {"membrane", body.name, seen.membrane / seen.bending, 0.02,
       fmt::format("body {}: membrane energy of quadratic strains is {} of bending energy (limit 2 %); without "
                   "modal derivatives the basis locks in membrane; add modal derivatives",
                   body.name, math::percent(seen.membrane / seen.bending))});
}

/// Of a file of the first version, which may be of shells without rotary inertia to speak of, a bound is known.
void judge_file(const BodyReport& body, double spin, std::vector<OutOfRange>& out) {
  if (body.file_version != 1 || body.omega.empty()) return;
  const double most = std::pow(spin / body.omega[0], 2);
  if (!(most > 0.05)) return;
  out.push_back(
      {"rotary", body.name, most, 0.05,
       fmt::format("body {}: at {:.3g} rad/s rotary inertia of second order changes its stiffness by up to {} "
                   "(limit 5 %) if it has beams or rigid masses, and \"{}\" was written without it: write it "
                   "again with floe reduce",
                   body.name, spin, math::percent(most), body.file)});
}

/// What its deformations alone tell, however they came about.
void judge_shape(const Model& model, const BodyReport& body, const Seen& seen, std::vector<OutOfRange>& out) {
  judge_file(body, seen.spin, out);
  const bool linear = model.formulation == Formulation::lffr;
  if (linear) judge_shortening(body, seen.slope, out);
  if (seen.intra_deflection > max_intra_deflection)
    out.push_back(
        {"mesh", body.name, seen.intra_deflection, max_intra_deflection,
         intra_deflection_text(body.name, "where it bends most", seen.intra_deflection, max_intra_deflection)});
  if (model.formulation != Formulation::nlffr && !linear) judge_stretching(body, seen, out);
}

/// Of the pieces of a body in several frames, for each thing that is judged, the one that is farthest out of range.
void keep_worst_pieces(const Model& model, std::vector<OutOfRange>& out) {
  std::map<std::pair<std::string, std::string>, std::size_t> worst;  // by body and thing
  std::vector<OutOfRange> kept;
  for (OutOfRange& one : out) {
    const auto body = std::find_if(model.bodies.begin(), model.bodies.end(),
                                   [&](const BodyReport& report) { return report.name == one.of; });
    const bool piece = body != model.bodies.end() && body->whole != body->name;
    const auto at = piece ? worst.try_emplace({body->whole, one.what}, kept.size()) : std::pair{worst.end(), true};
    if (at.second)
      kept.push_back(std::move(one));
    else if (one.value > kept[at.first->second].value)
      kept[at.first->second] = std::move(one);
  }
  out = std::move(kept);
}

}  // namespace

petsc::VecHandle deformation_of(const BodyReport& body, const State& state) {
  petsc::VecHandle field;
  if (!body.structure) return field;
  if (body.first_dof >= 0) {
    field = fem::field(*body.structure);
    petsc::Values own(field);
    std::copy_n(state.q.data() + body.first_dof, own.end - own.first, own.begin());
  } else if (body.basis && body.columns > 0) {
    field = fem::field(*body.structure);
    VectorXd eta = state.q.segment(body.first_elastic, body.columns);
    check(BVMultVec(body.basis->V, 1, 0, field, eta.data()));
  }
  return field;
}

bool also_of_full_order(const OutOfRange& one) {
  static const std::set<std::string> those = {"slope", "mesh", "in-plane", "coupling", "tension"};
  return those.count(one.what) > 0;
}

std::vector<OutOfRange> shapes_out_of_range(const Model& model, const std::vector<State>& states, MPI_Comm comm) {
  std::vector<OutOfRange> out;
  if (states.empty() || model.formulation == Formulation::cfr) return out;
  const std::vector<Seen> seen = look(model, states, comm);
  judge_slopes(model, samples_of(states), seen, comm, out);
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (!model.bodies[b].rigid) {
      judge_shape(model, model.bodies[b], seen[b], out);
      judge_missing(model, b, samples_of(states), out);
    }
  keep_worst_pieces(model, out);
  return out;
}

std::vector<OutOfRange> out_of_range(const Scene& whole, const Model& model, const KeptMotion& motion, MPI_Comm comm,
                                     std::string& unchecked) {
  std::vector<OutOfRange> out;
  if (motion.states().empty() || model.formulation == Formulation::cfr) return out;
  const Scene scene = split_frames(whole, comm);
  const std::vector<Seen> seen = look(model, motion.states(), comm);
  judge_slopes(model, samples_of(motion.states()), seen, comm, out);
  const bool linear = model.formulation == Formulation::lffr;
  std::vector<BodyReport> modes;
  const bool rotations = std::any_of(seen.begin(), seen.end(), [](const Seen& s) { return s.spin > 0; });
  if (linear && rotations)
    if (const std::string why = petsc::failed_together(comm, [&] { modes = body_modes(whole, comm); }); !why.empty())
      unchecked = "spin against first frequencies: " + why;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const BodyReport& body = model.bodies[b];
    if (body.rigid) continue;
    judge_shape(model, body, seen[b], out);
    judge_missing(model, b, samples_of(motion.states()), out);
    const std::vector<double>& omega = modes.empty() ? body.omega : modes[b].omega;
    if (model.formulation != Formulation::nlffr) judge_spin(body, seen[b], omega.empty() ? 0 : omega[0], linear, out);
  }
  judge_loads(scene, model, out);
  judge_step(scene, model, seen, out);
  keep_worst_pieces(model, out);
  return out;
}

}  // namespace floe::assess
