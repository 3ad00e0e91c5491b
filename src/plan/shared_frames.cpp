#include "floe/plan/shared_frames.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "floe/plan/prepare.h"
#include "floe/scene/joint_events.h"

namespace floe::plan {
namespace {

Eigen::Vector3d vector(const Point& p) { return {p[0], p[1], p[2]}; }

int index_of(const Scene& scene, const Place& place) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (scene.bodies[b].name == place.body) return static_cast<int>(b);
  return -1;
}

bool same(const Place& a, const Place& b) { return a.body == b.body && a.name == b.name && a.point == b.point; }

bool joined_to_ground(const Scene& scene, const Body& body) {
  return std::any_of(scene.joints.begin(), scene.joints.end(), [&](const Joint& joint) {
    return (joint.first.ground() && joint.second.body == body.name) ||
           (joint.second.ground() && joint.first.body == body.name);
  });
}

/// Whether both start with the velocities of one rigid body.
bool moves_with(const InitialSpec& welded, const InitialSpec& parent) {
  const Eigen::Vector3d spin = vector(parent.angular_velocity), rate = vector(welded.velocity),
                        carried =
                            vector(parent.velocity) + spin.cross(vector(welded.position) - vector(parent.position));
  const auto equal = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (a - b).norm() <= 1e-9 * std::max(a.norm(), b.norm());
  };
  return equal(vector(welded.angular_velocity), spin) && equal(rate, carried);
}

bool may_be_welded(const Scene& scene, const Body& welded, const Place& at, const Body& parent) {
  if (welded.reduced || parent.reduced || !parent.rigid || joined_to_ground(scene, welded)) return false;
  if (!moves_with(welded.initial, parent.initial)) return false;
  if (welded.initial.spatial_deformation || welded.initial.spatial_deformation_rate) return false;
  return welded.rigid || (!welded.frame.given && clamped_by_default(welded)) ||
         (welded.frame.given && welded.frame.kind == FrameSpec::Kind::clamped && same(welded.frame.at, at));
}

}  // namespace

bool clamped_by_default(const Body& body) { return body.rigid || body.mesh.plate || body.mesh.file; }

std::vector<SharedFrame> shared_frames(const Scene& scene) {
  std::vector<SharedFrame> shared(scene.bodies.size());
  if (scene.dimension != 3 || !scene.share_frames) return shared;
  std::vector<int> next(scene.bodies.size(), -1);  // the body to which each is welded
  const auto first_of = [&](int b) {
    while (next[b] >= 0) b = next[b];
    return b;
  };
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    const Joint& joint = scene.joints[j];
    if (joint.kind != Joint::Kind::fixed || joint.edges == Joint::Edges::mean) continue;
    if (is_unlocked(scene, joint.name) || is_measured(scene, joint.name)) continue;
    int a = index_of(scene, joint.first), b = index_of(scene, joint.second);
    if (a < 0 || b < 0 || a == b) continue;
    const auto attempt = [&](int welded, const Place& at, int parent) {
      if (next[welded] >= 0 || first_of(parent) == welded) return false;
      if (!may_be_welded(scene, scene.bodies[welded], at, scene.bodies[parent])) return false;
      next[welded] = parent;
      shared[welded].joint = static_cast<int>(j);
      return true;
    };
    if (a < b)
      attempt(b, joint.second, a) || attempt(a, joint.first, b);
    else
      attempt(a, joint.first, b) || attempt(b, joint.second, a);
  }
  for (std::size_t b = 0; b < shared.size(); ++b)
    if (next[b] >= 0) shared[b].parent = first_of(static_cast<int>(b));
  return shared;
}

}  // namespace floe::plan
