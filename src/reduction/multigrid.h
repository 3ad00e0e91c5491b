#pragma once
#include "floe/fem/reference_frame.h"

/// What an iteration needs of a matrix that nobody factors.
namespace floe::reduction {

/// Whether a KSP's preconditioner solves by itself (a factorisation).
bool factors(KSP ksp);

/// The rigid motions, zero at the constrained dofs, become the near null space of A. With rotations among the dofs
///
///   u = e_i,  rotations 0        u = e_i x (x - x_0),  rotations e_i
///
/// which MatNullSpaceCreateRigidBody does not know: it is for translations alone. Collective.
void set_near_null_space(Mat A, const fem::ReferenceFrame& frame, const fem::Conditions& constrained);

/// A (MATSBAIJ, blocks of a node) as algebraic multigrid takes it: MATAIJ with the same blocks and a near null space.
/// Collective.
petsc::MatHandle for_multigrid(Mat A, const fem::ReferenceFrame& frame, const fem::Conditions& constrained);

}  // namespace floe::reduction
