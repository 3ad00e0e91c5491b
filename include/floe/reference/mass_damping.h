#pragma once
#include <memory>
#include <vector>

#include "floe/dynamics/term.h"
#include "floe/fem/reference_frame.h"
#include "floe/reference/full_order.h"

namespace floe::reference {

/// Mass-proportional damping of a full-order body on the displacement q less its rigid part as joints see it
/// (fem::joint_frame), D = 1/2 alpha (q - Phi_r s)'' M (q - Phi_r s)' with f'(q - Phi_r s) = 0.
///
/// s, the rigid part, are unknowns of their own, so that the tangent stays sparse.
struct MassDamping {
  fem::ReferenceFrame joints;   ///< Phi_r and f
  fem::Conditions constrained;  ///< dofs at zero in these equations
  double alpha = 0;             ///< [1/s]
  int motion = -1;              ///< local index of s, as many as rigid motions; -1: s is zero whatever q
  int multipliers = -1;         ///< likewise
};

/// Whether f'q is zero for every q that is zero at `constrained`: s needs no unknowns. Collective.
bool moves_nothing(const fem::Structure& structure, const fem::ReferenceFrame& joints,
                   const fem::Conditions& constrained);

/// Each rank gets the terms of its own elements and nodes; the last one what couples s alone. Collective.
std::vector<std::unique_ptr<dynamics::Term>> mass_damping_terms(const fem::Structure& structure,
                                                                const MassDamping& damping,
                                                                const NodeCoordinates& nodes);

/// s of a displacement field; null: zero. Collective.
Eigen::VectorXd rigid_part(const fem::ReferenceFrame& joints, Vec q);

}  // namespace floe::reference
