#include "straight_edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "cut_mesh.h"
#include "deck_sections.h"
#include "floe/error.h"

namespace floe::plan {
namespace {

using Eigen::Vector3d;

constexpr double factor = 1000;   // c
constexpr double in_plane = 0.1;  // min component of e in the plane of a shell: the stiffness is A times its square

struct Edge {
  std::vector<PetscInt> nodes;  // in their order along it
  std::vector<Vector3d> x;
  Vector3d along;                 // t
  std::vector<Vector3d> normals;  // of the shells along it
};

const Place& place_of(const Joint& joint, const Body& body) {
  return joint.first.body == body.name ? joint.first : joint.second;
}

bool asks(const Joint& joint, const Body& body) {
  return joint.kind == Joint::Kind::support && !body.rigid &&
         std::count(joint.straight.begin(), joint.straight.end(), true) > 0 &&
         (joint.first.body == body.name || joint.second.body == body.name);
}

std::string key(const Joint& joint) { return joint.where.text() + ".straight"; }

/// Normals of the shells that have two or more of the nodes.
std::vector<Vector3d> normals_along(const std::vector<PetscInt>& nodes, const mesh::RawMesh& whole) {
  const std::set<PetscInt> edge(nodes.begin(), nodes.end());
  std::vector<Vector3d> normals;
  for (const mesh::Cell& cell : whole.cells) {
    const int corners = mesh::corner_count(cell.kind);
    if (corners < 3 || std::count_if(cell.nodes.begin(), cell.nodes.begin() + corners,
                                     [&](PetscInt node) { return edge.count(node) > 0; }) < 2)
      continue;
    const auto x = [&](int i) -> const Vector3d& {
      return whole.positions[static_cast<std::size_t>(cell.nodes[static_cast<std::size_t>(i)])];
    };
    normals.push_back((x(2) - x(0)).cross(x(corners - 1) - x(1)).normalized());
  }
  return normals;
}

Edge edge_of(const Joint& joint, const std::vector<PetscInt>& nodes, const mesh::RawMesh& whole) {
  const auto at = [&](PetscInt node) -> const Vector3d& { return whole.positions[static_cast<std::size_t>(node)]; };
  const auto far = std::max_element(nodes.begin(), nodes.end(), [&](PetscInt a, PetscInt b) {
    return (at(a) - at(nodes[0])).squaredNorm() < (at(b) - at(nodes[0])).squaredNorm();
  });
  Edge edge{nodes, {}, (at(*far) - at(nodes[0])).normalized(), normals_along(nodes, whole)};
  std::sort(edge.nodes.begin(), edge.nodes.end(),
            [&](PetscInt a, PetscInt b) { return edge.along.dot(at(a)) < edge.along.dot(at(b)); });
  for (const PetscInt node : edge.nodes) edge.x.push_back(at(node));
  const double length = (edge.x.back() - edge.x.front()).norm();
  for (const Vector3d& x : edge.x)
    if ((x - edge.x.front()).cross(edge.along).norm() > 1e-6 * length)
      throw InputError(key(joint) + ": its place is not a straight line of nodes; expected an edge");
  for (std::size_t i = 1; i < edge.x.size(); ++i)
    if (!((edge.x[i] - edge.x[i - 1]).norm() > 1e-6 * length))
      throw InputError(
          fmt::format("{}: two nodes of its place coincide at ({:.6g}, {:.6g}, {:.6g}); expected an edge "
                      "with one node at each point",
                      key(joint), edge.x[i].x(), edge.x[i].y(), edge.x[i].z()));
  return edge;
}

void add_springs_of(const Joint& joint, const Edge& edge, int component, double stiffness,
                    std::vector<mesh::NodeSpring>& springs) {
  const Vector3d e = Vector3d::Unit(component);
  if (std::abs(e.dot(edge.along)) > 1e-6)
    throw InputError(
        fmt::format("{}: direction {} is not normal to the edge; expected one that is", key(joint), "xyz"[component]));
  // normal to all shells: only their bending resists, D/L^2 << A, so that the springs would be too stiff for it
  if (!edge.normals.empty() && std::all_of(edge.normals.begin(), edge.normals.end(),
                                           [&](const Vector3d& n) { return e.cross(n).norm() < in_plane; }))
    throw InputError(
        fmt::format("{0}: direction {1} is normal to the shell; expected one in its plane (hold: [{1}] keeps "
                    "the edge at rest in this direction)",
                    key(joint), "xyz"[component]));
  const double L = (edge.x.back() - edge.x.front()).norm();
  for (std::size_t i = 1; i < edge.nodes.size(); ++i) {
    const double l = (edge.x[i] - edge.x[i - 1]).norm(), k = factor * stiffness * L / l;
    mesh::NodeSpring spring{
        {edge.nodes[i - 1], edge.nodes[i]}, {}, Eigen::Matrix3d::Identity(), 0.5, 0, mesh::SpringKind::linear};
    spring.axes.col(0) = e, spring.axes.col(1) = edge.along, spring.axes.col(2) = e.cross(edge.along);
    spring.stiffness[0] = k, spring.stiffness[5] = k * L * L;
    springs.push_back(spring);
  }
}

}  // namespace

bool has_straight_edges(const Scene& scene, const Body& body) {
  return std::any_of(scene.joints.begin(), scene.joints.end(), [&](const Joint& joint) { return asks(joint, body); });
}

void add_straight_edges(const Scene& scene, const Body& body, const mesh::NodeSets& places, double stiffness,
                        mesh::RawMesh& raw, std::map<int, fem::Section>& parts) {
  const mesh::RawMesh whole = on_every_rank(raw);
  int rank = 0;
  MPI_Comm_rank(raw.comm, &rank);
  std::vector<mesh::NodeSpring> springs;
  for (const Joint& joint : scene.joints) {
    if (!asks(joint, body)) continue;
    const auto place = places.find(place_of(joint, body).name);
    if (place == places.end() || place->second.nodes.size() < 3)
      throw InputError(key(joint) + ": its place is no edge of three nodes or more; expected the name of an edge");
    const Edge edge = edge_of(joint, place->second.nodes, whole);
    for (int component = 0; component < 3; ++component)
      if (joint.straight[static_cast<std::size_t>(component)])
        add_springs_of(joint, edge, component, stiffness, springs);
  }
  if (!springs.empty() && !(stiffness > 0))
    throw InputError(
        fmt::format("{}.straight: body {} has no shells; expected an edge of shells", body.where.text(), body.name));
  if (rank != 0) springs.clear();
  add_springs(raw, springs, parts);
}

}  // namespace floe::plan
