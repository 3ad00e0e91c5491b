#include <fmt/format.h>

#include <algorithm>

#include "error_part.h"
#include "floe/error.h"

namespace floe::assess {

namespace {

constexpr double power = 4;  // 2^2: errors of order 2 in the elements' length

/// How many times as many elements the refined bodies have.
double growth(const Scene& scene) { return any_shells(scene) ? 4 : 2; }

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
  const Model model = [&] {
    try {
      return built(motion, other, motion.model.formulation);
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
  const ProbeHistory history = simulated(motion, time, other, model, how, own.t,
                                         [&](const solve::Instant&, double spent) { return spent > 2 * allowed; });
  if (history.enough || !history.stopped.empty()) {
    const std::string why = part.by + ": " + (history.enough ? too_long(2 * allowed) : first_line(history.stopped));
    if (history.reached < min_fraction * motion.how.end) {
      part.none = why;
      return;
    }
    part.notes.push_back(why);
  }
  set_errors(own, {probe_columns(model), history.values},
             step == 1 ? Simulated{own.columns, own.values} : again(motion, own, time, step, history.reached, part),
             finer ? power / (power - 1) : -1 / (power - 1), {}, part);
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
