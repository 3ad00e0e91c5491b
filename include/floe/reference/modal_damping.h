#pragma once
#include <memory>
#include <vector>

#include "floe/dynamics/term.h"
#include "floe/fem/structure.h"
#include "floe/reference/full_order.h"

namespace floe::reference {

/// Modal damping of a full-order body, C = sum 2 zeta_i omega_i f_i f_i' with f_i = K phi_i / omega_i^2 (M phi_i, and
/// the reactions of what holds the body): no rigid motion is damped, whatever the floating frame.
///
/// y_i = f_i'q are unknowns of their own, with as many multipliers, so that the tangent stays sparse.
struct ModalDamping {
  std::vector<petsc::VecHandle> forces;  ///< f_i
  Eigen::VectorXd viscosity;             ///< 2 zeta_i omega_i [1/s]
  fem::Conditions constrained;           ///< dofs at zero in these equations
  int y = -1, multipliers = -1;          ///< local indices of the first
};

/// Rows of the multipliers, f_i'q, of this rank's own nodes. Rank-local.
std::vector<std::unique_ptr<dynamics::Term>> modal_rows(const fem::Structure& structure,
                                                        const std::vector<petsc::VecHandle>& forces,
                                                        const fem::Conditions& constrained, int multipliers,
                                                        const NodeCoordinates& nodes);
/// What acts on y alone: the viscous forces, and -y_i in the rows. Rank-local.
std::vector<std::unique_ptr<dynamics::Term>> modal_dampers(const Eigen::VectorXd& viscosity, int y, int multipliers);

/// Both: each rank gets the terms of its own nodes; the last one what acts on y alone. Rank-local.
std::vector<std::unique_ptr<dynamics::Term>> modal_damping_terms(const fem::Structure& structure,
                                                                 const ModalDamping& damping,
                                                                 const NodeCoordinates& nodes);

/// y of a displacement field; null: zero. Collective.
Eigen::VectorXd modal_coordinates(const std::vector<petsc::VecHandle>& forces, Vec q);

}  // namespace floe::reference
