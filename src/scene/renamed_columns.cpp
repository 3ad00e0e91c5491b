#include "renamed_columns.h"

#include <algorithm>

namespace floe::scene {
namespace {

/// Places of the body whose constraint modes have labels of the same form, `root.x`.
std::set<std::string> interface_places(const YAML::Node& reduction) {
  std::set<std::string> places;
  if (const YAML::Node given = reduction["interface"]; given && given.IsSequence())
    for (const auto& place : given)
      if (place.IsScalar()) places.insert(place.Scalar().substr(place.Scalar().find('.') + 1));
  return places;
}

/// Of `root.moment`, `root/2.fx` (a vector of an interface) or `push-.fx` (where the shape of a load is negative).
bool is_of(const std::set<std::string>& names, const std::string& vector) {
  std::string name = vector.substr(0, vector.rfind('.'));
  name = name.substr(0, name.find('/'));
  if (names.count(name)) return true;
  return name.ends_with('-') && names.count(name.substr(0, name.size() - 1)) > 0;
}

/// Whether it is the motion of an interface place, not the force or moment of a joint or load.
bool is_motion_of(const std::set<std::string>& places, const std::string& vector) {
  static const std::set<std::string> motions{"x", "y", "z", "rx", "ry", "rz", "rotation"};
  const auto dot = vector.rfind('.');
  return dot != std::string::npos && places.count(vector.substr(0, dot)) > 0 &&
         motions.count(vector.substr(dot + 1)) > 0;
}

}  // namespace

YAML::Node with_renamed_columns(const YAML::Node& reduction, const std::set<std::string>& copied,
                                const std::string& prefix) {
  if (!reduction.IsMap() || !reduction["columns"] || !reduction["columns"].IsSequence()) return reduction;
  const std::set<std::string> places = interface_places(reduction);
  YAML::Node labels = empty_list_at(reduction["columns"]);
  for (const auto& item : reduction["columns"]) {
    const std::string label = item.IsScalar() ? item.Scalar() : "";
    const auto kind = std::min(label.find("attachment "), label.find("derivative "));
    if (kind == std::string::npos) {
      labels.push_back(item);
      continue;
    }
    std::size_t at = label.find(' ', kind) + 1;
    std::string renamed = label.substr(0, at);
    for (std::size_t end = 0; end != std::string::npos; at = end + 1) {
      end = label.find(',', at);
      const std::string vector = label.substr(at, end == std::string::npos ? end : end - at);
      renamed += (is_of(copied, vector) && !is_motion_of(places, vector) ? prefix : "") + vector;
      if (end != std::string::npos) renamed += ',';
    }
    labels.push_back(text_at(item, renamed));
  }
  YAML::Node copy = empty_map_at(reduction);
  for (const auto& entry : reduction)
    copy.force_insert(entry.first, entry.first.IsScalar() && entry.first.Scalar() == "columns" ? labels : entry.second);
  return copy;
}

}  // namespace floe::scene
