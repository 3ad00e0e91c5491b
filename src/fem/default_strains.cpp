#include "floe/fem/default_strains.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace floe::fem {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

double thickness_of(const ShellSection& section) { return std::sqrt(12 * section.bending(0, 0) / section.A(0, 0)); }

/// Area and its moments, of all ranks.
struct Surface {
  double area = 0, thickness = 0;
  bool beams = false;
  Vector3d first = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();

  void add(const Mesh& mesh, const Mesh::Cell& cell) {
    const auto corner = cell.corners();
    const auto at = [&](std::size_t i) -> const Vector3d& { return mesh.positions[corner[i]]; };
    const Vector3d diagonal = at(2) - at(0), other = corner.size() == 4 ? at(3) - at(1) : at(0) - at(1);
    const double share = diagonal.cross(other).norm() / 2 / static_cast<double>(corner.size());
    for (std::size_t i = 0; i < corner.size(); ++i) {
      area += share;
      first += share * at(i);
      second += share * at(i) * at(i).transpose();
    }
  }
  void sum(MPI_Comm comm) {
    MPI_Allreduce(MPI_IN_PLACE, &area, 1, MPI_DOUBLE, MPI_SUM, comm);
    MPI_Allreduce(MPI_IN_PLACE, &thickness, 1, MPI_DOUBLE, MPI_MAX, comm);
    MPI_Allreduce(MPI_IN_PLACE, &beams, 1, MPI_CXX_BOOL, MPI_LOR, comm);
    MPI_Allreduce(MPI_IN_PLACE, first.data(), 3, MPI_DOUBLE, MPI_SUM, comm);
    MPI_Allreduce(MPI_IN_PLACE, second.data(), 9, MPI_DOUBLE, MPI_SUM, comm);
  }
};

/// EvaluationLevel of all nodes along a direction.
double extent_along(const Mesh& mesh, const Vector3d& n) {
  double ends[2] = {-INFINITY, -INFINITY};  // of -n.x and n.x
  for (const Vector3d& x : mesh.positions)
    ends[0] = std::max(ends[0], -n.dot(x)), ends[1] = std::max(ends[1], n.dot(x));
  MPI_Allreduce(MPI_IN_PLACE, ends, 2, MPI_DOUBLE, MPI_MAX, mesh.comm);
  return ends[0] + ends[1];
}

}  // namespace

std::string StrainsChoice::text() const {
  if (beams) return "second_order (beams)";
  const bool tall = height > greatest_height;
  const std::string why = tall ? fmt::format("height {:.2g} thicknesses, limit {}", height, greatest_height)
                               : fmt::format("width/length {:.2g}, limit {}", width, least_width);
  return fmt::format("{} ({})", strains() == Strains::von_karman ? "von_karman" : "second_order", why);
}

StrainsChoice default_strains(const Mesh& mesh, const std::vector<Section>& sections) {
  Surface surface;
  for (const Mesh::Cell& cell : mesh.cells) {
    if (mesh::is_line(cell.kind)) surface.beams = true;
    const auto* shell = std::get_if<ShellSection>(&sections[cell.part]);
    if (!shell) continue;
    surface.thickness = std::max(surface.thickness, thickness_of(*shell));
    surface.add(mesh, cell);
  }
  surface.sum(mesh.comm);
  StrainsChoice choice;
  choice.beams = surface.beams;
  if (!(surface.area > 0)) return choice;
  const Vector3d centre = surface.first / surface.area;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(surface.second / surface.area - centre * centre.transpose());
  const Vector3d squares = axes.eigenvalues().cwiseMax(0);  // ascending
  choice.height = extent_along(mesh, axes.eigenvectors().col(0)) / surface.thickness;
  choice.width = std::sqrt(squares[1] / squares[2]);
  return choice;
}

}  // namespace floe::fem
