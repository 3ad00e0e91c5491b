#include <fmt/format.h>

#include <cmath>

#include "floe/plan/prepare.h"
#include "floe/scene/places.h"

namespace floe::plan {
namespace {

Point between(const Point& a, const Point& b, double s) {
  return {a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2])};
}

double distance(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

std::string part_name(const std::string& body, int i) { return fmt::format("{}#{}", body, i + 1); }

Body part_of(const Body& body, int i) {
  if (body.mesh.segments.size() != 1)
    throw InputError(body.where.text() + ": frames splits one straight line; this mesh has " +
                     std::to_string(body.mesh.segments.size()) + " segments");
  if (body.mesh.elements[0] % body.frames != 0)
    throw InputError(fmt::format("{}: {} elements cannot be divided equally among {} frames; expected a multiple",
                                 body.where.text(), body.mesh.elements[0], body.frames));
  Body part = body;
  part.name = part_name(body.name, i);
  part.frames = 1;
  const Point a = body.mesh.points[body.mesh.segments[0][0]], b = body.mesh.points[body.mesh.segments[0][1]];
  part.mesh.points = {between(a, b, double(i) / body.frames), between(a, b, double(i + 1) / body.frames)};
  part.mesh.segments = {{0, 1}};
  part.mesh.elements = {body.mesh.elements[0] / body.frames};
  for (Place* place : {&part.frame.from, &part.frame.to, &part.frame.at}) {
    place->body = part.name;
    place->point.reset();
  }
  part.frame.from.name = part.frame.at.name = "start";
  part.frame.to.name = "end";
  return part;
}

/// The part that a place of the whole body lies on, by its coordinates.
void redirect(const Scene& scene, Place& place) {
  for (const Body& body : scene.bodies) {
    if (body.name != place.body || body.frames == 1) continue;
    const Point x = place_point(body.mesh, place), a = body.mesh.points[body.mesh.segments[0][0]];
    const double along = distance(a, x) / total_length(body.mesh) * body.frames;
    const int i = std::max(0, std::min(body.frames - 1, static_cast<int>(std::ceil(along - 1e-9)) - 1));
    place.body = part_name(body.name, i);
    place.name.clear();
    place.point = x;
    return;
  }
}

FrameSpec::Kind kind_of_frame(const Scene& scene, const Body& body) {
  return scene.dimension == 3 && !body.frame.given ? FrameSpec::Kind::mean_axis : body.frame.kind;
}

/// A deflection in a body of several frames is from the frame that the body would have as a whole.
void refer_to_whole(const Scene& scene, Probe& probe) {
  if (probe.quantity != Probe::Quantity::deflection) return;
  for (const Body& body : scene.bodies) {
    if (body.name != probe.at.body || body.frames == 1) continue;
    switch (kind_of_frame(scene, body)) {
      case FrameSpec::Kind::pinned:
        probe.frame = {body.frame.from, body.frame.to};
        break;
      case FrameSpec::Kind::clamped:
        probe.frame = {body.frame.at};
        break;
      case FrameSpec::Kind::mean_axis:
        for (int i = 0; i < body.frames; ++i) probe.frame.push_back({part_name(body.name, i), "start", {}, body.where});
    }
  }
}

}  // namespace

Scene split_frames(const Scene& scene) {
  Scene split = scene;
  for (Joint& joint : split.joints) redirect(scene, joint.first), redirect(scene, joint.second);
  for (Load& load : split.loads)
    if (!load.spread()) redirect(scene, load.at);
  for (Probe& probe : split.probes) {
    refer_to_whole(scene, probe);
    for (Place& place : probe.frame) redirect(scene, place);
    redirect(scene, probe.at);
    if (probe.relative_to) redirect(scene, *probe.relative_to);
    if (probe.toward) redirect(scene, *probe.toward);
  }
  split.bodies.clear();
  for (const Body& body : scene.bodies) {
    if (body.frames == 1) {
      split.bodies.push_back(body);
      continue;
    }
    for (int i = 0; i < body.frames; ++i) {
      split.bodies.push_back(part_of(body, i));
      if (i == 0) continue;
      Joint joint;
      joint.kind = Joint::Kind::fixed;
      joint.name = fmt::format("{}#{}-{}", body.name, i, i + 1);
      joint.first = {part_name(body.name, i - 1), "end", {}, body.where};
      joint.second = {part_name(body.name, i), "start", {}, body.where};
      joint.where = body.where;
      split.joints.push_back(joint);
    }
  }
  std::vector<Load> loads;
  for (const Load& load : split.loads) {
    int parts = 1;
    for (const Body& body : scene.bodies)
      if (load.spread() && body.name == load.body) parts = body.frames;
    for (int i = 0; i < parts; ++i) {
      loads.push_back(load);
      if (parts > 1) loads.back().body = part_name(load.body, i);
    }
  }
  split.loads = std::move(loads);
  return split;
}

}  // namespace floe::plan
