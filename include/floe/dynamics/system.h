#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "floe/dynamics/attitude.h"
#include "floe/dynamics/coordinates.h"
#include "floe/dynamics/term.h"
#include "floe/petsc/handle.h"

namespace floe::dynamics {

/// Attitudes among a system's unknowns, each with the local index of the first of its three.
using Attitudes = std::vector<std::pair<int, std::shared_ptr<Attitude>>>;

/// The equations of motion as a sum of terms, with the unknowns distributed over a communicator.
///
/// F(t, U, V, A) = 0 with U = (coordinates, multipliers); index-3 form: multiplier rows hold C(q, t).
/// A reduced system lives on PETSC_COMM_SELF, where its tangent is nearly full and dense; a full-order one lives on all
/// ranks with a sparse tangent.
class System {
 public:
  /// @param terms      on a parallel communicator each rank brings its own; together they are the system
  /// @param attitudes  those among this rank's local coordinates; ranks that share one hold a copy of its base each
  /// Collective.
  System(Coordinates coordinates, std::vector<std::unique_ptr<Term>> terms, Attitudes attitudes = {});

  const Coordinates& coordinates() const { return coordinates_; }
  MPI_Comm comm() const { return coordinates_.comm(); }

  /// A zero vector of the layout. Collective.
  petsc::VecHandle create_vector() const;
  /// An empty tangent with its pattern: dense where all unknowns are shared and the terms fill half of it, else AIJ.
  /// Collective.
  petsc::MatHandle create_tangent() const;
  /// Global indices of the multipliers (may be empty). Collective.
  petsc::IsHandle multipliers() const;

  /// F(t, U, V, A). Collective.
  void residual(double t, Vec U, Vec V, Vec A, ConstraintLevel level, Vec F) const;
  /// Maximum |C(q, t)| of all constraint rows, or of a rate of them: only the terms that constrain are evaluated.
  /// Collective.
  double constraint_violation(double t, Vec U, Vec V, ConstraintLevel level) const;
  /// A joint whose constraints are not met as they are meant to be (Term::constraint_status), by name; empty: there is
  /// none.
  struct FailedConstraint {
    std::string joint;
    ConstraintStatus constraint_status = ConstraintStatus::satisfied;
    /// What happened, for messages.
    std::string text() const;
  };
  /// Collective.
  FailedConstraint failed_constraint(double t, Vec U) const;
  /// w.q dF/dU + w.v dF/dV + w.a dF/dA, assembled. Collective.
  void tangent(double t, Vec U, Vec V, Vec A, Weights weights, Mat J) const;
  /// M + h C at U and at rest, C the damping of strains, with the rows and columns of constraints. Collective.
  /// @param lasting  of each body times 1 / (1 + (h / (12 beta))^6), C = beta K: what strongly damped strains do lasts
  ///                 for beta
  void damped_mass(double t, Vec U, double h, Mat J, bool lasting = false) const;
  /// Whether any term damps strains: the same answer on all ranks. Collective.
  bool damps_strains() const;
  /// Collective.
  Energy energy(double t, Vec U, Vec V) const;

  const Attitudes& attitudes() const { return attitudes_; }
  /// Whether any rank has attitudes: the same answer on all of them.
  bool has_attitudes() const { return has_attitudes_; }
  /// The maximum rotation of a node (Attitude::of_node) from its base at U [rad]. Collective.
  double greatest_node_rotation(Vec U) const;
  /// Every base takes over the rotation of U, whose three unknowns become zero: the same configuration, at which every
  /// term begins a step (Term::begin_step). Without attitudes nothing happens. V null: at rest. Collective.
  void rebase(Vec U, Vec V = nullptr, double t = 0) const;
  /// Every term takes over the configuration U, as at the beginning of a step (Term::begin_step): after an event, so
  /// that what it closed holds what it finds. Collective.
  void commit_step(Vec U, Vec V, double t) const;
  /// What bases and terms carry from step to step beside the unknowns, this rank's, into `numbers`; and back.
  /// @throws RunError  (load) so many numbers are those of another system. Rank-local.
  void save(std::vector<double>& numbers) const;
  void load(std::span<const double> numbers) const;
  /// The axes that every frame has at U, in columns (in the plane within x, y), of those frames that this rank owns.
  void frame_axes(Vec U, std::vector<Eigen::Matrix3d>& axes) const;
  /// What of y is in world axes and belongs to a frame, which rotated from axes `from` to those at U, rotates likewise,
  /// or `back`: places of frames (forces on them), and forces that hold points of bodies (gaps). So does a tangent, of
  /// a free body wholly: J(U) y = rotate(J(from) rotate_back(y)). No communication.
  void rotate(const std::vector<Eigen::Matrix3d>& from, Vec U, bool back, Vec y) const;
  /// W = a x b in the three rows of every attitude, zero in all others. Collective.
  void bracket(Vec a, Vec b, Vec W) const;

  /// This rank's local coordinates (Coordinates). Collective.
  void gather(Vec global, Eigen::VectorXd& local) const;
  /// Its transpose: local rows of all ranks, added up where ranks share them. Collective.
  void give(const Eigen::VectorXd& local, Vec global) const;

 private:
  struct Local {
    Eigen::VectorXd q, v, a;
  };
  /// Work arrays of one term's evaluation.
  struct TermWork {
    Eigen::VectorXd q, v, a, r;
    Eigen::MatrixXd J;
  };
  TermWork& pick(const Term& term) const;
  void set_up_scatter();
  void set_up_corotated();
  void begin_terms(Vec V, double t) const;
  /// Tangents at local_'s motion with the weights of each term, assembled. Collective.
  void assemble(double t, const std::function<Weights(const Term&)>& weights, Mat J) const;
  enum class Which { all, constraining };
  /// Rows of local_'s motion into sum_. Collective.
  void add_rows(double t, ConstraintLevel level, Which which) const;

  Coordinates coordinates_;
  std::vector<std::unique_ptr<Term>> terms_;
  Attitudes attitudes_;
  bool has_attitudes_ = false;
  /// Frames whose unknowns this rank owns, by global indices, and what rotates with them.
  struct Frame {
    PetscInt x;
    const Attitude* attitude;  // null in the plane, where x is the angle
  };
  struct Vector {
    PetscInt first;
    std::size_t frame;
  };
  std::vector<Frame> frames_;
  std::vector<Vector> corotated_;
  std::vector<char> constrains_;  // of each term: whether it has multipliers
  bool identity_ = false;         // local and global numbering are the same on every rank
  bool whole_ = false;            // one rank holds everything, though perhaps in another order
  bool dense_ = false;            // a dense tangent
  petsc::ScatterHandle scatter_;
  petsc::VecHandle staging_;
  mutable Local local_;
  mutable std::vector<TermWork> work_;  // one for each size of a term, so that nothing is allocated in a step
  mutable Eigen::VectorXd sum_;
  mutable std::vector<PetscInt> rows_;
  mutable std::vector<Eigen::Matrix3d> axes_;
};

}  // namespace floe::dynamics
