#include <algorithm>
#include <numeric>

#include "cut_mesh.h"
#include "floe/error.h"
#include "floe/mesh/exchange.h"
#include "floe/petsc/all_ranks.h"

namespace floe::plan {
namespace {

using mesh::RawMesh;

struct Coordinates {
  double x[3];
};

}  // namespace

RawMesh on_every_rank(const RawMesh& mesh) {
  RawMesh whole;
  whole.comm = mesh.comm, whole.source = mesh.source;
  whole.node_count = mesh.node_count, whole.cell_count = mesh.cell_count;
  whole.parts = mesh.parts, whole.places = mesh.places;
  std::vector<Coordinates> own;
  for (const Eigen::Vector3d& x : mesh.positions) own.push_back({{x[0], x[1], x[2]}});
  for (const Coordinates& at : petsc::of_all_ranks(mesh.comm, own))
    whole.positions.emplace_back(at.x[0], at.x[1], at.x[2]);
  whole.cells = petsc::of_all_ranks(mesh.comm, mesh.cells);
  whole.node_labels = petsc::of_all_ranks(mesh.comm, mesh.node_labels);
  whole.cell_labels = petsc::of_all_ranks(mesh.comm, mesh.cell_labels);
  for (const std::vector<PetscInt>& found : mesh.place_nodes) {
    std::vector<PetscInt> nodes = petsc::of_all_ranks(mesh.comm, found);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    whole.place_nodes.push_back(std::move(nodes));
  }
  for (const auto& [name, found] : mesh.place_weights)
    whole.place_weights[name] = petsc::of_all_ranks(mesh.comm, found);
  return whole;
}

RawMesh piece_of(const RawMesh& whole, const MeshPiece& piece, std::vector<mesh::DependentNode>& links) {
  const std::vector<int>& of_elements = *piece.of_elements;
  if (of_elements.size() != whole.cells.size()) throw InputError(whole.source + ": has changed while it was read");
  std::vector<mesh::DependentNode> own;
  for (int link : piece.links) own.push_back(links[link]);
  std::vector<PetscInt> number(whole.positions.size(), 0), nodes, cells;  // in the piece; in the whole mesh
  const auto use = [&](PetscInt node) { number[node] = 1; };
  for (const mesh::DependentNode& link : own) use(link.node), use(link.independent_node);
  for (std::size_t c = 0; c < of_elements.size(); ++c) {
    if (of_elements[c] != piece.number) continue;
    cells.push_back(static_cast<PetscInt>(c));
    for (int i = 0; i < mesh::node_count(whole.cells[c].kind); ++i) use(whole.cells[c].nodes[i]);
  }
  for (std::size_t node = 0; node < number.size(); ++node) {
    const bool used = number[node] != 0;
    number[node] = used ? static_cast<PetscInt>(nodes.size()) : -1;
    if (used) nodes.push_back(static_cast<PetscInt>(node));
  }
  RawMesh mesh;
  mesh.comm = whole.comm, mesh.source = whole.source, mesh.parts = whole.parts;
  mesh.node_count = static_cast<PetscInt>(nodes.size()), mesh.cell_count = static_cast<PetscInt>(cells.size());
  for (const PetscInt node : nodes) {
    mesh.positions.push_back(whole.positions[node]);
    mesh.node_labels.push_back(whole.node_labels[node]);
  }
  for (const PetscInt cell : cells) {
    mesh.cells.push_back(whole.cells[cell]);
    mesh.cell_labels.push_back(whole.cell_labels[cell]);
    for (PetscInt& node : mesh.cells.back().nodes)
      if (node >= 0) node = number[node];
  }
  const auto add_place = [&](const std::string& name, const auto& of_whole) {
    mesh.places.push_back(name);
    std::vector<PetscInt>& found = mesh.place_nodes.emplace_back();
    for (const auto node : of_whole)
      if (number[node] >= 0) found.push_back(number[node]);
    if (found.empty()) mesh.places.pop_back(), mesh.place_nodes.pop_back();
  };
  for (std::size_t p = 0; p < whole.places.size(); ++p) add_place(whole.places[p], whole.place_nodes[p]);
  for (const auto& [name, of_whole] : whole.place_weights)
    for (const mesh::NodeWeight& at : of_whole)
      if (number[at.node] >= 0) mesh.place_weights[name].push_back({number[at.node], at.weight});
  for (const auto& [name, of_whole] : piece.cuts) add_place(name, of_whole);
  for (mesh::DependentNode& link : own)
    link.node = number[link.node], link.independent_node = number[link.independent_node];
  links = std::move(own);
  return mesh::share_of_whole(mesh);
}

}  // namespace floe::plan
