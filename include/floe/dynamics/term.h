#pragma once
#include <Eigen/Dense>
#include <span>
#include <vector>

namespace floe::dynamics {

/// A force and a moment, in world axes unless said otherwise.
using Wrench = Eigen::Matrix<double, 6, 1>;

/// Which time derivative of the constraints the multiplier rows hold: C, dC/dt or d2C/dt2.
enum class ConstraintLevel { position, velocity, acceleration };

/// The motion as one term sees it: its own coordinates, in the order of Term::coordinates(), and their rates.
///
/// Multipliers stand among the coordinates; their rates are zero and mean nothing.
struct Motion {
  double t = 0;
  const Eigen::VectorXd& q;
  const Eigen::VectorXd& v;
  const Eigen::VectorXd& a;
  ConstraintLevel level = ConstraintLevel::position;
};

/// Weights of the three derivatives in a tangent: q * dr/dq + v * dr/dv + a * dr/da.
///
/// The columns of the multipliers and the constraint rows (C_q', C_q) count with weight 1 whatever the weights; the
/// stiffness that multipliers bring by (C_q' lambda)_q counts with q.
struct Weights {
  double q = 1, v = 0, a = 0;
};

/// How the constraints of a term stand, when their rows vanish: as they are meant to; 180 deg away, where rows of
/// axes vanish, too; or open: what was left out, because other joints constrained it, they hold no longer.
enum class ConstraintStatus { satisfied, flipped_branch, violated };

/// What a term holds and spends. [J]
struct Energy {
  double kinetic = 0;
  double elastic = 0;
  double potential = 0;
  Energy& operator+=(const Energy& other) {
    kinetic += other.kinetic, elastic += other.elastic, potential += other.potential;
    return *this;
  }
};

/// Unknowns that are the parts of a vector in world axes, and the frame that the vector rotates with: the local indices
/// of the first of three (in the plane two), and of the frame's x (its angle).
struct Corotated {
  int vector, frame;
};

/// One term of the equations of motion: it acts on few coordinates and adds to their rows.
///
/// The equations are sum over terms of r(t, q, v, a) = 0, in the sense inertia + elastic + constraint - applied forces.
/// A term knows neither ranks nor matrices: bodies, elements, joints and loads are terms; System sums them.
class Term {
 public:
  virtual ~Term() = default;
  /// Indices into the system's local coordinates (Coordinates), all different.
  virtual const std::vector<int>& coordinates() const = 0;
  /// r (sized as coordinates(), zero at entry) receives the term's rows.
  virtual void residual(const Motion& motion, Eigen::VectorXd& r) const = 0;
  /// J (square, zero at entry) receives the weighted derivatives of residual at level position.
  virtual void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const = 0;
  virtual Energy energy(const Motion&) const { return {}; }
  /// Whether constraints are met as they are meant to be. Of the motion t and q count.
  virtual ConstraintStatus constraint_status(const Motion&) const { return ConstraintStatus::satisfied; }
  /// Whether rows of its constraint were left out because others imply them: it may be violated without multipliers.
  virtual bool has_left_out_rows() const { return false; }
  /// The configuration that a step begins from: what depends on the way there, as whole revolutions do, is taken over
  /// here and nowhere else. Of the motion a does not count. Called more than once for one step.
  virtual void begin_step(const Motion&) {}
  /// beta of the damping of strains that it contains, which ends their rates by itself, however fast [s]; 0: none.
  virtual double strain_damping() const { return 0; }
  /// Appends which of its multipliers rotate with a frame: forces between places (System::rotate).
  virtual void add_corotated(std::vector<Corotated>&) const {}
  /// What the term carries from step to step beside the system's unknowns (begin_step, constraint switches), as
  /// numbers: `save` appends them, `load` takes as many back, in the same order.
  virtual void save(std::vector<double>&) const {}
  virtual void load(std::span<const double>) {}
};

}  // namespace floe::dynamics
