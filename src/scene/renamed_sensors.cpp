#include "renamed_sensors.h"

#include <algorithm>
#include <cctype>
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
  if (joints.count(owner(name)) || seen_from_group.count(owner(name))) return prefix + name;
  const std::string component = name.substr(name.find('.') + 1), axes = motion.dimension == 3 ? "xyz" : "xy";
  const auto axis = component.empty() ? std::string::npos : axes.find(component.back());
  if (axis == std::string::npos || component.size() > 2) return prefix + name;
  const YAML::Node probe = probes.at(owner(name));
  const bool position = probe["quantity"] && probe["quantity"].IsScalar() && probe["quantity"].Scalar() == "position" &&
                        !probe["relative_to"];
  std::vector<std::string> components;
  for (const char c : axes) {
    components.push_back(prefix + name);
    components.back().back() = c;
  }
  return motion.moved_back(static_cast<int>(axis), components, position);
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
