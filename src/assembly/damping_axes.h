#pragma once
#include <algorithm>

#include "floe/reference/modal_damping.h"
#include "whole_axes.h"

namespace floe::assembly {

/// Damping of a body whose parts have axes of their own: damping.mass in several frames, damping.mass and damping.modal
/// of corotational elements.
///
/// damping.mass acts on the velocity relative to axes f that accompany the whole body, according to the rigid motions
/// that its joints constrain (fem::joint_frame).
struct DampedWhole : WholeAxes {
  double alpha = 0;  ///< [1/s]
  /// Of a corotational body: y_i = sum over nodes f_i'(A_f'(R - R_f) - X, rotation in f), viscous forces on y.
  std::optional<reference::ModalDamping> modal = {};
};

/// Bodies of the plan that have damping.mass in several frames; corotational: all that have damping.mass or modal.
/// Collective.
/// @param still  of each body: whether its frame is fixed to the ground
std::vector<DampedWhole> damped_wholes(const Plan& plan, bool corotational, const std::vector<bool>& still);

/// Rows y_i of a corotational body's own nodes; on the last rank what acts on y alone joins `terms`. Rank-local.
/// @param axes_of  axes of a node by its local number; they are the body's when it moves rigidly
std::vector<std::unique_ptr<dynamics::AccompanyingAxes>> modal_rows(
    const DampedWhole& whole, const PlannedBody& body, const std::function<dynamics::MovingAxes(int)>& axes_of,
    std::vector<std::unique_ptr<dynamics::Term>>& terms);

/// The minimum damping.mass with these modes [1/s]: without any force on f its equations have no scale, and factors of
/// the tangent lose their digits.
inline double min_mass_damping(const reference::ModalDamping& modal) { return 1e-9 * modal.viscosity.maxCoeff(); }

/// c_0 of these rows, and the rates of y at the start. Collective.
Eigen::VectorXd begin_modal(const DampedWhole& whole, std::vector<std::unique_ptr<dynamics::AccompanyingAxes>>& rows,
                            const Eigen::VectorXd& q, const Eigen::VectorXd& v, MPI_Comm comm);

}  // namespace floe::assembly
