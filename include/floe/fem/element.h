#pragma once
#include <array>
#include <vector>

#include "floe/body/elasticity.h"
#include "floe/body/inertia.h"

namespace floe::fem {

/// The von Karman membrane strain at one point: eps_s(q) = L_s q + 1/2 (G q)' P_s (G q), in body axes.
struct StrainPoint {
  double weight;                   ///< quadrature weight [m], [m2]
  Eigen::MatrixXd D;               ///< membrane stiffness, s x s
  Eigen::MatrixXd L;               ///< linear strain, s x dofs
  Eigen::MatrixXd G;               ///< slopes, g x dofs
  std::vector<Eigen::MatrixXd> P;  ///< s symmetric matrices, g x g

  /// e(a, b): the symmetric bilinear part, e_s = (G a)' P_s (G b), from slopes G a, G b.
  Eigen::VectorXd bilinear(const Eigen::VectorXd& slope_a, const Eigen::VectorXd& slope_b) const;
};

/// An element is its strains, its bending stiffness, its mass points and the rotation of its sections: energy, forces,
/// tangents, derivative right-hand sides and inertia constants all follow from these, for every element alike.
struct ElementMaps {
  Eigen::MatrixXd bending;  ///< dofs x dofs: bending and torsion
  std::vector<StrainPoint> membrane;
  std::vector<body::MassPoint> mass;
  std::vector<body::RotatingMass> rotary;  ///< those of the mass points that belong to sections that rotate rigidly

  Eigen::MatrixXd stiffness() const;  ///< K = K_b + sum w L'DL
  /// d2U/dq2 = K_b + sum w [E'D E + sum_s sigma_s G'P_s G],  E = L + e(q, .),  sigma = D (L q + e(q, q)/2)
  Eigen::MatrixXd tangent(const Eigen::VectorXd& q) const;
  Eigen::MatrixXd mass_matrix() const;  ///< M = sum m N'N
};

/// (dK/deta_j) phi_i for one element: sum w [ L'D e(a, b) + e(a, .)'D L b + e(b, .)'D L a ]. Exact; symmetric in a, b.
Eigen::VectorXd stiffness_derivative(const ElementMaps& maps, const Eigen::VectorXd& a, const Eigen::VectorXd& b);

/// Pairs (a <= b) of columns that have slope in this element or in any: all pairs of `sloped`.
std::vector<std::pair<int, int>> pairs_of(const std::vector<int>& sloped);

/// Rows sqrt(w) D^(1/2) [ L V | e(V_a, V_b) for the pairs ] of one element, V = dofs x k.
Eigen::MatrixXd strain_rows(const ElementMaps& maps, const Eigen::MatrixXd& V,
                            const std::vector<std::pair<int, int>>& pairs);

/// Elastic energy of the element on the columns of V, as a sum of squares.
body::Elasticity elasticity(const ElementMaps& maps, const Eigen::MatrixXd& V);

/// Inertia constants of the element on the columns of V.
body::Inertia inertia(const ElementMaps& maps, const Eigen::MatrixXd& V);

}  // namespace floe::fem
