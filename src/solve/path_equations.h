#pragma once
#include <cmath>

#include "floe/petsc/handle.h"
#include "floe/solve/path.h"
#include "mass_norm.h"

namespace floe::solve {

/// A vector and the t that goes with it: a point of the path or a direction.
struct PathVector {
  petsc::VecHandle U;
  double t = 0;
};

void add_to(PathVector& x, double factor, const PathVector& d);
void set_to(PathVector& x, const PathVector& from);

/// Solutions at a point: a = -J^-1 dF/dt, for dt = 1, and b = -J^-1 F.
struct PathSolutions {
  petsc::VecHandle a, b;
};

/// Linear algebra of the path: its metric, and one factor for both right-hand sides.
class PathEquations {
 public:
  PathEquations(const System& system, double interval, Vec V, Vec weights);

  double beta = 1;

  PathVector vector() const { return {system_.create_vector(), 0}; }
  double product(const PathVector& x, const PathVector& y) const {
    return weighted_product(x.U, y.U, weights_) + beta * beta * x.t * y.t;
  }
  double size(const PathVector& x) const { return std::sqrt(product(x, x)); }

  /// dF/dt by central differences: exact where loads are linear in t.
  /// @return  false where J is singular. Collective.
  bool solve(const PathVector& x, const PathSolutions& s);

  /// The maximum of |J^-1 (F(t + d) - F(t))| / |d|, with J and F of the last point solved for: over the first step and
  /// tenths of the way to the end. Loads that begin smoothly (dF/dt = 0) have one, too. Collective.
  double max_chord(const PathVector& x, double first, double end);

 private:
  /// @return  false where loads have no value
  bool residual_at(double t, Vec U, Vec F);
  /// F a little before t, or at t where loads have no value before. @return  how much before
  double residual_below(const PathVector& x);
  bool solve_one(Vec right, Vec x);

  const System& system_;
  double interval_;
  Vec V_, weights_;
  petsc::VecHandle A_, F_, rate_;
  petsc::MatHandle J_;
  petsc::KspHandle ksp_;
};

}  // namespace floe::solve
