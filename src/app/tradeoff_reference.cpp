#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exact_motion.h"
#include "floe/math/rounded.h"
#include "refined.h"
#include "tradeoff.h"

namespace floe::app {

using scene::Formulation;
using scene::Scene;

namespace {

constexpr double smallest_required = 0.002;  // of the models that are selected

/// The scene on elements half as long, in steps of a quarter, stored as often.
Scene finer(const Scene& scene) {
  Scene fine = refined(scene);
  fine.motion = scene.motion;
  shorten_steps(fine.motion, 4);
  if (!scene.motion.output) fine.motion.every *= 4;
  return fine;
}

/// Adaptive steps by their tolerance.
std::string steps_in_words(const Scene& scene, int n) {
  return scene.motion.tolerance ? fmt::format("1/{} of the tolerance", n * n * n)
                                : fmt::format("steps 1/{} as long", n);
}

TradeoffReference of_exact(const Scene& scene, const ExactMotion& exact) {
  TradeoffReference reference;
  reference.formulation = Formulation::cfr;
  const int halvings = static_cast<int>(exact.of_mesh.size()) - 1;
  reference.words = fmt::format("cfr, elements 1/{} as long, {}, extrapolated", 1 << halvings,
                                steps_in_words(scene, 1 << exact.halved_steps));
  reference.series = exact.series, reference.error = exact.error;
  return reference;
}

/// The finer full-order model errs by a quarter of the mesh error and a sixteenth of the step error, so by a third at
/// most of what lies between it and the scene's own one.
TradeoffReference of_full_order(const Scene& scene, const Series& own, MPI_Comm comm) {
  TradeoffReference reference;
  reference.formulation = Formulation::nlffr;
  const bool halved = std::any_of(scene.bodies.begin(), scene.bodies.end(), scene::is_meshed);
  reference.words = fmt::format("nlffr, {}{}", halved ? "elements 1/2 as long, " : "", steps_in_words(scene, 4));
  reference.series = run(finer(scene), Formulation::nlffr, comm, std::nullopt).series;
  reference.error = worst_error(own, reference.series) / (halved ? 3 : 15);
  reference.error_lacks = "the error of strains and floating frames";
  const double end = own.t.back(), finer_end = reference.series.t.back();
  if (std::abs(finer_end - end) > 2 * scene.motion.step + scene.motion.output.value_or(0))
    reference.error_lacks += fmt::format(", and of the end, {:.4g} instead of {:.4g} s", end, finer_end);
  return reference;
}

}  // namespace

TradeoffReference tradeoff_reference(const Scene& scene, const TradeoffRequest& request, const Series& own,
                                     MPI_Comm comm) {
  if (request.reference == Formulation::nlffr) return of_full_order(scene, own, comm);
  const ExactMotion exact = exact_motion(scene, smallest_required, request.most_seconds, comm);
  if (exact.none.empty()) return of_exact(scene, exact);
  if (request.reference == Formulation::cfr)
    throw InputError(fmt::format("{}: --reference cfr: {}; expected --reference nlffr, or a longer --time-budget",
                                 scene.file, exact.none));
  TradeoffReference reference = of_full_order(scene, own, comm);
  reference.why = exact.none;
  return reference;
}

}  // namespace floe::app
