#include "surface_rise.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "floe/fem/structure.h"

namespace floe::fem {
namespace {

using Eigen::Vector3d;
using petsc::check;

constexpr double folded = 0.13;  // sin^2 of half of 42 degrees

bool is_flat_shell(const Mesh::Cell& cell) { return mesh::is_shell(cell.kind) && !mesh::is_quadratic(cell.kind); }

/// An element at its corners: their places, its unit normals there (zero where an edge has no length) and its angles.
struct Facet {
  std::vector<Vector3d> corner, normal;
  std::vector<double> angle;

  Facet(const Mesh& mesh, const Mesh::Cell& cell) {
    for (const int node : cell.corners()) corner.push_back(mesh.positions[node]);
    for (std::size_t i = 0, n = corner.size(); i < n; ++i) {
      const Vector3d next = corner[(i + 1) % n] - corner[i], previous = corner[(i + n - 1) % n] - corner[i];
      const Vector3d across = next.cross(previous);
      normal.push_back(across.stableNormalized());
      angle.push_back(std::atan2(across.norm(), next.dot(previous)));
    }
  }
};

/// sum angle n n' of this rank's elements at each local node: it does not know which way normals point.
Eigen::VectorXd own_sums(const Mesh& mesh) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(6 * static_cast<Eigen::Index>(mesh.positions.size()));
  for (const Mesh::Cell& cell : mesh.cells) {
    if (!is_flat_shell(cell)) continue;
    const Facet facet(mesh, cell);
    for (std::size_t i = 0; i < facet.corner.size(); ++i) {
      const Vector3d& n = facet.normal[i];
      double* sum = sums.data() + 6 * static_cast<Eigen::Index>(cell.corners()[i]);
      for (int a = 0; a < 3; ++a)
        for (int b = a; b < 3; ++b) *sum++ += facet.angle[i] * n[a] * n[b];
    }
  }
  return sums;
}

/// N at each local node, of either sign; zero where the surface is folded. Collective.
std::vector<Vector3d> surface_normals(const Mesh& mesh) {
  const Exchange exchange(mesh, 6);
  petsc::VecHandle field;
  check(VecCreateMPI(mesh.comm, 6 * mesh.owned_nodes, 6 * mesh.node_count, field.out()));
  check(VecSet(field, 0));
  exchange.add(own_sums(mesh), field);
  const Eigen::VectorXd sums = exchange.gather(field);
  std::vector<Vector3d> normals;
  for (Eigen::Index at = 0; at < sums.size(); at += 6) {
    const auto s = sums.segment<6>(at);
    Eigen::Matrix3d sum;
    sum << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(sum);
    const bool smooth = eigen.eigenvalues()[1] < folded * sum.trace();
    normals.push_back(smooth ? Vector3d(eigen.eigenvectors().col(2)) : Vector3d::Zero());
  }
  return normals;
}

}  // namespace

void set_rises(Mesh& mesh) {
  constexpr double round_off = 1e-8;
  const std::vector<Vector3d> normals = surface_normals(mesh);
  for (Mesh::Cell& cell : mesh.cells) {
    if (!is_flat_shell(cell)) continue;
    const Facet facet(mesh, cell);
    const auto count = static_cast<double>(facet.corner.size());
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& x : facet.corner) middle += x / count;
    cell.rise = 0;
    for (std::size_t i = 0; i < facet.corner.size(); ++i) {
      const double slope = facet.normal[i].cross(normals[cell.corners()[i]]).norm();
      if (slope > round_off && slope * slope < folded)
        cell.rise += (facet.corner[i] - middle).norm() * slope / 2 / count;
    }
  }
}

}  // namespace floe::fem
