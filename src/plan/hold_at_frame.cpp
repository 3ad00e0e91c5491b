#include "floe/plan/hold_at_frame.h"

#include "floe/plan/hold_by_joint.h"

namespace floe::plan {
namespace {

/// The node at which the frame is clamped; -1: no such frame, or one on several nodes (fem::constrained_frame).
PetscInt node_of_frame(const PlannedBody& body) {
  const fem::Conditions& dofs = body.frame.conditions;
  if (body.frame.kind != fem::ReferenceFrame::Kind::clamped || dofs.empty()) return -1;
  const PetscInt n = body.structure.dofs_per_node, node = dofs.front() / n;
  return dofs.back() / n == node ? node : -1;
}

/// Whether the joint holds the nodes of its place as one: not their mean, nor each by itself.
bool holds_as_one(const Joint& joint, const Anchor& place) {
  return place.nodes.size() <= 1 || joint.edges == Joint::Edges::rigid || joint.edges == Joint::Edges::line;
}

/// The joint's place on the body at the node of its frame; null: none.
const Anchor* place_at_frame(const Plan& plan, int b, std::size_t joint) {
  const PlannedBody& body = plan.bodies[b];
  if (body.spec.rigid || body.spec.reduced || body.parent >= 0) return nullptr;
  const PetscInt node = node_of_frame(body);
  const auto& [first, second] = plan.joints[joint];
  if (node < 0 || first.ground() || second.ground()) return nullptr;
  for (const Anchor* place : {&first, &second})
    if (place->body == b && !place->rotates_apart() && place->moved_by(node) &&
        holds_as_one(plan.scene.joints[joint], *place))
      return place;
  return nullptr;
}

}  // namespace

bool joins_at_frame(const Plan& plan, int body, std::size_t joint) { return place_at_frame(plan, body, joint); }

fem::Conditions held_at_frame(const Plan& plan, int body) {
  fem::Conditions held;
  for (std::size_t j = 0; j < plan.joints.size(); ++j)
    if (const Anchor* place = place_at_frame(plan, body, j)) hold_place_by_joint(plan, j, *place, held);
  return held;
}

}  // namespace floe::plan
