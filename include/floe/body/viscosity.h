#pragma once
#include "floe/body/elasticity.h"

namespace floe::body {

/// Kelvin-Voigt damping on the strain rates of an Elasticity, per unit of beta [s]:
///
///   D(q, q') = 1/2 q'' K_b q' + 1/2 |T q'|^2,   T = F dz/dq,   force dD/dq' = K_b q' + T(q)' T(q) q'
///
/// Twice D is the power that is dissipated; never negative. A motion q' without strain rates (foreshortening that
/// belongs to a deflection) is not damped, unlike with C = beta K, which is the same at q = 0 and for linear bodies.
struct ViscosityWork {
  Eigen::VectorXd zd, y, w;
  Eigen::MatrixXd T, U;
};
/// f += weight dD/dq'. No allocation once `work` has seen the size.
void add_viscous_force(const Elasticity& elasticity, const Eigen::VectorXd& q, const Eigen::VectorXd& v, double weight,
                       ViscosityWork& work, Eigen::Ref<Eigen::VectorXd> f);
/// K += wq d/dq + wv d/dq' of the force, exact; not symmetric in its first part.
void add_viscous_tangent(const Elasticity& elasticity, const Eigen::VectorXd& q, const Eigen::VectorXd& v, double wq,
                         double wv, ViscosityWork& work, Eigen::Ref<Eigen::MatrixXd> K);

}  // namespace floe::body
