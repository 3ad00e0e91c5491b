#pragma once
#include <Eigen/Geometry>

/// Rotations of space by rotation vectors x: exp(x) rotates by |x| about x. Source: Argyris 1982, An excursion into
/// large rotations; Bruels, Cardona 2010, On the use of Lie group time integrators in multibody dynamics. Every
/// function is smooth at x = 0.
namespace floe::math {

/// ~a, with ~a b = a x b.
Eigen::Matrix3d skew(const Eigen::Vector3d& a);

/// P with l . theta x (theta x c) = theta' P theta: P = (l c' + c l')/2 - (l . c) 1. An arm c that rotates by theta
/// moves by theta x c + 1/2 theta x (theta x c).
Eigen::Matrix3d arm_form(const Eigen::Vector3d& l, const Eigen::Vector3d& c);

/// exp(~x).
Eigen::Matrix3d rotation(const Eigen::Vector3d& x);
/// The same rotation as a unit quaternion.
Eigen::Quaterniond quaternion(const Eigen::Vector3d& x);
/// x with exp(~x) = the rotation of a unit quaternion, |x| <= pi; to round-off at any angle.
Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& rotation);

/// The least rotation from the direction of a to that of b; of opposite ones, about some axis across.
Eigen::Quaterniond rotation_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
/// R of the polar decomposition A = R S, det R = 1: of a sum of rotations their mean (in the chordal metric).
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& A);

/// T(x): exp(x)' d exp(x) = ~(T(x) dx), the spin in rotated axes that belongs to a change of x; T(-x) = T(x)'.
///
///   T = I - (1 - cos p)/p^2 ~x + (p - sin p)/p^3 ~x ~x,   p = |x|
Eigen::Matrix3d rotation_tangent(const Eigen::Vector3d& x);
/// d(T(x) w)/dx at fixed w.
Eigen::Matrix3d rotation_tangent_derivative(const Eigen::Vector3d& x, const Eigen::Vector3d& w);

}  // namespace floe::math
