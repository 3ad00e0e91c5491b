#pragma once
#include "differences.h"
#include "floe/reduction/reduce.h"
#include "random.h"
#include "structures.h"

namespace floe::testing {

using Kind = fem::ReferenceFrame::Kind;

/// A structure with its frame, constrained by joints, and what its reduction needs.
struct Held {
  fem::Structure structure;
  fem::ReferenceFrame frame;
  fem::Holding holding;
  reduction::Statics statics;

  /// Frame: origin at node 0, x axis through the last node (pinned).
  Held(fem::Structure s, Kind kind, const fem::Conditions& constrained)
      : structure(std::move(s)),
        frame(fem::reference_frame(structure, kind, 0, structure.mesh.node_count - 1)),
        holding(fem::holding(structure, frame, constrained)),
        statics(structure, frame, holding) {}
  Held(const Held&) = delete;

  reduction::Generators generators(int modes) const {
    return reduction::generators(structure, frame, holding, statics, modes, {}, 1e-7);
  }
  /// Modes and all their derivatives.
  reduction::Basis basis(int modes, bool full = false, double tolerance = 1e-7) const {
    const reduction::Generators g = generators(modes);
    return reduction::basis_of(
        structure, g,
        reduction::derivative_columns(structure, frame, holding, statics, g, reduction::all_pairs(modes), full),
        tolerance);
  }
};

/// Columns of a basis on every rank. Collective.
inline Eigen::MatrixXd columns_of(const fem::Structure& structure, const reduction::Basis& basis) {
  Eigen::MatrixXd V(structure.dofs(), basis.columns);
  for (int j = 0; j < basis.columns; ++j) {
    Vec column = nullptr;
    petsc::check(BVGetColumn(basis.V, j, &column));
    V.col(j) = everywhere(column);
    petsc::check(BVRestoreColumn(basis.V, j, &column));
  }
  return V;
}

/// Energy, force and tangent of the whole structure, element by element, on every rank.
struct FullElasticity {
  double energy = 0;
  Eigen::VectorXd force;
  Eigen::MatrixXd tangent;

  FullElasticity(const fem::Structure& s, const Eigen::VectorXd& q)
      : force(Eigen::VectorXd::Zero(s.dofs())), tangent(Eigen::MatrixXd::Zero(s.dofs(), s.dofs())) {
    body::ElasticityWork work;
    for (const auto& cell : s.mesh.cells) {
      std::vector<PetscInt> dofs;
      for (int local : s.cell_dofs(cell)) dofs.push_back(s.global_dof(local));
      const body::Elasticity e = fem::elasticity(s.maps(cell), Eigen::MatrixXd::Identity(6, 6));
      const Eigen::VectorXd own = q(dofs);
      Eigen::VectorXd f = Eigen::VectorXd::Zero(6);
      Eigen::MatrixXd K = Eigen::MatrixXd::Zero(6, 6);
      body::add_force(e, own, work, f);
      body::add_tangent(e, own, 1, work, K);
      energy += body::energy(e, own), force(dofs) += f, tangent(dofs, dofs) += K;
    }
    MPI_Allreduce(MPI_IN_PLACE, &energy, 1, MPI_DOUBLE, MPI_SUM, s.mesh.comm);
    MPI_Allreduce(MPI_IN_PLACE, force.data(), static_cast<int>(force.size()), MPI_DOUBLE, MPI_SUM, s.mesh.comm);
    MPI_Allreduce(MPI_IN_PLACE, tangent.data(), static_cast<int>(tangent.size()), MPI_DOUBLE, MPI_SUM, s.mesh.comm);
  }
};

}  // namespace floe::testing
