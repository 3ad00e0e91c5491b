#include "floe/reduction/place_set.h"

#include "floe/petsc/values.h"

namespace floe::reduction {

using petsc::check;

body::PlaceMap place_map(const fem::Structure& structure, const Basis& basis, const std::vector<WeightedNode>& nodes) {
  const fem::Mesh& mesh = structure.mesh;
  const int d = structure.dimension(), n = structure.dofs_per_node, k = basis.columns;
  std::vector<WeightedNode> mine;  // local numbers
  for (const WeightedNode& at : nodes)
    if (const PetscInt local = at.node - mesh.first_node; local >= 0 && local < mesh.owned_nodes)
      mine.push_back({local, at.weight, at.arm});
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, k + 1);  // columns of V, then positions
  for (const WeightedNode& at : mine) sum.col(k).head(d) += at.weight * mesh.positions[at.node].head(d);
  for (int j = 0; j < k; ++j) {
    Vec column = nullptr;
    check(BVGetColumn(basis.V, j, &column));
    {
      petsc::Values values(column);
      for (const WeightedNode& at : mine) {
        const Eigen::VectorXd motion = fem::nodal_motion(structure, values.begin(), static_cast<int>(at.node));
        sum.col(j) += at.weight * motion;
        if (d == 3) sum.col(j).head<3>() += at.arm * motion.tail<3>();
      }
    }
    check(BVRestoreColumn(basis.V, j, &column));
  }
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), static_cast<int>(sum.size()), MPI_DOUBLE, MPI_SUM, mesh.comm);
  return {sum.col(k).head(d), sum.topLeftCorner(d, k), sum.block(d, 0, n - d, k)};
}

}  // namespace floe::reduction
