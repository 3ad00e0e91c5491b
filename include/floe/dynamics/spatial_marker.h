#pragma once
#include <memory>
#include <vector>

#include "floe/dynamics/attitude.h"
#include "floe/dynamics/marker.h"
#include "floe/math/symmetric_forms.h"

namespace floe::dynamics {

using Matrix6Xd = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// A place of a body in space, as joints and loads see it: its position and its axes as functions of the coordinates.
///
///   p = mass * R + A (x0 + S e + 1/2 Q(e, e) + (exp(~beta) - 1 - ~b) arm),
///   D = A exp(~beta) D0,   beta = b + 1/2 H(b, b),   b = psi e
///
/// coordinates: the frame's six (R, x) when it is framed, then the elastic ones that S and psi refer to. A framed place
/// has A = attitude(x); among the velocities of its coordinates the frame's angular velocity in its own axes stands for
/// x, among the accelerations its rate (Attitude). Without attitude the frame stands still at `origin` with `axes`;
/// without elastic coordinates too, the place is one of the ground. With mass = int rho, x0 = s0 and S = int rho N the
/// same formula is rho-weighted: a force density on it is gravity.
struct SpatialMarker {
  std::vector<int> coordinates;
  std::shared_ptr<const Attitude> attitude;             ///< empty: the frame stands still
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();     ///< R of a frame that stands still
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();   ///< its A
  Eigen::Vector3d x0 = Eigen::Vector3d::Zero();         ///< place in the undeformed body
  Eigen::Matrix3d D0 = Eigen::Matrix3d::Identity();     ///< axes of the place there
  Eigen::Matrix3Xd S = Eigen::Matrix3Xd::Zero(3, 0);    ///< displacement of each elastic coordinate, 3 x k
  math::SymmetricForms Q = {};                          ///< of second order: x, y, z, symmetric; empty: zero
  Eigen::Matrix3Xd psi = Eigen::Matrix3Xd::Zero(3, 0);  ///< its rotation, 3 x k
  std::vector<Eigen::Matrix3d> H = {};                  ///< of its second order: x, y, z, symmetric; empty: zero
  /// From a node to the place that follows it rigidly; its first order, -~arm psi, is in S.
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();
  double mass = 1;

  bool framed() const { return attitude != nullptr; }
  static SpatialMarker ground(const Eigen::Vector3d& point, const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity());
};

/// Position and axes of a marker, their rates, and what their linearisation needs. n = number of its coordinates.
///
/// Virtual motions are counted by the displacement and the rotation in world axes (dp, dphi) of the place, and by a
/// rotation dtheta = T(x) dx in body axes of the frame. Columns "without T(x)" multiply dtheta (or the angular
/// velocity), and directions of forces are such; derivatives by x have those columns times T(x).
struct SpatialPose {
  Eigen::Vector3d p, velocity = Eigen::Vector3d::Zero(), acceleration = Eigen::Vector3d::Zero();
  Eigen::Matrix3d D;
  Eigen::Vector3d spin = Eigen::Vector3d::Zero(), spin_rate = Eigen::Vector3d::Zero();  ///< of D, in world axes
  Matrix6Xd P;                      ///< directions: (dp, dphi) of each coordinate, 6 x n, without T(x)
  Eigen::Matrix3d A, T;             ///< of the frame; T(x), or I when it stands still
  Eigen::Vector3d c, c_rate;        ///< body axes: p - mass * R, and its velocity omega x c + S(e) e.
  Eigen::Vector3d omega, rotation;  ///< body axes: spin of the frame, and of the place: omega + T(beta)' beta.
  Eigen::Vector3d beta, beta_rate;
  Eigen::Matrix3d G, H_rate;  ///< dbeta/db = 1 + H b, and H b.; set only where H does not vanish
  Eigen::Matrix3d bend;       ///< G' T(beta)
  Eigen::Vector3d arm;        ///< exp(~beta) arm; set only where there is one
  Eigen::Matrix3Xd S, Qed;    ///< S(e) = dc/de, set only where it depends on e; Q e', not set where Q vanishes
};

/// @param q, v, a  the marker's coordinates and rates
/// @param level   position: P, velocities, spins and their rates are left as they are; jacobian: those but P
/// Allocates only where `out` grows.
void pose(const SpatialMarker& marker, const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a,
          SpatialPose& out, EvaluationLevel level = EvaluationLevel::velocity);

/// rows = P' w for a wrench in world axes: what it does on each of the n coordinates. P itself is not needed.
void pull_back(const SpatialMarker& marker, const SpatialPose& at, const Wrench& wrench, Eigen::VectorXd& rows);

/// d(velocity, spin)/dq at fixed v, 6 x n, without T(x).
void rate_gradient(const SpatialMarker& marker, const SpatialPose& at, Matrix6Xd& out);

/// K += weight * d(P' w)/dq at fixed w in world axes: what moving the place does to the rows of a wrench, n x n.
///
/// With f = A' w_f, m = A' w_m, in rows and columns (x, e):
///
///   theta   (~c ~f + ~m) T(x)                    -~f S
///   e       (S' ~f + psi' G' T(beta) ~m) T(x)     psi' [G' d(T(beta) M)/dbeta G + T(beta) M . H + Z] psi + f . Q
///
/// with M = m + a x f, Z = G' T(beta) ~f ~a (G' T(beta))' of an arm a = exp(~beta) arm.
void add_geometric_stiffness(const SpatialMarker& marker, const SpatialPose& at, const Wrench& wrench, double weight,
                             Eigen::MatrixXd& K);

}  // namespace floe::dynamics
