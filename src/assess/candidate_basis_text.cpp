#include "candidate_basis_text.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "floe/scene/copies.h"

namespace floe::assess {

namespace {

/// The reduction of a body: its modes as they are, all static columns, and of these the ones that are taken.
void write_columns(YAML::Node reduction, const std::vector<std::string>& labels, bool linear) {
  reduction.remove("derivatives");
  reduction["attachment"] = "all";
  YAML::Node list(YAML::NodeType::Sequence);
  for (const std::string& label : labels) list.push_back(label);
  reduction["columns"] = list;
  if (linear)
    reduction["elastic_force"] = "linear";
  else
    reduction.remove("elastic_force");
}

/// Paths that are relative to the folder of one scene become those for a scene in another folder.
class MovedPaths {
 public:
  MovedPaths(std::filesystem::path from, const std::filesystem::path& to) : from_(std::move(from)), to_(whole(to)) {}

  void move(YAML::Node root) {
    for (const auto& entry : root["functions"])
      if (entry.second.IsMap()) move_path(entry.second["file"]);
    for (const auto& entry : root["bodies"]) {
      YAML::Node body = entry.second;
      move_path(body["reduced"]);
      if (!body["mesh"].IsDefined() || !body["mesh"].IsMap()) continue;
      if (const YAML::Node file = body["mesh"]["file"]; file.IsDefined() && file.IsMap()) move_path(file["path"]);
    }
  }

 private:
  static std::filesystem::path whole(const std::filesystem::path& one) {
    return std::filesystem::absolute(one).lexically_normal();
  }

  /// Once, however many aliases the node has.
  void move_path(YAML::Node node) {
    if (!node.IsDefined() || !node.IsScalar()) return;
    for (const YAML::Node& one : moved_)
      if (one.is(node)) return;
    moved_.push_back(node);
    const std::filesystem::path path = node.as<std::string>();
    if (!path.is_absolute()) node = whole(from_ / path).lexically_proximate(to_).string();
  }

  std::filesystem::path from_, to_;
  std::vector<YAML::Node> moved_;
};

/// The scene's text, its paths taken from `folder` where that is not empty.
YAML::Node tree_of(const Scene& scene, const std::filesystem::path& folder) {
  YAML::Node root = load_resolved(scene);
  if (!folder.empty()) MovedPaths(std::filesystem::path(scene.file).parent_path(), folder).move(root);
  return root;
}

/// Without an accuracy, in the steps of a motion.
std::string text_of(YAML::Node root, const Motion& motion) {
  root.remove("accuracy");
  root["motion"]["step"] = fmt::format("{}", motion.step);
  root["motion"].remove("every");
  if (!motion.tolerance) root["motion"].remove("tolerance");
  if (motion.output)
    root["motion"]["output"] = fmt::format("{}", *motion.output);
  else
    root["motion"]["every"] = motion.every;
  YAML::Emitter out;
  out << root;
  return out.c_str();
}

}  // namespace

std::string scene_text(const Scene& scene, const std::filesystem::path& folder) {
  return text_of(tree_of(scene, folder), scene.motion);
}

std::string candidates_text(const Scene& scene, const std::vector<CandidateVector>& columns, const Selection& selection,
                            const Motion& motion, const std::map<std::string, std::string>& files, bool share_frames,
                            const std::set<std::string>& deformed, const std::filesystem::path& folder) {
  YAML::Node root = tree_of(scene, folder);
  for (const Body& body : scene.bodies) {
    if (body.rigid || body.reduced) continue;
    std::vector<std::string> labels;
    bool any = false;
    std::map<int, int> responses_of;                     // by piece
    std::map<int, std::pair<bool, std::string>> pieces;  // whether it has one; the first that it may have
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i].body != body.name) continue;
      const int piece = columns[i].piece;
      bool& has = pieces.try_emplace(piece, false, columns[i].label).first->second.first;
      if (!selection.taken[i]) continue;
      any = has = true;
      columns[i].response ? static_cast<void>(++responses_of[piece]) : labels.push_back(columns[i].label);
    }
    int responses = 0;  // a scene gives all pieces as many
    for (const auto& [piece, count] : responses_of) responses = std::max(responses, count);
    for (const auto& [piece, one] : pieces)
      if (!one.first && (any || deformed.contains(body.name)))
        labels.push_back(one.second);  // as CandidateBasis::model has it
    YAML::Node node = root["bodies"][body.name];
    if (const auto file = files.find(body.name); file != files.end()) {
      const YAML::Node initial = node["initial"];
      YAML::Node from_file(YAML::NodeType::Map);
      from_file["reduced"] = file->second;
      if (initial.IsDefined()) from_file["initial"] = initial;
      root["bodies"][body.name] = from_file;
      continue;
    }
    if (!any && !deformed.contains(body.name)) {
      node["rigid"] = true;
      continue;
    }
    if (labels.empty()) continue;  // responses alone
    YAML::Node reduction(YAML::NodeType::Map);
    if (node["reduction"].IsMap()) reduction = YAML::Clone(node["reduction"]);  // copies of the body may have it, too
    write_columns(reduction, labels, selection.linear);
    reduction.remove("responses");
    if (const int count = static_cast<int>(std::ceil(selection.responses * responses)); count > 0)
      reduction["responses"] = count;
    node["reduction"] = reduction;
  }
  if (share_frames != scene.share_frames) root["share_frames"] = share_frames;
  return text_of(root, motion);
}

}  // namespace floe::assess
