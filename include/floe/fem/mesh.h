#pragma once
#include <Eigen/Dense>
#include <array>
#include <memory>
#include <span>
#include <vector>

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
struct Mesh {
  struct Cell {
    CellKind kind = CellKind::line;
    int part = 0;
    std::array<int, 4> corner{};  ///< local nodes; as many as the kind has
    std::span<const int> nodes() const { return {corner.data(), static_cast<std::size_t>(mesh::node_count(kind))}; }
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
  std::vector<PetscInt> original;  ///< of local nodes: a numbering that does not depend on ranks; empty: the global one

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

/// A mesh from a file, its nodes moved to the ranks named and numbered there in their original order; cells go with
/// their first node.
/// @param ranks  of each node of this rank's share (mesh::partition)
/// Collective.
Mesh mesh_of(const mesh::RawMesh& raw, const std::vector<int>& ranks);

/// Global numbers of nodes given by their original ones. Collective.
std::vector<PetscInt> global_nodes(const Mesh& mesh, const std::vector<PetscInt>& originals);

/// x -> R'(x - origin): the mesh in the axes of a frame. Rank-local.
void express_in_frame(Mesh& mesh, const Eigen::Vector3d& origin, const Eigen::Matrix3d& rotation);

struct NearestNode {
  PetscInt node;  ///< global; of equally near ones the first by original number
  double distance;
  Eigen::Vector3d position;
};
/// Collective.
NearestNode nearest_node(const Mesh& mesh, const Eigen::Vector3d& point);

}  // namespace floe::fem
