#include "variation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <set>

#include "floe/math/nearest.h"

namespace floe::scene {
namespace {

/// `a.b[2]` as a, b, [2].
std::vector<std::string> steps_of(const std::string& path) {
  std::vector<std::string> steps(1);
  for (const char c : path) {
    if (c == '.' || c == '[') steps.emplace_back();
    if (c != '.') steps.back() += c;
  }
  return steps;
}

std::vector<std::string> names_in(const YAML::Node& node) {
  std::vector<std::string> names;
  if (node.IsMap())
    for (const auto& entry : node)
      if (entry.first.IsScalar()) names.push_back(entry.first.Scalar());
  if (node.IsSequence())
    for (std::size_t i = 1; i <= node.size(); ++i) names.push_back(fmt::format("[{}]", i));
  return names;
}

/// The node's child of a name; an undefined node: there is none.
YAML::Node child(const YAML::Node& node, const std::string& name) {
  if (node.IsMap())
    for (const auto& entry : node)
      if (entry.first.IsScalar() && entry.first.Scalar() == name) return entry.second;
  if (node.IsSequence() && name.size() > 2 && name.front() == '[' && name.back() == ']') {
    const long index = std::strtol(name.c_str() + 1, nullptr, 10);
    if (index >= 1 && index <= static_cast<long>(node.size())) return node[static_cast<std::size_t>(index - 1)];
  }
  return YAML::Node(YAML::NodeType::Undefined);
}

/// The node at a path. @throws InputError
YAML::Node find(const YAML::Node& root, const std::string& file, const std::string& path) {
  std::vector<std::string> steps = steps_of(path);
  const YAML::Node parameters = child(root, "parameters");
  if (steps.size() == 1 && parameters.IsDefined() && child(parameters, path).IsDefined())
    steps.insert(steps.begin(), "parameters");
  std::vector<YAML::Node> way{root};  // a YAML::Node that is assigned changes the document
  std::string so_far;
  for (const std::string& step : steps) {
    const YAML::Node next = child(way.back(), step);
    if (!next.IsDefined()) {
      std::vector<std::string> names = names_in(way.back());
      if (so_far.empty() && parameters.IsDefined())
        for (const std::string& name : names_in(parameters)) names.push_back(name);
      const std::string near = math::nearest(step, names);
      std::string expected = so_far.empty() ? "a key of the scene or a parameter" : "a key of " + so_far;
      if (!names.empty()) expected += fmt::format(" ({})", fmt::join(names, ", "));
      throw InputError(fmt::format("{}: has no {}{}; expected {}{}", file, so_far.empty() ? "" : so_far + ".", step,
                                   expected, near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
    }
    so_far += (so_far.empty() || step.front() == '[' ? "" : ".") + step;
    way.push_back(next);
  }
  if (!way.back().IsScalar())
    throw InputError(fmt::format("{}: {} is {}; expected a number or a formula", file, path,
                                 way.back().IsSequence() ? "a list"
                                 : way.back().IsMap()    ? "a mapping"
                                                         : "empty"));
  return way.back();
}

/// Names in texts that may be formulas.
void collect_names(const YAML::Node& node, std::set<std::string>& names) {
  if (node.IsMap())
    for (const auto& entry : node) collect_names(entry.second, names);
  if (node.IsSequence())
    for (const auto& entry : node) collect_names(entry, names);
  if (!node.IsScalar()) return;
  std::string name;
  for (const char c : node.Scalar() + " ") {
    const bool part = std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    if (part)
      name += c;
    else if (!name.empty())
      names.insert(std::exchange(name, {}));
  }
}

void remove_keys(YAML::Node node, const std::set<std::string>& keys) {
  if (!node.IsMap()) return;
  for (const std::string& key : keys) node.remove(key);
}

/// What of joints, loads and events acts on bodies, and changes nothing in their reduction. All other keys count.
const std::vector<std::pair<std::string, std::set<std::string>>> acting = {
    {"joints",
     {"angle", "position", "speed", "stiffness", "viscosity", "length", "torsional_stiffness", "torsional_viscosity",
      "translation", "rotation", "translation_viscosity", "rotation_viscosity", "limits", "turn_limits"}},
    {"loads", {"force", "moment", "pressure"}},
    {"events", {"at", "when", "probe", "crosses", "stop"}}};

bool chooses_by_motion(const Scene& scene) {
  for (const Body& body : scene.bodies)
    if (is_meshed(body) &&
        (body.reduction.derivatives.choice == DerivativesSpec::Choice::count || body.reduction.responses > 0))
      return true;
  return false;
}

}  // namespace

void vary(const YAML::Node& root, const std::string& file, const std::vector<Variation>& variations) {
  std::vector<std::string> faults;
  for (const Variation& variation : variations) {
    try {
      YAML::Node node = find(root, file, variation.path);
      node = fmt::format("{}", variation.value);
    } catch (const InputError& error) {
      faults.push_back(error.what());
    }
  }
  if (!faults.empty()) throw InputError(faults);
}

std::string offline_inputs(const std::string& text, const std::string& name, const std::vector<Variation>& variations) {
  const Scene scene = parse_scene(text, name, variations);
  YAML::Node root = parse_yaml(text, name).node;
  vary(root, name, variations);
  if (chooses_by_motion(scene)) {
    remove_keys(root, {"title", "probes", "events", "parameters"});
  } else {
    remove_keys(root, {"title", "gravity", "ground", "motion", "probes", "parameters"});
    for (const auto& body : root["bodies"]) {
      const YAML::Node initial = child(body.second, "initial");
      if (initial.IsDefined()) remove_keys(initial, {"position", "velocity", "angular_velocity"});
    }
    for (const auto& [section, online] : acting) {
      const YAML::Node parts = child(root, section);
      if (!parts.IsDefined() || !parts.IsMap()) continue;
      for (const auto& part : parts) remove_keys(part.second, online);
    }
  }
  std::set<std::string> names;
  collect_names(root, names);
  YAML::Emitter out;
  out << root;
  std::string inputs = out.c_str();
  for (const auto& [parameter, value] : scene.parameters)
    if (names.count(parameter)) inputs += fmt::format("\n{} = {}", parameter, value);
  return inputs;
}

}  // namespace floe::scene
