#pragma once
#include "floe/assembly/reduce_bodies.h"

namespace floe::assembly {

/// field = V eta; zero where V has no basis vectors. Collective.
inline void combine(const reduction::Basis& basis, const Eigen::VectorXd& eta, Vec field) {
  if (basis.columns == 0)
    petsc::check(VecSet(field, 0));
  else
    petsc::check(BVMultVec(basis.V, 1, 0, field, const_cast<double*>(eta.data())));  // which reads it only
}

/// The same with the displacements over which the energy is condensed (reduction::Relief), where they are kept.
/// Collective.
inline void combine_relieved(const ReducedBody& body, const Eigen::VectorXd& eta, Vec field) {
  combine(*body.basis, eta, field);
  reduction::add_relief(*body.basis, body.relief, eta, field);
}

}  // namespace floe::assembly
