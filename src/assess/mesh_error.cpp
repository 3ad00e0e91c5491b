#include <fmt/format.h>

#include <algorithm>

#include "error_part.h"
#include "floe/error.h"

namespace floe::assess {

namespace {

constexpr double power = 4;  // 2^2: errors of order 2 in the elements' length

/// How many times as many elements the refined bodies have.
double growth(const Scene& scene) { return any_shells(scene) ? 4 : 2; }

/// Whether selected basis vectors are a great part of all that a body can do: those of the same names are a smaller
/// part on a refined mesh, and the difference is that of two reductions.
bool crowded(const FinishedMotion& motion) {
  return std::any_of(motion.scene.bodies.begin(), motion.scene.bodies.end(), [&](const Body& body) {
    int columns = 0;
    PetscInt dofs = 0;
    for (const BodyReport& report : motion.model.bodies)
      if (report.name == body.name || report.whole == body.name) columns += report.columns, dofs += report.dofs;
    return !body.reduction.columns.empty() && 4 * columns > dofs;
  });
}

void estimate(const FinishedMotion& motion, const ProbeSeries& own, const TimeBudget& time, double allowed,
              ErrorPart& part) {
  const double offline = time.of_first(motion.offline), took = std::max(1e-6, time.of_first(motion.seconds));
  Scene other = motion.scene;
  bool finer = growth(other) * offline <= allowed;
  if (!finer && !scale_meshes(other, 0.5)) {
    part.none = fmt::format("the reduction of the refined mesh would take about {:.2g} s (limit {:.2g} s)",
                            growth(other) * offline, allowed);
    return;
  }
  if (finer) scale_meshes(other, 2);
  part.by = finer ? "elements half as long" : "elements twice as long";
  const bool full = is_reduced(motion.model.formulation) && crowded(motion);
  const Formulation formulation = full ? Formulation::nlffr : motion.model.formulation;
  if (full) part.by += ", in full-order models";
  const Model model = [&] {
    try {
      return built(motion, other, formulation);
    } catch (const InputError& fault) {  // of every rank: a node of the scene's mesh that the other does not have
      throw RunError(fmt::format("on {}: {}", part.by, first_line(fault.what())));
    }
  }();
  int step = 1;
  const auto needs = [&] { return step == 1 ? took : 2 * took / step; };
  if (can_lengthen(motion))
    while (needs() > time.left() && step < 4) step *= 2;
  double end = motion.how.end;
  if (const double share = time.left() / needs(); share < 1) end *= std::max(share, min_fraction);
  solve::Integration how = motion.how;
  how.step *= step, how.end = end;
  if (step > 1) part.by += fmt::format(", steps {} times as long", step);
  const auto simulate = [&](const Scene& scene, const Model& of, double most) {
    return simulated(motion, time, scene, of, how, own.t,
                     [&](const solve::Instant&, double spent) { return spent > most; });
  };
  const auto fails = [&](const ProbeHistory& history, double most) {
    if (!history.enough && history.stopped.empty()) return false;
    const std::string why = part.by + ": " + (history.enough ? too_long(most) : first_line(history.stopped));
    const bool short_of = history.reached < min_fraction * motion.how.end;
    if (full && history.enough && !short_of) return false;  // the time that the part covers is told
    (short_of ? part.none : part.notes.emplace_back()) = why;
    return short_of;
  };
  Simulated one{own.columns, own.values};
  if (full) {
    const Model same = built(motion, motion.scene, formulation);
    ProbeHistory history = simulate(motion.scene, same, 0.7 * allowed);
    if (fails(history, 0.7 * allowed)) return;
    how.end = history.reached;
    one = {probe_columns(same), std::move(history.values)};
  }
  const ProbeHistory history = simulate(other, model, 2 * allowed);
  if (fails(history, 2 * allowed)) return;
  if (!full && step > 1) one = again(motion, own, time, step, history.reached, part);
  set_errors(own, {probe_columns(model), history.values}, one, finer ? power / (power - 1) : -1 / (power - 1), {},
             part);
  if (part.t.empty()) part.none = "there are no results at the instants stored";
}

}  // namespace

ErrorPart estimate_mesh_error(const FinishedMotion& motion, const ProbeSeries& own, double allowed) {
  ErrorPart part;
  part.none = any_mesh(motion.scene) ? "" : "no body has a mesh";
  if (part.none.empty() && own.t.empty()) part.none = "the integrator provides no accelerations";
  if (part.none.empty() && motion.scene.probes.empty()) part.none = "no probes";
  if (!part.none.empty()) return part;
  for (const Body& body : motion.scene.bodies)
    if (body.reduced) part.notes.push_back(fmt::format("body {} comes from a file without its mesh", body.name));
  const TimeBudget time(motion.comm, allowed);
  fill_in(motion, part, [&] { estimate(motion, own, time, allowed, part); });
  part.seconds = time.spent();
  return part;
}

}  // namespace floe::assess
