#pragma once
#include <map>
#include <set>

#include "moved_text.h"

namespace floe::scene {

/// The joints and probes of a copied group used in formulas: JOINT.angle becomes COPY_JOINT.angle, and components of
/// probes, which are those of world axes, become R' of those of the copy's probe.
struct RenamedSensors {
  std::set<std::string> joints;
  std::map<std::string, YAML::Node> probes;  ///< by name, the originals
  std::set<std::string> seen_from_group;     ///< probes in axes that move with the group: their components stay

  /// Whether a formula uses any of them.
  bool named_in(const std::string& formula) const;
  /// A formula or a list of formulas. @param prefix  of the names of copies
  YAML::Node renamed(const YAML::Node& formulas, const std::string& prefix, const GroupMotion& motion) const;

 private:
  bool contains(const std::string& name) const;
  std::string renamed(const std::string& name, const std::string& prefix, const GroupMotion& motion) const;
};

}  // namespace floe::scene
