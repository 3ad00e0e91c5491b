#pragma once
#include "floe/assembly/enrichment.h"
#include "floe/assembly/kept_motion.h"
#include "floe/assembly/offline.h"

namespace floe::assembly {

inline bool has_structure(const PlannedBody& body) { return is_meshed(body.spec); }

/// Of all bodies with a mesh.
PetscInt elements_of(const Offline& offline);

/// From this number of elements on, the terms of the full-order model take gigabytes.
inline constexpr PetscInt many_elements = 20000;

/// The full-order model of the bodies, without mass-proportional and modal damping, whose forces the caller adds to the
/// residual. @param apart  as assemble(). Collective.
Model full_order(Offline& offline, bool apart = false);

/// V'r by plain products.
Eigen::VectorXd products(const reduction::Basis& basis, Vec r);

/// Full-order residuals at prolonged states q = V eta of a reduced model, with the displacements over which energies of
/// bodies are condensed, body by body:
///
///   r = M(q) q'' - Q_v + dU/dq - Q_e + C_q' lambda
class Residuals {
 public:
  /// @param reduced     of offline.reduced
  /// @param apart_from  number of elements from which they are apart; in space only
  /// @param relieved    with the displacements over which energies are condensed
  Residuals(const Model& reduced, Offline& offline, PetscInt apart_from = many_elements, bool relieved = true);
  /// Whether elements are not stored, but created in each call of add().
  bool apart() const { return !full_.elements.empty(); }
  /// Elements that are apart are created once for all states. Collective.
  void add(const std::vector<solve::State>& states);
  /// -r of each state, of a body.
  const std::vector<ResidualLoad>& loads(std::size_t body) const { return loads_[body]; }
  /// |V'r| relative to the elastic forces on V, each the maximum over the states.
  double unbalanced() const { return forces_ > 0 ? unbalanced_ / forces_ : 0; }
  int samples = 0;

 private:
  /// This rank's part of the full-order model at a state.
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
  bool relieved_;
  Model full_;
  petsc::VecHandle U_, V_, A_;
  std::vector<std::vector<ResidualLoad>> loads_;
  double unbalanced_ = 0, forces_ = 0;
};

}  // namespace floe::assembly
