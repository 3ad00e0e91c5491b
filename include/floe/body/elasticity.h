#pragma once
#include <Eigen/Dense>
#include <utility>
#include <vector>

namespace floe::body {

/// Elastic energy of k coordinates as a sum of squares: the von Karman energy of an element or of a whole reduced body.
///
///   U(q) = 1/2 q' K_b q + 1/2 |F z(q)|^2,   z = (q, s),   s_ab = q_a q_b (a < b),  1/2 q_a^2 (a = b)
///
/// F (r x (k + number of pairs)) holds the membrane strains' linear columns and those of the pairs (a, b) that have
/// slope. U is never negative. Without pairs it is the linear body, U = 1/2 q' K q. Force and tangent are its exact
/// gradient and Hessian; F z is formed first and multiplied afterwards, because expanded cubic and quartic tensors lose
/// (L/r)^2 digits.
struct Elasticity {
  Eigen::MatrixXd bending;                   ///< K_b, k x k
  Eigen::MatrixXd F;                         ///< r x (k + pairs)
  std::vector<std::pair<int, int>> pairs;    ///< a <= b, from 0
  Eigen::MatrixXd linear_stiffness() const;  ///< K = K_b + F_lin' F_lin
};

double energy(const Elasticity& elasticity, const Eigen::VectorXd& q);

/// f += dU/dq, K += d2U/dq2 (either may be null). No allocation once `elasticity`'s size has been seen by `work`.
struct ElasticityWork {
  Eigen::VectorXd z, y, w;
  Eigen::MatrixXd T;
};
void add_force(const Elasticity& elasticity, const Eigen::VectorXd& q, ElasticityWork& work,
               Eigen::Ref<Eigen::VectorXd> f);
void add_tangent(const Elasticity& elasticity, const Eigen::VectorXd& q, double weight, ElasticityWork& work,
                 Eigen::Ref<Eigen::MatrixXd> K);

/// The linear body of the same K: pairs dropped.
Elasticity linearised(const Elasticity& elasticity);

/// The energy of the first coordinates with some of their pairs, the other products taken as zero: again a sum of
/// squares, with the same linear part. Of the columns of F that are kept, the triangular factor, where that has fewer
/// rows.
///
/// @param coordinates  how many of the first
/// @param kept         of each pair whether it is; of pairs of other coordinates of no effect
Elasticity part(const Elasticity& elasticity, int coordinates, const std::vector<char>& kept);

}  // namespace floe::body
