#include <algorithm>

#include "readers.h"

namespace floe::scene {

Probe read_probe(Document& document, const std::string& name, const Value& value) {
  using Quantity = Probe::Quantity;
  Probe probe;
  probe.name = name;
  probe.where = value.where;
  Reading reading(document, value, "probe");
  if (!value.node.IsMap()) return probe;
  const std::string of = reading.one_of({"at", "joint"});
  if (const auto at = reading.value("at")) probe.at = read_place(document, *at, reading.key("at"));
  if (of == "joint") probe.joint = reading.text("joint");
  if (const auto from = reading.value("relative_to"))
    probe.relative_to = read_place(document, *from, reading.key("relative_to"));
  if (of == "joint") probe.quantity = Quantity::force;
  if (reading.given("quantity"))
    probe.quantity = reading.choice<Quantity>("quantity", {{"position", Quantity::position},
                                                           {"displacement", Quantity::displacement},
                                                           {"deflection", Quantity::deflection},
                                                           {"velocity", Quantity::velocity},
                                                           {"rotation", Quantity::rotation},
                                                           {"angular_velocity", Quantity::angular_velocity},
                                                           {"force", Quantity::force},
                                                           {"moment", Quantity::moment}});
  const bool exerted = probe.quantity == Quantity::force || probe.quantity == Quantity::moment;
  if (exerted != (of == "joint") && !of.empty())
    document.fault(reading.where("quantity"),
                   of == "joint" ? "does not apply to a joint" : "is exerted by joints, and does not apply to a place",
                   of == "joint" ? "force or moment" : "joint: NAME instead of at");
  if (probe.relative_to && probe.quantity == Quantity::deflection)
    document.fault(reading.where("relative_to"),
                   "does not apply to a deflection, which is measured in the body's frame",
                   "another quantity, or none");
  return probe;
}

void place_probes(Document& document, Scene& scene) {
  std::vector<std::string> names;
  for (const Joint& joint : scene.joints) names.push_back(joint.name);
  for (Probe& probe : scene.probes) {
    if (probe.joint.empty()) continue;
    const auto found = std::find(names.begin(), names.end(), probe.joint);
    if (found == names.end()) {
      Where where = probe.where;
      where.key += ".joint";
      document.fault(where, "is \"" + probe.joint + "\"", "the name of a joint", probe.joint, names);
      continue;
    }
    const Joint& joint = scene.joints[static_cast<std::size_t>(found - names.begin())];
    probe.at = joint.second.ground() ? joint.first : joint.second;
  }
}

}  // namespace floe::scene
