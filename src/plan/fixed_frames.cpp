#include "floe/plan/fixed_frames.h"

#include <algorithm>
#include <cmath>

#include "floe/plan/reduced_place.h"
#include "floe/scene/file_places.h"
#include "floe/scene/joint_events.h"

namespace floe::plan {

namespace {

/// Whether a place of a body from a file has no motion in the body's frame.
bool at_rest(const PlannedBody& body, const body::PlaceMap& map) {
  const output::ReducedBodyFile& file = *body.spec.reduced->file;
  const double small = 1e-9 / std::sqrt(file.body.inertia.m);  // columns are normalised to unit mass
  return map.S.cwiseAbs().sum() <= small && map.psi.cwiseAbs().sum() * scene::extent_of(file) <= small;
}

bool is_supported(const Plan& plan, int b) {
  for (std::size_t j = 0; j < plan.joints.size(); ++j)
    if (const Anchor* place = constrained_place(plan, j);
        place && place->body == b && plan.scene.joints[j].kind == Joint::Kind::support)
      return true;
  return false;
}

/// Whether a probe measures what holds the body: then its frame moves, and all of this has constraint equations. Not so
/// of bodies that have supports: HeldReaction.
bool is_constrained_by_measured(const Plan& plan, int b) {
  if (is_supported(plan, b)) return false;
  for (std::size_t j = 0; j < plan.joints.size(); ++j)
    if (const Anchor* place = constrained_place(plan, j);
        place && place->body == b && is_measured(plan.scene, plan.scene.joints[j].name))
      return true;
  return false;
}

}  // namespace

int clamp_of(const Plan& plan, int b) {
  const PlannedBody& body = plan.bodies[b];
  if (body.frame.kind != fem::ReferenceFrame::Kind::clamped || is_constrained_by_measured(plan, b)) return -1;
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const auto& [first, second] = plan.joints[j];
    const Joint& joint = plan.scene.joints[j];
    if (joint.kind != Joint::Kind::fixed || first.ground() == second.ground()) continue;
    if (is_unlocked(plan.scene, joint.name)) continue;
    const Anchor& place = first.ground() ? second : first;
    if (place.body != b || place.rotates_apart()) continue;
    if (place.map ? at_rest(body, *place.map) : place.moved_by(body.frame.conditions.front() / 6))
      return static_cast<int>(j);
  }
  return -1;
}

bool has_fixed_frame(const Plan& plan, int b) {
  if (clamp_of(plan, b) >= 0) return true;
  const PlannedBody& body = plan.bodies[b];
  const fem::Conditions& conditions = body.frame.conditions;
  if (body.frame.kind != fem::ReferenceFrame::Kind::clamped || body.spec.rigid || body.spec.reduced) return false;
  if (is_constrained_by_measured(plan, b)) return false;
  bool firm = false;
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const Joint& joint = plan.scene.joints[j];
    const Anchor* place = constrained_place(plan, j);
    if (!place || place->body != b || !plan.joint_constrained[j]) continue;
    if (std::none_of(conditions.begin(), conditions.end(), [&](PetscInt dof) { return place->moved_by(dof / 6); }))
      continue;
    const bool drives = joint.kind == Joint::Kind::driven || joint.kind == Joint::Kind::driven_slide;
    if (drives || is_switched(plan.scene, joint.name)) return false;
    firm = true;
  }
  return firm && std::includes(body.constrained.begin(), body.constrained.end(), conditions.begin(), conditions.end());
}

}  // namespace floe::plan
