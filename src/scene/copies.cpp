#include "copies.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "floe/math/nearest.h"
#include "group_copies.h"
#include "readers.h"

namespace floe::scene {
namespace {

/// One of the mappings of names to entries: bodies, joints, loads or probes.
class Copies {
 public:
  Copies(Document& document, const std::string& section, const YAML::Node& entries)
      : document_(document), section_(section) {
    for (const auto& entry : entries)
      if (entry.first.IsScalar() && entries_.emplace(entry.first.Scalar(), entry.second).second)
        names_.push_back(entry.first.Scalar());
  }
  void resolve() {
    for (const std::string& name : names_) resolve(name);
  }

 private:
  void resolve(const std::string& name) {
    YAML::Node copy = entries_.at(name);
    const YAML::Node& given = copy;  // what is asked of a node that may be changed is in it from then on
    if (!copy.IsMap() || !given["like"]) return;
    const YAML::Node like = given["like"];
    const Where where = document_.place_of(like.Mark(), fmt::format("{}.{}.like", section_, name));
    copy.remove("like");
    const std::string original = like.IsScalar() ? like.Scalar() : "";
    if (!like.IsScalar() || entries_.count(original) == 0) {
      document_.fault(where, shown(like), fmt::format("one of the {} {}", section_, fmt::join(names_, ", ")), original,
                      names_);
      return;
    }
    under_way_.insert(name);
    if (under_way_.count(original) > 0)
      document_.fault(where, fmt::format("is \"{}\", which depends on itself", original),
                      "an entry with keys of its own");
    else
      resolve(original);
    under_way_.erase(name);
    if (original == name || !entries_.at(original).IsMap()) return;
    for (const auto& inherited : entries_.at(original))
      if (inherited.first.IsScalar() && inherited.first.Scalar() != "like" && !given[inherited.first.Scalar()])
        copy.force_insert(inherited.first, inherited.second);
  }
  Document& document_;
  std::string section_;
  std::map<std::string, YAML::Node> entries_;
  std::vector<std::string> names_;  // in the order of the file
  std::set<std::string> under_way_;
};

/// The same values with nodes of their own: those of copies are otherwise the same nodes as their originals'.
YAML::Node unshared(const YAML::Node& node) {
  if (node.IsScalar()) return YAML::Node(node.Scalar());
  if (!node.IsSequence() && !node.IsMap()) return {};
  YAML::Node own(node.Type());
  if (node.IsSequence())
    for (const auto& item : node) own.push_back(unshared(item));
  else
    for (const auto& entry : node) own.force_insert(unshared(entry.first), unshared(entry.second));
  own.SetStyle(node.Style());
  return own;
}

}  // namespace

void resolve_copies(Document& document, const YAML::Node& root) {
  if (!root.IsMap()) return;
  for (const char* section : {"bodies", "joints", "loads", "probes"})
    if (const YAML::Node entries = root[section]; entries && entries.IsMap())
      Copies(document, section, entries).resolve();
}

YAML::Node load_resolved(const Scene& scene) {
  YAML::Node root = YAML::Load(scene.text);
  Document document;
  document.file = scene.file;
  document.dimension = scene.dimension;
  resolve_copies(document, root);
  if (root["parameters"]) read_parameters(document, {root["parameters"], {}});
  if (root["functions"]) read_functions(document, {root["functions"], {}});
  write_out_groups(document, root);
  root.remove("copies");
  return unshared(root);
}

}  // namespace floe::scene
