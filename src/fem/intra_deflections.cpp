#include <algorithm>
#include <cmath>

#include "floe/fem/field_rows.h"
#include "floe/fem/pressure.h"

namespace floe::fem {
namespace {

/// Of the edges of a cell; values: six of each local node, in body axes.
double max_intra_deflection(const Mesh& mesh, const Mesh::Cell& cell, const double* values) {
  const auto corners = cell.corners();
  const auto at = [&](std::size_t i) -> const Eigen::Vector3d& { return mesh.positions[corners[i % corners.size()]]; };
  const auto rotation = [&](std::size_t i) {
    return Eigen::Map<const Eigen::Vector3d>(values + 6 * static_cast<std::ptrdiff_t>(corners[i % corners.size()]) + 3);
  };
  const std::size_t last = corners.size() - 1;
  const Eigen::Vector3d normal =
      (last == 2 ? (at(1) - at(0)).cross(at(2) - at(0)) : (at(2) - at(0)).cross(at(3) - at(1))).normalized();
  double most = 0;
  for (std::size_t i = 0; i <= last; ++i)
    most = std::max(most, std::abs(normal.dot((rotation(i) - rotation(i + 1)).cross(at(i + 1) - at(i)))) / 8);
  return most;
}

}  // namespace

Eigen::VectorXd intra_deflections(const Structure& structure, const FieldRows& fields) {
  Eigen::ArrayXXd most = Eigen::ArrayXXd::Zero(fields.cols(), 2);  // deflect within an element, displacement
  for_each_field(structure, fields, [&](Eigen::Index j, const double* values) {
    for (const Mesh::Cell& cell : structure.mesh.cells)
      if (is_shell(cell) && !mesh::is_quadratic(cell.kind) && !cell.follows())
        most(j, 0) = std::max(most(j, 0), max_intra_deflection(structure.mesh, cell, values));
    for (std::size_t i = 0; i < structure.mesh.positions.size(); ++i)
      most(j, 1) = std::max(most(j, 1), Eigen::Map<const Eigen::Vector3d>(values + 6 * i).norm());
  });
  MPI_Allreduce(MPI_IN_PLACE, most.data(), static_cast<int>(most.size()), MPI_DOUBLE, MPI_MAX, structure.mesh.comm);
  return (most.col(0) > 0).select(most.col(0) / most.rowwise().sum(), 0).matrix();
}

}  // namespace floe::fem
