#pragma once
#include <vector>

#include "floe/body/inertia.h"
#include "floe/math/symmetric_forms.h"

namespace floe::body {

/// The contractions of Inertia (d = 3) that a motion in space needs, e the k elastic coordinates, c = x + N e + n/2.
///
///   sigma(e) = int rho c = s0 + S e + 1/2 Q(e, e),     S(e) = dsigma/de = S + Q e
///   J(e)     = int rho (c.c I - c c'),     dJ/de_i = J_i(e)
///   G(e)     = int rho c x dc/de  (3 x k)
///
/// J is kept to second order in e, its derivatives and G to first order:
///   dC_aa/de = 2 (h_aa + D_a e),       D_a = M_aa + W_aa                        J = tr(C) I - C,  C = int rho c c'
///   dC_bc/de = h_bc + h_cb + E_a e,    E_a = M_bc + M_cb + W_bc + W_cb    (a, b, c) cyclic
///   G_a      = h_bc - h_cb + B_a e + Y_a e,    B_a = M_cb - M_bc (skew),   Y_a = W_bc - W_cb (symmetric)
/// D, E, B and Y are kept where they are greater than round-off of M: a body that moves in few directions has few.
struct SpatialInertia {
  double m = 0;
  Eigen::Vector3d s0 = Eigen::Vector3d::Zero();
  Eigen::Matrix3d J0 = Eigen::Matrix3d::Zero();  ///< J at e = 0, about the frame's origin
  Eigen::Matrix3Xd S;
  math::SymmetricForms Q;                           ///< x, y, z; empty: zero
  Eigen::Matrix<double, Eigen::Dynamic, 9> linear;  ///< k x (J_xx J_yy J_zz J_yz J_zx J_xy G_x G_y G_z), d/de at e = 0
  Eigen::MatrixXd M;                                ///< M_xx + M_yy + M_zz
  Eigen::MatrixXd forms;                            ///< k x (k n): the n of D, E, B, Y that do not vanish side by side
  std::vector<int> kinds;                           ///< of each: 0 1 2 D, 3 4 5 E, 6 7 8 B, 9 10 11 Y; ascending
  int symmetric = 0;                                ///< how many of them are D or E

  int coordinates() const { return static_cast<int>(S.cols()); }
};

/// @param inertia  d = 3, any k from 0
SpatialInertia spatial(const Inertia& inertia);

/// Arrays of an evaluation: made once and used again, so that nothing is allocated in a step.
struct SpatialInertiaWork {
  using Rates = Eigen::Matrix<double, Eigen::Dynamic, 12>;
  Eigen::VectorXd e, ed, edd;           ///< elastic parts of q, v, a
  Rates of_e, of_ed, of_edd;            ///< dJ/de, G but for Y e, Y e; what e', e'' as e would add to them
  Eigen::Matrix3Xd S, Qed, Qedd;        ///< S(e), Q e', Q e''; not set where Q vanishes
  Eigen::VectorXd products, Medd, sum;  ///< forms times a vector; M e''; forms added up
};

/// Coordinates of a body floating in space: q = (R, x, e), A = base exp(x), e in body axes; v = (R', omega, e') and
/// a = (R'', alpha, e'') with omega the angular velocity in body axes, alpha = d omega/dt.
///
/// Inertia rows, with u = A'R'' and J' = sum J_i e_i':
///   R      m R'' + A (alpha x sigma + omega x (omega x sigma) + 2 omega x S e' + S e'' + Q(e', e'))
///   theta  sigma x u + J alpha + J' omega + G e'' + Y(e', e') + omega x (J omega + G e')
///   e_i    S_i.u + G_i.alpha + (M e'')_i - 1/2 omega.J_i omega + 2 (sum omega_a B_a e')_i
/// with S = S(e); theta are moments about body axes. Source: Shabana, Dynamics of multibody systems, ch. 5, with the
/// rotation on the group.
/// @param A        base exp(x), x = q[3..5]
/// @param q, v, a  k + 6 each
void add_spatial_inertia_force(const SpatialInertia& inertia, const Eigen::Matrix3d& A, const Eigen::VectorXd& q,
                               const Eigen::VectorXd& v, const Eigen::VectorXd& a, SpatialInertiaWork& work,
                               Eigen::VectorXd& r);

/// Weighted derivatives of the same rows: wq d/dq + wv d/dv + wa d/da, exact. Columns of x are those of a rotation
/// about body axes times T(x) (math::rotation_tangent).
void add_spatial_inertia_tangent(const SpatialInertia& inertia, const Eigen::Matrix3d& A, const Eigen::VectorXd& q,
                                 const Eigen::VectorXd& v, const Eigen::VectorXd& a, double wq, double wv, double wa,
                                 SpatialInertiaWork& work, Eigen::MatrixXd& tangent);

/// 1/2 int rho |r'|^2 [J].
double kinetic_energy(const SpatialInertia& inertia, const Eigen::Matrix3d& A, const Eigen::VectorXd& q,
                      const Eigen::VectorXd& v);

/// int rho r' and, about the origin of the world, int rho r x r'; world axes.
struct Momentum {
  Eigen::Vector3d linear, angular;
};
Momentum momentum(const SpatialInertia& inertia, const Eigen::Matrix3d& A, const Eigen::VectorXd& q,
                  const Eigen::VectorXd& v);

}  // namespace floe::body
