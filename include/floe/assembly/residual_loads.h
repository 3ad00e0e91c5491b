#pragma once
#include "floe/assembly/enrichment.h"
#include "floe/assembly/kept_motion.h"
#include "floe/assembly/offline.h"

namespace floe::assembly {

inline bool has_structure(const PlannedBody& body) { return !body.spec.rigid && !body.spec.reduced; }

/// The full-order model of the bodies; mass-proportional and modal damping, which it does not know, are taken out of
/// the residual by those who know V. Collective.
Model full_order(Offline& offline);

/// V'r by plain products.
Eigen::VectorXd products(const reduction::Basis& basis, Vec r);

/// Full-order residuals at prolonged states q = V eta of a reduced model, body by body:
///
///   r = M(q) q'' - Q_v + dU/dq - Q_e + C_q' lambda
class Residuals {
 public:
  /// @param reduced  of offline.reduced; @param full  full_order(offline)
  Residuals(const Model& reduced, Offline& offline, Model full);
  /// Collective.
  void add(const solve::State& state);
  /// -r of each state, of a body.
  const std::vector<ResidualLoad>& loads(std::size_t body) const { return loads_[body]; }
  /// |V'r| against the elastic forces that V carries, the greatest of each over the states.
  double unbalanced() const { return forces_ > 0 ? unbalanced_ / forces_ : 0; }
  int samples = 0;

 private:
  void take(int b, const solve::State& state);
  void add_mass_damping(int b, const solve::State& state, Vec load);

  const Model& reduced_;
  Offline& offline_;
  Model full_;
  petsc::VecHandle U_, V_, A_, F_;
  std::vector<std::vector<ResidualLoad>> loads_;
  double unbalanced_ = 0, forces_ = 0;
};

}  // namespace floe::assembly
