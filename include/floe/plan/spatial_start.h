#pragma once
#include "floe/plan/prepare.h"

namespace floe::plan {

/// Puts a body in space where its scene says at the start: place, attitude and motion of its frame, deformation and its
/// rate in it; as start_body does in the plane.
///
/// The scene gives displacements d(X) and rates w(X) in the axes of the mesh, which stand at (P, Q) and move with (v,
/// W). The frame goes with what moves its conditions f:
///
///   u'(x)   = B'(X + d - R') - x                      f'u' = 0 for the pose (R', B) in mesh axes, by Newton
///   u'_t(x) = B'w - (c + b x (x + u'))                f'u'_t = 0 for the rates (c, b), linear
///   R = P + Q R',  A = Q B;  R_t = v + W x Q R' + Q B c,  A'W + b the frame's spin
///
/// Nodal rotations are slopes of the deformed surface or line in the frame, and half the curl in a shell's plane; the
/// sections of beams go with their line without a twist. Where elements meet at an angle they are the mean.
/// @param body  all but what is set here  @throws InputError  no pose meets the conditions. Collective.
void start_spatial_body(PlannedBody& body);

}  // namespace floe::plan
