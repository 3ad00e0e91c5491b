#pragma once
#include "floe/plan/prepare.h"

namespace floe::plan {

/// Puts a body where its scene says at the start: pose and velocity of its frame, deformation and its rate in it.
///
/// The scene gives a displacement field u(X) and its rate w(X) in the axes of the mesh, which stand at (P, alpha) and
/// move with (dP/dt, dalpha/dt). They may move the conditions f of the frame, and then the frame goes with them:
///
///   u'(x)   = A(theta')' (X + u(X) - R') - x          f'u' = 0 for the pose (R', theta') in mesh axes, by Newton
///   u'_t(x) = A(theta')' w - (c + theta'_t J (x + u'))    f'u'_t = 0 for the rates (c, theta'_t), linear
///   R = P + A(alpha) R',  theta = alpha + theta';    rates likewise, R'_t = A(theta') c
///
/// Nodal rotations are slopes in the frame; where elements meet at an angle, their mean. Rigid bodies do not deform.
/// @param body  all but what is set here  @throws InputError  no pose meets the conditions. Collective.
void start_body(PlannedBody& body);

/// Angles of the sections from the undeformed body in its frame, and their rates: what corotational beams rotate by.
///
/// With t the tangent of the deformed axis and e the undeformed one, both in the frame: atan2(e x t, e.t), t x t_t /
/// t.t
/// @return (owned nodes) x 2 [rad, rad/s]. Collective.
Eigen::MatrixX2d section_angles(const PlannedBody& body);

}  // namespace floe::plan
