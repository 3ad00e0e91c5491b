#include "mesh_files.h"

#include <Eigen/Geometry>

namespace floe::testing {

double measure(const mesh::RawMesh& raw, int part) {
  std::vector<double> mine;
  for (const auto& p : raw.positions) mine.insert(mine.end(), {p[0], p[1], p[2]});
  const auto all = of_all_ranks(mine);
  const auto at = [&](PetscInt node) {
    return Eigen::Vector3d(all.at(3 * node), all.at(3 * node + 1), all.at(3 * node + 2));
  };
  double sum = 0, total = 0;
  for (const auto& cell : raw.cells) {
    if (cell.part != part) continue;
    const Eigen::Vector3d a = at(cell.nodes[1]) - at(cell.nodes[0]);
    if (mesh::is_line(cell.kind)) sum += a.norm();
    for (int k = 2; k < mesh::corner_count(cell.kind); ++k)
      sum += (at(cell.nodes[k - 1]) - at(cell.nodes[0])).cross(at(cell.nodes[k]) - at(cell.nodes[0])).norm() / 2;
  }
  MPI_Allreduce(&sum, &total, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return total;
}

}  // namespace floe::testing
