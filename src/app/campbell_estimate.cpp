#include "campbell_estimate.h"

#include <algorithm>
#include <cmath>

#include "campbell_check.h"
#include "floe/assembly/rotation.h"
#include "model_hierarchy.h"

namespace floe::app {
namespace {

int vectors_of(int modes) { return modes + modes * (modes + 1) / 2; }

void enlarge(scene::ReductionSpec& reduction) {
  int& modes = reduction.modes.count;
  const int most = modes + (modes + 1) / 2;
  ++modes;
  while (modes < most && vectors_of(modes + 1) <= most_vectors) ++modes;
  reduction.modes.given = false;  // a small body may have fewer
  reduction.derivatives.choice = scene::DerivativesSpec::Choice::all;
  reduction.columns.clear();
  reduction.products.reset();
}

}  // namespace

std::optional<scene::Scene> on_larger_bases(const scene::Scene& scene) {
  scene::Scene larger = scene;
  bool any = false;
  for (scene::Body& body : larger.bodies)
    if (is_meshed(body)) enlarge(body.reduction), any = true;
  return any ? std::optional(larger) : std::nullopt;
}

std::vector<FrequencyError> frequency_errors(const CampbellPoint& point, const std::vector<solve::Vibration>& larger) {
  std::vector<FrequencyError> errors;
  std::vector<char> used(larger.size());
  for (const TrackedVibration& one : point.vibrations) {
    if (one.omega == 0) continue;
    const auto apart = [&](std::size_t i) { return std::abs(larger[i].omega - one.omega); };
    std::optional<std::size_t> nearest;
    for (std::size_t i = 0; i < larger.size(); ++i)
      if (!used[i] && larger[i].omega > 0 && (!nearest || apart(i) < apart(*nearest))) nearest = i;
    if (!nearest) break;
    used[*nearest] = 1;
    errors.push_back({one.track, apart(*nearest) / larger[*nearest].omega});
  }
  return errors;
}

void estimate_frequencies(const scene::Scene& given, const scene::Scene& scene, int modes, double speed, MPI_Comm comm,
                          CampbellDiagram& diagram) {
  if (diagram.model.formulation != scene::Formulation::vm && diagram.model.formulation != scene::Formulation::vm_md)
    return;
  CampbellEstimate& estimate = diagram.estimate;
  estimate.speed = speed;
  const CampbellPoint* at = steady_at(diagram, speed);
  const std::optional<scene::Scene> larger = on_larger_bases(scene);
  if (!at || !larger) {
    estimate.missing = larger ? "no steady rotation" : "no body has a mesh from which a larger basis could be computed";
    return;
  }
  CampbellPoint point{speed, {}, 0, {}};
  try {
    CampbellDiagram second{{}, diagram.axis, plan_rotation(*larger, scene::Formulation::vm_md, comm), {}};
    estimate.coordinates = second.model.coordinates;
    if (estimate.coordinates <= diagram.model.coordinates)
      throw InputError("the larger bases have no more coordinates than the model");
    follow(assembly::rotating_system(given, second.model, second.axis), diagram, *at, modes + 2, second.model.U, point);
    estimate.missing = point.fault;
  } catch (const InputError& error) {
    estimate.missing = error.what();
  } catch (const RunError& error) {
    estimate.missing = error.what();
  }
  if (estimate.missing.empty())
    estimate.errors = frequency_errors(*at, {point.vibrations.begin(), point.vibrations.end()});
}

}  // namespace floe::app
