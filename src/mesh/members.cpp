#include "floe/mesh/members.h"

#include <algorithm>

#include "floe/error.h"
#include "floe/mesh/exchange.h"
#include "text.h"

namespace floe::mesh {

std::vector<PetscInt> told_members(const RawMesh& mesh, const std::vector<PetscInt>& told) {
  const auto starts = starts_of(mesh.comm, static_cast<PetscInt>(mesh.positions.size()));
  auto nodes = told;
  const auto make_unique = [](std::vector<PetscInt>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
  };
  make_unique(nodes);
  auto members = scatter(mesh.comm, nodes, [&](PetscInt node) { return owner_of(starts, node); }).values;
  make_unique(members);
  return members;
}

std::vector<PetscInt> members_of(const RawMesh& mesh, const std::string& name) {
  const auto place = std::find(mesh.places.begin(), mesh.places.end(), name);
  if (place != mesh.places.end()) return told_members(mesh, mesh.place_nodes[place - mesh.places.begin()]);
  if (std::find(mesh.parts.begin(), mesh.parts.end(), name) == mesh.parts.end()) {
    auto known = mesh.places;
    known.insert(known.end(), mesh.parts.begin(), mesh.parts.end());
    throw InputError(mesh.source + ": there is no place or part " + in_quotes(name) + suggestion(name, known));
  }
  std::vector<PetscInt> nodes;
  for (const auto& cell : mesh.cells)
    if (mesh.parts[static_cast<std::size_t>(cell.part)] == name)  // several parts may have it
      nodes.insert(nodes.end(), cell.nodes.begin(), cell.nodes.begin() + node_count(cell.kind));
  return told_members(mesh, nodes);
}

}  // namespace floe::mesh
