#include <algorithm>

#include "copies.h"
#include "group_copies.h"
#include "readers.h"
#include "variation.h"

namespace floe::scene {
namespace {

bool good_name(const std::string& name) {
  return !name.empty() && name.size() <= 100 && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

// A mapping of names to sections, each read by `read(document, name, value)`.
template <class Part>
std::vector<Part> read_named(Document& document, Reading& scene, const std::string& key,
                             Part (*read)(Document&, const std::string&, const Value&)) {
  std::vector<Part> parts;
  const auto value = scene.value(key);
  if (!value) return parts;
  for (const auto& entry : read_mapping(document, *value, describe(scene.key(key)))) {
    if (!good_name(entry.name)) {
      document.fault(entry.where, "is not a valid name", "letters, digits, _ and -");
    } else if (key == "bodies" && entry.name == "ground") {
      document.fault(entry.where, "is the name of the ground", "another name");
    }
    Value part = entry.value;
    part.where = entry.where;
    parts.push_back(read(document, entry.name, part));
  }
  return parts;
}

// Whether a body that was reduced before is in space; what is wrong with its file is reported when it is read.
bool reduced_in_space(Document& document, const YAML::Node& body) {
  if (!body.IsMap() || !body["reduced"] || !body["reduced"].IsScalar()) return false;
  try {
    return document.reduced_file(document.beside(body["reduced"].Scalar()))->dimension == 3;
  } catch (const InputError&) {
    return false;
  }
}

// Whether all bodies are from files, of which none can be read: nothing says in how many dimensions the scene is.
bool unknown_dimension(Document& document, const YAML::Node& bodies) {
  if (!bodies || !bodies.IsMap() || bodies.size() == 0) return false;
  for (const auto& body : bodies) {
    if (!body.second.IsMap() || !body.second["reduced"] || !body.second["reduced"].IsScalar() || body.second["mesh"])
      return false;
    try {
      document.reduced_file(document.beside(body.second["reduced"].Scalar()));
      return false;
    } catch (const InputError&) {
    }
  }
  return true;
}

// A scene is in space as soon as a mesh has a point of three coordinates, is a plate or comes from a file, or a reduced
// body is.
bool is_spatial(Document& document, const YAML::Node& root) {
  const auto three = [](const YAML::Node& point) { return point && point.IsSequence() && point.size() == 3; };
  const YAML::Node bodies = root["bodies"];
  if (!bodies || !bodies.IsMap()) return false;
  for (const auto& body : bodies) {
    if (reduced_in_space(document, body.second)) return true;
    if (const YAML::Node rigid = body.second.IsMap() ? body.second["rigid"] : YAML::Node(); rigid && rigid.IsMap())
      if (three(rigid["centre"])) return true;
    const YAML::Node mesh = body.second.IsMap() ? body.second["mesh"] : YAML::Node();
    if (!mesh || !mesh.IsMap()) continue;
    if (mesh["file"] || mesh["plate"]) return true;
    for (const auto& shape : mesh) {
      if (!shape.second.IsMap()) continue;
      const YAML::Node points = shape.second["points"];
      if (three(shape.second["from"]) || (points && points.IsSequence() && points.size() > 0 && three(points[0])))
        return true;
    }
  }
  return false;
}

Accuracy read_accuracy(Document& document, Reading& scene) {
  const Value value = *scene.value("accuracy");
  if (!value.node.IsMap()) return {read_share(document, value, scene.key("accuracy"))};
  Reading reading(document, value, "accuracy");
  const auto reduction = reading.value("reduction");
  return {reduction ? read_share(document, *reduction, reading.key("reduction")) : NAN, false};
}

}  // namespace

Scene parse_scene(const std::string& text, const std::string& name) { return parse_scene(text, name, {}); }

Scene parse_scene(const std::string& text, const std::string& name, const std::vector<Variation>& variations) {
  Document document;
  document.file = name;
  const Value root = parse_yaml(text, name);
  vary(root.node, name, variations);
  Scene scene;
  scene.file = name;
  scene.text = text;
  Reading reading(document, root, "scene");
  if (!root.node.IsMap()) document.throw_faults();
  const std::size_t before = document.fault_count();
  resolve_copies(document, root.node);
  if (document.fault_count() != before) document.throw_faults();  // what a copy lacks would only follow
  scene.dimension = document.dimension = is_spatial(document, root.node) ? 3 : 2;
  if (const auto parameters = reading.value("parameters")) read_parameters(document, *parameters);
  if (const auto functions = reading.value("functions")) read_functions(document, *functions);
  scene.tables = document.tables;
  const std::size_t before_groups = document.fault_count();
  write_out_groups(document, root.node);
  if (document.fault_count() != before_groups) document.throw_faults();
  if (unknown_dimension(document, root.node["bodies"])) {  // coordinates would be judged by a guess
    read_named<Body>(document, reading, "bodies", read_body);
    document.throw_faults();
  }
  scene.title = reading.text("title");
  scene.gravity = reading.force("gravity");
  if (const auto ground = reading.value("ground"))
    scene.ground_acceleration = Reading(document, *ground, "ground").force("acceleration");
  if (reading.given("share_frames")) scene.share_frames = reading.flag("share_frames");
  scene.bodies = read_named<Body>(document, reading, "bodies", read_body);
  scene.joints = read_named<Joint>(document, reading, "joints", read_joint);
  scene.loads = read_named<Load>(document, reading, "loads", read_load);
  if (const auto motion = reading.value("motion")) scene.motion = read_motion(document, *motion);
  if (reading.given("accuracy")) scene.accuracy = read_accuracy(document, reading);
  if (scene.accuracy && scene.motion.tolerance)
    document.fault(reading.where("accuracy"), "cannot be combined with motion.tolerance: it selects the step",
                   "one of them");
  scene.probes = read_named<Probe>(document, reading, "probes", read_probe);
  place_probes(document, scene);
  place_loads(document, scene);
  check_start(document, scene);
  scene.events = read_named<Event>(document, reading, "events", read_event);
  if (scene.bodies.empty() && reading.given("bodies") && document.fault_count() == 0) {
    document.fault(reading.where("bodies"), "is empty", "at least one body");
  }
  check_places(document, scene);
  check_joints(document, scene);
  check_formulas(document, scene);
  check_events(document, scene);
  check_responses(document, scene);
  document.throw_faults();
  scene.parameters = document.names.numbers;
  return scene;
}

Scene read_scene(const std::string& path) { return parse_scene(read_text(path), path); }

}  // namespace floe::scene
