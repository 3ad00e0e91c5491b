#pragma once
#include "floe/body/inertia.h"

namespace floe::body {

/// The constants of the same body in other axes, x -> R x + r (d = 2 or 3), whose displacements rotate with it,
/// N -> R N, n -> R n:
///
///   s0 -> R s0 + m r,   C0 -> R C0 R' + R s0 r' + r (R s0)' + m r r',   S -> R S,   Q_a -> sum R_ac Q_c,
///   h_ab -> sum R_ac R_bd h_cd + r_a (R S)_b,   M_ab -> sum R_ac R_bd M_cd,   W_ab -> sum R_ac R_bd W_cd + r_a Q_b
Inertia placed(const Inertia& inertia, const Eigen::MatrixXd& rotation, const Eigen::VectorXd& translation);

}  // namespace floe::body
