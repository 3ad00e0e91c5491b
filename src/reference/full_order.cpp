#include "floe/reference/full_order.h"

#include <algorithm>

#include "floe/dynamics/damping.h"
#include "floe/dynamics/floating_body.h"

namespace floe::reference {

namespace {

constexpr int dofs = 3;  // of a node in the plane

bool is_constrained(const fem::Conditions& conditions, PetscInt dof) {
  return std::binary_search(conditions.begin(), conditions.end(), dof);
}

/// Element dofs that the frame leaves free, as columns of a selection matrix.
Eigen::MatrixXd free_columns(const fem::Structure& structure, const fem::Conditions& conditions,
                             const std::vector<int>& cell, std::vector<int>& kept) {
  kept.clear();
  for (std::size_t i = 0; i < cell.size(); ++i)
    if (!is_constrained(conditions, structure.global_dof(cell[i]))) kept.push_back(static_cast<int>(i));
  Eigen::MatrixXd V =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(cell.size()), static_cast<Eigen::Index>(kept.size()));
  for (std::size_t j = 0; j < kept.size(); ++j) V(kept[j], j) = 1;
  return V;
}

std::vector<int> with_frame(int frame, const std::vector<int>& cell, const NodeCoordinates& nodes) {
  std::vector<int> all = {frame, frame + 1, frame + 2};
  for (int dof : cell) all.push_back(nodes.of_local_node(dof / dofs) + dof % dofs);
  return all;
}

}  // namespace

NodeCoordinates::NodeCoordinates(dynamics::Coordinates& coordinates, const fem::Mesh& mesh,
                                 const std::vector<PetscInt>& visited, int dofs_per_node, bool everywhere)
    : dofs_(dofs_per_node) {
  int rank = 0, size = 1;
  MPI_Comm_rank(mesh.comm, &rank);
  MPI_Comm_size(mesh.comm, &size);
  std::vector<PetscInt> nodes = mesh.foreign;
  if (everywhere || rank == size - 1)
    for (PetscInt node : visited) {
      const bool own = node >= mesh.first_node && node < mesh.first_node + mesh.owned_nodes;
      if (!own && std::find(nodes.begin(), nodes.end(), node) == nodes.end()) nodes.push_back(node);
    }
  std::vector<PetscInt> foreign;
  for (PetscInt node : nodes)
    for (int d = 0; d < dofs_; ++d) foreign.push_back(dofs_ * node + d);
  first_ = coordinates.add_distributed(dofs_ * mesh.owned_nodes, foreign);
  for (PetscInt i = 0; i < mesh.owned_nodes; ++i)
    first_of_node_[mesh.first_node + i] = first_ + dofs_ * static_cast<int>(i);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    first_of_node_[nodes[i]] = first_ + dofs_ * static_cast<int>(mesh.owned_nodes + i);
}

std::vector<std::unique_ptr<dynamics::Term>> full_order_terms(const fem::Structure& structure,
                                                              const fem::ReferenceFrame& reference,
                                                              const NodeCoordinates& nodes, int frame, int multipliers,
                                                              ElasticForce force, double viscosity) {
  std::vector<std::unique_ptr<dynamics::Term>> terms;
  const bool mean_axis = reference.kind == fem::ReferenceFrame::Kind::mean_axis;
  std::vector<Eigen::VectorXd> rigid;
  for (const auto& motion : reference.rigid) rigid.push_back(structure.exchange.gather(motion));
  double stiffest = 0;
  std::vector<int> kept;
  for (const auto& cell : structure.mesh.cells) {
    const fem::ElementMaps maps = structure.maps(cell);
    const std::vector<int> all = structure.cell_dofs(cell);
    const Eigen::MatrixXd V = free_columns(structure, reference.conditions, all, kept);
    std::vector<int> free;
    for (int i : kept) free.push_back(all[i]);
    body::Elasticity elasticity = fem::elasticity(maps, V);
    if (force == ElasticForce::linear) elasticity = body::linearised(elasticity);
    const body::PlanarInertia inertia = body::planar(fem::inertia(maps, V));
    if (viscosity != 0) {
      std::vector<int> elastic = with_frame(frame, free, nodes);
      elastic.erase(elastic.begin(), elastic.begin() + 3);
      terms.push_back(std::make_unique<dynamics::StrainRateDamping>(std::move(elastic), elasticity, viscosity));
    }
    stiffest = std::max(stiffest, maps.bending.diagonal().maxCoeff());
    if (mean_axis) {
      Eigen::MatrixXd rows(3, static_cast<Eigen::Index>(all.size()));
      for (int motion = 0; motion < 3; ++motion) rows.row(motion) = rigid[motion](all).transpose() * maps.mass_matrix();
      std::vector<int> coordinates = with_frame(frame, all, nodes);
      coordinates.erase(coordinates.begin(), coordinates.begin() + 3);
      for (int i = 0; i < 3; ++i) coordinates.push_back(multipliers + i);
      terms.push_back(std::make_unique<LinearConstraint>(coordinates, rows));
    }
    terms.push_back(
        std::make_unique<dynamics::FloatingBody>(with_frame(frame, free, nodes), inertia, std::move(elasticity)));
  }
  for (PetscInt dof : reference.conditions) {
    const PetscInt local = dof - dofs * structure.mesh.first_node;
    if (local < 0 || local >= dofs * structure.mesh.owned_nodes) continue;
    terms.push_back(
        std::make_unique<ConstrainedDof>(nodes.first() + static_cast<int>(local), stiffest > 0 ? stiffest : 1));
  }
  return terms;
}

std::vector<std::unique_ptr<dynamics::Term>> inertia_terms(const fem::Structure& structure,
                                                           const fem::Conditions& constrained,
                                                           const NodeCoordinates& nodes, int frame, CellsOfPart part) {
  std::vector<std::unique_ptr<dynamics::Term>> terms;
  std::vector<int> kept;
  for (std::size_t c = 0; c < structure.mesh.cells.size(); ++c) {
    if (!counts(part, c)) continue;
    const std::vector<int> all = structure.cell_dofs(structure.mesh.cells[c]);
    const Eigen::MatrixXd V = free_columns(structure, constrained, all, kept);
    std::vector<int> free;
    for (int i : kept) free.push_back(all[i]);
    const Eigen::Index k = V.cols();
    terms.push_back(std::make_unique<dynamics::FloatingBody>(
        with_frame(frame, free, nodes), body::planar(fem::inertia(structure.maps(structure.mesh.cells[c]), V)),
        body::Elasticity{Eigen::MatrixXd::Zero(k, k), Eigen::MatrixXd(0, k), {}}));
  }
  return terms;
}

std::vector<dynamics::Marker> density_markers(const fem::Structure& structure, const fem::Conditions& constrained,
                                              const NodeCoordinates& nodes, int frame, Density density,
                                              CellsOfPart part) {
  std::vector<dynamics::Marker> markers;
  for (std::size_t c = 0; c < structure.mesh.cells.size(); ++c) {
    if (!counts(part, c)) continue;
    const fem::Mesh::Cell& cell = structure.mesh.cells[c];
    const std::vector<int> all = structure.cell_dofs(cell);
    fem::ElementMaps maps = structure.maps(cell);
    if (density == Density::line) maps.mass = structure.line(cell), maps.rotary.clear();
    const body::PlanarInertia in = body::planar(fem::inertia(
        maps, Eigen::MatrixXd::Identity(static_cast<Eigen::Index>(all.size()), static_cast<Eigen::Index>(all.size()))));
    dynamics::Marker marker;
    marker.framed = true;
    marker.coordinates = with_frame(frame, all, nodes);
    marker.mass = in.m;
    marker.x = in.s0;
    marker.S = in.S, marker.Q = in.Q;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!is_constrained(constrained, structure.global_dof(all[i]))) continue;
      const auto at = static_cast<Eigen::Index>(i);
      marker.S.col(at).setZero();
      for (Eigen::MatrixXd& Q : marker.Q) Q.row(at).setZero(), Q.col(at).setZero();
    }
    marker.psi = Eigen::RowVectorXd::Zero(in.S.cols());
    markers.push_back(std::move(marker));
  }
  return markers;
}

dynamics::Marker node_marker(const fem::Conditions& constrained, const NodeCoordinates& nodes, int frame, PetscInt node,
                             const Eigen::Vector3d& x) {
  dynamics::Marker marker;
  const int first = nodes.of_node(node);
  marker.framed = true;
  marker.coordinates = {frame, frame + 1, frame + 2, first, first + 1, first + 2};
  marker.x = x.head<2>();
  marker.S = Eigen::Matrix<double, 2, 3>::Identity();
  marker.psi = Eigen::RowVector3d(0, 0, 1);
  for (int d = 0; d < dofs; ++d)
    if (is_constrained(constrained, dofs * node + d)) marker.S.col(d).setZero(), marker.psi[d] = 0;
  return marker;
}

std::vector<dynamics::Marker> corotational_line_markers(const fem::Structure& structure, const NodeCoordinates& nodes,
                                                        CellsOfPart part) {
  std::vector<dynamics::Marker> markers;
  for (std::size_t c = 0; c < structure.mesh.cells.size(); ++c) {
    if (!counts(part, c)) continue;
    const fem::Mesh::Cell& cell = structure.mesh.cells[c];
    const double length = (structure.mesh.positions[cell.place[1]] - structure.mesh.positions[cell.place[0]]).norm();
    for (int node : cell.nodes()) {
      dynamics::Marker marker;
      const int first = nodes.of_local_node(node);
      marker.coordinates = {first, first + 1};
      marker.S = 0.5 * length * Eigen::Matrix2d::Identity();
      marker.psi = Eigen::RowVector2d::Zero();
      markers.push_back(std::move(marker));
    }
  }
  return markers;
}

LinearConstraint::LinearConstraint(std::vector<int> coordinates, Eigen::MatrixXd C)
    : coordinates_(std::move(coordinates)), C_(std::move(C)) {}

void LinearConstraint::residual(const dynamics::Motion& motion, Eigen::VectorXd& r) const {
  const Eigen::Index n = C_.cols();
  r.head(n).noalias() += C_.transpose() * motion.q.tail(C_.rows());
  const Eigen::VectorXd& constrained = motion.level == dynamics::ConstraintLevel::position   ? motion.q
                                       : motion.level == dynamics::ConstraintLevel::velocity ? motion.v
                                                                                             : motion.a;
  r.tail(C_.rows()).noalias() += C_ * constrained.head(n);
}

void LinearConstraint::tangent(const dynamics::Motion&, dynamics::Weights, Eigen::MatrixXd& J) const {
  const Eigen::Index n = C_.cols(), m = C_.rows();
  J.bottomLeftCorner(m, n) += C_;
  J.topRightCorner(n, m) += C_.transpose();
}

void ConstrainedDof::residual(const dynamics::Motion& motion, Eigen::VectorXd& r) const {
  r[0] += scale_ * motion.q[0];
}

void ConstrainedDof::tangent(const dynamics::Motion&, dynamics::Weights, Eigen::MatrixXd& J) const {
  J(0, 0) += scale_;
}

}  // namespace floe::reference
