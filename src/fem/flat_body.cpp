#include "floe/fem/flat_body.h"

#include <cmath>

#include "floe/petsc/values.h"
#include "kept.h"
#include "straight_body.h"

namespace floe::fem {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

bool uncoupled(const Section& section) {
  const ShellSection* shell = std::get_if<ShellSection>(&section);
  return shell && shell->coupling.squaredNorm() * shell->A.trace() <= 1e-24 * shell->bending.trace() &&
         std::abs(shell->mass_centre) <= 1e-12 * shell->mass_radius;
}

/// Whether all ranks say yes.
bool everywhere(MPI_Comm comm, bool here) {
  int yes = here;
  MPI_Allreduce(MPI_IN_PLACE, &yes, 1, MPI_INT, MPI_MIN, comm);
  return yes != 0;
}

bool uncoupled_shells(const Structure& structure) {
  bool yes = structure.dimension() == 3;
  for (const Mesh::Cell& cell : structure.mesh.cells)
    yes = yes && mesh::is_shell(cell.kind) && uncoupled(structure.sections[cell.part]);
  return everywhere(structure.mesh.comm, yes);
}

/// Twice the areas of the triangles at the first corners, as vectors, rotated to the side of `up`.
Vector3d area(const Structure& structure, const Vector3d& up) {
  Vector3d sum = Vector3d::Zero();
  const auto& at = structure.mesh.positions;
  for (const Mesh::Cell& cell : structure.mesh.cells) {
    const Vector3d& first = at[cell.place[0]];
    const Vector3d normal = (at[cell.place[1]] - first).cross(at[cell.place[2]] - first);
    sum += normal.dot(up) < 0 ? Vector3d(-normal) : normal;
  }
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), 3, MPI_DOUBLE, MPI_SUM, structure.mesh.comm);
  return sum;
}

/// A normal of one cell, the same on all ranks.
Vector3d one_normal(const Structure& structure) {
  int rank = 0, lowest = 0;
  MPI_Comm_rank(structure.mesh.comm, &rank);
  MPI_Comm_size(structure.mesh.comm, &lowest);
  Vector3d normal = Vector3d::Zero();
  if (!structure.mesh.cells.empty()) {
    lowest = rank;
    const auto& corner = structure.mesh.cells[0].place;
    const auto& at = structure.mesh.positions;
    normal = (at[corner[1]] - at[corner[0]]).cross(at[corner[2]] - at[corner[0]]);
  }
  MPI_Allreduce(MPI_IN_PLACE, &lowest, 1, MPI_INT, MPI_MIN, structure.mesh.comm);
  int size = 0;
  MPI_Comm_size(structure.mesh.comm, &size);
  if (lowest < size) MPI_Bcast(normal.data(), 3, MPI_DOUBLE, lowest, structure.mesh.comm);
  return normal;
}

/// Axes of the plane with this normal; those of the body where it is one of its coordinate planes.
Matrix3d plane_axes(const Vector3d& normal) {
  int greatest = 0, least = 0;
  normal.cwiseAbs().maxCoeff(&greatest);
  normal.cwiseAbs().minCoeff(&least);
  Matrix3d axes;
  axes.col(2) = (normal[greatest] < 0 ? -1 : 1) * normal;
  const Vector3d along = Vector3d::Unit(least);
  axes.col(0) = (along - axes.col(2).dot(along) * axes.col(2)).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

/// Least and greatest height of the nodes above the plane through the origin.
std::array<double, 2> heights(const Structure& structure, const Vector3d& normal) {
  double bounds[2] = {1e300, 1e300};
  for (const Vector3d& x : structure.mesh.positions) {
    bounds[0] = std::min(bounds[0], normal.dot(x));
    bounds[1] = std::min(bounds[1], -normal.dot(x));
  }
  MPI_Allreduce(MPI_IN_PLACE, bounds, 2, MPI_DOUBLE, MPI_MIN, structure.mesh.comm);
  return {bounds[0], -bounds[1]};
}

/// Whether some node's own rotations are about axes neither in the plane nor normal to it. Collective.
bool oblique_spins(const Mesh& mesh, const Vector3d& normal) {
  bool oblique = std::any_of(mesh.spins.begin(), mesh.spins.end(), [&](const Mesh::Spin& spin) {
    const Vector3d about = spin.own().transpose() * normal;
    return about.norm() > 1e-9 && about.norm() < 1 - 1e-9;
  });
  MPI_Allreduce(MPI_IN_PLACE, &oblique, 1, MPI_C_BOOL, MPI_LOR, mesh.comm);
  return oblique;
}

std::unique_ptr<const FlatBody> find(const Structure& structure) {
  if (!uncoupled_shells(structure)) return nullptr;
  const Vector3d sum = area(structure, one_normal(structure));
  if (!(sum.norm() > 0)) return nullptr;
  auto flat = std::make_unique<FlatBody>();
  flat->axes = plane_axes(sum.normalized());
  const auto [low, high] = heights(structure, flat->axes.col(2));
  if (!(high - low <= 1e-12 * extent(structure)) || oblique_spins(structure.mesh, flat->axes.col(2))) return nullptr;
  for (const Vector3d& x : structure.mesh.positions) {
    flat->positions.push_back(flat->axes.transpose() * x);
    flat->positions.back().z() = (low + high) / 2;
  }
  for (const Section& section : structure.sections) {
    ShellSection shell = std::get<ShellSection>(rotated(section, flat->axes));
    shell.coupling.setZero(), shell.mass_centre = 0;  // not round-off either
    flat->sections.push_back(shell);
  }
  return flat;
}

}  // namespace

const FlatBody* flat_body(const Structure& structure) {
  Kept& kept = *structure.kept;
  if (!kept.flatness_known) kept.flat = find(structure), kept.flatness_known = true;
  return kept.flat.get();
}

namespace {

/// A node's rotation, or those that are its own.
Vector3d rotation_of(const Mesh& mesh, const Vector3d& dofs, Eigen::Index node) {
  const Mesh::Spin* spin = spin_of(mesh, static_cast<int>(node));
  return spin ? Vector3d(spin->own() * dofs) : dofs;
}

}  // namespace

void separate(const Structure& structure, Vec field, double share) {
  if (structure.dimension() == 2) return separate_straight(structure, field, share);
  const FlatBody* flat = flat_body(structure);
  if (!flat) return;
  const double length = extent(structure);
  const Vector3d normal = flat->axes.col(2);
  petsc::Values values(field);
  Eigen::Map<Eigen::Matrix<double, 6, Eigen::Dynamic>> q(values.begin(), 6, structure.mesh.owned_nodes);
  double squares[2] = {0, 0};  // out of the plane, in it
  for (Eigen::Index i = 0; i < q.cols(); ++i) {
    const Vector3d u = q.col(i).head<3>(), rotation = length * rotation_of(structure.mesh, q.col(i).tail<3>(), i);
    const double w = normal.dot(u), drill = normal.dot(rotation);
    squares[0] += w * w + (rotation - drill * normal).squaredNorm();
    squares[1] += drill * drill + (u - w * normal).squaredNorm();
  }
  MPI_Allreduce(MPI_IN_PLACE, squares, 2, MPI_DOUBLE, MPI_SUM, structure.mesh.comm);
  const Matrix3d across = normal * normal.transpose(), along = Matrix3d::Identity() - across;
  for (int part : {0, 1}) {
    if (!(squares[part] < share * share * squares[1 - part])) continue;
    q.topRows<3>() = ((part == 0 ? along : across) * q.topRows<3>()).eval();
    const Eigen::Matrix3Xd rotations = q.bottomRows<3>();
    q.bottomRows<3>() = (part == 0 ? across : along) * rotations;
    for (const Mesh::Spin& spin : structure.mesh.spins)
      if (spin.node < q.cols())
        q.col(spin.node).tail<3>() =
            spin.own().transpose() * (part == 0 ? across : along) * spin.own() * rotations.col(spin.node);
  }
}

}  // namespace floe::fem
