#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "floe/scene/scene.h"
#include "floe/scene/schema.h"
#include "schema_parts.h"

namespace floe::scene {

bool Range::contains(double value) const {
  return std::isfinite(value) && (least_excluded ? value > least : value >= least) &&
         (greatest_excluded ? value < greatest : value <= greatest);
}

std::string Range::text() const {
  const char* below = least_excluded ? "<" : "<=";
  const char* above = greatest_excluded ? "<" : "<=";
  if (std::isinf(least) && std::isinf(greatest)) return "";
  if (std::isinf(greatest)) return fmt::format("{} {}", least_excluded ? ">" : ">=", least);
  if (std::isinf(least)) return fmt::format("{} {}", above, greatest);
  return fmt::format("{} {} value {} {}", least, below, above, greatest);
}

const Key& SchemaSection::key(const std::string& wanted) const {
  for (const Key& candidate : keys) {
    if (candidate.name == wanted) return candidate;
  }
  throw std::logic_error("the grammar has no key " + name + "." + wanted);
}

const SchemaSection& schema_section(const std::string& name) {
  for (const SchemaSection& section : schema()) {
    if (section.name == name) return section;
  }
  throw std::logic_error("the grammar has no section " + name);
}

std::string describe(const Key& key, int dimension) {
  const bool space = dimension == 3;
  const std::string coordinates = space ? "[x, y, z]" : "[x, y]", count = space ? "three" : "two";
  switch (key.type) {
    case Type::text:
      return "a text";
    case Type::texts:
      return "a list of texts";
    case Type::flag:
      return "true or false";
    case Type::integer:
      return "an integer";
    case Type::integers:
      return "an integer or a list of them";
    case Type::number:
      return "a number or a formula of the parameters";
    case Type::share:
      return "a number, or a percentage (1 %)";
    case Type::numbers:
      return "a list of numbers";
    case Type::point:
      return fmt::format("{} numbers {}", count, coordinates);
    case Type::points:
      return "a list of points " + coordinates;
    case Type::pairs:
      return "a list of pairs of numbers";
    case Type::joins:
      return "a list of pairs of point numbers [i, j]";
    case Type::pair:
      return "two integers [i, j]";
    case Type::formula:
      return "a number or a formula of t";
    case Type::formulas:
      return fmt::format("{} formulas of t {}", count, coordinates);
    case Type::load_force:
      return fmt::format("{} formulas of t and sensors {}; of a load on a joint, one", count, coordinates);
    case Type::load_moment:
      return space ? "three formulas of t and sensors [x, y, z]; of a load on a joint, one"
                   : "a number or a formula of t and sensors";
    case Type::formula_of_sensors:
      return "a formula of t and sensors";
    case Type::rigid:
      return fmt::format("true or false, or a mapping with the keys of `{}`", key.section);
    case Type::inertia:
      return space ? "three or six numbers [Jxx, Jyy, Jzz, Jxy, Jxz, Jyz]" : "a number or a formula of the parameters";
    case Type::rotating:
      return space ? "three numbers [x, y, z]" : "a number or a formula of the parameters";
    case Type::formula_of_place:
      return space ? "three formulas of x, y and z [u, v, w]" : "two formulas of x and y [u, v]";
    case Type::formula_of_point:
      return "a number or a formula of x, y and z";
    case Type::choice:
      return fmt::format("one of {}", fmt::join(key.choices, ", "));
    case Type::derivatives:
      return "all, none, an integer or a list of pairs [i, j]";
    case Type::products:
      return "all, a number, or a percentage (1 %)";
    case Type::place:
      return "a place (BODY.NAME, or {body: BODY, node: " + coordinates + "})";
    case Type::places:
      return "two places [BODY.NAME, BODY.NAME], either may be ground";
    case Type::own_place:
      return "the name of a place of this body, or a node's coordinates " + coordinates;
    case Type::own_places:
      return "a list of places of this body, each a name or a node's coordinates " + coordinates;
    case Type::body:
      return "the name of a body";
    case Type::parameters:
      return "a mapping NAME: number";
    case Type::functions:
      return fmt::format("a mapping NAME: formula of t, or mapping with the keys of `{}`", key.section);
    case Type::section:
      return fmt::format("a mapping with the keys of `{}`", key.section);
    case Type::modes:
      return fmt::format("an integer, or a mapping with the keys of `{}`", key.section);
    case Type::accuracy:
      return fmt::format("a number, or a percentage (1 %), or a mapping with the keys of `{}`", key.section);
    case Type::frame:
      return fmt::format("pinned, clamped, mean-axis, or a mapping with the keys of `{}`", key.section);
    case Type::named_sections:
      return fmt::format("a mapping NAME: mapping with the keys of `{}`", key.section);
  }
  throw std::logic_error("a type without a description");
}

std::string described(const SchemaSection& section, const Key& key) {
  const auto& spatial = spatial_sections();
  const bool only_spatial =
      key.dimension == 3 || std::any_of(spatial.begin(), spatial.end(),
                                        [&](const SchemaSection& other) { return other.name == section.name; });
  const std::string planar = describe(key, 2), space = describe(key, 3);
  if (only_spatial) return space;
  return key.dimension == 2 || planar == space ? planar : planar + "; in spatial scenes " + space;
}

std::string default_text(const Key& key) {
  if (key.fallback == Key::required) return "";
  return key.type == Type::rotating && key.fallback == "0" ? "0; in spatial scenes [0, 0, 0]" : key.fallback;
}

std::string schema_reference() {
  std::string out =
      "A scene is a YAML file. Every number may be given as a formula of the parameters (\"pi/2\", L/20).\nFormulas "
      "may contain pi, e, + - * / ^, comparisons, `condition ? a : b`, sin, cos, exp, sqrt, abs, min, max and so "
      "on,\n"
      "triangle(t, rise, fall), ramp(t, from, to), smooth(t, from, to), pulse(t, from, to) and the scene's functions; "
      "in a\nlist, quote a formula that has a comma.\n"
      "Names consist of letters, digits, _ and -. Units are SI here; any consistent set of units may be used.\n";
  for (const SchemaSection& section : schema()) {
    out += fmt::format("\n{}\n{}\n{}\n", section.name, std::string(section.name.size(), '-'), section.text);
    for (const Key& key : section.keys) {
      out += fmt::format("  {:<20} {}\n", key.name, key.text);
      std::string line = described(section, key);
      if (!key.unit.empty()) line += fmt::format(" [{}]", key.unit);
      if (const std::string range = key.range.text(); !range.empty()) line += "; " + range;
      if (key.fallback == Key::required) line += "; required";
      if (const std::string fallback = default_text(key); !fallback.empty()) line += "; default " + fallback;
      if (key.dimension != 0) line += key.dimension == 2 ? "; only in planar scenes" : "; only in spatial scenes";
      if (!key.kinds.empty()) line += fmt::format("; only for type {}", fmt::join(key.kinds, ", "));
      out += fmt::format("  {:<20}   {}\n", "", line);
    }
    out += "  Example:\n    ";
    for (const char c : section.example) out += c == '\n' ? std::string("\n    ") : std::string(1, c);
    out += '\n';
  }
  return out;
}

}  // namespace floe::scene
