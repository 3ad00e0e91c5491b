#include "floe/reference/spatial_full_order.h"

#include <algorithm>

#include "floe/dynamics/damping.h"
#include "floe/dynamics/fixed_frame_body.h"

namespace floe::reference {
namespace {

constexpr int dofs = 6;  // of a node

bool is_constrained(const fem::Conditions& constrained, PetscInt dof) {
  return std::binary_search(constrained.begin(), constrained.end(), dof);
}

std::vector<int> coordinates_of(const fem::Mesh::Cell& cell, const NodeCoordinates& nodes) {
  std::vector<int> all;
  for (int node : cell.nodes())
    for (int d = 0; d < dofs; ++d) all.push_back(nodes.of_local_node(node) + d);
  return all;
}

std::vector<int> behind_frame(const SpatialFrame& frame, const std::vector<int>& elastic) {
  std::vector<int> all(6);
  for (int i = 0; i < 6; ++i) all[i] = frame.first + i;
  all.insert(all.end(), elastic.begin(), elastic.end());
  return all;
}

}  // namespace

FreeDofs free_dofs(const fem::Structure& structure, const fem::Conditions& constrained, const fem::Mesh::Cell& cell,
                   const NodeCoordinates& nodes) {
  const std::vector<int> all = structure.cell_dofs(cell), where = coordinates_of(cell, nodes);
  FreeDofs free;
  std::vector<Eigen::Index> kept;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (is_constrained(constrained, structure.global_dof(all[i]))) continue;
    kept.push_back(static_cast<Eigen::Index>(i));
    free.coordinates.push_back(where[i]);
  }
  free.V = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(all.size()), static_cast<Eigen::Index>(kept.size()));
  for (std::size_t j = 0; j < kept.size(); ++j) free.V(kept[j], static_cast<Eigen::Index>(j)) = 1;
  return free;
}

double stiffest(const fem::ElementMaps& maps) {
  return (maps.bending.isZero(0) ? maps.stiffness() : maps.bending).diagonal().maxCoeff();
}

namespace {

/// Of one element on its free dofs, with mass for all of them: what the drilling dofs lack is shared by M_xx, M_yy,
/// M_zz.
body::Inertia inertia_of(const fem::Structure& structure, const fem::Mesh::Cell& cell, const fem::ElementMaps& maps,
                         const Eigen::MatrixXd& V) {
  body::Inertia inertia = fem::inertia(maps, V);
  const Eigen::MatrixXd M = maps.mass_matrix();
  const Eigen::MatrixXd lacking = V.transpose() * (with_drilling_inertia(structure, cell, M) - M) * V / 3;
  for (int a = 0; a < 3; ++a) inertia.M[a][a] += lacking;
  return inertia;
}

}  // namespace

Eigen::MatrixXd with_drilling_inertia(const fem::Structure& structure, const fem::Mesh::Cell& cell, Eigen::MatrixXd M) {
  if (!mesh::is_shell(cell.kind)) return M;
  const auto at = [&](int i) { return structure.mesh.positions[cell.place[i]]; };
  const Eigen::Vector3d n = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
  const Eigen::MatrixXd own =  // of its corners, whomever they follow
      cell.follows() ? structure.matrix(cell.alone(), 0, 1) : M;
  const Eigen::MatrixXd T = cell.follows() ? fem::following(structure.mesh, cell) : Eigen::MatrixXd();
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(cell.places().size()); ++i) {
    const double lacking = 0.5 * own.block<3, 3>(6 * i + 3, 6 * i + 3).trace();
    if (!cell.follows()) {
      M.block<3, 3>(6 * i + 3, 6 * i + 3) += lacking * n * n.transpose();
      continue;
    }
    const Eigen::VectorXd drill = T.middleRows<3>(6 * i + 3).transpose() * n;
    M += lacking * drill * drill.transpose();
  }
  return M;
}

SpatialElements::SpatialElements(const fem::Structure& structure, const fem::ReferenceFrame& reference,
                                 fem::Conditions constrained, const NodeCoordinates& nodes, SpatialFrame frame,
                                 ElasticForce force, double viscosity)
    : structure_(structure),
      constrained_(std::move(constrained)),
      nodes_(nodes),
      frame_(std::move(frame)),
      force_(force),
      viscosity_(viscosity) {
  if (!frame_.attitude || reference.kind != fem::ReferenceFrame::Kind::mean_axis) return;
  for (const auto& motion : reference.rigid) rigid_.push_back(structure.exchange.gather(motion));
}

SpatialElements::Terms SpatialElements::terms(std::size_t c, double& stiffest) const {
  Terms terms;
  const fem::Mesh::Cell& cell = structure_.mesh.cells[c];
  const FreeDofs free = free_dofs(structure_, constrained_, cell, nodes_);
  if (!frame_.attitude && free.coordinates.empty()) return terms;
  const fem::ElementMaps maps = structure_.maps(cell);
  stiffest = std::max(stiffest, reference::stiffest(maps));
  body::Elasticity elasticity = fem::elasticity(maps, free.V);
  if (force_ == ElasticForce::linear) elasticity = body::linearised(elasticity);
  if (viscosity_ != 0)
    terms.push_back(std::make_unique<dynamics::StrainRateDamping>(free.coordinates, elasticity, viscosity_));
  if (!frame_.attitude) {
    const Eigen::MatrixXd M = free.V.transpose() * with_drilling_inertia(structure_, cell, maps.mass_matrix()) * free.V;
    terms.push_back(std::make_unique<dynamics::FixedFrameBody>(free.coordinates, M, std::move(elasticity)));
    return terms;
  }
  if (!rigid_.empty()) {
    const std::vector<int> all = structure_.cell_dofs(cell);
    Eigen::MatrixXd rows(6, free.V.cols());
    for (int motion = 0; motion < 6; ++motion)
      rows.row(motion) = rigid_[motion](all).transpose() * maps.mass_matrix() * free.V;
    std::vector<int> coordinates = free.coordinates;
    for (int i = 0; i < 6; ++i) coordinates.push_back(frame_.multipliers + i);
    terms.push_back(std::make_unique<LinearConstraint>(coordinates, rows));
  }
  terms.push_back(std::make_unique<dynamics::SpatialBody>(behind_frame(frame_, free.coordinates), frame_.attitude,
                                                          body::spatial(inertia_of(structure_, cell, maps, free.V)),
                                                          std::move(elasticity)));
  return terms;
}

SpatialElements::Terms SpatialElements::constraints(double scale) const {
  Terms terms;
  for (const PetscInt dof : constrained_) {
    const PetscInt local = dof - dofs * structure_.mesh.first_node;
    if (local >= 0 && local < structure_.owned_dofs())
      terms.push_back(std::make_unique<ConstrainedDof>(nodes_.first() + static_cast<int>(local), scale));
  }
  return terms;
}

SpatialElements::Terms SpatialElements::all() const {
  Terms all;
  double stiffest = 0;
  for (std::size_t c = 0; c < count(); ++c)
    for (auto& term : terms(c, stiffest)) all.push_back(std::move(term));
  MPI_Allreduce(MPI_IN_PLACE, &stiffest, 1, MPI_DOUBLE, MPI_MAX, structure_.mesh.comm);
  for (auto& term : constraints(stiffest > 0 ? stiffest : 1)) all.push_back(std::move(term));
  return all;
}

std::vector<std::unique_ptr<dynamics::Term>> spatial_inertia_terms(const fem::Structure& structure,
                                                                   const fem::Conditions& constrained,
                                                                   const NodeCoordinates& nodes,
                                                                   const SpatialFrame& frame, CellsOfPart part) {
  std::vector<std::unique_ptr<dynamics::Term>> terms;
  for (std::size_t c = 0; c < structure.mesh.cells.size(); ++c) {
    if (!counts(part, c)) continue;
    const fem::Mesh::Cell& cell = structure.mesh.cells[c];
    const FreeDofs free = free_dofs(structure, constrained, cell, nodes);
    const Eigen::Index k = free.V.cols();
    terms.push_back(std::make_unique<dynamics::SpatialBody>(
        behind_frame(frame, free.coordinates), frame.attitude,
        body::spatial(inertia_of(structure, cell, structure.maps(cell), free.V)),
        body::Elasticity{Eigen::MatrixXd::Zero(k, k), Eigen::MatrixXd(0, k), {}}));
  }
  return terms;
}

body::Inertia density_inertia(const fem::Structure& structure, const fem::Mesh::Cell& cell, Density density,
                              const Eigen::MatrixXd& V) {
  fem::ElementMaps maps = structure.maps(cell);
  if (density == Density::line) maps.mass = structure.line(cell), maps.rotary.clear();
  return fem::inertia(maps, V);
}

std::vector<dynamics::SpatialMarker> spatial_density_markers(const fem::Structure& structure,
                                                             const fem::Conditions& constrained,
                                                             const NodeCoordinates& nodes, const SpatialFrame& frame,
                                                             Density density, CellsOfPart part) {
  std::vector<dynamics::SpatialMarker> markers;
  for (std::size_t c = 0; c < structure.mesh.cells.size(); ++c) {
    if (!counts(part, c)) continue;
    const fem::Mesh::Cell& cell = structure.mesh.cells[c];
    const FreeDofs free = free_dofs(structure, constrained, cell, nodes);
    const body::Inertia in = density_inertia(structure, cell, density, free.V);
    if (in.m == 0) continue;
    dynamics::SpatialMarker marker;
    marker.coordinates = behind_frame(frame, free.coordinates);
    marker.attitude = frame.attitude;
    marker.mass = in.m;
    marker.x0 = in.s0;
    marker.S = in.S, marker.Q = in.Q;
    marker.psi = Eigen::Matrix3Xd::Zero(3, in.S.cols());
    markers.push_back(std::move(marker));
  }
  return markers;
}

}  // namespace floe::reference
