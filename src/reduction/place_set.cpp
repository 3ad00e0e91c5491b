#include "floe/reduction/place_set.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "floe/math/rotation.h"
#include "floe/petsc/values.h"

namespace floe::reduction {

using petsc::check;

namespace {

/// A node of this rank in the mean, and the node that it follows at an arm.
struct Moved {
  WeightedNode at;  ///< local number
  int independent_node = -1;
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();
  Eigen::Matrix3Xd rotation = {};  ///< rotations of the independent node
};

std::vector<Moved> moved_here(const fem::Mesh& mesh, const std::vector<WeightedNode>& nodes, int columns) {
  std::vector<Moved> mine;
  for (const WeightedNode& at : nodes) {
    const PetscInt local = at.node - mesh.first_node;
    if (local < 0 || local >= mesh.owned_nodes) continue;
    mine.push_back({{local, at.weight, at.arm, at.turn, at.twist}});
    for (const fem::Mesh::DependentNode& f : mesh.dependent_nodes) {
      if (f.node != local || mesh.dimension != 3) continue;
      mine.back().independent_node = f.independent_node,
      mine.back().arm = mesh.positions[f.node] - mesh.positions[f.independent_node];
      mine.back().rotation.setZero(3, columns);
    }
  }
  return mine;
}

/// Sum of weight/2 theta x (theta x arm) on the columns: Q. Empty where only round-off is left of it, as of an edge
/// whose nodes follow the one in its middle. Collective.
std::vector<Eigen::MatrixXd> second_order(const fem::Mesh& mesh, const std::vector<Moved>& moved,
                                          Eigen::Index columns) {
  int any = std::any_of(moved.begin(), moved.end(), [](const Moved& each) { return each.independent_node >= 0; });
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, mesh.comm);
  if (!any) return {};
  std::vector<Eigen::MatrixXd> Q(3, Eigen::MatrixXd::Zero(columns, columns));
  double terms = 0, found = 0;
  for (const Moved& each : moved)
    if (each.independent_node >= 0) terms += std::abs(each.at.weight) * each.arm.norm() * each.rotation.squaredNorm();
  MPI_Allreduce(MPI_IN_PLACE, &terms, 1, MPI_DOUBLE, MPI_SUM, mesh.comm);
  for (int a = 0; a < 3; ++a) {
    for (const Moved& each : moved)
      if (each.independent_node >= 0)
        Q[a] += each.at.weight * each.rotation.transpose() * math::arm_form(Eigen::Vector3d::Unit(a), each.arm) *
                each.rotation;
    MPI_Allreduce(MPI_IN_PLACE, Q[a].data(), static_cast<int>(Q[a].size()), MPI_DOUBLE, MPI_SUM, mesh.comm);
    found = std::max(found, Q[a].norm());
  }
  if (found <= 1e-13 * terms) return {};
  return Q;
}

/// Of nodes that rotate by theta as one the sum of turn u is theta + 1/2 C(theta, theta), since they move by
/// theta x x + 1/2 theta x (theta x x), those at arms as the nodes that they follow: H = -C. Collective.
std::vector<Eigen::Matrix3d> second_order_rotation(const fem::Mesh& mesh, const std::vector<Moved>& moved) {
  if (mesh.dimension != 3) return {};
  std::array<Eigen::Matrix3d, 3> H;
  for (int a = 0; a < 3; ++a) H[a].setZero();
  for (const Moved& each : moved) {
    const Eigen::Vector3d& x = mesh.positions[each.independent_node < 0 ? each.at.node : each.independent_node];
    for (int a = 0; a < 3; ++a) H[a] -= math::arm_form(each.at.turn.row(a).transpose(), x);
  }
  MPI_Allreduce(MPI_IN_PLACE, H[0].data(), 27, MPI_DOUBLE, MPI_SUM, mesh.comm);
  if (std::all_of(H.begin(), H.end(), [](const Eigen::Matrix3d& form) { return form.isZero(0); })) return {};
  return {H.begin(), H.end()};
}

}  // namespace

body::PlaceMap place_map(const fem::Structure& structure, const Basis& basis, const std::vector<WeightedNode>& nodes) {
  const fem::Mesh& mesh = structure.mesh;
  const int d = structure.dimension(), n = structure.dofs_per_node, k = basis.columns;
  std::vector<Moved> mine = moved_here(mesh, nodes, k);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, k + 1);  // columns of V, then positions
  for (const Moved& each : mine) sum.col(k).head(d) += each.at.weight * mesh.positions[each.at.node].head(d);
  for (int j = 0; j < k; ++j) {
    Vec column = nullptr;
    check(BVGetColumn(basis.V, j, &column));
    {
      petsc::Values values(column);
      for (Moved& each : mine) {
        const Eigen::VectorXd motion = fem::nodal_motion(structure, values.begin(), static_cast<int>(each.at.node));
        sum.col(j) += each.at.weight * motion;
        if (d == 3) sum.col(j).head<3>() += each.at.arm * motion.tail<3>();
        if (d == 3) sum.col(j).tail<3>() += each.at.turn * motion.head<3>() + each.at.twist * motion.tail<3>();
        if (each.independent_node >= 0)
          each.rotation.col(j) = fem::nodal_motion(structure, values.begin(), each.independent_node).tail<3>();
      }
    }
    check(BVRestoreColumn(basis.V, j, &column));
  }
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), static_cast<int>(sum.size()), MPI_DOUBLE, MPI_SUM, mesh.comm);
  return {sum.col(k).head(d), sum.topLeftCorner(d, k), sum.block(d, 0, n - d, k), second_order(mesh, mine, k),
          second_order_rotation(mesh, mine)};
}

}  // namespace floe::reduction
