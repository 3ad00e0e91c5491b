#include "rigid_regions.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "floe/petsc/all_ranks.h"
#include "floe/plan/prepare_spatial.h"

namespace floe::plan {
namespace {

/// Those at the point, or at the least distance from it, on all ranks. Collective.
std::vector<PetscInt> nearest_nodes(const mesh::RawMesh& mesh, const Eigen::Vector3d& point) {
  double least = std::numeric_limits<double>::infinity(), size = point.norm();
  for (const Eigen::Vector3d& x : mesh.positions)
    least = std::min(least, (x - point).norm()), size = std::max(size, x.norm());
  MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_DOUBLE, MPI_MIN, mesh.comm);
  MPI_Allreduce(MPI_IN_PLACE, &size, 1, MPI_DOUBLE, MPI_MAX, mesh.comm);
  std::vector<PetscInt> mine;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    if ((mesh.positions[i] - point).norm() <= least + 1e-9 * size)
      mine.push_back(mesh.first_node + static_cast<PetscInt>(i));
  return petsc::of_all_ranks(mesh.comm, mine);
}

}  // namespace

std::vector<mesh::DependentNode> with_independent_nodes(const Scene& scene, const Body& body, const mesh::RawMesh& mesh,
                                                        const std::vector<mesh::DependentNode>& links,
                                                        const mesh::NodeSets& places) {
  if (links.empty()) return links;
  std::vector<const Place*> held;
  if (body.frame.given) held = {&body.frame.from, &body.frame.to, &body.frame.at};
  for (const Joint& joint : scene.joints)
    for (const auto& [place, other] : {std::pair(&joint.first, &joint.second), {&joint.second, &joint.first}})
      if (other->ground() && place->body == body.name) held.push_back(place);
  std::vector<PetscInt> kept;
  const auto keep = [&](const std::vector<PetscInt>& nodes) { kept.insert(kept.end(), nodes.begin(), nodes.end()); };
  for (const Place* place : held)
    if (place->point)
      keep(nearest_nodes(mesh, {(*place->point)[0], (*place->point)[1], (*place->point)[2]}));
    else if (const auto found = places.find(place->name); found != places.end())
      keep(found->second.nodes);
  return mesh::with_independent_elements(mesh, links, kept);
}

std::vector<std::vector<PetscInt>> rigid_pieces(const Scene& scene, const Body& body, const mesh::NodeSets& places) {
  std::vector<std::vector<PetscInt>> pieces;
  for (const Joint& joint : scene.joints)
    for (const Place* place : {&joint.first, &joint.second}) {
      if (body.rigid || place->body != body.name || !holds_a_piece(joint)) continue;
      const auto found = places.find(place->name);
      if (found != places.end() && found->second.nodes.size() > 1) pieces.push_back(found->second.nodes);
    }
  return pieces;
}

void refuse_loose_edges(const Scene& scene, const Body& body, const std::vector<mesh::DependentNode>& links,
                        const mesh::NodeSets& places, const mesh::RawMesh& mesh) {
  std::vector<PetscInt> loose;
  for (const mesh::DependentNode& link : links)
    if (link.spins()) loose.push_back(link.node);
  std::vector<std::string> faults;
  for (const Joint& joint : scene.joints)
    for (const Place* place : {&joint.first, &joint.second}) {
      const auto found = places.find(place->name);
      if (body.rigid || place->body != body.name || place->point || found == places.end()) continue;
      const bool rotations = joint.kind == Joint::Kind::support &&
                             std::any_of(joint.hold.begin() + 3, joint.hold.end(), [](bool hold) { return hold; });
      if (found->second.nodes.size() < 2 || (joint.edges == Joint::Edges::mean && !rotations)) continue;
      if (std::none_of(found->second.nodes.begin(), found->second.nodes.end(),
                       [&](PetscInt node) { return std::binary_search(loose.begin(), loose.end(), node); }))
        continue;
      faults.push_back(fmt::format(
          "{}: its place {}.{} has nodes whose rotations a link of {} leaves free; expected a "
          "place without them, or {}",
          joint.where.text(), place->body, place->name, mesh.source, rotations ? "no rotations held" : "edges: mean"));
    }
  if (!faults.empty()) throw InputError(faults);
}

}  // namespace floe::plan
