#pragma once
#include <functional>
#include <string>
#include <vector>

#include "floe/assembly/model.h"
#include "floe/body/inertia.h"
#include "floe/dynamics/relative_damping.h"
#include "floe/plan/prepare.h"

namespace floe::assembly {
using namespace plan;

/// Axes f that accompany a whole body whose parts have axes of their own, according to rigid motions of constrained
/// dofs, and where these leave rigid motions free, the mean of the mass:
///
///   sum over dofs constrained (S_r z)' d = 0,  z in the row space of S_r;   int rho (t + w x X)'(A_f'(r - R_f) - X) =
///   0,  (t, w) in the rest
///
/// with d the motion of a dof from f. f has three unknowns in the plane and six in space, and as many multipliers;
/// none where the body is fixed to the ground.
struct WholeAxes {
  std::vector<int> bodies;  ///< of the plan
  bool fixed = false;       ///< to the ground: f is the ground
  dynamics::MovingAxes f;
  int multipliers = -1;  ///< local index of the first: of `seen`, then of `free`
  double length = 1;
  Eigen::MatrixXd seen, free;                     ///< rigid motions (t, w length) in mesh axes, 6 x ...
  std::vector<fem::Conditions> constrained = {};  ///< of each body
  /// f; none: the ground.
  std::optional<dynamics::MovingAxes> axes() const;
  bool has(int body) const;
  int place_in(int body) const;  ///< index of the body
  /// `seen` and `free` from dofs that count. Collective.
  void split(const Plan& plan, const std::vector<fem::Conditions>& dofs);
};

/// Axes that follow a body by the conditions of its floating frame: mean axes, or the dofs that it is clamped or pinned
/// at. Collective.
WholeAxes frame_axes(const Plan& plan, int body);

/// Whether something needs these axes of a corotational body: loads in axes of the body, and deflections.
/// @param by_places  of a probe: whether the frame of its deflection follows from places
bool needs_frame_axes(const Plan& plan, int body, const std::function<bool(std::size_t)>& by_places);

/// Parts of a body that are axes with mass, and coordinates e in them: constants in these axes.
struct CarriedMass {
  dynamics::MovingAxes axes;
  std::vector<int> elastic;
  body::Inertia inertia;
  Eigen::Vector3d X;   ///< origin and
  Eigen::Matrix3d A0;  ///< axes of the undeformed part, in mesh axes
};

/// A place of a part, dofs of which a joint constrains.
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

/// The rows of f, a term for each part.
using AxesTerms = std::vector<std::unique_ptr<dynamics::AccompanyingAxes>>;

/// The rows of f that the masses and the constrained places of all bodies add to; none where the whole is
/// fixed to the ground. They are zero where f has moved with the undeformed body.
/// @param masses  adds the dampers of a body's masses to the model, and returns the masses
/// @param places  of a body
AxesTerms conditions(const WholeAxes& whole, int dofs_per_node,
                     const std::function<std::vector<CarriedMass>(int)>& masses,
                     const std::function<std::vector<ConstrainedPlace>(int)>& places);

/// f and its multipliers, as rows of a joint: what models of the same scene have in common.
JointMultipliers unknowns_of(const WholeAxes& whole);

/// c_0 of the terms: their rows are zero at q.
void begin_at(const AxesTerms& terms, const Eigen::VectorXd& q);

/// The velocity of f at which all rows together stand. @param q, v  local coordinates. Collective.
Eigen::VectorXd rates_of(const WholeAxes& whole, const AxesTerms& terms, const Eigen::VectorXd& q,
                         const Eigen::VectorXd& v, MPI_Comm comm);

/// Moves f to where all rows together are zero, from nearby: its coordinates in q, and in space its attitude's base.
/// Collective.
/// @param name  of the body
/// @throws floe::RunError  on all ranks, where Newton's method does not converge
void place_axes(const WholeAxes& whole, const AxesTerms& terms, const std::string& name, dynamics::Attitude* attitude,
                Eigen::VectorXd& q, MPI_Comm comm);

/// The place and attitude of f at the start.
struct StartOfAxes {
  Eigen::Vector3d R;
  Eigen::Matrix3d A;
};
/// Of the axes of a body's mesh, moved with its floating frame.
StartOfAxes mesh_axes_at_start(const PlannedBody& body);

}  // namespace floe::assembly
