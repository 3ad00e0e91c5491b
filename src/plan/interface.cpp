#include "floe/plan/interface.h"

#include <fmt/format.h>

#include <algorithm>

#include "floe/math/rotation.h"
#include "floe/plan/hold_at_frame.h"

namespace floe::plan {

std::vector<AveragingWeight> Anchor::moved_by() const {
  return averaging_weights.empty()
             ? std::vector<AveragingWeight>{{node, 1, Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Identity()}}
             : averaging_weights;
}

bool Anchor::moved_by(PetscInt other) const {
  const std::vector<AveragingWeight> all = moved_by();
  return std::any_of(all.begin(), all.end(), [&](const AveragingWeight& weight) { return weight.node == other; });
}

bool Anchor::rigid_arm() const {
  if (averaging_weights.size() != 1) return false;
  const AveragingWeight& one = averaging_weights.front();
  const double round_off = 1e-12 * one.lead.norm();
  return round_off > 0 && std::abs(one.share - 1) < 1e-12 && one.turn.isZero(0) &&
         (one.arm + math::skew(one.lead)).norm() <= round_off &&
         (one.rotation - Eigen::Matrix3d::Identity()).norm() < 1e-12;
}

std::vector<LoadPart> parts_of_load(const Plan& plan, std::size_t load) {
  const auto parts = plan.load_parts.find(load);
  return parts == plan.load_parts.end() ? std::vector<LoadPart>{{plan.loads[load]}} : parts->second;
}

bool share_a_node(const Anchor& one, const Anchor& other) {
  const std::vector<AveragingWeight> averaging_weights = one.moved_by();
  return std::any_of(averaging_weights.begin(), averaging_weights.end(),
                     [&](const AveragingWeight& weight) { return other.moved_by(weight.node); });
}

namespace {

/// The joint to the ground that holds a node of the place; empty if none does.
std::string joint_that_holds(const Plan& plan, int index, const Anchor& place) {
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const Anchor* constrained = constrained_place(plan, j);
    if (!constrained || plan.scene.joints[j].kind == Joint::Kind::spring) continue;
    if (constrained->body == index && share_a_node(*constrained, place)) return plan.scene.joints[j].name;
  }
  return "";
}

}  // namespace

fem::Conditions constrained_by_modes(const Plan& plan, int index) {
  const PlannedBody& body = plan.bodies[index];
  fem::Conditions constrained = body.constrained;
  const fem::Conditions at_frame = held_at_frame(plan, index);
  constrained.insert(constrained.end(), at_frame.begin(), at_frame.end());
  const int n = body.structure.dofs_per_node;
  for (const Anchor& place : body.interface)
    for (const AveragingWeight& weight : place.moved_by())
      for (int d = 0; d < n; ++d) constrained.push_back(n * weight.node + d);
  std::sort(constrained.begin(), constrained.end());
  constrained.erase(std::unique(constrained.begin(), constrained.end()), constrained.end());
  return constrained;
}

void check_interface(const Plan& plan, int index) {
  const PlannedBody& body = plan.bodies[index];
  std::vector<std::string> faults;
  for (std::size_t i = 0; i < body.interface.size(); ++i) {
    const std::string where = body.spec.reduction.interface[i].where.text();
    const std::string joint = body.structure.dimension() == 3 ? joint_that_holds(plan, index, body.interface[i]) : "";
    if (!joint.empty())
      faults.push_back(
          fmt::format("{}: has a node fixed by joint {}; expected a place without joint to the ground", where, joint));
    for (std::size_t j = 0; j < i; ++j)
      if (share_a_node(body.interface[i], body.interface[j]))
        faults.push_back(
            fmt::format("{}: shares a node with interface[{}]; expected places without common nodes, each of which is "
                        "a rigid region",
                        where, j + 1));
  }
  if (!faults.empty()) throw InputError(faults);
}

}  // namespace floe::plan
