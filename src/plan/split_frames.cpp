#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "cut_mesh.h"
#include "floe/plan/prepare.h"
#include "floe/plan/prepare_spatial_joints.h"
#include "floe/plan/shared_frames.h"
#include "floe/scene/places.h"

namespace floe::plan {
namespace {

Point between(const Point& a, const Point& b, double s) {
  return {a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2])};
}

double distance(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

std::string part_name(const std::string& body, int i) { return fmt::format("{}#{}", body, i + 1); }

/// Bodies that are cut (cut_mesh), by name; the other split ones are single lines.
using Cuts = std::map<std::string, CutMesh>;

bool is_split(const Body& body) { return body.frames > 1; }
bool is_line(const Body& body) { return body.mesh.segments.size() == 1; }

int part_count(const Body& body, const Cuts& cuts) {
  const auto cut = cuts.find(body.name);
  return cut == cuts.end() ? body.frames : static_cast<int>(cut->second.pieces.size());
}

void to_part(const std::string& name, FrameSpec& frame) {
  for (Place* place : {&frame.from, &frame.to, &frame.at}) {
    place->body = name;
    place->point.reset();
  }
  frame.from.name = frame.at.name = "start";
  frame.to.name = "end";
}

Body part_of_line(const Body& body, int i) {
  if (body.mesh.elements[0] % body.frames != 0)
    throw InputError(fmt::format("{}: {} elements cannot be divided equally among {} frames; expected a multiple",
                                 body.where.text(), body.mesh.elements[0], body.frames));
  Body part = body;
  const Point a = body.mesh.points[body.mesh.segments[0][0]], b = body.mesh.points[body.mesh.segments[0][1]];
  part.mesh.points = {between(a, b, double(i) / body.frames), between(a, b, double(i + 1) / body.frames)};
  part.mesh.segments = {{0, 1}};
  part.mesh.elements = {body.mesh.elements[0] / body.frames};
  to_part(part_name(body.name, i), part.frame);
  return part;
}

Body part_of(const Body& body, const Cuts& cuts, int i) {
  const auto cut = cuts.find(body.name);
  Body part = cut == cuts.end() ? part_of_line(body, i) : body;
  if (cut != cuts.end()) part.mesh.piece = cut->second.pieces[i];
  part.name = part_name(body.name, i);
  part.whole = body.name, part.piece = i + 1;
  part.frames = 1;
  return part;
}

const Body* split_body(const Scene& scene, const std::string& name) {
  for (const Body& body : scene.bodies)
    if (body.name == name && is_split(body)) return &body;
  return nullptr;
}

/// Where on a line a place is, in parts from its start.
double parts_along(const Body& body, const Place& place) {
  const Point x = place_point(body.mesh, place), a = body.mesh.points[body.mesh.segments[0][0]];
  return distance(a, x) / total_length(body.mesh) * body.frames;
}

bool is_border(const Body& body, double along) {
  const double near = std::round(along);
  return std::abs(along - near) < 1e-9 && near > 0.5 && near < body.frames - 0.5;
}

/// A place of a line, on the part where its coordinates lie; on a border, the part before it.
void redirect_on_line(const Body& body, Place& place) {
  const double along = parts_along(body, place);
  const int i = std::max(0, std::min(body.frames - 1, static_cast<int>(std::ceil(along - 1e-9)) - 1));
  place.point = place_point(body.mesh, place);
  place.body = part_name(body.name, i);
  place.name.clear();
}

/// A section of a line on the part that has the element towards `toward`, which becomes an end of this part.
void redirect_section(const Body& body, Place& place, Place& toward) {
  const double along = parts_along(body, place);
  const bool onwards = parts_along(body, toward) > along;
  const int border = static_cast<int>(std::lround(along));
  redirect_on_line(body, place);
  if (onwards && is_border(body, along)) place.body = part_name(body.name, border);
  toward.body = place.body;
  toward.name = onwards ? "end" : "start";
  toward.point.reset();
}

void move_to_piece(const Body& body, int piece, Place& place) {
  if (place.name == "middle" && !place.point) place.point = place_point(body.mesh, place);
  if (place.point) place.name.clear();
  place.body = part_name(body.name, piece);
}

/// Puts a place of the whole body on the part that has it, the first of several.
/// @param beside  a place that is to be on the same part, of the same body
void redirect(const Scene& scene, const Cuts& cuts, Place& place, Place* beside = nullptr) {
  const Body* body = split_body(scene, place.body);
  if (!body) return;
  const auto cut = cuts.find(body->name);
  if (cut == cuts.end()) {
    if (beside) return redirect_section(*body, place, *beside);
    return redirect_on_line(*body, place);
  }
  std::vector<int> pieces = cut->second.pieces_of(*body, place);
  if (beside) {
    std::vector<int> both;
    const std::vector<int> others = cut->second.pieces_of(*body, *beside);
    std::set_intersection(pieces.begin(), pieces.end(), others.begin(), others.end(), std::back_inserter(both));
    pieces = both;
  }
  if (pieces.empty())
    throw InputError(
        beside
            ? fmt::format("{}: is not on the same floating frame of body {} as the place of its probe; expected a "
                          "place on the element beside it",
                          beside->where.text(), body->name)
            : fmt::format("{}: lies in several of the {} floating frames of body {}; expected a place that one frame "
                          "contains, or frames: 1",
                          place.where.text(), body->frames, body->name));
  move_to_piece(*body, pieces.front(), place);
  if (beside) move_to_piece(*body, pieces.front(), *beside);
}

/// Where the ground clamps the body, if anywhere.
const Place* clamped_place(const Scene& scene, const Body& body) {
  for (const Joint& joint : scene.joints)
    if (clamps(joint) && joint.first.ground() != joint.second.ground()) {
      const Place& place = joint.first.ground() ? joint.second : joint.first;
      if (place.body == body.name) return &place;
    }
  return nullptr;
}

/// A deflection in a body of several frames is from the frame that the body would have as a whole.
void refer_to_whole(const Scene& scene, const Cuts& cuts, Probe& probe) {
  const Body* body = split_body(scene, probe.at.body);
  if (probe.quantity != Probe::Quantity::deflection || !body) return;
  FrameSpec::Kind kind = body->frame.kind;
  const Place* at = &body->frame.at;
  if (scene.dimension == 3 && !body->frame.given) {
    const Place* clamp = clamped_by_default(*body) ? clamped_place(scene, *body) : nullptr;
    kind = clamp ? FrameSpec::Kind::clamped : FrameSpec::Kind::mean_axis;
    if (clamp) at = clamp;
  }
  if (kind == FrameSpec::Kind::pinned) probe.frame = {body->frame.from, body->frame.to};
  if (kind == FrameSpec::Kind::clamped) probe.frame = {*at};
  for (int i = 0; kind == FrameSpec::Kind::mean_axis && i < part_count(*body, cuts); ++i) {
    Place& place = probe.frame.emplace_back();
    place.body = part_name(body->name, i);
    place.where = body->where;
    place.name = "start";
    if (const auto cut = cuts.find(body->name); cut != cuts.end())
      place.name = cut->second.pieces[i]->cuts.begin()->first;
  }
}

/// At a border a section is that of the part before it; where a force acts the other side has another one, and the mean
/// of both is on no part.
void check_section(const Scene& scene, const Probe& probe) {
  const Body* body = probe.of_section() && !probe.toward ? split_body(scene, probe.at.body) : nullptr;
  if (!body || !is_line(*body)) return;
  const double along = parts_along(*body, probe.at);
  if (!is_border(*body, along)) return;
  const auto acts = [&](const Place& place) {
    return place.body == body->name && std::abs(parts_along(*body, place) - along) < 1e-9;
  };
  const bool loaded =
      std::any_of(scene.loads.begin(), scene.loads.end(),
                  [&](const Load& load) { return !load.spread() && load.joint.empty() && acts(load.at); }) ||
      std::any_of(scene.joints.begin(), scene.joints.end(),
                  [&](const Joint& joint) { return acts(joint.first) || acts(joint.second); });
  if (loaded)
    throw InputError(
        fmt::format("{}.at: lies between two floating frames of body {}, where a load or a joint acts; "
                    "expected toward: a place on one side",
                    probe.where.text(), body->name));
}

Joint between_parts(const Body& body, const Cuts& cuts, int j) {
  Joint joint;
  joint.kind = Joint::Kind::fixed;
  joint.where = body.where;
  int first = j, second = j + 1;
  std::string start = "start", end = "end";
  if (const auto cut = cuts.find(body.name); cut != cuts.end()) {
    first = cut->second.cuts[j].first, second = cut->second.cuts[j].second;
    start = end = cut->second.cuts[j].name;
    joint.edges = Joint::Edges::nodes;
  }
  joint.name = fmt::format("{}#{}-{}", body.name, first + 1, second + 1);
  joint.first = {part_name(body.name, first), end, {}, body.where};
  joint.second = {part_name(body.name, second), start, {}, body.where};
  return joint;
}

/// A spread load on each part, a pressure on those that have shells for it (or the first, which will be refused).
void add_parts_of(const Scene& scene, const Cuts& cuts, const Load& load, std::vector<Load>& loads) {
  const Body* body = load.spread() ? split_body(scene, load.body) : nullptr;
  if (!body) return loads.push_back(load);
  std::vector<int> parts(static_cast<std::size_t>(part_count(*body, cuts)));
  std::iota(parts.begin(), parts.end(), 0);
  if (const auto cut = cuts.find(body->name); cut != cuts.end() && load.kind == Load::Kind::pressure)
    if (parts = cut->second.pieces_with_shells(load.part); parts.empty()) parts = {0};
  for (int i : parts) {
    loads.push_back(load);
    loads.back().body = part_name(load.body, i);
  }
}

}  // namespace

Scene split_frames(const Scene& scene, MPI_Comm comm) {
  Cuts cuts;
  for (const Body& body : scene.bodies)
    if (is_split(body) && !is_line(body)) cuts.emplace(body.name, cut_mesh(body, comm));
  Scene split = scene;
  if (std::any_of(scene.bodies.begin(), scene.bodies.end(), is_split))
    split.unsplit = std::make_shared<const Scene>(scene);
  for (Joint& joint : split.joints) redirect(scene, cuts, joint.first), redirect(scene, cuts, joint.second);
  for (Load& load : split.loads)
    if (!load.spread()) redirect(scene, cuts, load.at);
  for (Probe& probe : split.probes) {
    check_section(scene, probe);
    refer_to_whole(scene, cuts, probe);
    for (Place& place : probe.frame) redirect(scene, cuts, place);
    redirect(scene, cuts, probe.at, probe.toward ? &*probe.toward : nullptr);
    if (probe.relative_to) redirect(scene, cuts, *probe.relative_to);
  }
  const std::vector<Load> scene_loads = std::move(split.loads);
  split.bodies.clear();
  for (const Body& body : scene.bodies) {
    if (!is_split(body)) {
      split.bodies.push_back(body);
      continue;
    }
    for (int i = 0; i < part_count(body, cuts); ++i) split.bodies.push_back(part_of(body, cuts, i));
    const auto cut = cuts.find(body.name);
    const int joints = cut == cuts.end() ? body.frames - 1 : static_cast<int>(cut->second.cuts.size());
    for (int j = 0; j < joints; ++j) split.joints.push_back(between_parts(body, cuts, j));
  }
  split.loads.clear();
  for (const Load& load : scene_loads) add_parts_of(scene, cuts, load, split.loads);
  return split;
}

}  // namespace floe::plan
