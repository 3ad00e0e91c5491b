#include "floe/scene/sensors.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "readers.h"

namespace floe::scene {

using Kind = Joint::Kind;

std::vector<const math::Formula*> Load::formulas() const {
  if (!joint.empty()) return {&on_joint};
  if (kind == Kind::pressure) return {&pressure};
  const auto& all = kind == Kind::moment ? moment : force;
  return {&all[0], &all[1], &all[2]};
}

bool Load::has_sensors() const {
  const auto all = formulas();
  return std::any_of(all.begin(), all.end(), [](const math::Formula* formula) { return formula->has_sensors(); });
}

std::vector<JointCoordinate> coordinates_of(const Joint& joint, int dimension) {
  switch (joint.kind) {
    case Kind::revolute:
    case Kind::driven:
      return {JointCoordinate::rotation};
    case Kind::prismatic:
    case Kind::driven_slide:
      return {JointCoordinate::travel};
    case Kind::cylindrical:
      return {JointCoordinate::travel, JointCoordinate::rotation};
    case Kind::spring:
      if (dimension == 3 && !joint.axis_given) return {JointCoordinate::length};
      return {JointCoordinate::length, JointCoordinate::rotation};
    default:
      return {};
  }
}

JointCoordinate loaded_coordinate(const Load& load, const Joint& joint, int dimension) {
  const bool moment = load.kind == Load::Kind::moment;
  if (joint.kind == Kind::driven || joint.kind == Kind::driven_slide)
    throw InputError(fmt::format("{}.joint: the motion of joint {} is prescribed; expected a joint that is free",
                                 load.where.text(), joint.name));
  for (const JointCoordinate of : coordinates_of(joint, dimension))
    if ((of == JointCoordinate::rotation) == moment) return of;
  throw InputError(fmt::format("{}.joint: joint {} has no {}; expected {}", load.where.text(), joint.name,
                               moment ? "angle" : "travel or length",
                               moment ? "a revolute or cylindrical joint, or a spring (in space with axis)"
                                      : "a prismatic or cylindrical joint, or a spring"));
}

std::vector<std::string> components_of(Probe::Quantity quantity, int dimension) {
  const bool plane = dimension == 2;
  using Words = std::vector<std::string>;
  switch (quantity) {
    case Probe::Quantity::formula:
      return {"value"};
    case Probe::Quantity::section_force:
      return plane ? Words{"N", "V"} : Words{"N", "Vy", "Vz"};
    case Probe::Quantity::section_moment:
      return plane ? Words{"M"} : Words{"T", "My", "Mz"};
    case Probe::Quantity::principal_stress:
      return {"first", "second"};
    case Probe::Quantity::von_mises_stress:
      return {"mises"};
    case Probe::Quantity::drive:
    case Probe::Quantity::power:
    case Probe::Quantity::kinetic_energy:
    case Probe::Quantity::strain_energy:
      return {"value"};
    case Probe::Quantity::strain:
    case Probe::Quantity::stress:
    case Probe::Quantity::membrane_force:
    case Probe::Quantity::bending_moment:
      return {"xx", "yy", "xy"};
    default:
      break;
  }
  if (quantity == Probe::Quantity::rotation)
    return plane ? std::vector<std::string>{"angle"} : std::vector<std::string>{"rx", "ry", "rz"};
  if (plane && (quantity == Probe::Quantity::angular_velocity || quantity == Probe::Quantity::angular_acceleration ||
                quantity == Probe::Quantity::moment))
    return {"z"};
  return plane ? std::vector<std::string>{"x", "y"} : std::vector<std::string>{"x", "y", "z"};
}

namespace {

/// Whether a load may depend on it.
bool is_sensed(Probe::Quantity quantity) {
  switch (quantity) {
    case Probe::Quantity::position:
    case Probe::Quantity::displacement:
    case Probe::Quantity::velocity:
    case Probe::Quantity::rotation:
    case Probe::Quantity::angular_velocity:
      return true;
    default:
      return false;
  }
}

const char* name_of(JointCoordinate of, bool rate) {
  switch (of) {
    case JointCoordinate::rotation:
      return rate ? "rate" : "angle";
    case JointCoordinate::travel:
      return rate ? "speed" : "travel";
    case JointCoordinate::length:
      return rate ? "length_rate" : "length";
  }
  throw std::logic_error("a coordinate without a name");
}

}  // namespace

std::vector<std::pair<std::string, Sensor>> sensors_of(const Scene& scene) {
  std::vector<std::pair<std::string, Sensor>> all;
  for (std::size_t j = 0; j < scene.joints.size(); ++j)
    for (const JointCoordinate of : coordinates_of(scene.joints[j], scene.dimension))
      for (const bool rate : {false, true})
        all.emplace_back(scene.joints[j].name + "." + name_of(of, rate), Sensor{static_cast<int>(j), -1, of, rate, 0});
  for (std::size_t p = 0; p < scene.probes.size(); ++p) {
    if (!is_sensed(scene.probes[p].quantity)) continue;
    const auto components = components_of(scene.probes[p].quantity, scene.dimension);
    for (std::size_t c = 0; c < components.size(); ++c)
      all.emplace_back(scene.probes[p].name + "." + components[c],
                       Sensor{-1, static_cast<int>(p), {}, false, static_cast<int>(c)});
  }
  return all;
}

Sensor sensor_of(const Scene& scene, const std::string& name) {
  for (const auto& [known, sensor] : sensors_of(scene))
    if (known == name) return sensor;
  throw std::logic_error("no sensor " + name);
}

std::size_t joint_index(const Scene& scene, const std::string& name) {
  const auto found =
      std::find_if(scene.joints.begin(), scene.joints.end(), [&](const Joint& joint) { return joint.name == name; });
  if (found == scene.joints.end()) throw std::logic_error("no joint " + name);
  return static_cast<std::size_t>(found - scene.joints.begin());
}

namespace {

void check_sensor(Document& document, const Scene& scene, const Where& where, const std::string& name) {
  const auto all = sensors_of(scene);
  const auto count = std::count_if(all.begin(), all.end(), [&](const auto& known) { return known.first == name; });
  if (count == 1) return;
  if (count > 1)
    return document.fault(where, fmt::format("depends on \"{}\", which is both of a joint and of a probe", name),
                          "names that differ");
  const std::string owner = name.substr(0, name.find('.'));
  for (const Probe& probe : scene.probes)
    if (probe.name == owner && !is_sensed(probe.quantity))
      return document.fault(
          where,
          fmt::format("depends on \"{}\", {}", name,
                      probe.quantity == Probe::Quantity::formula ? "another formula"
                      : !probe.joint.empty()                     ? "a reaction, which itself depends on the loads"
                      : probe.of_section() || probe.of_shell() ? "an internal force, which itself depends on the loads"
                      : probe.of_acceleration()                ? "an acceleration, which itself depends on the loads"
                      : probe.of_body()                        ? "an energy"
                                                               : "a deflection"),
          "positions, rotations and their rates");
  std::vector<std::string> names;
  for (const auto& known : all) names.push_back(known.first);
  document.fault(where, fmt::format("depends on \"{}\", which no joint and no probe has", name),
                 "JOINT.angle, rate, travel, speed, length or length_rate, or PROBE.COMPONENT", name, names);
}

}  // namespace

void place_loads(Document& document, Scene& scene) {
  for (const Probe& probe : scene.probes)
    for (std::size_t i = 1; i < probe.formula.variables().size(); ++i) {
      Where where = probe.where;
      where.key += ".formula";
      check_sensor(document, scene, where, probe.formula.variables()[i]);
    }
  std::vector<std::string> names;
  for (const Joint& joint : scene.joints) names.push_back(joint.name);
  for (Load& load : scene.loads) {
    for (const math::Formula* formula : load.formulas())
      for (std::size_t i = 1; i < formula->variables().size(); ++i) {
        Where where = load.where;
        where.key += load.kind == Load::Kind::moment     ? ".moment"
                     : load.kind == Load::Kind::pressure ? ".pressure"
                                                         : ".force";
        check_sensor(document, scene, where, formula->variables()[i]);
      }
    if (load.joint.empty()) continue;
    Where where = load.where;
    where.key += ".joint";
    const auto found = std::find(names.begin(), names.end(), load.joint);
    if (found == names.end()) {
      document.fault(where, "is \"" + load.joint + "\"", "the name of a joint", load.joint, names);
      continue;
    }
    const Joint& joint = scene.joints[static_cast<std::size_t>(found - names.begin())];
    load.at = joint.second.ground() ? joint.first : joint.second;
    try {
      loaded_coordinate(load, joint, scene.dimension);
    } catch (const InputError& error) {
      document.fault(where, error);
    }
  }
}

}  // namespace floe::scene
