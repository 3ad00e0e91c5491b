#include <algorithm>
#include <map>

#include "readers.h"

namespace floe::scene {

namespace {

void read_shell_keys(Document& document, Reading& reading, Probe& probe) {
  using Surface = Probe::Surface;
  if (reading.given("surface")) {
    probe.surface = reading.choice<Surface>(
        "surface", {{"middle", Surface::middle}, {"top", Surface::top}, {"bottom", Surface::bottom}});
    if (!probe.of_stress())
      document.fault(reading.where("surface"), "applies to stresses and strains of shells only",
                     "quantity: stress, or none");
  }
  if (reading.given("layer")) {
    probe.layer = reading.integer("layer");
    if (!probe.of_stress())
      document.fault(reading.where("layer"), "applies to stresses and strains of shells only",
                     "quantity: stress, or none");
  }
  if (reading.given("axis")) {
    probe.axis = reading.point("axis");
    if (!probe.of_shell())
      document.fault(reading.where("axis"), "applies to shells only", "quantity: stress, membrane_force, ..., or none");
    if (probe.axis == Point{0, 0, 0}) document.fault(reading.where("axis"), "is zero", "a direction");
  }
}

/// Coordinates of joints, which formulas know as sensors.
const std::map<std::string, std::string>& coordinate_units() {
  static const std::map<std::string, std::string> units{{"angle", "rad"}, {"rate", "rad/s"}, {"travel", "m"},
                                                        {"speed", "m/s"}, {"length", "m"},   {"length_rate", "m/s"}};
  return units;
}

Probe::Quantity quantity_named(const std::string& name) {
  using Quantity = Probe::Quantity;
  static const std::map<std::string, Quantity> known{{"position", Quantity::position},
                                                     {"displacement", Quantity::displacement},
                                                     {"deflection", Quantity::deflection},
                                                     {"velocity", Quantity::velocity},
                                                     {"rotation", Quantity::rotation},
                                                     {"angular_velocity", Quantity::angular_velocity},
                                                     {"acceleration", Quantity::acceleration},
                                                     {"angular_acceleration", Quantity::angular_acceleration},
                                                     {"force", Quantity::force},
                                                     {"moment", Quantity::moment},
                                                     {"drive", Quantity::drive},
                                                     {"power", Quantity::power},
                                                     {"kinetic_energy", Quantity::kinetic_energy},
                                                     {"strain_energy", Quantity::strain_energy},
                                                     {"section_force", Quantity::section_force},
                                                     {"section_moment", Quantity::section_moment},
                                                     {"stress", Quantity::stress},
                                                     {"principal_stress", Quantity::principal_stress},
                                                     {"von_mises_stress", Quantity::von_mises_stress},
                                                     {"strain", Quantity::strain},
                                                     {"membrane_force", Quantity::membrane_force},
                                                     {"bending_moment", Quantity::bending_moment}};
  const auto found = known.find(name);
  return found == known.end() ? Quantity::formula : found->second;  // angle, ...: of joints alone
}

/// A coordinate of a joint as the formula of its sensor. @return whether it is one
bool read_coordinate(Document& document, Reading& reading, const std::string& quantity, Probe& probe) {
  const auto unit = coordinate_units().find(quantity);
  if (unit == coordinate_units().end()) return false;
  probe.quantity = Probe::Quantity::formula;
  probe.unit = unit->second;
  try {
    probe.formula = math::Formula::of_sensors(reading.text("joint") + "." + quantity, {});
  } catch (const math::FormulaError&) {
    document.fault(reading.where("joint"), "is no name that formulas can have",
                   "a joint named by letters, digits and _");
  }
  for (const char* key : {"unit", "relative_to", "axes"})
    if (reading.given(key)) document.fault(reading.where(key), "does not apply to a coordinate of a joint", "none");
  return true;
}

/// Whether what is recorded is of a place, of a joint or of a body.
void check_owner(Document& document, const Reading& reading, const std::string& of, const Probe& probe) {
  if (of.empty()) return;
  const bool joint = of == "joint", body = of == "body";
  if (probe.quantity == Probe::Quantity::formula) {
    document.fault(reading.where("quantity"), "is of joints", "joint: NAME instead of " + of);
  } else if (probe.of_joint() != joint) {
    document.fault(
        reading.where("quantity"),
        joint ? "does not apply to a joint" : "is exerted by joints, and does not apply to a " + (body ? of : "place"),
        joint ? "force, moment, drive, power, angle, rate, travel, speed, length or length_rate"
              : "joint: NAME instead of " + of);
  } else if (probe.of_body() != body) {
    document.fault(reading.where("quantity"),
                   body ? "does not apply to a body" : "is of a body, and does not apply to a place",
                   body ? "kinetic_energy or strain_energy" : "body: NAME instead of at");
  }
  if (probe.relative_to &&
      (body || probe.quantity == Probe::Quantity::drive || probe.quantity == Probe::Quantity::power))
    document.fault(reading.where("relative_to"), "does not apply to energies, drives and powers", "none");
}

/// In which axes the force or moment of a joint is given.
void read_axes(Document& document, Reading& reading, Probe& probe) {
  if (!reading.given("axes")) return;
  probe.joint_axes = reading.choice<bool>("axes", {{"world", false}, {"ground", false}, {"joint", true}});
  if (probe.quantity != Probe::Quantity::force && probe.quantity != Probe::Quantity::moment)
    document.fault(reading.where("axes"), "applies to forces and moments of joints only",
                   "quantity: force or moment of a joint, or none");
  else if (probe.relative_to)
    document.fault(reading.where("axes"), "is given beside relative_to, which gives the axes, too", "one of them");
}

}  // namespace

Probe read_probe(Document& document, const std::string& name, const Value& value) {
  using Quantity = Probe::Quantity;
  Probe probe;
  probe.name = name;
  probe.where = value.where;
  Reading reading(document, value, "probe");
  if (!value.node.IsMap()) return probe;
  const std::string of = reading.one_of({"at", "joint", "body", "formula"});
  const std::string quantity = reading.given("quantity") ? reading.choice("quantity") : "";
  if (of == "joint" && read_coordinate(document, reading, quantity, probe)) return probe;
  if (of == "formula") {
    probe.quantity = Quantity::formula;
    probe.formula = read_formula(document, *reading.value("formula"), reading.key("formula"), {"t"});
    probe.unit = reading.text("unit");
    for (const char* key : {"quantity", "relative_to", "axes"})
      if (reading.given(key))
        document.fault(reading.where(key), "does not apply to a formula", "formula and unit alone");
    return probe;
  }
  if (reading.given("unit")) document.fault(reading.where("unit"), "is given without formula", "unit of a formula");
  if (const auto at = reading.value("at")) probe.at = read_place(document, *at, reading.key("at"));
  if (of == "joint") probe.joint = reading.text("joint");
  if (const auto from = reading.value("relative_to"))
    probe.relative_to = read_place(document, *from, reading.key("relative_to"));
  if (of == "body") probe.body = reading.text("body");
  if (of == "joint") probe.quantity = Quantity::force;
  if (of == "body") probe.quantity = Quantity::strain_energy;
  if (!quantity.empty()) probe.quantity = quantity_named(quantity);
  check_owner(document, reading, of, probe);
  read_axes(document, reading, probe);
  if (probe.relative_to && probe.quantity == Quantity::deflection)
    document.fault(reading.where("relative_to"),
                   "does not apply to a deflection, which is measured in the body's frame",
                   "another quantity, or none");
  read_shell_keys(document, reading, probe);
  if (probe.relative_to && (probe.of_section() || probe.of_shell()))
    document.fault(reading.where("relative_to"), "does not apply to sections and shells, whose own axes count",
                   "another quantity, or none");
  if (const auto toward = reading.value("toward")) {
    probe.toward = read_place(document, *toward, reading.key("toward"));
    if (!probe.of_section() && !probe.of_shell())
      document.fault(reading.where("toward"), "applies to sections of beams and to shells only",
                     "quantity: section_force, stress, ..., or none");
    else if (probe.toward->body != probe.at.body)
      document.fault(reading.where("toward"), "is on body " + probe.toward->body, "a place of body " + probe.at.body);
  }
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
