#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "floe/reduction/statics.h"

namespace floe::reduction {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Root of bending over membrane stiffness, of a beam the lesser one. [m] Infinite where there is no such ratio.
struct RadiusOfGyration {
  static double of(double bending, double membrane) {
    return bending > 0 && membrane > 0 ? std::sqrt(bending / membrane) : std::numeric_limits<double>::infinity();
  }
  double operator()(const fem::BeamSection& section) const { return of(section.EI, section.EA); }
  double operator()(const fem::SpatialBeam& beam) const {
    return std::min(of(beam.section.EIy, beam.section.EA), of(beam.section.EIz, beam.section.EA));
  }
  double operator()(const fem::ShellSection& shell) const { return of(shell.D()(0, 0), shell.A(0, 0)); }
  double operator()(const fem::PointMass&) const { return std::numeric_limits<double>::infinity(); }
};

/// h, r of the cell with the greatest h/r, and whether the body bends without stretching its cells in any direction of
/// space: lines along one direction, shells with one normal.
struct Cells {
  double h = 0, r = 0;
  bool plain = true;
};

Vector3d direction(const fem::Mesh& mesh, const fem::Mesh::Cell& cell) {
  const auto at = [&](int corner) { return mesh.positions[cell.place[corner]]; };
  const Vector3d along = at(1) - at(0);
  return cell.corners().size() < 3 ? along : Vector3d(along.cross(at(2) - at(0)));
}

Cells cells_of(const fem::Structure& structure) {
  const fem::Mesh& mesh = structure.mesh;
  double least[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};  // r/h; r
  Matrix3d directions = Matrix3d::Zero();
  for (const fem::Mesh::Cell& cell : mesh.cells) {
    if (cell.corners().size() < 2) continue;
    const double h = (mesh.positions[cell.place[1]] - mesh.positions[cell.place[0]]).norm(),
                 r = std::visit(RadiusOfGyration(), structure.sections[cell.part]);
    if (r / h < least[0]) least[0] = r / h, least[1] = r;
    const Vector3d d = direction(mesh, cell).normalized();
    directions += d * d.transpose();
  }
  double all[2] = {least[0], std::numeric_limits<double>::infinity()};
  MPI_Allreduce(least, all, 1, MPI_DOUBLE, MPI_MIN, mesh.comm);
  if (least[0] > all[0]) least[1] = std::numeric_limits<double>::infinity();
  MPI_Allreduce(least + 1, all + 1, 1, MPI_DOUBLE, MPI_MIN, mesh.comm);
  MPI_Allreduce(MPI_IN_PLACE, directions.data(), 9, MPI_DOUBLE, MPI_SUM, mesh.comm);
  const Vector3d values = Eigen::SelfAdjointEigenSolver<Matrix3d>(directions, Eigen::EigenvaluesOnly).eigenvalues();
  return {all[1] / all[0], all[1], values[1] <= 1e-12 * values[2]};
}

}  // namespace

RunError too_fine(const fem::Structure& structure, const std::string& what) {
  const Cells cells = cells_of(structure);
  const double length = fem::extent(structure);
  if (cells.plain || !(cells.h > 10 * cells.r))  // (L/h)^4, the bending of a cell against that of the body
    return RunError(
        fmt::format("the mesh of {} elements is finer than double precision resolves: {}; take fewer elements",
                    structure.mesh.cell_count, what));
  return RunError(fmt::format(
      "the body is thinner than double precision resolves: {}; where it is bent or folded, an element of {:.2g} m with "
      "the radius of gyration {:.2g} m stretches (L/h)^2 (L/r)^2 = {:.1g} times as stiffly as the whole of {:.2g} m "
      "bends; take a thicker section (twice as thick: a quarter), or fewer elements (half as many along it: a quarter)",
      what, cells.h, cells.r, std::pow(length / cells.h * length / cells.r, 2), length));
}

}  // namespace floe::reduction
