#include "floe/scene/range.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "floe/petsc/values.h"
#include "offline.h"

namespace floe::scene {

using dynamics::State;
using Eigen::VectorXd;
using petsc::check;

namespace {

constexpr std::size_t samples = 64;

/// Of one body over the motion.
struct Seen {
  double slope = 0, spin = 0;        // greatest
  double bending = 0, membrane = 0;  // energies where membrane's is greatest
  double rate = 0, size = 0;         // sums of squares of deformations
};

double spin_of(const BodyReport& body, const State& state) {
  if (body.first_coordinate < 0) return 0;
  return body.dimension == 2 ? std::abs(state.v[body.first_coordinate + 2])
                             : state.v.segment<3>(body.first_coordinate + 3).norm();
}

/// Greatest rotation of a node in a field, this rank's part.
double greatest_rotation(int dimension, const double* values, PetscInt dofs) {
  const int n = dimension == 2 ? 3 : 6;
  double most = 0;
  for (PetscInt i = 0; i + n <= dofs; i += n)
    most = std::max(
        most, dimension == 2 ? std::abs(values[i + 2]) : Eigen::Map<const Eigen::Vector3d>(values + i + 3).norm());
  return most;
}

/// In the floating frame; bodies from files have no nodes to look at.
double slope_of(const Model& model, std::size_t b, const State& state) {
  const BodyReport& body = model.bodies[b];
  const PetscInt dofs = static_cast<PetscInt>(body.positions.size()) / body.dimension * (body.dimension == 2 ? 3 : 6);
  if (body.first_dof >= 0) return greatest_rotation(body.dimension, state.q.data() + body.first_dof, dofs);
  if (!body.basis || body.columns == 0 || !model.offline) return 0;
  const petsc::VecHandle field = fem::field(model.offline->prepared.bodies[b].structure);
  VectorXd eta = state.q.segment(body.first_elastic, body.columns);
  check(BVMultVec(body.basis->V, 1, 0, field, eta.data()));
  petsc::Values own(field);
  return greatest_rotation(body.dimension, own.begin(), own.end - own.first);
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
  const double bending = 0.5 * eta.dot(elasticity.bending * eta), membrane = body::energy(elasticity, eta) - bending;
  if (membrane > seen.membrane) seen.membrane = membrane, seen.bending = bending;
}

std::vector<Seen> look(const Model& model, const KeptMotion& motion, MPI_Comm comm) {
  std::vector<Seen> all(model.bodies.size());
  const std::vector<State>& states = motion.states();
  const std::size_t count = std::min(samples, states.size());
  for (std::size_t i = 1; i <= count; ++i) {
    const State& state = states[i * states.size() / count - 1];
    for (std::size_t b = 0; b < all.size(); ++b) {
      if (model.bodies[b].rigid) continue;
      all[b].spin = std::max(all[b].spin, spin_of(model.bodies[b], state));
      all[b].slope = std::max(all[b].slope, slope_of(model, b, state));
      see_deformation(model, b, state, all[b]);
    }
  }
  for (std::size_t b = 0; b < all.size(); ++b) {
    MPI_Allreduce(MPI_IN_PLACE, &all[b].slope, 1, MPI_DOUBLE, MPI_MAX, comm);
    double sums[2] = {all[b].rate, all[b].size};  // of distributed dofs; replicated ones keep their quotient
    MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, comm);
    all[b].rate = sums[0], all[b].size = sums[1];
  }
  return all;
}

bool stretches(const BodyReport& body) {
  return std::any_of(body.origins.begin(), body.origins.end(), [](const reduction::ColumnOrigin& origin) {
    return origin.kept && origin.kind == reduction::ColumnOrigin::Kind::derivative;
  });
}

void judge_slope(const Model& model, const BodyReport& body, const std::string& frame, double slope,
                 std::vector<OutOfRange>& out) {
  if (model.formulation == Formulation::lffr) {
    const double shortening = slope * slope / 2;
    if (shortening > 0.01)
      out.push_back({"shortening", body.name, shortening, 0.01,
                     fmt::format("body {}: slopes to {:.2g} shorten it by {:.2g} %, which a linear elastic force does "
                                 "not know (limit 1 %): take vm+md or nlffr",
                                 body.name, slope, 100 * shortening)});
    return;
  }
  const bool tangent = frame == "clamped";
  const double error = tangent ? 0.04 * std::pow(slope, 3) : 0.008 * std::pow(slope, 4);
  if (error > 0.005)
    out.push_back(
        {"slope", body.name, slope, tangent ? 0.5 : 0.89,
         fmt::format("body {}: slopes to {:.2g} in its {} frame, beyond {}: von Karman's strains err by about "
                     "{:.1g} % there; {}",
                     body.name, slope, frame, tangent ? "0.5" : "0.89", 100 * error,
                     tangent ? "take a pinned frame, or several (frames: 2)" : "take several (frames: 2)")});
}

void judge_stretching(const BodyReport& body, const Seen& seen, double omega, bool linear,
                      std::vector<OutOfRange>& out) {
  if (!linear && stretches(body)) return;
  const std::string remedy = linear ? "take vm+md or nlffr" : "give it derivatives";
  if (omega > 0 && seen.spin > 0.2 * omega)
    out.push_back({"spin", body.name, seen.spin / omega, 0.2,
                   fmt::format("body {}: spins at {:.3g} rad/s, {:.2g} of its first frequency (limit 0.2), and nothing "
                               "stiffens it as it turns: stiffness off by about {:.2g} %; {}",
                               body.name, seen.spin, seen.spin / omega, 100 * std::pow(seen.spin / omega, 2), remedy)});
  if (!linear && seen.bending > 0 && seen.membrane > 0.02 * seen.bending)
    out.push_back({"membrane", body.name, seen.membrane / seen.bending, 0.02,
                   fmt::format("body {}: stretching holds {:.2g} % of the energy of bending (limit 2 %), and without "
                               "derivatives nothing gives way to it: too stiff; {}",
                               body.name, 100 * seen.membrane / seen.bending, remedy)});
}

/// What drives bodies by formulas of t.
struct Excitation {
  std::string name;  ///< of a load, or the scene's key
  std::string words;
  std::string body;  ///< empty: all
  std::vector<math::Formula> formulas;
};

std::vector<Excitation> excitations(const Scene& scene) {
  std::vector<Excitation> all;
  for (const Load& load : scene.loads) {
    Excitation one{load.name, "load " + load.name, load.spread() ? load.body : load.at.body, {load.pressure}};
    one.formulas.insert(one.formulas.end(), load.force.begin(), load.force.end());
    one.formulas.insert(one.formulas.end(), load.moment.begin(), load.moment.end());
    all.push_back(std::move(one));
  }
  const auto& g = scene.gravity;
  const auto& a = scene.ground_acceleration;
  all.push_back({"gravity", "gravity", "", {g.begin(), g.end()}});
  all.push_back({"ground.acceleration", "ground.acceleration", "", {a.begin(), a.end()}});
  return all;
}

struct LoadRate {
  Excitation of;
  double omega = 0;  ///< rms rate over rms value
};

/// Those that are something. A formula without a finite rate between the steps has none that can be judged.
std::vector<LoadRate> rates_of_loads(const Scene& scene) {
  constexpr int points = 2000;
  std::vector<LoadRate> all;
  for (Excitation& one : excitations(scene)) {
    double rate = 0, size = 0;
    try {
      for (const math::Formula& formula : one.formulas)
        for (int i = 0; i < points && !formula.constant(); ++i) {
          const double t = scene.motion.end * (i + 0.5) / points;
          rate += std::pow(formula.derivative(t), 2), size += std::pow(formula(t), 2);
        }
    } catch (const math::FormulaError&) {
      continue;
    }
    for (const math::Formula& formula : one.formulas)
      if (formula.constant()) size += points * std::pow(formula(), 2);
    if (rate > 0 && std::isfinite(rate / size)) all.push_back({std::move(one), std::sqrt(rate / size)});
  }
  return all;
}

void judge_loads(const Scene& scene, const Model& model, std::vector<OutOfRange>& out) {
  for (const LoadRate& load : rates_of_loads(scene))
    for (const BodyReport& body : model.bodies) {
      if ((!load.of.body.empty() && body.name != load.of.body) || body.omega.empty() || body.rigid) continue;
      const double share = load.omega / body.omega.back();
      if (share > 0.5)
        out.push_back({"load", load.of.name, share, 0.5,
                       fmt::format("{}: changes at {:.3g} rad/s, {:.2g} of the highest kept frequency of body {} "
                                   "(limit 0.5): give it more modes",
                                   load.of.words, load.omega, share, body.name)});
    }
}

void judge_step(const Scene& scene, const Model& model, const std::vector<Seen>& seen, std::vector<OutOfRange>& out) {
  if (scene.motion.tolerance) return;
  double fastest = 0;
  std::string of;
  for (std::size_t b = 0; b < seen.size(); ++b)
    if (seen[b].size > 0 && std::sqrt(seen[b].rate / seen[b].size) > fastest)
      fastest = std::sqrt(seen[b].rate / seen[b].size), of = "deformations of body " + model.bodies[b].name;
  for (const LoadRate& load : rates_of_loads(scene))
    if (load.omega > fastest) fastest = load.omega, of = load.of.words;
  const double turn = scene.motion.step * fastest;
  if (turn > 0.25)
    out.push_back(
        {"step", of, turn, 0.25,
         fmt::format("motion.step {:.3g} s: only {:.2g} steps in a period of the {}, {:.3g} s (limit 25): take "
                     "{:.2g} s or less",
                     scene.motion.step, 2 * M_PI / turn, of, 2 * M_PI / fastest, 0.25 / fastest)});
}

}  // namespace

std::vector<OutOfRange> out_of_range(const Scene& whole, const Model& model, const KeptMotion& motion, MPI_Comm comm) {
  std::vector<OutOfRange> out;
  if (motion.states().empty() || model.formulation == Formulation::cfr) return out;
  const Scene scene = split_frames(whole);
  const std::vector<Seen> seen = look(model, motion, comm);
  const bool linear = model.formulation == Formulation::lffr;
  std::vector<BodyReport> modes;
  const bool turns = std::any_of(seen.begin(), seen.end(), [](const Seen& s) { return s.spin > 0; });
  if (linear && turns) modes = body_modes(whole, comm);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const BodyReport& body = model.bodies[b];
    if (body.rigid) continue;
    judge_slope(model, body, body.frame, seen[b].slope, out);
    const std::vector<double>& omega = modes.empty() ? body.omega : modes[b].omega;
    if (model.formulation != Formulation::nlffr)
      judge_stretching(body, seen[b], omega.empty() ? 0 : omega[0], linear, out);
  }
  judge_loads(scene, model, out);
  judge_step(scene, model, seen, out);
  return out;
}

}  // namespace floe::scene
