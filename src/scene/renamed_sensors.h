#pragma once
#include <map>
#include <optional>
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

  /// Whether `tip.y` is of a probe of the group.
  bool has_probe(const std::string& component) const;
  /// A component of a probe that crosses a value.
  struct Crossing {
    std::string probe, crosses;
  };
  /// The same of the copy; nothing where several components of the copy's probe make up the original's.
  std::optional<Crossing> crossing(const Crossing& original, const std::string& prefix,
                                   const GroupMotion& motion) const;

 private:
  /// Which of the axes x, y, z of the world a component is along, or -1 if it is along none.
  int axis_of(const std::string& name, const GroupMotion& motion) const;
  bool is_position(const std::string& probe) const;
  bool contains(const std::string& name) const;
  std::string renamed(const std::string& name, const std::string& prefix, const GroupMotion& motion) const;
};

}  // namespace floe::scene
