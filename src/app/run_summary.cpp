#include "run_summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "floe/math/rounded.h"
#include "floe/output/provenance.h"

namespace floe::app {

using nlohmann::ordered_json;

namespace {

const char* kind_name(reduction::ColumnOrigin::Kind kind) {
  switch (kind) {
    case reduction::ColumnOrigin::Kind::mode:
      return "mode";
    case reduction::ColumnOrigin::Kind::derivative:
      return "derivative";
    default:
      return "attachment";
  }
}

ordered_json body_json(const assembly::BodyReport& body) {
  ordered_json j;
  j["name"] = body.name;
  j["nodes"] = body.nodes;
  j["elements"] = body.elements;
  j["dofs"] = body.dofs;
  j["rigid"] = body.rigid;
  if (!body.strains.empty()) j["strains"] = body.strains;
  if (!body.file.empty()) j["reduced_file"] = body.file;
  if (!body.basis && body.file.empty()) return j;
  if (!body.reduction_of.empty()) j["reduction_of"] = body.reduction_of;
  j["reduced_coordinates"] = body.columns;
  j["products"] = {{"kept", body.products}, {"of", body.products + body.omitted_products}};
  for (std::size_t i = 0; i < body.omega.size(); ++i)
    j["frequencies"].push_back(
        {{"rad_per_s", body.omega[i]}, {"Hz", body.omega[i] / (2 * M_PI)}, {"residual", body.residual[i]}});
  for (const auto& origin : body.origins) {
    ordered_json column{{"column", origin.label},
                        {"kind", kind_name(origin.kind)},
                        {"kept", origin.kept},
                        {"new_part", origin.new_part}};
    if (origin.interaction > 0) column["interaction"] = origin.interaction;
    if (!origin.dropped.empty()) column["dropped"] = origin.dropped;
    j["basis"].push_back(column);
  }
  j["seconds"] = {{"modes", body.seconds_modes},
                  {"derivatives", body.seconds_derivatives},
                  {"projection", body.seconds_projection}};
  return j;
}

/// Of a drive at t = 0; 0 where its formula has none there.
double first_speed(const scene::Joint& joint) {
  try {
    if (joint.speed) return (*joint.speed)(0);
    return (joint.kind == scene::Joint::Kind::driven ? joint.angle : joint.position).derivative(0);
  } catch (const math::FormulaError&) {
    return 0;
  }
}

}  // namespace

std::string changed_start(const scene::Scene& scene, const assembly::Model& model) {
  constexpr double noticeable = 0.01;
  if (!(model.velocity_correction > noticeable)) return "";
  std::vector<std::string> moving;
  for (const scene::Joint& joint : scene.joints) {
    const bool rotates = joint.kind == scene::Joint::Kind::driven;
    if (!rotates && joint.kind != scene::Joint::Kind::driven_slide) continue;
    if (const double speed = first_speed(joint); speed != 0)
      moving.push_back(fmt::format("{} {:.4g} {}", joint.name, speed, rotates ? "rad/s" : "m/s"));
  }
  const std::string drives = moving.empty() ? "" : fmt::format(" (at t = 0: {})", fmt::join(moving, ", "));
  return fmt::format(
      "the initial velocities contradict the joints and drives{}, and were changed by {} of their size, as by an "
      "impulse "
      "at t = 0; give the bodies the velocities of their drives, or let drives begin with speed 0",
      drives, math::percent(std::min(1.0, model.velocity_correction)));
}

ordered_json first_summary(const scene::Scene& scene, const assembly::Model& model, MPI_Comm comm,
                           const RunResult& result) {
  ordered_json j;
  j["status"] = "running";
  j["scene"] = {{"file", scene.file}, {"title", scene.title}};
  j["formulation"] = scene::name_of(model.formulation);
  j["label"] = result.label;
  j["provenance"] = output::provenance(comm);
  j["unknowns"] = {{"coordinates", model.coordinates}, {"multipliers", model.multipliers}};
  for (const auto& body : model.bodies) j["bodies"].push_back(body_json(body));
  j["motion"] = {
      {"end", scene.motion.end}, {"step", scene.motion.step}, {"spectral_radius", scene.motion.spectral_radius}};
  if (scene.motion.tolerance) j["motion"]["tolerance"] = *scene.motion.tolerance;
  if (model.velocity_correction > 1e-9) j["start_velocity_correction"] = model.velocity_correction;
  j["warnings"] = model.warnings;
  j["seconds"] = {{"offline", result.offline_seconds}};
  j["events"] = ordered_json::array();
  return j;
}

ordered_json estimate_json(const assess::Estimate& estimate, const assembly::Model& model) {
  if (!estimate.none.empty()) return {{"none", estimate.none}};
  ordered_json j;
  if (estimate.by.empty()) j["deformation"] = estimate.deformation;
  for (std::size_t p = 0; p < model.probes.size(); ++p)
    if (!std::isnan(estimate.probes[p])) j["probes"][model.probes[p].name] = estimate.probes[p];
  if (estimate.by.empty()) {
    j["full_order_residuals"] = estimate.samples;
    j["columns"] = estimate.columns;
    j["unbalanced"] = estimate.unbalanced;
  } else {
    j["by"] = estimate.by;
    j["until"] = estimate.t.back();
  }
  j["steps"] = estimate.t.size();
  j["seconds"] = {{"taken", estimate.seconds}, {"allowed", estimate.allowed}};
  if (!estimate.notes.empty()) j["notes"] = estimate.notes;
  return j;
}

}  // namespace floe::app
