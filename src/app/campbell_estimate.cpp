#include "campbell_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "campbell_check.h"
#include "floe/assembly/offline.h"
#include "model_hierarchy.h"

namespace floe::app {
namespace {

int vectors_of(int modes) { return modes + modes * (modes + 1) / 2; }

void enlarge(scene::ReductionSpec& reduction) {
  int& modes = reduction.modes.count;
  const int most = 2 * modes;
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

std::vector<FrequencyError> frequency_errors(const CampbellPoint& point, const std::vector<solve::Vibration>& better) {
  std::vector<FrequencyError> errors;
  std::vector<char> used(better.size());
  for (const TrackedVibration& one : point.vibrations) {
    if (one.omega == 0) continue;
    const auto apart = [&](std::size_t i) { return std::abs(better[i].omega - one.omega); };
    std::optional<std::size_t> nearest;
    for (std::size_t i = 0; i < better.size(); ++i)
      if (!used[i] && better[i].omega > 0 && (!nearest || apart(i) < apart(*nearest))) nearest = i;
    if (!nearest) break;
    used[*nearest] = 1;
    errors.push_back({one.track, apart(*nearest) / better[*nearest].omega});
  }
  return errors;
}

namespace {

/// Before it is built: of bodies from files there is no full-order model.
bool fits_at_full_order(const assembly::Model& model) {
  PetscInt dofs = 0;
  for (const assembly::PlannedBody& body : model.offline->plan.bodies) {
    if (is_meshed(body.spec)) dofs += body.structure.dofs();
    if (body.spec.reduced) return false;
  }
  return dofs > 0 && dofs <= solve::largest_rotating_system;
}

}  // namespace

void estimate_frequencies(const scene::Scene& scene, int modes, double speed, MPI_Comm comm, CampbellDiagram& diagram) {
  using scene::Formulation;
  if (!is_reduced(diagram.model.formulation)) return;
  CampbellEstimate& estimate = diagram.estimate;
  estimate.speed = speed;
  const CampbellPoint* at = steady_at(diagram, speed);
  if (!at) {
    estimate.missing = "no steady rotation";
    return;
  }
  OtherPoint better;
  const auto compare_with = [&](const scene::Scene& other, Formulation formulation) {
    better = in_other_model(other, formulation, modes + 2, *at, comm, diagram);
    estimate.coordinates = better.coordinates;
    return better.point.fault.empty();
  };
  std::string failed;  // at full order
  if (fits_at_full_order(diagram.model)) {
    estimate.full_order = compare_with(scene, Formulation::nlffr);
    failed = better.point.fault;
  }
  if (!estimate.full_order) {
    const std::optional<scene::Scene> larger = on_larger_bases(scene);
    if (!larger)
      estimate.missing = "no body has a mesh from which a larger basis could be computed";
    else if (!compare_with(*larger, Formulation::vm_md))
      estimate.missing = better.point.fault;
    else if (better.coordinates <= diagram.model.coordinates)
      estimate.missing = "the larger bases have no more coordinates than the model";
  }
  if (!failed.empty() && estimate.missing.empty())
    diagram.model.warnings.push_back(
        fmt::format("the frequency errors are estimated by a second reduced model, because the comparison with the "
                    "full-order model failed: {}; errors that both bases share are not contained",
                    failed));
  if (!failed.empty() && !estimate.missing.empty()) estimate.missing += "; at full order: " + failed;
  if (estimate.missing.empty())
    estimate.errors = frequency_errors(*at, {better.point.vibrations.begin(), better.point.vibrations.end()});
}

}  // namespace floe::app
