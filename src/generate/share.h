#pragma once
#include <functional>

#include "floe/generate/generate.h"

namespace floe::generate {

/// A node set by a formula: its i-th node, 0 <= i < count.
struct PlaceRule {
  std::string name;
  PetscInt count;
  std::function<PetscInt(PetscInt i)> node;
};

/// What is wrong with the arguments of a generator, told at once.
class Checks {
 public:
  explicit Checks(std::string of) : of_(std::move(of)) {}
  void require(bool good, const std::string& text);
  void at_least(PetscInt least, const std::string& name, PetscInt value);
  void finite(const std::string& name, const Eigen::Vector3d& value);
  void positive(const std::string& name, double value);
  /// @throws InputError  with all faults
  void finish() const;

 private:
  std::string of_;
  std::vector<std::string> faults_;
};

/// @throws InputError  more than PetscInt counts
void require_countable(const std::string& source, double nodes, double cells);

/// What a generator knows without making a node.
struct Recipe {
  std::string source;
  PetscInt nodes, cells;
  std::vector<std::string> parts;
  std::vector<PlaceRule> places;
};

/// This rank's shares of nodes, cells and places. Rank-local.
/// @param position  of a node by its number
/// @param cell      by its number
template <class Position, class CellAt>
RawMesh generated(MPI_Comm comm, const Recipe& recipe, Position&& position, CellAt&& cell) {
  RawMesh mesh;
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  const Share nodes = share_of(recipe.nodes, rank, ranks), cells = share_of(recipe.cells, rank, ranks);
  mesh.comm = comm;
  mesh.source = recipe.source;
  mesh.node_count = recipe.nodes;
  mesh.cell_count = recipe.cells;
  mesh.first_node = nodes.first;
  mesh.first_cell = cells.first;
  mesh.parts = recipe.parts;
  mesh.positions.reserve(nodes.count);
  mesh.node_labels.reserve(nodes.count);
  mesh.cells.reserve(cells.count);
  mesh.cell_labels.reserve(cells.count);
  for (PetscInt i = nodes.first; i < nodes.first + nodes.count; ++i) {
    mesh.positions.push_back(position(i));
    mesh.node_labels.push_back(i + 1LL);
  }
  for (PetscInt i = cells.first; i < cells.first + cells.count; ++i) {
    mesh.cells.push_back(cell(i));
    mesh.cell_labels.push_back(i + 1LL);
  }
  for (const auto& place : recipe.places) {
    const Share own = share_of(place.count, rank, ranks);
    mesh.places.push_back(place.name);
    auto& found = mesh.place_nodes.emplace_back();
    for (PetscInt i = own.first; i < own.first + own.count; ++i) found.push_back(place.node(i));
  }
  return mesh;
}

/// A place of one node.
inline PlaceRule single(std::string name, PetscInt node) {
  return {std::move(name), 1, [node](PetscInt) { return node; }};
}

}  // namespace floe::generate
