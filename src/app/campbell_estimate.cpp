#include "campbell_estimate.h"

#include <algorithm>
#include <cmath>

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
    if (meshed(body)) enlarge(body.reduction), any = true;
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

}  // namespace floe::app
