#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "readers.h"

namespace floe::scene {
namespace {

/// A spring of which nothing is said does nothing; an explicit zero is a choice.
void check_spring(Document& document, const Reading& reading, const Where& where) {
  for (const char* key : {"stiffness", "viscosity", "torsional_stiffness", "torsional_viscosity"})
    if (reading.given(key)) return;
  document.fault(where, "has no stiffness and no viscosity",
                 "one of stiffness, viscosity, torsional_stiffness, torsional_viscosity");
}

void check_preload(Document& document, const Reading& reading, const Joint& joint) {
  if (reading.given("preload") && reading.given("length"))
    document.fault(reading.where("preload"), "is given together with length", "one of them");
  if (joint.preload != 0 && joint.stiffness == 0)
    document.fault(reading.where("preload"), "is given without stiffness", "stiffness > 0");
  if (joint.rest_angle != 0 && joint.torsional_stiffness == 0)
    document.fault(reading.where("rest_angle"), "is given without torsional_stiffness", "torsional_stiffness > 0");
}

void check_bushing(Document& document, const Reading& reading, const Where& where) {
  for (const char* key : {"translation", "rotation", "translation_viscosity", "rotation_viscosity"})
    if (reading.given(key)) return;
  document.fault(where, "has no stiffness and no viscosity",
                 "one of translation, rotation, translation_viscosity, rotation_viscosity");
}

using Kind = Joint::Kind;

const std::vector<std::pair<std::string, Kind>> kinds{{"fixed", Kind::fixed},
                                                      {"revolute", Kind::revolute},
                                                      {"prismatic", Kind::prismatic},
                                                      {"driven", Kind::driven},
                                                      {"spring", Kind::spring},
                                                      {"cylindrical", Kind::cylindrical},
                                                      {"spherical", Kind::spherical},
                                                      {"universal", Kind::universal},
                                                      {"planar", Kind::planar},
                                                      {"distance", Kind::distance},
                                                      {"driven_slide", Kind::driven_slide},
                                                      {"bushing", Kind::bushing},
                                                      {"support", Kind::support}};

void read_axes(Document& document, Reading& reading, Joint& joint) {
  const auto direction = [&](const char* key) {
    const Point axis = reading.point(key);
    if (axis == Point{})
      document.fault(reading.where(key), document.dimension == 2 ? "is [0, 0]" : "is [0, 0, 0]", "a direction");
    return axis;
  };
  joint.axis_given = reading.given("axis");
  if (joint.axis_given) joint.axis = direction("axis");
  if (joint.axis_given && document.dimension == 2 && joint.kind != Kind::prismatic)
    document.fault(reading.where("axis"), fmt::format("does not apply to type {}", reading.text("type")),
                   "this key only with type prismatic in planar scenes");
  if (reading.given("second_axis")) joint.second_axis = direction("second_axis");
}

void check_axes(Document& document, const Reading& reading, const Joint& joint) {
  const auto needs = [&](const char* key) {
    if (!reading.given(key)) document.fault(reading.where(key), "is missing", "three numbers [x, y, z]");
  };
  switch (joint.kind) {
    case Kind::universal:
      needs("axis"), needs("second_axis");
      break;
    case Kind::prismatic:
    case Kind::cylindrical:
    case Kind::planar:
    case Kind::driven_slide:
      needs("axis");
      break;
    case Kind::spring:
      if (joint.torsional_stiffness != 0 || joint.torsional_viscosity != 0) needs("axis");
      break;
    default:
      break;
  }
}

/// @returns false  after a fault: it depends on sensors, as only loads may
bool depends_on_time_alone(Document& document, Reading& reading, const char* key) {
  const std::string text = reading.text(key);
  bool senses = false;
  try {
    senses = math::Formula::of_sensors(text, document.names).has_sensors();
  } catch (const math::FormulaError&) {  // reported where it is read
  }
  if (senses)
    document.fault(reading.where(key),
                   fmt::format("depends on a sensor ({}): a drive prescribes its joint as a constraint, whose reaction "
                               "would act on what is sensed, too",
                               in_quotes(text)),
                   "a formula of t, or a joint that is free, with a load on it that follows the sensor: force or "
                   "moment \"-k*(JOINT.angle - ...) - d*JOINT.rate\"");
  return !senses;
}

/// A formula of the coordinate, or of its rate.
void read_drive(Document& document, Reading& reading, const char* key, math::Formula& value,
                std::optional<math::Formula>& speed) {
  if (reading.given(key) == reading.given("speed"))
    document.fault(
        reading.where(reading.given("speed") ? "speed" : key),
        reading.given("speed") ? fmt::format("is given together with {}", key) : "is missing, and so is speed",
        fmt::format("either {} or speed", key));
  else if (const char* given = reading.given(key) ? key : "speed"; depends_on_time_alone(document, reading, given))
    (given == key ? value : speed.emplace()) = reading.formula(given);
}

std::optional<LimitsSpec> read_limits(Document& document, Reading& joint, const char* key) {
  const auto value = joint.value(key);
  if (!value) return {};
  Reading reading(document, *value, "limits");
  LimitsSpec limits;
  limits.where = value->where;
  limits.lower = reading.optional_number("lower").value_or(limits.lower);
  limits.upper = reading.optional_number("upper").value_or(limits.upper);
  limits.stiffness = reading.number("stiffness");
  limits.damping = reading.number("damping");
  limits.width = reading.optional_number("width");
  if (!reading.given("lower") && !reading.given("upper"))
    document.fault(value->where, "has no limit", "lower, upper or both");
  else if (!(limits.lower < limits.upper))
    document.fault(value->where, fmt::format("go from {:.6g} to {:.6g}", limits.lower, limits.upper),
                   "a lower limit below the upper one");
  return limits;
}

std::optional<FrictionSpec> read_friction(Document& document, Reading& joint, const char* key) {
  const auto value = joint.value(key);
  if (!value) return {};
  Reading reading(document, *value, "friction");
  FrictionSpec friction{reading.number("level"), reading.number("viscosity"), reading.number("speed"), value->where};
  if (friction.level == 0 && friction.viscosity == 0)
    document.fault(value->where, "has no level and no viscosity", "level, viscosity or both");
  return friction;
}

/// Components by name, as many as `set` has.
void read_components(Document& document, Reading& reading, const char* key, std::span<bool> set) {
  static const std::vector<std::string> components{"x", "y", "z", "rx", "ry", "rz"};
  const auto value = reading.value(key);
  if (!value) return;
  const auto end = components.begin() + static_cast<std::ptrdiff_t>(set.size());
  for (const std::string& component : read_texts(document, *value, reading.key(key))) {
    const auto found = std::find(components.begin(), end, component);
    if (found == end)
      document.fault(value->where, fmt::format("contains \"{}\"", component),
                     fmt::format("{}", fmt::join(components.begin(), end, ", ")));
    else
      set[static_cast<std::size_t>(found - components.begin())] = true;
  }
}

void read_support(Document& document, Reading& reading, Joint& joint) {
  joint.edges = Joint::Edges::mean;  // no rigid region
  read_components(document, reading, "hold", joint.hold);
  read_components(document, reading, "straight", joint.straight);
  if (!reading.given("hold") && !reading.given("straight"))
    document.fault(reading.where("hold"), "is missing", "hold, straight or both");
  for (std::size_t i = 0; i < joint.straight.size(); ++i)
    if (joint.straight[i] && joint.hold[i])
      document.fault(reading.where("straight"), fmt::format("contains \"{}\", as hold does", "xyz"[i]),
                     "components that are not zero");
  if (joint.first.ground() == joint.second.ground() && !joint.first.body.empty() && !joint.second.body.empty())
    document.fault(reading.where("between"), "has no place or two of the ground", "the ground and a place of a body");
}

void read_properties(Document& document, Reading& reading, Joint& joint) {
  if (joint.kind == Kind::driven) read_drive(document, reading, "angle", joint.angle, joint.speed);
  if (joint.kind == Kind::driven_slide) read_drive(document, reading, "position", joint.position, joint.speed);
  if (joint.kind == Kind::support) return read_support(document, reading, joint);
  joint.limits = read_limits(document, reading, "limits");
  if (document.dimension == 3) joint.rotation_limits = read_limits(document, reading, "turn_limits");
  joint.friction = read_friction(document, reading, "friction");
  if (document.dimension == 3) joint.rotation_friction = read_friction(document, reading, "turn_friction");
  using Edges = Joint::Edges;
  const bool holds_rotations = joint.kind == Kind::fixed || joint.kind == Kind::prismatic ||
                               joint.kind == Kind::driven || joint.kind == Kind::driven_slide;
  const bool rotations = joint.kind == Kind::revolute || joint.kind == Kind::cylindrical;
  joint.edges = holds_rotations ? Edges::rigid : rotations ? Edges::line : Edges::mean;
  joint.edges_given = reading.given("edges");
  if (joint.edges_given)
    joint.edges =
        reading.choice<Edges>("edges", {{"rigid", Edges::rigid}, {"mean", Edges::mean}, {"line", Edges::line}});
  if (joint.edges == Edges::line && !rotations)
    document.fault(reading.where("edges"), fmt::format("is line at a joint of type {}", reading.text("type")),
                   "rigid or mean; line with type revolute or cylindrical");
  joint.stiffness = reading.number("stiffness");
  joint.viscosity = reading.number("viscosity");
  joint.length = reading.optional_number("length");
  joint.torsional_stiffness = reading.number("torsional_stiffness");
  joint.torsional_viscosity = reading.number("torsional_viscosity");
  joint.translation = reading.three("translation");
  joint.rotation = reading.three("rotation");
  joint.translation_viscosity = reading.three("translation_viscosity");
  joint.rotation_viscosity = reading.three("rotation_viscosity");
  joint.preload = reading.number("preload");
  joint.rest_angle = reading.number("rest_angle");
  if (joint.kind == Kind::spring) {
    check_spring(document, reading, reading.where("type"));
    check_preload(document, reading, joint);
  }
  if (joint.kind == Kind::bushing) check_bushing(document, reading, reading.where("type"));
}

}  // namespace

Joint read_joint(Document& document, const std::string& name, const Value& value) {
  Joint joint;
  joint.name = name;
  joint.where = value.where;
  Reading reading(document, value, "joint");
  if (!value.node.IsMap()) return joint;
  const std::size_t before = document.fault_count();
  joint.kind = reading.choice<Kind>("type", kinds);
  const bool known = document.fault_count() == before;
  if (known && document.dimension == 2 && joint.kind > Kind::spring)
    document.fault(reading.where("type"), "is " + reading.text("type"),
                   "fixed, revolute, prismatic, driven or spring in a planar scene");
  if (known) reading.set_kind(reading.text("type"));
  if (const auto between = reading.value("between")) {
    const auto places = read_list(document, *between, reading.key("between"), 2);
    if (places.size() == 2) {
      joint.first = read_place(document, places[0], reading.key("between"));
      joint.second = read_place(document, places[1], reading.key("between"));
    }
  }
  if (!known) return joint;
  read_axes(document, reading, joint);
  read_properties(document, reading, joint);
  if (document.dimension == 3) check_axes(document, reading, joint);
  return joint;
}

}  // namespace floe::scene
