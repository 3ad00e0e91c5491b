#pragma once
#include "floe/fem/reference_frame.h"

/// Domain decomposition: one subdomain a rank, the elements of that rank.
namespace floe::reduction {

/// K - shift M under conditions.
struct ShiftedStiffness {
  const fem::Structure& structure;
  const fem::ReferenceFrame& frame;
  const fem::Conditions& constrained;
  double shift;
  Mat assembled = nullptr;  ///< where it is already
};

/// The matrix that an iteration's preconditioner takes, with the rigid motions as its near null space: by subdomains
/// for PCBDDC, whose corners are set too; assembled for all others.
/// @throws InputError  PCBDDC on one rank. Collective.
petsc::MatHandle for_iteration(KSP ksp, const ShiftedStiffness& stiffness);

/// Makes all dofs of two nodes of each interface primal: of the nodes that the same ranks share, two that are far
/// apart.
/// Without them a subdomain that no condition holds is singular, for all other constraints of PCBDDC are means.
/// @param A  by subdomains. Collective.
void set_corners(PC bddc, Mat A, const fem::Structure& structure);

}  // namespace floe::reduction
