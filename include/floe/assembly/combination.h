#pragma once
#include "floe/reduction/basis.h"

namespace floe::assembly {

/// field = V eta; zero where V has no basis vectors. Collective.
inline void combine(const reduction::Basis& basis, const Eigen::VectorXd& eta, Vec field) {
  if (basis.columns == 0)
    petsc::check(VecSet(field, 0));
  else
    petsc::check(BVMultVec(basis.V, 1, 0, field, const_cast<double*>(eta.data())));  // which reads it only
}

}  // namespace floe::assembly
