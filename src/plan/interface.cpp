#include "floe/plan/interface.h"

#include <fmt/format.h>

#include <algorithm>

namespace floe::plan {

std::vector<Lever> Anchor::moved_by() const {
  return levers.empty() ? std::vector<Lever>{{node, 1, Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Identity()}} : levers;
}

bool Anchor::moved_by(PetscInt other) const {
  const std::vector<Lever> all = moved_by();
  return std::any_of(all.begin(), all.end(), [&](const Lever& lever) { return lever.node == other; });
}

std::vector<LoadPart> parts_of_load(const Plan& plan, std::size_t load) {
  const auto parts = plan.load_parts.find(load);
  return parts == plan.load_parts.end() ? std::vector<LoadPart>{{plan.loads[load]}} : parts->second;
}

bool share_a_node(const Anchor& one, const Anchor& other) {
  const std::vector<Lever> levers = one.moved_by();
  return std::any_of(levers.begin(), levers.end(), [&](const Lever& lever) { return other.moved_by(lever.node); });
}

namespace {

/// The joint to the ground that holds a node of the place; empty if none does.
std::string joint_that_holds(const Plan& plan, int index, const Anchor& place) {
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const Anchor* held = held_place(plan, j);
    if (!held || plan.scene.joints[j].kind == Joint::Kind::spring) continue;
    if (held->body == index && share_a_node(*held, place)) return plan.scene.joints[j].name;
  }
  return "";
}

}  // namespace

fem::Conditions held_by_modes(const PlannedBody& body) {
  fem::Conditions held = body.held;
  const int n = body.structure.dofs_per_node;
  for (const Anchor& place : body.interface)
    for (const Lever& lever : place.moved_by())
      for (int d = 0; d < n; ++d) held.push_back(n * lever.node + d);
  std::sort(held.begin(), held.end());
  held.erase(std::unique(held.begin(), held.end()), held.end());
  return held;
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
