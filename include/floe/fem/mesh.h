#pragma once
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "floe/mesh/links.h"
#include "floe/mesh/raw_mesh.h"
#include "floe/petsc/handle.h"

namespace floe::fem {

/// Straight segments between points, each divided into elements of equal length.
struct Segments {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 2>> join;  ///< indices of points
  std::vector<PetscInt> elements;        ///< of each segment
};

using mesh::CellKind;

/// Nodes and cells of one body, distributed: each rank holds its share of consecutive nodes, the cells that begin there
/// and copies of the foreign nodes that those cells touch. Local node numbers count owned nodes first, then `foreign`.
///
/// Nodes may follow others rigidly: they have a place and no motion of their own, and the cells that touch them act on
/// the dofs of those that they follow. Nodes of a line hinge follow its independent node but for their rotation about
/// the line, those of other links that leave rotations free but for one, two or three, phi:
///
///   u = u_independent + theta_independent x arm,   theta = (1 - S S') theta_independent + S phi;
///
/// phi are the dofs of theirs that are left, the rotations of the columns of S that are not zero (Spin::own); elements
/// that touch them act on these and on the independent node.
struct Mesh {
  /// An element: what it is, where it is, and which nodes move it.
  struct Cell {
    CellKind kind = CellKind::line;
    int part = 0;
    using Nodes = std::array<int, mesh::most_nodes>;
    Nodes place{};  ///< local nodes where it is; as many as the kind has
    /// Local nodes that move them: the same, or those that they follow; then independent nodes of those that rotate by
    /// themselves.
    std::array<int, 2 * mesh::most_nodes> moved{};
    int moving = 0;                      ///< how many
    Nodes line = mesh::no_nodes<int>();  ///< of each node on a line hinge: where in `moved` its independent node is
    double rise = 0;  ///< of a curved surface over a flat shell element of three or four nodes (set_rises) [m]
    Cell() = default;
    Cell(CellKind k, int p, const Nodes& at) : kind(k), part(p), place(at), moving(mesh::node_count(k)) {
      std::copy(at.begin(), at.end(), moved.begin());
    }
    /// Local nodes whose dofs the element acts on.
    std::span<const int> nodes() const { return {moved.data(), static_cast<std::size_t>(moving)}; }
    /// Local nodes where it is: corners, then middles of edges.
    std::span<const int> places() const { return {place.data(), static_cast<std::size_t>(mesh::node_count(kind))}; }
    std::span<const int> corners() const { return places().first(static_cast<std::size_t>(mesh::corner_count(kind))); }
    bool follows() const { return spins() || !std::equal(places().begin(), places().end(), moved.begin()); }
    bool spins() const { return line != mesh::no_nodes<int>(); }
    /// The element where it is, moved by its own nodes.
    Cell alone() const {
      Cell cell(kind, part, place);
      cell.rise = rise;
      return cell;
    }
  };
  /// An owned node that follows another one rigidly: local numbers.
  struct DependentNode {
    int node, independent_node;
  };
  MPI_Comm comm = MPI_COMM_NULL;
  int dimension = 2;
  PetscInt node_count = 0;  ///< of all ranks
  PetscInt cell_count = 0;  ///< of all ranks
  PetscInt first_node = 0;  ///< global number of local node 0
  PetscInt owned_nodes = 0;
  std::vector<PetscInt> foreign;           ///< global numbers, ascending
  std::vector<Eigen::Vector3d> positions;  ///< of local nodes
  std::vector<Cell> cells;
  std::vector<DependentNode> dependent_nodes;  ///< among the owned nodes, ascending
  /// A local node with rotations of its own: about the axis e, or `others`, about all axes normal to it.
  struct Spin {
    int node;
    Eigen::Vector3d axis;  ///< zero: none
    bool others = false;
    /// S: orthonormal columns, or zero. About one axis the column is that of the rotation nearest to it (spin_slot).
    Eigen::Matrix3d own() const;
  };
  std::vector<Spin> spins;         ///< ascending
  std::vector<PetscInt> original;  ///< of local nodes: a numbering that does not depend on ranks; empty: the global one

  /// From original numbers to global ones.
  struct Renumbering {
    std::vector<PetscInt> starts;  ///< of the ranks' shares of original numbers
    std::vector<PetscInt> global;  ///< of this rank's share
  };
  std::shared_ptr<const Renumbering> renumbering;  ///< null: original numbers are global ones

  PetscInt original_node(int local) const { return original.empty() ? global_node(local) : original[local]; }
  PetscInt global_node(int local) const {
    return local < owned_nodes ? first_node + local : foreign[local - owned_nodes];
  }
};

/// Nodes are numbered along the segments in their order, points where they are met first; the numbering does not depend
/// on the number of ranks. Every rank makes its own share only.
Mesh mesh_of(MPI_Comm comm, const Segments& segments);

/// A mesh from a file, its nodes moved to the ranks named and numbered there in their original order; elements go with
/// their first node.
/// @param ranks      of each node of this rank's share (mesh::partition); a dependent node goes with the one it follows
/// @param dependent_nodes  by numbers of `raw`, ascending, the same on all ranks (mesh::dependent_nodes)
/// Collective.
Mesh mesh_of(const mesh::RawMesh& raw, std::vector<int> ranks,
             const std::vector<mesh::DependentNode>& dependent_nodes = {});

/// The rotations of a local node that are its own; null: none.
const Mesh::Spin* spin_of(const Mesh& mesh, int local);
/// The rotation among three whose axis is nearest to e.
int spin_slot(const Eigen::Vector3d& axis);

/// Global dofs of all nodes that follow others, but for the rotations that are their own, ascending, on every rank.
/// Collective.
std::vector<PetscInt> dependent_dofs(const Mesh& mesh, int dofs_per_node);

/// Global numbers of nodes given by their original ones. Collective.
std::vector<PetscInt> global_nodes(const Mesh& mesh, const std::vector<PetscInt>& originals);

/// x -> R'(x - origin): the mesh in the axes of a frame. Rank-local.
void express_in_frame(Mesh& mesh, const Eigen::Vector3d& origin, const Eigen::Matrix3d& rotation);

/// A node that was looked for by a point.
struct NearestNode {
  PetscInt node;  ///< global; of equally near ones the first by original number, dependent nodes last
  double distance;
  Eigen::Vector3d position;
};
/// Collective.
NearestNode nearest_node(const Mesh& mesh, const Eigen::Vector3d& point);

/// Of global nodes, in their order, on every rank. Collective; `nodes` the same on all ranks.
std::vector<Eigen::Vector3d> positions_of(const Mesh& mesh, const std::vector<PetscInt>& nodes);

/// The middle of the nodes, where the mesh's own origin is farther from it than ten times the mesh is long; else that
/// origin. About a far one a body that rotates would also travel: its stiffness against rotation would stand beside the
/// arm squared times that of springs that hold it in place, and be round-off of it. Collective.
Eigen::Vector3d near_origin(const Mesh& mesh);

}  // namespace floe::fem
