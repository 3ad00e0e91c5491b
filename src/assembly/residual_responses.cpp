#include "residual_responses.h"

#include <fmt/format.h>

#include <algorithm>

#include "floe/assembly/body_stage.h"
#include "floe/assembly/kept_motion.h"
#include "floe/assembly/residual_loads.h"

namespace floe::assembly {

using reduction::ColumnOrigin;

namespace {

constexpr std::size_t most_samples = 16;  // full-order residuals of a round
constexpr int most_vectors = 8;           // of a body in a round
constexpr int most_tangents = 2;          // of the deformed body, beside that at rest

/// The scene's reduced model in the scene's steps. @throws RunError  it does not get beyond its start
void simulate_reduced(const Plan& plan, Model& model, KeptMotion& motion) {
  const Motion& how = plan.scene.motion;
  solve::Integration with{how.end, how.step, how.spectral_radius, how.tolerance, "ranking_"};
  with.events = events_of(plan.scene, model, how.end);
  with.kinks = kinks_of(plan.scene, how.end);
  with.state_loads = std::ranges::any_of(plan.scene.loads, [](const Load& load) { return load.has_sensors(); });
  try {
    solve::simulate(*model.system, with, model.U, model.V,
                    [&](const solve::Instant& instant) { motion.keep(instant); });
  } catch (const solve::MotionStopped& stopped) {  // what it did until then has residuals, too
    if (motion.states().empty()) throw RunError(std::string("reduction.responses: ") + stopped.what());
  }
  if (motion.states().empty()) throw RunError("reduction.responses: the integrator provides no accelerations");
}

/// Whether bodies are of beams alone. About a deformation V eta, K_T of beams on a fine mesh has the stresses of terms
/// of higher order; that of shells has what bends without stretching in the same vector, which few responses of K at
/// rest do not (the blade of the examples, 12 responses: 5 % instead of 1.2 %).
bool of_beams(const Offline& offline) {
  for (std::size_t b = 0; b < offline.reduced.size(); ++b)
    if (has_structure(offline.plan.bodies[b]))
      for (const fem::Section& section : offline.plan.bodies[b].structure.sections)
        if (std::holds_alternative<fem::ShellSection>(section)) return false;
  return true;
}

/// Where the motion deforms most, and some instants along it.
void take_residuals(const Model& model, const KeptMotion& motion, Residuals& residuals) {
  std::vector<solve::State> all{most_deformed(model, motion.states())};
  for (const solve::State& state : spread(motion.states(), most_samples - 1))
    if (state.t != all.front().t) all.push_back(state);
  residuals.add(all);
}

/// The body on V and W, with the origins of both. @param number  of responses that it has
/// @param relieves  extends the relief that it has by that of W; else the relief is found anew
ReducedBody joined(const PlannedBody& body, const ReducedBody& reduced, const std::vector<ResidualLoad>& loads,
                   const reduction::Columns& W, int number, bool relieves) {
  ReducedBody more = with_columns(body, reduced, W);
  more.statics = reduced.statics;
  more.report.origins = reduced.report.origins;
  std::vector<ColumnOrigin>& origins = more.basis->origins;
  std::size_t i = 0;
  for (const ColumnOrigin& origin : reduced.report.origins)
    if (origin.kept) origins[i++] = origin;
  for (; i < origins.size(); ++i) {
    if (!origins[i].kept) continue;
    origins[i].label = fmt::format("response {}", ++number);
    more.report.origins.push_back(origins[i]);
  }
  if (relieves)
    relieve(body, loads, W, reduced, more);
  else
    find_relief(body, *more.statics, more);
  finish_elasticity(body, more);
  return more;
}

}  // namespace

bool has_responses(const Scene& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(),
                     [](const Body& body) { return is_meshed(body) && body.reduction.responses > 0; });
}

void add_residual_responses(Offline& offline, std::vector<std::string>& warnings) {
  const Plan& plan = offline.plan;
  std::vector<int> has(offline.reduced.size(), 0);
  const auto wanted = [&](std::size_t b) {
    return has_structure(plan.bodies[b]) ? plan.bodies[b].spec.reduction.responses : 0;
  };
  const auto lacks = [&] {
    for (std::size_t b = 0; b < has.size(); ++b)
      if (has[b] < wanted(b)) return true;
    return false;
  };
  for (bool more = true; more && lacks();) {
    more = false;
    Model model = assemble(plan, Formulation::vm_md, offline.reduced);
    KeptMotion motion(model);
    simulate_reduced(plan, model, motion);
    const bool relieves = of_beams(offline);
    Residuals residuals(model, offline, many_elements, relieves);
    take_residuals(model, motion, residuals);
    for (std::size_t b = 0; b < has.size(); ++b) {
      const int most = std::min(wanted(b) - has[b], most_vectors);
      if (most <= 0) continue;
      const PlannedBody& body = plan.bodies[b];
      ReducedBody& reduced = offline.reduced[b];
      const double start = MPI_Wtime();
      const reduction::Columns W = main_columns(
          body.structure,
          responses(body, reduced, residuals.loads(b), relieves && reduced.relief.W ? 0 : most_tangents, warnings),
          most);
      const int before = reduced.body.coordinates();
      if (!W.empty()) reduced = joined(body, reduced, residuals.loads(b), W, has[b], relieves);
      has[b] += reduced.body.coordinates() - before;
      more = more || reduced.body.coordinates() > before;
      reduced.report.seconds_projection += MPI_Wtime() - start;
    }
  }
  for (std::size_t b = 0; b < has.size(); ++b)
    if (has[b] < wanted(b))
      warnings.push_back(fmt::format("body {}: {} residual responses instead of {}; the others are linearly dependent",
                                     plan.bodies[b].spec.name, has[b], wanted(b)));
}

}  // namespace floe::assembly
