#pragma once
#include <Eigen/Dense>
#include <array>
#include <vector>

#include "floe/petsc/handle.h"

namespace floe::fem {

/// Straight segments between points, each divided into elements of equal length.
struct Segments {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 2>> join;  ///< indices of points
  std::vector<PetscInt> elements;        ///< of each segment
};

/// Nodes and cells of one body, distributed: each rank holds its share of consecutive nodes, the cells that begin there
/// and copies of the foreign nodes that those cells touch. Local node numbers count owned nodes first, then `foreign`.
struct Mesh {
  struct Cell {
    std::array<int, 2> nodes;  ///< local
    int part;                  ///< the segment
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

  PetscInt global_node(int local) const {
    return local < owned_nodes ? first_node + local : foreign[local - owned_nodes];
  }
};

/// Nodes are numbered along the segments in their order, points where they are met first; the numbering does not depend
/// on the number of ranks. Every rank makes its own share only.
Mesh mesh_of(MPI_Comm comm, const Segments& segments);

/// x -> R'(x - origin): the mesh in the axes of a frame. Rank-local.
void express_in_frame(Mesh& mesh, const Eigen::Vector3d& origin, const Eigen::Matrix3d& rotation);

struct NearestNode {
  PetscInt node;  ///< global; the lowest of equally near ones
  double distance;
  Eigen::Vector3d position;
};
/// Collective.
NearestNode nearest_node(const Mesh& mesh, const Eigen::Vector3d& point);

}  // namespace floe::fem
