#pragma once
#include "floe/fem/reference_frame.h"

namespace floe::fem {

/// The rigid part of a displacement q as joints see it: it follows the dofs that they hold, and where these leave rigid
/// motions free, the mean of the mass. As a ReferenceFrame without conditions of its own, whose projector P
/// (fem::to_frame) leaves of q what the joints' holding excites as vibration:
///
///   f' q = (Q' S_r' S q, Z' Phi_r' M q)    S: dofs constrained (rotations times the body's length), S_r = S Phi_r,
///                                          Q: its row space, Z: the rest, rigid motions that S does not see
///
/// clamped: from the clamp; hinged: from the hinge, less the mean rotation about it; free: mean axes. The modes of the
/// body as these dofs hold it are not changed by P, and none depends on the frame that q is measured in: P P_frame = P.
/// @param constrained  dofs, global, ascending. Collective.
ReferenceFrame joint_frame(const Structure& structure, const ReferenceFrame& frame, const Conditions& constrained);

/// P'MP on the columns of V: V'P'MPV. @param V  M-orthonormal or not. Collective; replicated.
Eigen::MatrixXd mass_seen(const Structure& structure, const ReferenceFrame& joints,
                          const std::vector<petsc::VecHandle>& V);

}  // namespace floe::fem
