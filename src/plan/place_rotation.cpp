#include <Eigen/Eigenvalues>
#include <algorithm>

#include "floe/fem/pressure.h"
#include "floe/math/rotation.h"
#include "floe/plan/place_weights.h"

namespace floe::plan {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Of a node: sums over the shells there, by their areas.
struct NodeOfShells {
  double bent[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};  ///< 1 - n n'
  double area = 0, stiff = 0;                    ///< stiff: of bending over membrane, h^2 / 12 [m2]

  /// Directions of rotations that the node has by itself.
  Matrix3d by_itself(RotationBy by) const {
    if (by != RotationBy::shares) return Matrix3d::Zero();
    return area > 0 ? Matrix3d(Matrix3d::Map(bent) / area) : Matrix3d::Identity();
  }
  /// l^2 times the directions of rotations that bend shells.
  Matrix3d rotary() const {
    return area > 0 ? Matrix3d(stiff / (area * area) * Matrix3d::Map(bent)) : Matrix3d::Zero();
  }
};

void add_shell(const fem::Structure& structure, const fem::Mesh::Cell& cell, NodeOfShells& node) {
  const auto corners = cell.corners();
  const auto at = [&](std::size_t i) -> const Vector3d& { return structure.mesh.positions[corners[i]]; };
  const Vector3d n = corners.size() == 4 ? Vector3d((at(2) - at(0)).cross(at(3) - at(1)))
                                         : Vector3d((at(1) - at(0)).cross(at(2) - at(0)));
  const auto* section = std::get_if<fem::ShellSection>(&structure.sections[cell.part]);
  if (!section || !(n.norm() > 0)) return;
  Matrix3d::Map(node.bent) += n.norm() * Matrix3d::Identity() - n * n.transpose() / n.norm();
  node.area += n.norm();
  node.stiff += n.norm() * section->bending.trace() / section->A.trace();
}

/// On every rank. Collective.
std::vector<NodeOfShells> nodes_of_shells(const fem::Structure& structure,
                                          const std::vector<reduction::WeightedNode>& weights) {
  const fem::Mesh& mesh = structure.mesh;
  std::vector<std::pair<PetscInt, std::size_t>> index;
  for (std::size_t i = 0; i < weights.size(); ++i) index.emplace_back(weights[i].node, i);
  std::sort(index.begin(), index.end());
  const auto place_of = [&](int local) -> std::ptrdiff_t {
    const auto at = std::lower_bound(index.begin(), index.end(), std::pair(mesh.global_node(local), std::size_t(0)));
    return at != index.end() && at->first == mesh.global_node(local) ? std::ptrdiff_t(at->second) : -1;
  };
  std::vector<NodeOfShells> all(weights.size());
  for (const fem::Mesh::Cell& cell : mesh.cells)
    if (fem::is_shell(cell))
      for (const int node : cell.places())
        if (const std::ptrdiff_t i = place_of(node); i >= 0)
          add_shell(structure, cell, all[static_cast<std::size_t>(i)]);
  constexpr int doubles = sizeof(NodeOfShells) / sizeof(double);
  MPI_Allreduce(MPI_IN_PLACE, all.front().bent, doubles * static_cast<int>(all.size()), MPI_DOUBLE, MPI_SUM, mesh.comm);
  return all;
}

}  // namespace

namespace {

/// Axes about which J resists, and the others, about which the nodes' own rotations count: those of a line without
/// shells, whose coordinates are rounded, are not those of the arms that rounding makes.
struct Axes {
  Matrix3d inverse = Matrix3d::Zero(), others = Matrix3d::Zero();
};

Axes axes_of(const Matrix3d& inertia, const Matrix3d& rotary) {
  constexpr double short_arms = 1e-6, no_bending = 1e-12;  // squares of lengths, of the greatest
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(inertia);
  const double greatest = axes.eigenvalues()[2];
  Axes found;
  for (int i = 0; i < 3; ++i) {
    const Vector3d e = axes.eigenvectors().col(i);
    const double resists = axes.eigenvalues()[i];
    if (resists > short_arms * greatest || e.dot(rotary * e) > no_bending * greatest)
      found.inverse += e * e.transpose() / resists;
    else
      found.others += e * e.transpose();
  }
  return found;
}

}  // namespace

void set_rotation(const fem::Structure& structure, std::vector<reduction::WeightedNode>& weights, RotationBy by) {
  for (reduction::WeightedNode& at : weights) at.turn.setZero(), at.twist.setZero();
  if (weights.size() < 2 || structure.mesh.dimension != 3) return;
  const std::vector<NodeOfShells> nodes = nodes_of_shells(structure, weights);
  if (by != RotationBy::displacements &&
      std::none_of(nodes.begin(), nodes.end(), [](const NodeOfShells& node) { return node.area > 0; }))
    return;
  std::vector<PetscInt> numbers;
  for (const reduction::WeightedNode& at : weights) numbers.push_back(at.node);
  const std::vector<Vector3d> x = fem::positions_of(structure.mesh, numbers);
  Vector3d centre = Vector3d::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i) centre += weights[i].weight * x[i];
  Matrix3d inertia = Matrix3d::Zero(), rotary = Matrix3d::Zero(),
           as_one = Matrix3d::Zero();  // the part of rotations that it has as a whole
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Matrix3d arm = math::skew(x[i] - centre);
    rotary += weights[i].weight * nodes[i].rotary();
    inertia -= weights[i].weight * arm * arm;
    as_one += weights[i].weight * (Matrix3d::Identity() - nodes[i].by_itself(by));
  }
  const Axes axes = axes_of(inertia + rotary, rotary);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double weight = weights[i].weight;
    weights[i].turn = weight * as_one * axes.inverse * math::skew(x[i] - centre);
    weights[i].twist = weight * as_one * (axes.inverse * nodes[i].rotary() + axes.others) +
                       weight * (nodes[i].by_itself(by) - Matrix3d::Identity());
  }
}

std::optional<Vector3d> common_normal(const fem::Structure& structure, const std::vector<PetscInt>& nodes) {
  constexpr double flat = 1e-12;  // square of an angle
  std::vector<reduction::WeightedNode> weights;
  for (const PetscInt node : nodes) weights.push_back({node, 1});
  int others = 0;  // elements that are no shells
  for (const fem::Mesh::Cell& cell : structure.mesh.cells)
    if (!fem::is_shell(cell))
      for (const int place : cell.places())
        others += std::find(nodes.begin(), nodes.end(), structure.mesh.global_node(place)) != nodes.end();
  MPI_Allreduce(MPI_IN_PLACE, &others, 1, MPI_INT, MPI_SUM, structure.mesh.comm);
  if (nodes.empty() || others > 0) return {};
  Matrix3d bent = Matrix3d::Zero();
  for (const NodeOfShells& node : nodes_of_shells(structure, weights)) {
    if (!(node.area > 0)) return {};
    bent += Matrix3d::Map(node.bent) / node.area / static_cast<double>(nodes.size());
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(bent);
  if (axes.eigenvalues()[0] > flat) return {};
  return axes.eigenvectors().col(0);
}

}  // namespace floe::plan
