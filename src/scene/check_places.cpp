#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "floe/scene/file_places.h"
#include "floe/scene/places.h"
#include "readers.h"

namespace floe::scene {
namespace {

std::vector<std::string> body_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Body& body : scene.bodies) names.push_back(body.name);
  return names;
}

const Body* find_body(Document& document, const Scene& scene, const std::string& name, const Where& where,
                      bool may_be_ground) {
  for (const Body& body : scene.bodies) {
    if (body.name == name) return &body;
  }
  auto names = body_names(scene);
  if (may_be_ground) names.push_back("ground");
  document.fault(
      where, fmt::format("there is no body \"{}\"", name),
      fmt::format("one of {}", fmt::join(names.begin(), names.begin() + std::min<long>(names.size(), 20), ", ")), name,
      names);
  return nullptr;
}

void check_place(Document& document, const Scene& scene, const Place& place, bool may_be_ground) {
  if (place.body.empty()) return;  // a fault already
  if (place.ground()) {
    if (!may_be_ground) document.fault(place.where, "is the ground", "a place of a body");
    return;
  }
  const Body* body = find_body(document, scene, place.body, place.where, may_be_ground);
  if (body && body->reduced && body->reduced->file) {
    if (place.point && body->reduced->file->has_shapes) return;  // found when the scene is built
    try {
      named_place(*body, place);
    } catch (const InputError& error) {
      document.fault(place.where, error);
    }
    return;
  }
  if (!body || body->mesh.points.empty() || scene.dimension == 3) return;  // in space found on the mesh itself
  try {
    place_point(*body, place);
  } catch (const InputError& error) {
    document.fault(place.where, error);
  }
}

/// Forces in sections and stresses are those of a flexible body with a mesh; shells are in space.
void check_inner(Document& document, const Scene& scene, const Probe& probe) {
  if (probe.of_shell() && scene.dimension == 2)
    document.fault(probe.where, "records a shell, which planar scenes do not have",
                   "a scene in space, or section_force");
  for (const Body& body : scene.bodies) {
    if (body.name != probe.at.body) continue;
    if (body.rigid)
      document.fault(probe.at.where, fmt::format("is a place of body {}, which is rigid", body.name),
                     "a place of a flexible body, or a probe of a joint's force");
    if (body.reduced)
      document.fault(probe.at.where, fmt::format("is a place of body {}, whose file has no elements", body.name),
                     "a body with a mesh, or a probe of a joint's force");
  }
}

}  // namespace

void check_places(Document& document, const Scene& scene) {
  for (const Joint& joint : scene.joints) {
    check_place(document, scene, joint.first, true);
    check_place(document, scene, joint.second, true);
  }
  for (const Load& load : scene.loads) {
    check_place(document, scene, load.at, false);
    Where where = load.where;
    where.key += ".body";
    if (load.body == "ground")
      document.fault(where, "is the ground", "a body");
    else if (!load.body.empty())
      find_body(document, scene, load.body, where, false);
  }
  for (const Probe& probe : scene.probes) {
    check_place(document, scene, probe.at, false);
    Where where = probe.where;
    where.key += ".body";
    if (!probe.body.empty()) find_body(document, scene, probe.body, where, false);
    if (probe.relative_to) check_place(document, scene, *probe.relative_to, false);
    if (probe.toward) check_place(document, scene, *probe.toward, false);
    if (probe.of_section() || probe.of_shell()) check_inner(document, scene, probe);
  }
}

}  // namespace floe::scene
