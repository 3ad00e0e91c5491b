#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "floe/math/rounded.h"
#include "moderate_rotations.h"
#include "validity_seen.h"

namespace floe::assess {

using solve::State;

namespace {

constexpr double limit = 0.01;       // of the length
constexpr double small_slope = 0.2;  // errs by 0.3 % at most

/// A body, or the pieces that `frames` made of it: [first, end) of the model's bodies.
struct Whole {
  std::string name;
  std::size_t first, end;
  std::size_t frames() const { return end - first; }
};

std::vector<Whole> wholes_of(const Model& model) {
  std::vector<Whole> wholes;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (const std::string& whole = model.bodies[b].whole; !wholes.empty() && wholes.back().name == whole)
      wholes.back().end = b + 1;
    else
      wholes.push_back({whole, b, b + 1});
  }
  return wholes;
}

bool is_straight(const std::vector<BentElement>& elements) {
  return std::all_of(elements.begin(), elements.end(),
                     [&](const BentElement& one) { return one.direction.cross(elements[0].direction).norm() < 1e-6; });
}

struct SlopeError {
  double error = 0;
  bool splits = false;  ///< `frames` can split it: in space every mesh, in the plane one straight line
};

/// That of a strip under a force across its tip, tangent (cfr: 0.032 at a slope of 0.5) or chord; end moments err by
/// 0.04 and 0.008.
SlopeError error_of_shells(const BodyReport& body, double slope) {
  const bool tangent = body.frame != "pinned" && body.frame != "mean-axis";
  return {tangent ? 0.25 * std::pow(slope, 3) : 0.03 * std::pow(slope, 4), true};
}

SlopeError greatest_error(const Model& model, const Whole& whole, const std::vector<const State*>& states,
                          double slope) {
  SlopeError most;
  for (const State* state : states) {
    std::vector<std::vector<BentElement>> parts;
    for (std::size_t b = whole.first; b < whole.end; ++b) {
      const BodyReport& body = model.bodies[b];
      const petsc::VecHandle field = deformation_of(body, *state);
      if (!field.get()) return most;
      parts.push_back(bent_elements(*body.structure, field));
      if (parts.back().empty()) return error_of_shells(body, slope);
    }
    most.error = std::max(most.error, rotation_error(parts, is_reduced(model.formulation) ? 2 : 3));
    most.splits = whole.frames() > 1 || model.bodies[whole.first].dimension == 3 || is_straight(parts[0]);
  }
  return most;
}

std::string remedy(const Whole& whole, const BodyReport& body, bool splits) {
  if (!splits) return "divide it into several bodies with fixed joints";
  if (whole.frames() > 1) return fmt::format("take more than {} (frames: {})", whole.frames(), 2 * whole.frames());
  if (body.frame != "clamped") return "take several (frames: 2)";
  return fmt::format("take a {} frame, or several (frames: 2)", body.dimension == 2 ? "pinned" : "mean-axis");
}

}  // namespace

void judge_slopes(const Model& model, const std::vector<const State*>& states, const std::vector<Seen>& seen,
                  MPI_Comm comm, std::vector<OutOfRange>& out) {
  if (model.formulation == Formulation::lffr) return;
  for (const Whole& whole : wholes_of(model)) {
    const BodyReport& body = model.bodies[whole.first];
    double slope = 0;
    for (std::size_t b = whole.first; b < whole.end; ++b) slope = std::max(slope, seen[b].slope);
    MPI_Bcast(&slope, 1, MPI_DOUBLE, 0, comm);
    if (body.rigid || slope < small_slope) continue;
    const SlopeError found = greatest_error(model, whole, states, slope);
    if (!(found.error > limit)) continue;
    const std::string frames = whole.frames() > 1 ? fmt::format("{} {} frames", whole.frames(), body.frame)
                                                  : fmt::format("{} frame", body.frame);
    out.push_back(
        {"slope", whole.name, found.error, limit,
         fmt::format(
             "body {}: slopes of up to {:.2g} relative to its {}: the error of its strains, which hold for moderate "
             "rotations, is about {} of its length (limit 1 %); {}",
             whole.name, slope, frames, math::percent(found.error, 1), remedy(whole, body, found.splits))});
  }
}

}  // namespace floe::assess
