#include <fmt/format.h>

#include <algorithm>

#include "floe/plan/prepare_spatial.h"

namespace floe::plan {
namespace {

/// The ground is one body, wherever it is constrained; but rods from several of its points may lead to one place.
bool same_place(const Anchor& one, const Anchor& other, bool rods = false) {
  if (one.ground() || other.ground()) return one.ground() && other.ground() && (!rods || one.x == other.x);
  return one.body == other.body && one.node == other.node && one.nodes == other.nodes && one.x == other.x;
}

}  // namespace

void check_pairs(const Plan& plan) {
  std::vector<std::string> faults;
  const auto apart = [](const Joint& joint) {
    return joint.kind == Joint::Kind::spring || joint.kind == Joint::Kind::bushing;
  };
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const Joint& joint = plan.scene.joints[j];
    const auto& [first, second] = plan.joints[j];
    if (first.body == Anchor::elsewhere || second.body == Anchor::elsewhere) continue;
    if (same_place(first, second))
      faults.push_back(joint.where.text() + ": connects a place with itself; expected two different places");
    for (std::size_t i = 0; i < j && !apart(joint); ++i) {
      const auto& [one, other] = plan.joints[i];
      const Joint& before = plan.scene.joints[i];
      if (apart(before)) continue;
      const bool rods = joint.kind == Joint::Kind::distance || before.kind == Joint::Kind::distance;
      if (!(same_place(one, first, rods) && same_place(other, second, rods)) &&
          !(same_place(one, second, rods) && same_place(other, first, rods)))
        continue;
      faults.push_back(
          fmt::format("{}: connects the same two places as joint {} (line {}); expected one joint for a pair of places "
                      "(besides springs)",
                      joint.where.text(), before.name, before.where.line));
      break;
    }
  }
  if (!faults.empty()) throw InputError(faults);
}

}  // namespace floe::plan
