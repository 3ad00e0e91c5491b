#pragma once
#include <Eigen/Geometry>
#include <map>
#include <set>

#include "floe/generate/generate.h"
#include "floe/mesh/inspect.h"
#include "mesh_files.h"

namespace floe::testing {

/// A mesh in one piece.
struct Whole {
  std::vector<std::array<double, 3>> positions;
  std::vector<std::array<PetscInt, 6>> cells;  // kind, part, nodes
  std::vector<std::string> parts;
  std::map<std::string, std::set<PetscInt>> places;
  std::vector<long long> labels;  // of nodes, then of cells
  bool operator==(const Whole&) const = default;

  Eigen::Vector3d at(PetscInt node) const { return Eigen::Vector3d(positions.at(node).data()); }
};

/// A mesh on PETSC_COMM_WORLD or PETSC_COMM_SELF on every rank. Collective.
inline Whole whole(const mesh::RawMesh& raw) {
  const bool alone = raw.comm == PETSC_COMM_SELF;
  const auto gathered = [&](const auto& mine) { return alone ? mine : of_all_ranks(mine); };
  std::vector<std::array<double, 3>> positions;
  std::vector<std::array<PetscInt, 6>> cells;
  for (const auto& x : raw.positions) positions.push_back({x[0], x[1], x[2]});
  for (const auto& cell : raw.cells)
    cells.push_back(
        {static_cast<PetscInt>(cell.kind), cell.part, cell.nodes[0], cell.nodes[1], cell.nodes[2], cell.nodes[3]});
  Whole all{gathered(positions), gathered(cells), raw.parts, {}, gathered(raw.node_labels)};
  const auto cell_labels = gathered(raw.cell_labels);
  all.labels.insert(all.labels.end(), cell_labels.begin(), cell_labels.end());
  for (std::size_t p = 0; p < raw.places.size(); ++p) {
    const auto nodes = gathered(raw.place_nodes[p]);
    all.places[raw.places[p]] = {nodes.begin(), nodes.end()};
  }
  return all;
}

/// How often each edge of the shells is run along, upwards and downwards.
inline std::map<std::array<PetscInt, 2>, std::array<int, 2>> edges_of(const Whole& all) {
  std::map<std::array<PetscInt, 2>, std::array<int, 2>> edges;
  for (const auto& cell : all.cells) {
    const int n = mesh::node_count(static_cast<mesh::CellKind>(cell[0]));
    for (int k = 0; n > 2 && k < n; ++k) {
      const PetscInt a = cell[2 + k], b = cell[2 + (k + 1) % n];
      ++edges[{std::min(a, b), std::max(a, b)}][a < b ? 0 : 1];
    }
  }
  return edges;
}

struct Topology {
  long euler, boundary_edges;  // nodes - edges + cells
};

/// Checks that no edge is run along twice in one direction, thus is in one shell or in two of the same orientation.
inline Topology topology_of(const Whole& all) {
  const auto edges = edges_of(all);
  long boundary = 0;
  bool oriented = true;
  for (const auto& [edge, times] : edges) {
    oriented = oriented && times[0] <= 1 && times[1] <= 1;
    boundary += times[0] + times[1] == 1;
  }
  CHECK(oriented);
  return {
      static_cast<long>(all.positions.size()) - static_cast<long>(edges.size()) + static_cast<long>(all.cells.size()),
      boundary};
}

/// What every generated mesh keeps; `make` is called with a communicator. Returns it in one piece. Collective.
template <class Make>
Whole sound(Make&& make, bool notices = false) {
  const mesh::RawMesh raw = make(PETSC_COMM_WORLD);
  const auto found = mesh::inspect(raw);
  CHECK(found.faults == std::vector<std::string>{});
  if (!notices) CHECK(found.notices == std::vector<std::string>{});
  const auto own = mesh::share_of(raw.node_count, this_rank(), ranks());
  const auto own_cells = mesh::share_of(raw.cell_count, this_rank(), ranks());
  CHECK((raw.first_node == own.first && static_cast<PetscInt>(raw.positions.size()) == own.count));
  CHECK((raw.first_cell == own_cells.first && static_cast<PetscInt>(raw.cells.size()) == own_cells.count));
  const Whole all = whole(raw);
  CHECK(all == whole(make(PETSC_COMM_SELF)));
  REQUIRE(all.labels.size() == all.positions.size() + all.cells.size());
  CHECK((all.labels.front() == 1 && all.labels.back() == static_cast<long long>(all.cells.size())));
  return all;
}

/// The nodes where a function of the position is 0 within 1e-12.
template <class Function>
std::set<PetscInt> nodes_where(const Whole& all, Function&& zero) {
  std::set<PetscInt> nodes;
  for (PetscInt i = 0; i < static_cast<PetscInt>(all.positions.size()); ++i)
    if (std::abs(zero(all.at(i))) < 1e-12) nodes.insert(i);
  return nodes;
}

}  // namespace floe::testing
