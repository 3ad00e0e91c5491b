#include "discretisation.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>

#include "floe/scene/copies.h"

namespace floe::app {

using scene::Body;
using scene::Scene;

namespace {

void write_elements(YAML::Node mesh, const Body& body, int times) {
  const auto several = [&](const auto& counts) {
    YAML::Node list(YAML::NodeType::Sequence);
    for (const int elements : counts) list.push_back(elements * times);
    return list;
  };
  if (body.mesh.file) mesh["file"]["refine"] = body.mesh.file->refine + std::ilogb(times);
  for (const char* kind : {"line", "polyline", "segments", "plate"}) {
    if (!mesh[kind].IsDefined()) continue;
    if (body.mesh.plate)
      mesh[kind]["elements"] = several(body.mesh.plate->elements);
    else if (std::string(kind) == "line")
      mesh[kind]["elements"] = body.mesh.elements[0] * times;
    else
      mesh[kind]["elements"] = several(body.mesh.elements);
  }
}

void write_frames(YAML::Node node, const Body& body, int frames) {
  node["frames"] = frames;
  YAML::Node reduction(YAML::NodeType::Map);
  if (node["reduction"].IsDefined() && node["reduction"].IsMap()) reduction = YAML::Clone(node["reduction"]);
  for (const char* key : {"derivatives", "columns", "interface", "modes"}) reduction.remove(key);
  const int whole = body.reduction.modes.count * body.frames;
  YAML::Node modes(YAML::NodeType::Map);
  modes["count"] = std::max(2, (whole + frames - 1) / frames + (whole % frames != 0 ? 1 : 0));
  modes["of"] = body.reduction.modes.of == scene::ModesSpec::Of::joints ? "joints" : "frame";
  reduction["modes"] = modes;
  node["reduction"] = reduction;
}

}  // namespace

bool divisible(const Body& body) {
  return is_meshed(body) && (body.mesh.segments.size() == 1 || body.mesh.plate) && body.reduction.interface.empty();
}

double element_count(const Scene& scene, const Discretisation& bodies) {
  double sum = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    if (body.rigid || !is_meshed(body)) continue;
    const double times = bodies[b].elements;
    if (body.mesh.plate) sum += times * times * body.mesh.plate->elements[0] * body.mesh.plate->elements[1];
    for (const int elements : body.mesh.elements) sum += times * elements;
  }
  return sum;
}

bool fits(const Body& body, const Discretised& one) {
  if (!body.mesh.plate) {
    const int count = body.mesh.elements[0] * one.elements;
    return count % one.frames == 0 && count >= 2 * one.frames;
  }
  const scene::PlateSpec& plate = *body.mesh.plate;
  const auto square = [](const scene::Point& p) { return p[0] * p[0] + p[1] * p[1] + p[2] * p[2]; };
  const int longer = square(plate.across) > square(plate.along) ? 1 : 0;
  return plate.elements[static_cast<std::size_t>(longer)] * one.elements >= 2 * one.frames;
}

Discretisation discretisation_of(const Scene& scene) {
  Discretisation all;
  for (const Body& body : scene.bodies) all.push_back({body.frames, 1, {}});
  return all;
}

Scene discretised(const Scene& scene, const Discretisation& bodies) {
  if (bodies == discretisation_of(scene)) return scene;
  YAML::Node root = scene::load_resolved(scene);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    YAML::Node node = root["bodies"][body.name] = YAML::Clone(root["bodies"][body.name]);  // it may be an alias
    if (bodies[b].elements != 1) write_elements(node["mesh"], body, bodies[b].elements);
    if (bodies[b].frames != body.frames) write_frames(node, body, bodies[b].frames);
    if (bodies[b].strains)
      node["strains"] = *bodies[b].strains == fem::Strains::second_order ? "second_order" : "von_karman";
  }
  YAML::Emitter out;
  out << root;
  Scene other = scene::parse_scene(out.c_str(), scene.file);
  other.accuracy = scene.accuracy;
  return other;
}

}  // namespace floe::app
