#pragma once
#include <Eigen/Dense>

// The corotational beam in its extended coordinates z = (r1e, r1n, r2e, r2n, a1, a2, beta): places of the nodes, local
// rotations and rotation of the chord. All of z is linear in q but for beta = arg(r2 - r1) - arg(X2 - X1), so with
// g = dbeta/dq, H = d2beta/dq2 and the constant p = (0, 0, 0, 0, -1, -1, 1)
//     dz = P dq,    P = P_0 + p g',    z. = P v,    z.. = P a + p (v'H v)
// Components of vectors and matrices, over q as over z, stand on the axes (e, n) that the chord has at this moment.
namespace floe::reference::corotational {

using Six = Eigen::Matrix<double, 6, 1>;    ///< over q
using Seven = Eigen::Matrix<double, 7, 1>;  ///< over z
using SixSquare = Eigen::Matrix<double, 6, 6>;
using SevenSquare = Eigen::Matrix<double, 7, 7>;

struct Chord {
  double length;
  double elongation;      ///< length less the undeformed one, without the cancellation of that difference
  Eigen::Vector2d e, n;   ///< along it from node 1 to node 2, and a quarter turn further; world axes
  Eigen::Vector2d local;  ///< a_i = theta_i - beta [rad], beta next to their mean by whole turns
};

/// @param undeformed  X2 - X1, world axes
/// @param q           the element's coordinates, world axes
Chord chord_at(const Eigen::Vector2d& undeformed, const Six& q);

/// A vector over q from world axes to (e, n), and back.
Six on_chord(const Chord& chord, const Six& world);
Six on_world(const Chord& chord, const Six& vector);
/// A matrix over q from (e, n) to world axes.
SixSquare on_world(const Chord& chord, const SixSquare& matrix);

/// z. and z..
struct Rates {
  Seven velocity, acceleration;
};
Rates extended_rates(const Chord& chord, const Six& v, const Six& a);

/// P'f
Six reduced(const Chord& chord, const Seven& f);

/// The weighted derivative of P'f(z, z., z..) with respect to q, v, a, weights w:
///     P'[S P + (w_q C + 2 w_v M) p (H v)' + w_q M p (H a + beta'''(v, v))'] + w_q (p'f) H,   S = w_q K + w_v C + w_a M
/// @param K, C, M  df/dz, df/dz., df/dz..
SixSquare reduced(const Chord& chord, const Six& v, const Six& a, const Seven& f, const SevenSquare& K,
                  const SevenSquare& C, const SevenSquare& M, const Eigen::Vector3d& weights);

}  // namespace floe::reference::corotational
