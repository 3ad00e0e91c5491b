#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "floe/math/rotation.h"
#include "floe/scene/file_places.h"
#include "floe/scene/places.h"
#include "readers.h"

namespace floe::scene {
namespace {

// A place as the joints see it: its body and node.
struct Spot {
  const Body* body = nullptr;  // of the ground: none
  Point node{};
  std::optional<Point> world;  // at the start; nothing: ground that follows the other place
  bool operator==(const Spot& other) const {
    return body == other.body && (!body || node == other.node);  // the ground is one body, wherever it is constrained
  }
};

// Rods from several points of the ground may lead to one place.
bool same_pair(const Joint& joint, const Spot& first, const Spot& second, const Joint& before, const Spot& one,
               const Spot& other) {
  const bool rods = joint.kind == Joint::Kind::distance || before.kind == Joint::Kind::distance;
  const auto same = [&](const Spot& a, const Spot& b) { return a == b && (a.body || !rods || a.world == b.world); };
  return (same(first, one) && same(second, other)) || (same(first, other) && same(second, one));
}

std::optional<Point> world_point(const Body& body, const Point& node, int dimension) {
  const InitialSpec& initial = body.initial;
  Point p = node;
  try {
    if (initial.deformation && !body.rigid)
      for (int i = 0; i < 2; ++i) p[i] += (*initial.deformation)[i](node[0], node[1]);
    if (initial.spatial_deformation && !body.rigid)
      for (int i = 0; i < 3; ++i) p[i] += (*initial.spatial_deformation)[i].value(node);
  } catch (const math::FormulaError&) {
    return {};
  }
  if (dimension == 3) {
    const Point &x = initial.position, &rotation = initial.rotation;
    const Eigen::Vector3d world =
        Eigen::Vector3d(x[0], x[1], x[2]) +
        math::rotation({rotation[0], rotation[1], rotation[2]}) * Eigen::Vector3d::Map(p.data());
    return Point{world.x(), world.y(), world.z()};
  }
  const double c = std::cos(initial.angle), s = std::sin(initial.angle);
  return Point{initial.position[0] + c * p[0] - s * p[1], initial.position[1] + s * p[0] + c * p[1],
               initial.position[2] + p[2]};
}

Point reduced_point(const Body& body, const Place& place) {
  if (place.point) return *place.point;
  const Eigen::Vector3d x = in_mesh(*body.reduced->file, named_place(body, place).map.x);
  return {x.x(), x.y(), x.z()};
}

// Nothing when the place is wrong, which check_places has reported.
std::optional<Spot> find_spot(const Scene& scene, const Place& place) {
  if (place.ground()) return Spot{nullptr, {}, place.point};
  for (const Body& body : scene.bodies) {
    if (body.name != place.body || (body.mesh.points.empty() && !body.reduced)) continue;
    if (body.reduced && !body.reduced->file) return {};
    try {
      const Point node = body.reduced ? reduced_point(body, place) : place_point(body, place);
      return Spot{&body, node, world_point(body, node, scene.dimension)};
    } catch (const InputError&) {
      return {};
    }
  }
  return {};
}

// Two points that a joint keeps together must be together at the start, up to rounding in the file's numbers.
void check_distance(Document& document, const Joint& joint, const Spot& first, const Spot& second) {
  using Kind = Joint::Kind;
  const bool meets = joint.kind == Kind::fixed || joint.kind == Kind::revolute || joint.kind == Kind::driven ||
                     joint.kind == Kind::spherical || joint.kind == Kind::universal;
  if (!meets || !first.world || !second.world) return;
  double size = 0;
  for (const Spot& spot : {first, second}) {
    if (!spot.body) continue;
    size = std::max(size, spot.body->reduced ? extent_of(*spot.body->reduced->file) : total_length(spot.body->mesh));
  }
  const Point &p = *first.world, &q = *second.world;
  const double away = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
  if (!(away > 1e-6 * size)) return;
  document.fault(joint.where,
                 fmt::format("its places are {:.4g} apart at the start: ({:.6g}) and ({:.6g})", away,
                             fmt::join(p.begin(), p.begin() + document.dimension, ", "),
                             fmt::join(q.begin(), q.begin() + document.dimension, ", ")),
                 "one point (see `initial` of the bodies)");
}

}  // namespace

void check_joints(Document& document, const Scene& scene) {
  struct Held {
    const Joint* joint;
    Spot first, second;
  };
  std::vector<Held> constrained;
  for (const Joint& joint : scene.joints) {
    const auto spots = std::pair(find_spot(scene, joint.first), find_spot(scene, joint.second));
    if (!spots.first || !spots.second) continue;
    const Spot &first = *spots.first, &second = *spots.second;
    if (first == second) {
      document.fault(joint.where, first.body ? "connects a place with itself" : "connects the ground with itself",
                     "two different places");
      continue;
    }
    if (first.body && first.body == second.body && first.body->rigid) {
      document.fault(joint.where, "connects two places of one rigid body", "places of two bodies");
      continue;
    }
    check_distance(document, joint, first, second);
    if (joint.kind == Joint::Kind::spring || joint.kind == Joint::Kind::bushing) continue;  // beside a hinge
    for (const Held& other : constrained) {
      if (!same_pair(joint, first, second, *other.joint, other.first, other.second)) continue;
      document.fault(
          joint.where,
          fmt::format("connects the same two places as joint {} (line {})", other.joint->name, other.joint->where.line),
          "one joint for a pair of places (besides springs)");
      break;
    }
    constrained.push_back({&joint, first, second});
  }
}

}  // namespace floe::scene
