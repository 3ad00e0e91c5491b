#include "stretched_start.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "floe/assembly/body_stage.h"
#include "floe/assembly/start_vectors.h"

namespace floe::assembly {

std::string stretched_start(const Plan& plan, const Model& model) {
  const auto sprung = [](const Joint& joint) {
    return joint.kind == Joint::Kind::spring || joint.kind == Joint::Kind::bushing || joint.limits ||
           joint.rotation_limits;
  };
  if (std::any_of(plan.scene.joints.begin(), plan.scene.joints.end(), sprung)) return "";
  double linear = 0;
  std::vector<std::string> names;
  for (const PlannedBody& body : plan.bodies) {
    if (!starts_deformed(body) || !body.deformation) continue;
    linear += body.linear_start_energy;
    const std::string& whole = whole_name(body.spec);
    if (names.empty() || names.back() != whole) names.push_back(whole);
  }
  if (names.empty() || !(linear > 0)) return "";
  const double ratio = model.system->energy(0, model.U, model.V).elastic / linear;
  if (!(ratio > most_stretch)) return "";
  return fmt::format(
      "initial.deformation of {}: its strain energy is {:.2g} times that of its linear strains (limit {}): the "
      "deflections "
      "stretch the body; add their shortening, u' = -w'^2/2, or start from an equilibrium under loads (motion: "
      "{{start: equilibrium}})",
      fmt::join(names, ", "), ratio, most_stretch);
}

}  // namespace floe::assembly
