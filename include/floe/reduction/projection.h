#pragma once
#include "floe/body/flexible_body.h"
#include "floe/reduction/basis.h"

namespace floe::reduction {

/// The body on the columns of V: inertia constants, bending stiffness, and the membrane energy's triangular factor F.
///
/// H has the rows sqrt(w) D^(1/2) [L V | e(V_a, V_b)] of every strain point; H = Q F by a tall-skinny QR (LAPACK),
/// blocks of rows at a time and then over ranks. Pairs of columns without slope are left out. Energy and forces equal
/// the projected full ones to round-off. Bending and inertia are sums of products of many rows at a time (BLAS),
/// without the columns that are zero there. Collective; the result is the same to the bit on all ranks. Cost O(cells (k
/// + p)^2), p the number of pairs, at most k^2/2; memory: V once more on every rank, and O((k + p)^2).
body::FlexibleBody project(const fem::Structure& structure, const Basis& basis);

/// R of a QR of the rows sqrt(w) D^(1/2) [L V | e(V_a, V_b) for the pairs | L W] of every strain point, and of those of
/// bending, which are linear: V'K V = R_V'R_V. Collective; the same on all ranks.
/// @param pairs  as project() gives them
Eigen::MatrixXd strain_factor(const fem::Structure& structure, const Basis& basis,
                              const std::vector<std::pair<int, int>>& pairs, const Columns& W);

/// Inertia constants of some of the cells on the columns of V, of their mass and of unit density per length (area).
/// @param only  of each of this rank's cells whether it counts. Collective; the same on all ranks.
struct PartMasses {
  body::Inertia mass, line;
};
PartMasses part_masses(const fem::Structure& structure, const Basis& basis, const std::vector<char>& only);

/// Rows of V at a node: S and psi. Collective; replicated.
body::PlaceMap place_map(const fem::Structure& structure, const Basis& basis, PetscInt node);

/// A body without elastic coordinates: its mass alone. Collective.
body::FlexibleBody rigid_body(const fem::Structure& structure);

}  // namespace floe::reduction
