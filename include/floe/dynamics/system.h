#pragma once
#include <memory>
#include <string>
#include <vector>

#include "floe/dynamics/coordinates.h"
#include "floe/dynamics/term.h"
#include "floe/petsc/handle.h"

namespace floe::dynamics {

/// The equations of motion as a sum of terms, with the unknowns distributed over a communicator.
///
/// F(t, U, V, A) = 0 with U = (coordinates, multipliers); index-3 form: multiplier rows hold C(q, t).
/// A reduced system lives on PETSC_COMM_SELF with a dense tangent; a full-order one on all ranks with a sparse one.
class System {
 public:
  /// @param terms  on a parallel communicator each rank brings its own; together they are the system
  System(Coordinates coordinates, std::vector<std::unique_ptr<Term>> terms);

  const Coordinates& coordinates() const { return coordinates_; }
  MPI_Comm comm() const { return coordinates_.comm(); }

  /// A zero vector of the layout. Collective.
  petsc::VecHandle create_vector() const;
  /// An empty tangent with its pattern (dense on one rank of a SELF communicator, else AIJ). Collective.
  petsc::MatHandle create_tangent() const;
  /// Global indices of the multipliers (may be empty). Collective.
  petsc::IsHandle multipliers() const;

  /// F(t, U, V, A). Collective.
  void residual(double t, Vec U, Vec V, Vec A, ConstraintLevel level, Vec F) const;
  /// w.q dF/dU + w.v dF/dV + w.a dF/dA, assembled. Collective.
  void tangent(double t, Vec U, Vec V, Vec A, Weights weights, Mat J) const;
  /// Collective.
  Energy energy(double t, Vec U, Vec V) const;

  /// This rank's local coordinates (Coordinates). Collective.
  void gather(Vec global, Eigen::VectorXd& local) const;

 private:
  struct Local {
    Eigen::VectorXd q, v, a;
  };

  Coordinates coordinates_;
  std::vector<std::unique_ptr<Term>> terms_;
  bool identity_ = false;  // local and global numbering are the same on every rank
  bool dense_ = false;     // one rank holds everything: dense tangent
  petsc::ScatterHandle scatter_;
  petsc::VecHandle staging_;
  petsc::MappingHandle mapping_;
  mutable Local local_;
  mutable Eigen::VectorXd sum_;
  mutable std::vector<PetscInt> rows_;
};

}  // namespace floe::dynamics
