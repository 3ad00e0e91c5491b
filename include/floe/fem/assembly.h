#pragma once
#include <array>

#include "floe/fem/structure.h"

namespace floe::fem {

/// Global dofs constrained to zero, ascending, the same on all ranks.
using Conditions = std::vector<PetscInt>;

/// k K + m M, MATSBAIJ (blocks of a node). Rows and columns of `conditions` are empty but for `diagonal` times the
/// largest diagonal entry of an element. Collective.
petsc::MatHandle assemble(const Structure& structure, const Conditions& conditions, double diagonal, double k,
                          double m);

/// K under conditions: K_b + sum w L'DL, with the conditions' diagonal positive. Collective.
petsc::MatHandle stiffness(const Structure& structure, const Conditions& conditions);
/// d2U/dq2 at the displacements q, under conditions: not definite where compression buckles. Collective.
petsc::MatHandle tangent_stiffness(const Structure& structure, const Conditions& conditions, Vec q);
/// M under conditions; their diagonal is zero. Without conditions it is assembled once and shared by all who ask, who
/// may not change it (it is found out at the next call, which assembles another); under conditions it is a copy of that
/// one. Collective.
petsc::MatHandle mass(const Structure& structure, const Conditions& conditions);

/// f = (dK/deta_j) phi_i, exact, element by element; symmetric in i and j. Collective.
petsc::VecHandle stiffness_derivative(const Structure& structure, Vec phi_i, Vec phi_j);

/// The same for many pairs (i, j) of fields in one pass over the elements. Collective.
/// @return  one field for each pair. Memory: fields and results once more on every rank, with foreign nodes.
std::vector<petsc::VecHandle> stiffness_derivatives(const Structure& structure,
                                                    const std::vector<petsc::VecHandle>& fields,
                                                    const std::vector<std::array<int, 2>>& pairs);

/// Sets the entries of `conditions` to zero. Collective.
void hold(Vec field, const Conditions& conditions);

}  // namespace floe::fem
