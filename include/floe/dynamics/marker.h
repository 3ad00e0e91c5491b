#pragma once
#include <Eigen/Dense>
#include <vector>

#include "floe/dynamics/term.h"

namespace floe::dynamics {

/// What of a pose is wanted: where a place is; its directions too (in the plane they always come along); its rates (and
/// theirs) too.
enum class EvaluationLevel { position, jacobian, velocity };

/// A place that joints and loads act on: its pose (x, y, angle) as a function of a body's coordinates.
///
///   p = mass * R + A(theta) (x + S q + 1/2 Q(q, q)),   angle = angle0 + theta + psi q
///
/// coordinates: the frame's three (when `framed`), then the elastic ones that S and psi refer to. The nodal rotation
/// psi q is the slope v' itself, not its arc tangent. Without frame and coordinates it is a point of the ground;
/// without frame but with coordinates it belongs to a body described in world axes (corotational beams). With mass =
/// int rho, x = s0 and S = int rho N the same formula is rho-weighted: a force density on it is gravity.
struct Marker {
  std::vector<int> coordinates;
  bool framed = false;
  Eigen::Vector2d x = Eigen::Vector2d::Zero();
  double angle0 = 0;
  Eigen::Matrix2Xd S;
  std::vector<Eigen::MatrixXd> Q = {};  ///< x, y, symmetric; empty: zero. Of a density, which joints do not act on
  Eigen::RowVectorXd psi;
  double mass = 1;

  static Marker ground(Eigen::Vector2d point, double angle = 0);
};

/// Pose of a marker, its rates and what their linearisation needs. n = number of the marker's coordinates.
struct Pose {
  Eigen::Vector3d y, yd, ydd;
  Eigen::Matrix3Xd P;    ///< dy/dq, 3 x n
  Eigen::Matrix3Xd dyd;  ///< d(yd)/dq at fixed v, 3 x n
  Eigen::Vector2d arm;   ///< A (x + S q + 1/2 Q(q, q))
  double angle;          ///< of the frame; 0 without
  Eigen::Matrix2Xd S;    ///< S + Q q; not set where Q vanishes
};

/// @param q, v, a  the marker's coordinates and rates
/// @param level   position or jacobian: y, P and arm alone are filled
void pose(const Marker& marker, const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a, Pose& out,
          EvaluationLevel level = EvaluationLevel::velocity);

/// Entry i of d(P' w)/dq, w = (f, m) fixed, in the row and the column of the frame's angle; all others are zero.
double geometric_stiffness(const Pose& at, const Eigen::Vector3d& wrench, Eigen::Index i);

/// K += weight * d(P' w)/dq at fixed wrench w = (f, m): the geometric stiffness of a force on a moving marker.
void add_geometric_stiffness(const Marker& marker, const Pose& at, const Eigen::Vector3d& wrench, double weight,
                             Eigen::Ref<Eigen::MatrixXd> K);

}  // namespace floe::dynamics
