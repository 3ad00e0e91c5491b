#pragma once
#include <petscsys.h>

#include <Eigen/Core>
#include <array>
#include <map>
#include <string>
#include <vector>

namespace floe::mesh {

/// A spring joins two nodes, which may be at one point. The last three are of second order: their nodes are the corners
/// and then the middles of the edges, from each corner to the next.
enum class CellKind : signed char {
  spring = -2,
  point,
  line,
  triangle,
  quadrilateral,
  line3,
  triangle6,
  quadrilateral8
};

constexpr bool is_quadratic(CellKind kind) { return kind >= CellKind::line3; }
constexpr bool is_line(CellKind kind) { return kind == CellKind::line || kind == CellKind::line3; }
/// Whether it is a piece of material: a beam or a shell, no mass or spring.
constexpr bool has_extent(CellKind kind) { return kind >= CellKind::line; }
constexpr bool is_shell(CellKind kind) { return has_extent(kind) && !is_line(kind); }

/// Corners of an element: 1 to 4.
constexpr int corner_count(CellKind kind) {
  return kind == CellKind::spring ? 2 : static_cast<int>(kind) + (is_quadratic(kind) ? -1 : 2);
}

/// Nodes of an element: 1 to 8.
constexpr int node_count(CellKind kind) {
  return kind == CellKind::line3 ? 3 : is_quadratic(kind) ? 2 * corner_count(kind) : corner_count(kind);
}
inline constexpr int most_nodes = 8;

/// The kind with the nodes at the corners alone.
constexpr CellKind first_order(CellKind kind) {
  return is_quadratic(kind) ? static_cast<CellKind>(static_cast<int>(kind) - 3) : kind;
}

/// Numbers of an element's nodes; those beyond its kind's number are -1.
template <class Number>
constexpr std::array<Number, most_nodes> no_nodes() {
  std::array<Number, most_nodes> nodes{};
  nodes.fill(-1);
  return nodes;
}

/// An element: its nodes, and the part that it belongs to.
struct Cell {
  CellKind kind;
  std::array<PetscInt, most_nodes> nodes;  // global; -1 where unused
  int part;
};

/// The weight that a file gives a node of a place.
struct NodeWeight {
  PetscInt node;
  double weight;
};

/// Nodes of a place, the same on all ranks, with the weights that a file gives them; else none: by lengths and areas.
struct NodeSet {
  std::vector<PetscInt> nodes;
  std::vector<double> weights = {};
};
using NodeSets = std::map<std::string, NodeSet>;

/// A mesh as a file holds it: no elements, no unknowns.
///
/// Each rank holds a contiguous share of the nodes and of the cells, in the order of the file; nodes are numbered from
/// 0 to node_count - 1. Every node is used by an element, or by something else that the file says about it.
struct RawMesh {
  MPI_Comm comm = MPI_COMM_NULL;
  PetscInt node_count = 0, cell_count = 0, first_node = 0, first_cell = 0;
  std::vector<Eigen::Vector3d> positions;          // of the share's nodes
  std::vector<Cell> cells;                         // of the share
  std::vector<std::string> parts;                  // names, same on all ranks; Cell::part indexes it
  std::vector<std::string> places;                 // names of node sets, same on all ranks
  std::vector<std::vector<PetscInt>> place_nodes;  // of each place: nodes that this rank found (the union is the set)
  std::map<std::string, std::vector<NodeWeight>> place_weights;  // of places with weights: those that this rank found
  std::vector<long long> node_labels;                            // of the share's nodes: their numbers in the file
  std::vector<long long> cell_labels;                            // of the share's elements
  std::string source;                                            // the file, for messages
};

/// The part of 0..count-1 that a rank holds when all hold the same number, give or take one.
struct Share {
  PetscInt first, count;
};
Share share_of(PetscInt count, int rank, int ranks);

/// This rank's share of a mesh that is whole on every rank. Rank-local.
RawMesh share_of_whole(const RawMesh& whole);

/// First entry of every rank when this one holds `count`; one number more than ranks, the last is the total.
/// Collective.
std::vector<PetscInt> starts_of(MPI_Comm comm, PetscInt count);

/// The rank that holds entry i.
int owner_of(const std::vector<PetscInt>& starts, PetscInt i);

}  // namespace floe::mesh
