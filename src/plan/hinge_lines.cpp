#include "hinge_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "floe/error.h"
#include "floe/math/rotation.h"
#include "floe/mesh/exchange.h"

namespace floe::plan {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// On every rank. Collective.
std::vector<Vector3d> positions(const mesh::RawMesh& mesh, const std::vector<PetscInt>& nodes) {
  struct Point {
    double x[3];
  };
  const std::vector<PetscInt> starts = mesh::starts_of(mesh.comm, static_cast<PetscInt>(mesh.positions.size()));
  std::vector<Vector3d> all;
  for (const Point& p : mesh::ask<Point>(
           mesh.comm, nodes, [&](PetscInt node) { return mesh::owner_of(starts, node); },
           [&](PetscInt node) {
             const Vector3d& x = mesh.positions[node - mesh.first_node];
             return Point{{x[0], x[1], x[2]}};
           }))
    all.emplace_back(p.x[0], p.x[1], p.x[2]);
  return all;
}

/// The line of the points; nothing where they lie on none.
std::optional<Vector3d> line_of(const std::vector<Vector3d>& points) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& x : points) mean += x / static_cast<double>(points.size());
  Vector3d far = Vector3d::Zero();
  for (const Vector3d& x : points)
    if ((x - mean).norm() > far.norm() * (1 + 1e-9)) far = x - mean;
  if (!(far.norm() > 0)) return {};
  const Vector3d along = far.normalized();
  for (const Vector3d& x : points)
    if ((x - mean).cross(along).norm() > 1e-6 * far.norm()) return {};
  return along;
}

}  // namespace

std::vector<mesh::HingeLine> hinge_lines(const Scene& scene, const Body& body, const mesh::RawMesh& mesh,
                                         const mesh::NodeSets& places, std::vector<std::string>& notices) {
  std::vector<mesh::HingeLine> lines;
  std::vector<std::string> faults;
  const auto vector = [](const Point& p) { return Vector3d(p[0], p[1], p[2]); };
  const Matrix3d to_mesh = math::rotation(vector(body.initial.rotation)).transpose();
  for (const Joint& joint : scene.joints)
    for (const Place* place : {&joint.first, &joint.second}) {
      if (body.rigid || place->body != body.name || joint.edges != Joint::Edges::line) continue;
      const auto found = places.find(place->name);
      if (place->point || found == places.end() || found->second.nodes.size() < 2) continue;
      const std::optional<Vector3d> line = line_of(positions(mesh, found->second.nodes));
      if (line && (!joint.axis_given || (to_mesh * vector(joint.axis).normalized()).cross(*line).norm() < 1e-6)) {
        const Place& other = place == &joint.first ? joint.second : joint.first;
        lines.push_back({found->second.nodes,
                         {line->x(), line->y(), line->z()},
                         joint.where.text(),
                         other.ground(),
                         other.ground() ? "ground" : "body " + other.body});
        continue;
      }
      const std::string why =
          fmt::format("{}.{}", place->body,
                      place->name + (line ? " is a straight edge, and the joint's axis is not along it"
                                          : " is not a straight edge"));
      if (joint.edges_given)
        faults.push_back(fmt::format("{}.edges: is line, but {}; expected rigid or mean, or an edge along the axis",
                                     joint.where.text(), why));
      else if (line)
        notices.push_back(
            fmt::format("joint {}: {}, so that the joint constrains the mean of its nodes", joint.name, why));
    }
  if (!faults.empty()) throw InputError(faults);
  return lines;
}

void report_left_out(const Scene& scene, const std::vector<std::string>& left_out, std::vector<std::string>& notices) {
  std::vector<std::string> faults;
  for (const Joint& joint : scene.joints) {
    if (std::find(left_out.begin(), left_out.end(), joint.where.text()) == left_out.end()) continue;
    if (joint.edges_given)
      faults.push_back(joint.where.text() +
                       ".edges: is line, but its edge meets edges of other bodies or rigid regions; expected mean, "
                       "with which the ground fixes each node of the edge separately, or edges that do not meet");
    else
      notices.push_back(
          fmt::format("joint {}: its edge meets edges of other bodies or rigid regions and cannot be a line hinge; the "
                      "ground fixes each of its nodes separately (edges: mean)",
                      joint.name));
  }
  if (!faults.empty()) throw InputError(faults);
}

std::vector<PetscInt> constrained_elsewhere(const Scene& scene, const Body& body, const mesh::NodeSets& places) {
  using Kind = Joint::Kind;
  std::vector<PetscInt> nodes;
  const auto add = [&](const Place& place) {
    const auto found = places.find(place.name);
    if (!place.point && found != places.end())
      nodes.insert(nodes.end(), found->second.nodes.begin(), found->second.nodes.end());
  };
  for (const Place* place : {&body.frame.from, &body.frame.to, &body.frame.at})
    if (body.frame.given) add(*place);
  for (const Joint& joint : scene.joints) {
    const bool clamps = joint.kind == Kind::fixed || joint.kind == Kind::driven || joint.kind == Kind::driven_slide;
    if (!clamps || joint.first.ground() == joint.second.ground()) continue;
    const Place& place = joint.first.ground() ? joint.second : joint.first;
    if (place.body == body.name) add(place);
  }
  return nodes;
}

}  // namespace floe::plan
