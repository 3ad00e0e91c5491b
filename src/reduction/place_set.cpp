#include "floe/reduction/place_set.h"

#include "floe/petsc/values.h"

namespace floe::reduction {

using petsc::check;

body::PlaceMap place_map(const fem::Structure& structure, const Basis& basis, const std::vector<PetscInt>& nodes) {
  const fem::Mesh& mesh = structure.mesh;
  const int d = structure.dimension(), n = structure.dofs_per_node, k = basis.columns;
  std::vector<PetscInt> mine;  // local
  for (PetscInt node : nodes)
    if (node >= mesh.first_node && node < mesh.first_node + mesh.owned_nodes) mine.push_back(node - mesh.first_node);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, k + 1);  // columns of V, then positions
  for (PetscInt node : mine) sum.col(k).head(d) += mesh.positions[node].head(d);
  for (int j = 0; j < k; ++j) {
    Vec column = nullptr;
    check(BVGetColumn(basis.V, j, &column));
    {
      petsc::Values values(column);
      for (PetscInt node : mine) sum.col(j) += fem::nodal_motion(structure, values.begin(), static_cast<int>(node));
    }
    check(BVRestoreColumn(basis.V, j, &column));
  }
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), static_cast<int>(sum.size()), MPI_DOUBLE, MPI_SUM, mesh.comm);
  sum /= static_cast<double>(nodes.size());
  return {sum.col(k).head(d), sum.topLeftCorner(d, k), sum.block(d, 0, n - d, k)};
}

}  // namespace floe::reduction
