#include "straight_body.h"

#include <cmath>
#include <optional>

#include "floe/petsc/values.h"

namespace floe::fem {
namespace {

using Eigen::Vector2d;

struct Line {
  Vector2d along = Vector2d::UnitX();
  double length = 0;  // of the order of the body's
};

/// The line through all nodes (to 1e-12 of the length). Collective.
std::optional<Line> line_of(const Structure& structure) {
  const auto& mesh = structure.mesh;
  const auto of = [&](PetscInt i) -> Vector2d { return mesh.positions[i].head<2>(); };
  double sums[6] = {0, 0, 0, 0, 0, 0};  // x, y, xx, xy, yy, count
  for (PetscInt i = 0; i < mesh.owned_nodes; ++i) {
    const Vector2d x = of(i);
    const double add[6] = {x[0], x[1], x[0] * x[0], x[0] * x[1], x[1] * x[1], 1};
    for (int k = 0; k < 6; ++k) sums[k] += add[k];
  }
  MPI_Allreduce(MPI_IN_PLACE, sums, 6, MPI_DOUBLE, MPI_SUM, mesh.comm);
  const Vector2d mean = Vector2d(sums[0], sums[1]) / sums[5];
  const double xx = sums[2] / sums[5] - mean[0] * mean[0], xy = sums[3] / sums[5] - mean[0] * mean[1],
               yy = sums[4] / sums[5] - mean[1] * mean[1], angle = std::atan2(2 * xy, xx - yy) / 2;
  Line line{{std::cos(angle), std::sin(angle)}, std::sqrt(std::max(0.0, xx + yy))};
  const Vector2d across(-line.along[1], line.along[0]);
  double off = 0;
  for (PetscInt i = 0; i < mesh.owned_nodes; ++i) off = std::max(off, std::abs(across.dot(of(i) - mean)));
  MPI_Allreduce(MPI_IN_PLACE, &off, 1, MPI_DOUBLE, MPI_MAX, mesh.comm);
  if (!(off <= 1e-12 * line.length)) return {};
  if (std::abs(line.along[1]) < 1e-12) line.along = Vector2d::UnitX();  // to the bit, as the elements have it
  if (std::abs(line.along[0]) < 1e-12) line.along = Vector2d::UnitY();
  return line;
}

}  // namespace

void separate_straight(const Structure& structure, Vec field, double share) {
  const std::optional<Line> line = line_of(structure);
  if (!line) return;
  const Vector2d along = line->along, across(-along[1], along[0]);
  petsc::Values values(field);
  Eigen::Map<Eigen::Matrix<double, 3, Eigen::Dynamic>> q(values.begin(), 3, structure.mesh.owned_nodes);
  double squares[2] = {0, 0};  // across, along
  for (Eigen::Index i = 0; i < q.cols(); ++i) {
    squares[0] += std::pow(across.dot(q.col(i).head<2>()), 2) + std::pow(line->length * q(2, i), 2);
    squares[1] += std::pow(along.dot(q.col(i).head<2>()), 2);
  }
  MPI_Allreduce(MPI_IN_PLACE, squares, 2, MPI_DOUBLE, MPI_SUM, structure.mesh.comm);
  if (squares[0] < share * share * squares[1]) {
    q.topRows<2>() = (along * (along.transpose() * q.topRows<2>())).eval();
    q.row(2).setZero();
  } else if (squares[1] < share * share * squares[0]) {
    q.topRows<2>() = (across * (across.transpose() * q.topRows<2>())).eval();
  }
}

}  // namespace floe::fem
