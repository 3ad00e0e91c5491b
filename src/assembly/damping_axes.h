#pragma once
#include <algorithm>
#include <functional>
#include <vector>

#include "floe/assembly/model.h"
#include "floe/body/inertia.h"
#include "floe/dynamics/relative_damping.h"
#include "floe/plan/prepare.h"
#include "floe/reference/modal_damping.h"

namespace floe::assembly {
using namespace plan;

/// Damping of a body whose parts have axes of their own: damping.mass in several frames, damping.mass and damping.modal
/// of corotational elements.
///
/// damping.mass acts on the velocity relative to axes f that accompany the whole body, according to the rigid motions
/// that its joints constrain (fem::joint_frame): f follows the constrained dofs, and where these leave rigid motions
/// free, the mean of the mass,
///
///   sum over dofs constrained (S_r z)' d = 0,  z in the row space of S_r;   int rho (t + w x X)'(A_f'(r - R_f) - X) =
///   0,  (t, w) in the rest
///
/// with d the motion of a dof from f. f has three unknowns in the plane and six in space, and as many multipliers;
/// none where the ground holds the body altogether.
struct DampedWhole {
  std::vector<int> bodies;  ///< of the plan
  double alpha = 0;         ///< [1/s]
  bool fixed = false;       ///< the ground holds it: f is the ground
  dynamics::MovingAxes f;
  int multipliers = -1;  ///< local index of the first: of `seen`, then of `free`
  double length = 1;
  Eigen::MatrixXd seen, free;                     ///< rigid motions (t, w length) in mesh axes, 6 x ...
  std::vector<fem::Conditions> constrained = {};  ///< of each body
  /// Of a corotational body: y_i = sum over nodes f_i'(A_f'(R - R_f) - X, rotation in f), viscous forces on y.
  std::optional<reference::ModalDamping> modal = {};
  /// f; none: the ground.
  std::optional<dynamics::MovingAxes> axes() const;
  bool has(int body) const;
  int place_in(int body) const;  ///< index of the body
};

/// Parts of a body that are axes with mass, and coordinates e in them: constants in these axes.
struct CarriedMass {
  dynamics::MovingAxes axes;
  std::vector<int> elastic;
  body::Inertia inertia;
  Eigen::Vector3d X;   ///< origin and
  Eigen::Matrix3d A0;  ///< axes of the undeformed part, in mesh axes
};

/// A place of a part, dofs of which a joint holds.
struct ConstrainedPlace {
  dynamics::MovingAxes axes;
  std::vector<int> elastic;
  Eigen::Vector3d x;        ///< in the part
  Eigen::Matrix3Xd S, psi;  ///< of e
  std::vector<int> dofs;    ///< numbers of a node's dofs
  Eigen::Vector3d X;        ///< as of CarriedMass
  Eigen::Matrix3d A0;
};

/// Axes and origin of a body's frame, undeformed, in mesh axes.
Eigen::Matrix3d undeformed_axes(const PlannedBody& body);
Eigen::Vector3d undeformed_origin(const PlannedBody& body);

/// Bodies of the plan that have damping.mass in several frames; corotational: all that have damping.mass or modal.
/// Collective.
/// @param still  of each body: whether its frame is fixed to the ground
std::vector<DampedWhole> damped_wholes(const Plan& plan, bool corotational, const std::vector<bool>& still);

/// The rows of f that the masses and the constrained places of all bodies add to; none where the ground holds the
/// whole.
/// @param masses  adds the dampers of a body's masses to the model, and returns the masses
/// @param places  of a body
std::vector<std::unique_ptr<dynamics::AccompanyingAxes>> conditions(
    const DampedWhole& whole, int dofs_per_node, const std::function<std::vector<CarriedMass>(int)>& masses,
    const std::function<std::vector<ConstrainedPlace>(int)>& places);

/// f and its multipliers, as rows of a joint: what models of the same scene have in common.
JointMultipliers unknowns_of(const DampedWhole& whole);

/// c_0 of the terms and the velocity of f at the start. @param q, v  local coordinates, v with none of f. Collective.
Eigen::VectorXd begin(const DampedWhole& whole, std::vector<std::unique_ptr<dynamics::AccompanyingAxes>>& terms,
                      const Eigen::VectorXd& q, const Eigen::VectorXd& v, MPI_Comm comm);

/// Rows y_i of a corotational body's own nodes; on the last rank what acts on y alone joins `terms`. Rank-local.
/// @param axes_of  axes of a node by its local number; they are the body's when it moves rigidly
std::vector<std::unique_ptr<dynamics::AccompanyingAxes>> modal_rows(
    const DampedWhole& whole, const PlannedBody& body, const std::function<dynamics::MovingAxes(int)>& axes_of,
    std::vector<std::unique_ptr<dynamics::Term>>& terms);

/// The minimum damping.mass with these modes [1/s]: without any force on f its equations have no scale, and factors of
/// the tangent lose their digits.
inline double min_mass_damping(const reference::ModalDamping& modal) { return 1e-9 * modal.viscosity.maxCoeff(); }

/// Whether some mode of the body is damped.
inline bool has_modal_damping(const Body& body) {
  return std::any_of(body.damping.modal.begin(), body.damping.modal.end(), [](double ratio) { return ratio > 0; });
}

/// c_0 of these rows, and the rates of y at the start. Collective.
Eigen::VectorXd begin_modal(const DampedWhole& whole, std::vector<std::unique_ptr<dynamics::AccompanyingAxes>>& rows,
                            const Eigen::VectorXd& q, const Eigen::VectorXd& v, MPI_Comm comm);

}  // namespace floe::assembly
