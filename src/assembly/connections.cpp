#include "connections.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "floe/dynamics/local_indices.h"
#include "floe/error.h"

namespace floe::assembly {

std::vector<const dynamics::Connection*> measured(const Connections& all, const scene::Scene& scene,
                                                  const scene::Probe& probe) {
  for (std::size_t j = 0; j < scene.joints.size(); ++j)
    if (const auto found = all.find(j); scene.joints[j].name == probe.joint && found != all.end()) return found->second;
  return {};
}

double relaxed_length(const scene::Joint& joint, double apart, double extent) {
  if (joint.preload == 0) return joint.length.value_or(apart);
  if (!(apart > 1e-12 * extent))
    throw InputError(
        fmt::format("{}: the places of spring {} coincide at the start, which leaves undefined the direction of its "
                    "preload; expected places apart",
                    joint.where.text(), joint.name));
  return apart - joint.preload / joint.stiffness;
}

dynamics::Wrench exerted(const std::vector<const dynamics::Connection*>& connections, double t,
                         const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  dynamics::Wrench sum = dynamics::Wrench::Zero();
  Eigen::VectorXd own, rate;
  for (const dynamics::Connection* connection : connections) {
    dynamics::pick(connection->coordinates(), q, own);
    dynamics::pick(connection->coordinates(), v, rate);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(own.size());
    sum += connection->on_second({t, own, rate, none});
  }
  return sum;
}

void refuse_undetermined(const scene::Scene& scene, const std::vector<int>& joints) {
  const bool flexible = std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const auto& b) { return !b.rigid; });
  const char* remedy = flexible ? ", or formulation nlffr or cfr, where flexible bodies determine them" : "";
  std::vector<std::string> names;
  for (const int j : joints) names.push_back(scene.joints[j].name);
  for (const scene::Probe& probe : scene.probes) {
    if (probe.joint.empty() || std::find(names.begin(), names.end(), probe.joint) == names.end()) continue;
    throw InputError(
        fmt::format("{}.joint: the reaction of joint {} is statically indeterminate in this model: the constraints of "
                    "joints {} are redundant; expected joints that release the redundant constraints{}",
                    probe.where.text(), probe.joint, fmt::join(names, ", "), remedy));
  }
}

}  // namespace floe::assembly
