#include "surface_rise.h"

#include <cmath>

#include "floe/fem/structure.h"
#include "floe/mesh/facet.h"

namespace floe::fem {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using petsc::check;

mesh::FacetCorner at_corner(const Mesh& mesh, const Mesh::Cell& cell, std::size_t i) {
  const auto nodes = cell.corners();
  const std::size_t n = nodes.size();
  return {mesh.positions[nodes[(i + n - 1) % n]], mesh.positions[nodes[i]], mesh.positions[nodes[(i + 1) % n]]};
}

/// Calls with the local node and the element there.
template <class Act>
void each_corner(const Mesh& mesh, Act&& act) {
  for (const Mesh::Cell& cell : mesh.cells)
    for (std::size_t i = 0; mesh::is_flat_shell(cell.kind) && i < cell.corners().size(); ++i)
      act(static_cast<Eigen::Index>(cell.corners()[i]), at_corner(mesh, cell, i));
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

/// N at each local node; zero where an element is folded from it, or the surface has a sharp edge. Collective.
std::vector<Vector3d> surface_normals(const Mesh& mesh) {
  constexpr int dofs = 9 + 3 + 1;  // sums of n n', of sectors, of angles
  const auto nodes = static_cast<Eigen::Index>(mesh.positions.size());
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(dofs * nodes), folds = Eigen::VectorXd::Zero(nodes);
  each_corner(mesh, [&](Eigen::Index node, const mesh::FacetCorner& corner) {
    auto at = sums.segment<dofs>(dofs * node);
    Eigen::Map<Matrix3d>(at.data()) += corner.weighted();
    at.segment<3>(9) += corner.sector;
    at[12] += corner.angle;
  });
  sums = summed(mesh, sums, dofs);
  std::vector<Vector3d> normals;
  for (Eigen::Index node = 0; node < nodes; ++node) {
    const auto at = sums.segment<dofs>(dofs * node);
    normals.push_back(mesh::surface_normal(Eigen::Map<const Matrix3d>(at.data())));
    if (mesh::is_sharp(at.segment<3>(9), at[12])) normals.back().setZero();
  }
  each_corner(mesh, [&](Eigen::Index node, const mesh::FacetCorner& corner) {
    if (corner.normal.cross(normals[node]).norm() >= std::sin(mesh::fold)) folds[node] += 1;
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
    if (!mesh::is_flat_shell(cell.kind)) continue;
    const auto nodes = cell.corners();
    const auto count = static_cast<double>(nodes.size());
    Vector3d middle = Vector3d::Zero();
    for (const int node : nodes) middle += mesh.positions[node] / count;
    cell.rise = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double slope = at_corner(mesh, cell, i).normal.cross(normals[nodes[i]]).norm();
      if (slope > round_off) cell.rise += (mesh.positions[nodes[i]] - middle).norm() * slope / 2 / count;
    }
  }
}

}  // namespace floe::fem
