#pragma once
#include "floe/assembly/enrichment.h"
#include "floe/assembly/kept_motion.h"
#include "floe/assembly/offline.h"

namespace floe::assembly {

inline bool has_structure(const PlannedBody& body) { return !body.spec.rigid && !body.spec.reduced; }

/// Of all bodies with a mesh.
PetscInt elements_of(const Offline& offline);

/// From so many elements on the terms of full order take gigabytes.
inline constexpr PetscInt many_elements = 20000;

/// The full-order model of the bodies; mass-proportional and modal damping, which it does not know, are taken out of
/// the residual by those who know V. @param apart  as assemble(). Collective.
Model full_order(Offline& offline, bool apart = false);

/// V'r by plain products.
Eigen::VectorXd products(const reduction::Basis& basis, Vec r);

/// Full-order residuals at prolonged states q = V eta of a reduced model, body by body:
///
///   r = M(q) q'' - Q_v + dU/dq - Q_e + C_q' lambda
class Residuals {
 public:
  /// @param reduced     of offline.reduced
  /// @param apart_from  so many elements, where the scene is in space
  Residuals(const Model& reduced, Offline& offline, PetscInt apart_from = many_elements);
  /// Whether elements are not stored, but made anew by each call of add().
  bool apart() const { return !full_.elements.empty(); }
  /// Elements that are apart are made once for all of the states. Collective.
  void add(const std::vector<solve::State>& states);
  /// -r of each state, of a body.
  const std::vector<ResidualLoad>& loads(std::size_t body) const { return loads_[body]; }
  /// |V'r| against the elastic forces that V carries, the greatest of each over the states.
  double unbalanced() const { return forces_ > 0 ? unbalanced_ / forces_ : 0; }
  int samples = 0;

 private:
  /// The full-order model at a state, as this rank sees it.
  struct Lifted {
    double t;
    Eigen::VectorXd q, v, a;
    std::vector<Eigen::Quaterniond> bases;  // of the system's attitudes
    petsc::VecHandle F;
  };
  Lifted lifted(const solve::State& state);
  void add_elements(std::vector<Lifted>& all);
  void take(int b, const solve::State& state, Vec F);
  void add_mass_damping(int b, const solve::State& state, Vec load);

  const Model& reduced_;
  Offline& offline_;
  Model full_;
  petsc::VecHandle U_, V_, A_;
  std::vector<std::vector<ResidualLoad>> loads_;
  double unbalanced_ = 0, forces_ = 0;
};

}  // namespace floe::assembly
