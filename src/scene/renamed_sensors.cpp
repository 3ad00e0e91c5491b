#include "renamed_sensors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>

namespace floe::scene {
namespace {

bool letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool digit(char c) { return std::isdigit(static_cast<unsigned char>(c)); }

/// The text with every name with dots, as hinge.angle, replaced; numbers such as 1.5e3 are not names.
std::string replaced(const std::string& text, const std::function<std::string(const std::string&)>& by) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i;
    if (letter(text[i])) {
      while (end < text.size() && (letter(text[end]) || digit(text[end]) || text[end] == '.')) ++end;
      out += by(text.substr(i, end - i));
    } else if (digit(text[i]) || text[i] == '.') {
      while (end < text.size() && (letter(text[end]) || digit(text[end]) || text[end] == '.')) ++end;
      out += text.substr(i, end - i);
    } else {
      out += text[end++];
    }
    i = end;
  }
  return out;
}

std::string owner(const std::string& name) { return name.substr(0, name.find('.')); }

std::string along(std::string component, int axis) {
  component.back() = "xyz"[axis];
  return component;
}

/// Quantities whose components are in axes of bodies, sections or shells.
const std::set<std::string>& own_axes() {
  static const std::set<std::string> all{"deflection", "section_force",    "section_moment", "stress",
                                         "strain",     "principal_stress", "membrane_force", "bending_moment"};
  return all;
}

}  // namespace

bool RenamedSensors::contains(const std::string& name) const {
  return name.find('.') != std::string::npos && (joints.count(owner(name)) || probes.count(owner(name)));
}

bool RenamedSensors::named_in(const std::string& formula) const {
  bool any = false;
  replaced(formula, [&](const std::string& name) {
    any = any || contains(name);
    return name;
  });
  return any;
}

std::string RenamedSensors::renamed(const std::string& name, const std::string& prefix,
                                    const GroupMotion& motion) const {
  if (!contains(name)) return name;
  const int axis = axis_of(name, motion);
  if (axis < 0) return prefix + name;
  std::vector<std::string> components;
  for (int i = 0; i < motion.dimension; ++i) components.push_back(along(prefix + name, i));
  return motion.moved_back(axis, components, is_position(owner(name)));
}

int RenamedSensors::axis_of(const std::string& name, const GroupMotion& motion) const {
  const auto found = probes.find(owner(name));
  if (found == probes.end() || joints.count(owner(name)) || seen_from_group.count(owner(name))) return -1;
  const YAML::Node& quantity = found->second["quantity"];
  if (quantity && quantity.IsScalar() && own_axes().count(quantity.Scalar())) return -1;
  if (const YAML::Node& axes = found->second["axes"]; axes && axes.IsScalar() && axes.Scalar() == "joint") return -1;
  const std::string component = name.substr(name.find('.') + 1), axes = motion.dimension == 3 ? "xyz" : "xy";
  const auto axis = component.empty() ? std::string::npos : axes.find(component.back());
  return axis == std::string::npos || component.size() > 2 ? -1 : static_cast<int>(axis);
}

bool RenamedSensors::is_position(const std::string& probe) const {
  const YAML::Node& of = probes.at(probe);
  return of["quantity"] && of["quantity"].IsScalar() && of["quantity"].Scalar() == "position" && !of["relative_to"];
}

bool RenamedSensors::has_probe(const std::string& component) const { return probes.count(owner(component)) > 0; }

std::optional<RenamedSensors::Crossing> RenamedSensors::crossing(const Crossing& original, const std::string& prefix,
                                                                 const GroupMotion& motion) const {
  if (!has_probe(original.probe)) return original;
  const Crossing same{prefix + original.probe, original.crosses};
  const int axis = axis_of(original.probe, motion);
  if (axis < 0) return same;
  for (int i = 0; i < motion.dimension; ++i) {  // x_axis = R_i,axis (x'_i - p_i)
    const double sign = motion.R(i, axis), shift = is_position(owner(original.probe)) ? motion.p[i] : 0;
    if (std::abs(sign) != 1) continue;
    if (sign == 1 && shift == 0) return Crossing{along(same.probe, i), original.crosses};
    return Crossing{along(same.probe, i), fmt::format("({})*({}) + ({})", sign, original.crosses, shift)};
  }
  return std::nullopt;
}

YAML::Node RenamedSensors::renamed(const YAML::Node& formulas, const std::string& prefix,
                                   const GroupMotion& motion) const {
  if (formulas.IsScalar())
    return text_at(formulas,
                   replaced(formulas.Scalar(), [&](const std::string& name) { return renamed(name, prefix, motion); }));
  if (!formulas.IsSequence()) return formulas;
  YAML::Node list = empty_list_at(formulas);
  for (const auto& formula : formulas) list.push_back(renamed(formula, prefix, motion));
  return list;
}

}  // namespace floe::scene
