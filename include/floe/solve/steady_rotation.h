#pragma once
#include <string>
#include <vector>

#include "floe/dynamics/system.h"
#include "floe/solve/branch.h"

namespace floe::solve {
using namespace dynamics;

/// The line about which everything rotates; in the plane z through `point`.
struct RotationAxis {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< of unit length, world axes
};

/// A mechanism that rotates as a whole at a constant speed W about an axis: in axes that rotate with it nothing moves.
///
/// With W the vector of the angular velocity and R from the axis, all seen at the instant at which the rotating axes
/// coincide with those of the world:
///
///   V(U): R. = W x R, omega = A'W, elastic rates 0;   A(U): R.. = W x (W x R), alpha = 0;   in the plane alike
///
/// Drives stand where they are at t = 0: their rate is the rotation. Loads are those at t = 0, too.
struct RotatingSystem {
  const System& system;
  /// In the plane: local index of (R_x, R_y, theta) of every frame. In space System::attitudes() says where frames are,
  /// R before x.
  std::vector<int> planar_frames;
  RotationAxis axis;
  /// Owners (Coordinates::belongs_to) of the joints that drive the system from the ground: where their angle is
  /// constrained, the ground is thought to rotate along.
  std::vector<std::string> drives;
  /// Springs and bushings to the ground, for messages: `bushing left`.
  std::vector<std::string> springs = {};
};

/// Unknowns beyond which vibrations() are not sought: their matrices are dense.
inline constexpr PetscInt largest_rotating_system = 1500;

/// That the equations are the same for a scene that has rotated about the axis: constraints stay met, allow the same
/// motions, and forces and their stiffness rotate along. Tried by rotating U by a finite angle.
///
/// @param U  a configuration that meets the constraints; as before afterwards
/// @throws InputError  what does not rotate: a joint (by name), or loads and gravity. Collective.
void check_rotations(const RotatingSystem& rotating, Vec U);

/// How a steady rotation was reached.
struct RotationSearch {
  BranchJump jump = {};  ///< where the shortest step did not continue; ratio 0: all did
  /// From a start that is not steady at `from`: how far away Newton's method finds another steady rotation, largest
  /// change of an unknown by mass, as the rotation of a frame [rad]. 0: there is none.
  double other = 0;
  /// From such a start, how far away from it the result is, where this is further than `far_from_start`; else 0.
  double away = 0;
};

/// The steady state F(0, U, V(U), A(U)) = 0 at `speed` [rad/s] by Newton's method from the one at `from`, in halved
/// steps of the speed where a whole one fails, down to a thousandth of the way.
///
/// Where U is not steady at `from`, Newton's method starts from it at `speed`; where this leads further than
/// `near_start` away, U becomes steady at `from` first, and is followed from there.
///
/// Where the equations leave directions open (a hub that rotates freely, a hinge at rest) the nearest solution is
/// taken. Where U is steady at `from`, it is followed in shorter steps likewise where it does not continue (branch.h,
/// with speeds in place of t).
///
/// Returns the iterations. Attitudes of U are their own bases afterwards.
/// @throws RunError  none found, or a moment about the axis is left that spins the scene up; U is then as before.
/// Collective, the same on every rank.
PetscInt steady_rotation(const RotatingSystem& rotating, double from, double speed, Vec U,
                         RotationSearch* search = nullptr);
/// A warning of RotationSearch::other, or of `away`; empty: neither.
std::string other_rotation(const RotationSearch& search);
inline constexpr double near_start = 0.1, far_from_start = 0.5;  ///< [rad], as RotationSearch::other

/// V = V(U) at `speed`; attitudes of U are their own bases afterwards. Collective.
void rotating_velocities(const RotatingSystem& rotating, double speed, Vec U, Vec V);

/// A small motion e^(growth t) cos(omega t) about the steady rotation, as seen in the rotating axes.
struct Vibration {
  double omega = 0;   ///< [rad/s]
  double growth = 0;  ///< [1/s]; > 0: unstable, < 0: damped
  bool zero = false;  ///< neither swings nor grows: the scene may rotate on or drift this way
  double below =
      0;  ///< of a zero: what is slower cannot be distinguished from it beside the fastest vibrations [rad/s]
  /// y over all unknowns of the system, y^H M y = 1, and M y; empty without an oscillation.
  Eigen::VectorXcd shape = {}, momentum = {};
  bool unstable() const { return growth > 0; }
};

/// Modal assurance criterion of two vibrations at different speeds, in the mass norm:
///
///   |y_1^H (M_1 + M_2)/2 y_2|^2 in [0, 1];  0 where one of them has no shape.
double modal_assurance(const Vibration& one, const Vibration& other);

/// The `count` slowest vibrations u = Re y e^(st) about a steady state by |s|, and all found that grow; in the order of
/// their frequencies.
///
/// With u the change of U in the rotating axes, x counted in body axes, and u' its rate,
///
///   dV = V_U u + u',  dA = A_U u + H u' + u'',   V_U, A_U derivatives of V(U), A(U);  H: 2 W x in rows R, omega x in x
///   M = F_a,  C = F_v + F_a H,  K = F_q + F_v V_U + F_a A_U,   G u = 0
///
/// on the null space of the constraint gradient G (rank-revealing QR). Up to 150 coordinates the quadratic problem is
/// linearised, shifted, inverted and solved densely; beyond by SLEPc's PEP (TOAR, prefix campbell_).
/// @throws RunError  not converged. Collective, the same on every rank.
std::vector<Vibration> vibrations(const RotatingSystem& rotating, double speed, Vec U, int count);

}  // namespace floe::solve
