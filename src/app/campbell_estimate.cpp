#include "campbell_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "campbell_check.h"
#include "floe/assembly/offline.h"
#include "floe/assembly/rotation.h"
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

/// Before it is built.
bool fits_at_full_order(const assembly::Model& model) {
  PetscInt dofs = 0;
  for (const assembly::PlannedBody& body : model.offline->plan.bodies)
    if (is_meshed(body.spec)) dofs += body.structure.dofs();
  return dofs <= solve::largest_rotating_system;
}

/// The vibrations at a speed of a better model.  @return  why not; empty: found
std::string find_better(const scene::Scene& given, const scene::Scene& scene, scene::Formulation formulation, int modes,
                        const CampbellPoint& at, MPI_Comm comm, const CampbellDiagram& diagram, CampbellPoint& point,
                        PetscInt& coordinates) {
  point = {at.speed, {}, 0, {}};
  try {
    CampbellDiagram second{{}, diagram.axis, plan_rotation(scene, formulation, comm), {}};
    coordinates = second.model.coordinates;
    if (coordinates <= diagram.model.coordinates)
      throw InputError("the larger bases have no more coordinates than the model");
    if (coordinates + second.model.multipliers > solve::largest_rotating_system)
      throw InputError("the better model has too many unknowns");
    follow(assembly::rotating_system(given, second.model, second.axis), diagram, at, modes + 2, second.model.U, point);
    return point.fault;
  } catch (const InputError& error) {
    return error.what();
  } catch (const RunError& error) {
    return error.what();
  }
}

}  // namespace

void estimate_frequencies(const scene::Scene& given, const scene::Scene& scene, int modes, double speed, MPI_Comm comm,
                          CampbellDiagram& diagram) {
  if (!is_reduced(diagram.model.formulation)) return;
  CampbellEstimate& estimate = diagram.estimate;
  estimate.speed = speed;
  const CampbellPoint* at = steady_at(diagram, speed);
  if (!at) {
    estimate.missing = "no steady rotation";
    return;
  }
  CampbellPoint point;
  if (fits_at_full_order(diagram.model)) {
    const std::string why =
        find_better(given, scene, scene::Formulation::nlffr, modes, *at, comm, diagram, point, estimate.coordinates);
    estimate.full_order = why.empty();
    if (!why.empty() && estimate.coordinates > diagram.model.coordinates)
      diagram.model.warnings.push_back(
          fmt::format("the error of the frequencies is not that to the full-order model: {}; a second reduced model "
                      "does not see what neither basis has",
                      why));
  }
  if (!estimate.full_order) {
    const std::optional<scene::Scene> larger = on_larger_bases(scene);
    estimate.missing = larger ? find_better(given, *larger, scene::Formulation::vm_md, modes, *at, comm, diagram, point,
                                            estimate.coordinates)
                              : "no body has a mesh from which a larger basis could be computed";
  }
  if (estimate.missing.empty())
    estimate.errors = frequency_errors(*at, {point.vibrations.begin(), point.vibrations.end()});
}

}  // namespace floe::app
