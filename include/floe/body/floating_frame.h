#pragma once
#include "floe/body/inertia.h"

namespace floe::body {

/// Coordinates of a body floating in the plane: (R_x, R_y, theta, q), q its k elastic coordinates in body axes.
///
/// Inertia rows of the equations of motion, M(q) a - Q_v(q, v), with sigma = s0 + S0 q + 1/2 Q(q, q), S = S0 + Q q,
/// A = A(theta), J = [[0,-1],[1,0]]:
///   R      m R.. + A (J sigma th.. + S q.. + Q(q., q.) - th.^2 sigma + 2 th. J S q.)
///   theta  (A J sigma).R.. + (C0 + 2 h q + q'D q) th.. + (g + B'q + Y q).q.. + Y(q., q.) + 2 th. (h + D q).q.
///   q      S'A'R.. + (g + B'q + Y q) th.. + M q.. - th.^2 (h + D q) - 2 th. B q.
/// Source: Shabana, Dynamics of multibody systems, ch. 5.
/// @param q, v, a  k + 3 each, frame first
/// @param work     its arrays are made once and used again: nothing is allocated in a step
struct InertiaWork {
  Eigen::VectorXd e, ed, edd;              ///< elastic parts of q, v, a
  Eigen::VectorXd De, Be, Ded, Bed, Bedd;  ///< their products with D and B; B e is less Y e
  Eigen::VectorXd Yed;                     ///< 0 where Y vanishes
  Eigen::Matrix2Xd S, Qed, Qedd;           ///< S + Q e, Q e', Q e''; not set where Q vanishes
};
void add_inertia_force(const PlanarInertia& inertia, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                       const Eigen::VectorXd& a, InertiaWork& work, Eigen::VectorXd& r);

/// Weighted derivatives of the same rows: wq d/dq + wv d/dv + wa d/da, exact.
void add_inertia_tangent(const PlanarInertia& inertia, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                         const Eigen::VectorXd& a, double wq, double wv, double wa, InertiaWork& work,
                         Eigen::MatrixXd& J);

/// Both with work arrays of their own, for single evaluations.
void add_inertia_force(const PlanarInertia& inertia, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                       const Eigen::VectorXd& a, Eigen::VectorXd& r);
void add_inertia_tangent(const PlanarInertia& inertia, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                         const Eigen::VectorXd& a, double wq, double wv, double wa, Eigen::MatrixXd& J);

/// 1/2 v'M(q)v. [J]
double kinetic_energy(const PlanarInertia& inertia, const Eigen::VectorXd& q, const Eigen::VectorXd& v);

}  // namespace floe::body
