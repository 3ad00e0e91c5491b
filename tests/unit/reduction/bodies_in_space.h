#pragma once
#include "bodies.h"
#include "spatial_structures.h"

namespace floe::testing {

/// A body in space with its frame, constrained by joints, and what its reduction needs.
struct SpatiallyConstrained {
  fem::Structure structure;
  fem::ReferenceFrame frame;
  fem::Holding holding;
  reduction::Statics statics;

  /// Frame: at original node 0. @param nodes  original numbers of those that are clamped
  SpatiallyConstrained(fem::Structure s, Kind kind, const std::vector<PetscInt>& nodes)
      : structure(std::move(s)),
        frame(fem::reference_frame(structure, kind, fem::global_nodes(structure.mesh, {0})[0], 0)),
        holding(fem::holding(structure, frame, dofs_of(structure, nodes, {0, 1, 2, 3, 4, 5}))),
        statics(structure, frame, holding) {}
  SpatiallyConstrained(const SpatiallyConstrained&) = delete;

  reduction::Modes modes(int count) const {
    return reduction::vibration_modes(structure, frame, holding, statics, count);
  }
  reduction::Basis basis(int modes, bool full = false) const {
    const auto g = reduction::generators(structure, frame, holding, statics, modes, {}, 1e-7);
    return reduction::basis_of(
        structure, g,
        reduction::derivative_columns(structure, frame, holding, statics, g, reduction::all_pairs(modes), full), 1e-7);
  }
};

/// A plate of 1 x 0.7 x 0.02 of triangles or quadrilaterals; original nodes row by row along x.
inline fem::Structure small_plate(MPI_Comm comm, generate::ShellCells cells, Spread spread,
                                  fem::Strains strains = fem::Strains::von_karman) {
  generate::Plate plate{{0, 0, 0}, {1, 0, 0}, {0, 0.7, 0}, 4, 3};
  plate.cells = cells;
  fem::ShellSection section = fem::shell_section({{fem::isotropic(1e4, 0.3, 2), 0.02, 0}});
  section.strains = strains;
  return structure_of(generate::plate(comm, plate), {section}, spread);
}

/// The corners of a plate's edge x = 0.
inline std::vector<PetscInt> root_of_plate() { return {0, 5, 10, 15}; }

/// A portal with a spur out of its plane, of one section whose bending stiffnesses differ.
inline fem::Structure small_frame(MPI_Comm comm, Spread spread) {
  const generate::Polyline lines{{{0, 0, 0}, {0, 0, 1}, {1.2, 0, 1}, {1.2, 0.1, 0}, {0.6, 0.8, 1.1}},
                                 {{0, 1}, {1, 2}, {2, 3}, {1, 4}},
                                 {3, 4, 3, 3},
                                 {}};
  const fem::SpatialBeam beam{{2e4, 2, 3, 0, 1.5, 1.1, 2e-3, 3e-3, 0, {0, 0}, {0, 0}}, {0.3, 1, 0.2}, {}};
  return structure_of(generate::polyline(comm, lines), {beam}, spread);
}

/// Small bodies of every kind of cell; flat and mixed ones whose shells have strains of second order, the latter with
/// nodes that follow others.
/// `curved`: all elements of second order, linked with strains of second order; `curved_plate` a flat one.
enum class What { triangles, quadrilaterals, beams, mixed, second_order, linked_second_order, curved, curved_plate };

inline fem::Structure body_of(What what, MPI_Comm comm, Spread spread) {
  if (what == What::mixed) return mixed_structure(comm, spread);
  if (what == What::beams) return small_frame(comm, spread);
  if (what == What::second_order)
    return small_plate(comm, generate::ShellCells::quadrilaterals, spread, fem::Strains::second_order);
  if (what == What::curved) return linked_structure(comm, spread, fem::Strains::second_order, Order::second);
  if (what == What::curved_plate) {
    generate::Plate plate{{0, 0, 0}, {1, 0, 0}, {0, 0.7, 0}, 2, 2};
    plate.cells = generate::ShellCells::quadrilaterals;
    const mesh::RawMesh raw = second_order(generate::plate(comm, plate), [](const Eigen::Vector3d& x) { return x; });
    return structure_of(raw, {fem::shell_section({{fem::isotropic(1e4, 0.3, 2), 0.02, 0}})}, spread);
  }
  if (what == What::linked_second_order) return linked_structure(comm, spread, fem::Strains::second_order);
  return small_plate(
      comm, what == What::triangles ? generate::ShellCells::triangles : generate::ShellCells::quadrilaterals, spread);
}

/// Columns of a basis by original dofs, on every rank. Collective.
inline Eigen::MatrixXd columns_in_originals(const fem::Structure& s, const reduction::Basis& basis) {
  Eigen::MatrixXd V(s.dofs(), basis.columns);
  for (int j = 0; j < basis.columns; ++j) {
    Vec column = nullptr;
    petsc::check(BVGetColumn(basis.V, j, &column));
    V.col(j) = in_original_order(s, column);
    petsc::check(BVRestoreColumn(basis.V, j, &column));
  }
  return V;
}

/// A symmetric matrix by original dofs on every rank. Collective, for small structures.
inline Eigen::MatrixXd dense(const fem::Structure& s, Mat A) {
  Eigen::MatrixXd all(s.dofs(), s.dofs());
  for (Eigen::Index j = 0; j < all.cols(); ++j)
    all.col(j) = product_in_originals(s, A, Eigen::VectorXd::Unit(all.rows(), j));
  return all;
}

/// Energy and force of the whole structure element by element, by original dofs. Collective.
struct SpatialElasticity {
  double energy = 0;
  Eigen::VectorXd force;

  SpatialElasticity(const fem::Structure& s, const Eigen::VectorXd& q) : force(Eigen::VectorXd::Zero(s.dofs())) {
    body::ElasticityWork work;
    for (const auto& cell : s.mesh.cells) {
      std::vector<PetscInt> dofs;
      for (int local : s.cell_dofs(cell)) dofs.push_back(s.original_dof(local));
      const auto n = static_cast<Eigen::Index>(dofs.size());
      const body::Elasticity e = fem::elasticity(s.maps(cell), Eigen::MatrixXd::Identity(n, n));
      const Eigen::VectorXd own = q(dofs);
      Eigen::VectorXd f = Eigen::VectorXd::Zero(n);
      body::add_force(e, own, work, f);
      energy += body::energy(e, own), force(dofs) += f;
    }
    MPI_Allreduce(MPI_IN_PLACE, &energy, 1, MPI_DOUBLE, MPI_SUM, s.mesh.comm);
    MPI_Allreduce(MPI_IN_PLACE, force.data(), static_cast<int>(force.size()), MPI_DOUBLE, MPI_SUM, s.mesh.comm);
  }
};

}  // namespace floe::testing
