#include "surface_rise.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "floe/fem/structure.h"

namespace floe::fem {
namespace {

using Eigen::Vector3d;
using petsc::check;

const double folded = std::sin(21 * M_PI / 180);

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

/// Calls with the local node, the element's normal there and its angle.
template <class Act>
void each_corner(const Mesh& mesh, Act&& act) {
  for (const Mesh::Cell& cell : mesh.cells) {
    if (!is_flat_shell(cell)) continue;
    const Facet facet(mesh, cell);
    for (std::size_t i = 0; i < facet.corner.size(); ++i)
      act(static_cast<Eigen::Index>(cell.corners()[i]), facet.normal[i], facet.angle[i]);
  }
}

/// Over all ranks, of values at this rank's local nodes. Collective.
Eigen::VectorXd summed(const Mesh& mesh, const Eigen::VectorXd& own, int dofs) {
  const Exchange exchange(mesh, dofs);
  petsc::VecHandle field;
  check(VecCreateMPI(mesh.comm, dofs * mesh.owned_nodes, dofs * mesh.node_count, field.out()));
  check(VecSet(field, 0));
  exchange.add(own, field);
  return exchange.gather(field);
}

/// N at each local node, of either sign: the axis of greatest sum angle (n.N)^2. Zero where an element is folded from
/// it. Collective.
std::vector<Vector3d> surface_normals(const Mesh& mesh) {
  const auto nodes = static_cast<Eigen::Index>(mesh.positions.size());
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(6 * nodes), folds = Eigen::VectorXd::Zero(nodes);
  each_corner(mesh, [&](Eigen::Index node, const Vector3d& n, double angle) {
    double* sum = squares.data() + 6 * node;
    for (int a = 0; a < 3; ++a)
      for (int b = a; b < 3; ++b) *sum++ += angle * n[a] * n[b];
  });
  squares = summed(mesh, squares, 6);
  std::vector<Vector3d> normals;
  for (Eigen::Index node = 0; node < nodes; ++node) {
    const auto s = squares.segment<6>(6 * node);
    Eigen::Matrix3d sum;
    sum << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
    normals.emplace_back(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum).eigenvectors().col(2));
  }
  each_corner(mesh, [&](Eigen::Index node, const Vector3d& n, double) {
    if (n.cross(normals[node]).norm() >= folded) folds[node] += 1;
  });
  folds = summed(mesh, folds, 1);
  for (Eigen::Index node = 0; node < nodes; ++node)
    if (folds[node] > 0) normals[node].setZero();
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
    for (std::size_t i = 0; i < facet.corner.size(); ++i) {
      const double slope = facet.normal[i].cross(normals[cell.corners()[i]]).norm();
      if (slope > round_off) cell.rise += (facet.corner[i] - middle).norm() * slope / 2 / count;
    }
  }
}

}  // namespace floe::fem
