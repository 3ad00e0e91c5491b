#pragma once
#include "floe/body/elasticity.h"
#include "floe/body/viscosity.h"
#include "floe/fem/mesh.h"
#include "floe/reference/spatial_places.h"

namespace floe::reference {

/// An elastic element in space that floats in a frame of its own: a beam between two places, a triangle of shell
/// between three, or either of second order. Each place is carried by the rigid frame of a node, finite rotations
/// included.
///
/// Places i: position p_i, axes D_i (world), X_i in body axes; undeformed D_i = Q for a rotation Q of the body. With Q
/// the element's rotation from body axes,
///
///   d = (u_i, theta_i),   u_i = Q'(p_i - p_1) - (X_i - X_1),   exp(~theta_i) = Q' D_i,   U = U_e(d),   Gamma d = 0
///
/// where U_e is the energy of the finite element as fem has it, and three conditions linear in d say what Q is: of a
/// beam the chord of its ends along X_2 - X_1 and no mean twist of these; of a triangle its corners in its plane and no
/// rotation of them in the mean, sum (X_i - C) x u_i = 0; of elements with more places all three of these sums. Rigid
/// motions cost nothing, exactly.
///
/// Q is found by Newton's method; with the multipliers of Gamma the energy is stationary in Q, so that
///
///   forces F_i = Q f_i,   moments M_i = Q T(theta_i)^-1 m_i,   (f, m) = (I - R'W') dU_e/dd,   R = (Gamma W)^-1 Gamma,
///
/// W = dd/dQ: P = I - W R is the projector of Rankin and Nour-Omid, T that of the rotation vector. The tangent is
/// exact: material, geometric, and of Q. Kelvin-Voigt damping acts on the strain rates of U_e (body::add_viscous_force)
/// by d' = P (Q'p_i', T(theta_i)'^-1 Q'w_i); a rigid motion has none.
///
/// Strains are small within the element, and rotations moderate; the mesh makes them so. A rotation of half a turn
/// within one element, and three corners on a line, give values that are not finite.
///
/// Sources: Rankin, Nour-Omid 1988, Comput. Struct. 30; Felippa, Haugen 2005, Comput. Methods Appl. Mech. Eng. 194.
class CorotationalElement final : public dynamics::Term {
 public:
  /// @param kind        of the element: first order triangles and beams, or those of second order
  /// @param places      of its nodes, framed; x0 and D0 are those of the place in its node's frame
  /// @param X           the places undeformed, 3 x n, body axes [m]
  /// @param elasticity  of the element, 6n displacements and rotation vectors in body axes
  /// @param viscosity   beta of Kelvin-Voigt damping [s]
  /// @throws InputError  two places that coincide, three on a line
  CorotationalElement(fem::CellKind kind, std::vector<dynamics::SpatialMarker> places, Eigen::Matrix3Xd X,
                      body::Elasticity elasticity, double viscosity = 0);

  const std::vector<int>& coordinates() const override { return places_.coordinates(); }
  void residual(const dynamics::Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const dynamics::Motion& motion, dynamics::Weights weights, Eigen::MatrixXd& J) const override;
  dynamics::Energy energy(const dynamics::Motion& motion) const override;
  double strain_damping() const override { return viscosity_; }
  /// d, of which strains are functions, 6n. Valid until the next call.
  const Eigen::VectorXd& deformation(const dynamics::Motion& motion) const {
    see(motion, dynamics::EvaluationLevel::position);
    return d_;
  }

 private:
  static constexpr int most = 6 * mesh::most_nodes;
  using Matrix3x = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, most>;
  using Matrixx3 = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, most, 3>;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most, most>;
  Eigen::Index size() const { return 6 * X_.cols(); }
  void see(const dynamics::Motion& motion, dynamics::EvaluationLevel level) const;
  Eigen::Quaterniond guess() const;
  bool measure(const Eigen::Matrix3d& Q) const;
  void see_rates() const;
  void balance() const;      ///< f_ on d becomes forces in equilibrium; wrenches_
  Square of_places() const;  ///< d on (Q'dp, Q'dphi) at fixed Q
  Square by_places(const Square& stiffness, const Square& rate_stiffness) const;

  bool line_;
  Eigen::Matrix3Xd X_;
  body::Elasticity elasticity_;
  double viscosity_;
  Matrix3x conditions_;  // Gamma

  // of the configuration seen last; kept so that nothing is allocated
  mutable SpatialPlaces places_;
  mutable Eigen::VectorXd d_, rate_, f_, wrenches_;
  mutable Eigen::MatrixXd K_, C_, Y_, Yd_;
  mutable Eigen::Matrix3d Q_;
  mutable Eigen::Matrix3Xd r_;                               // Q'(p_i - p_1)
  mutable std::array<Eigen::Matrix3d, mesh::most_nodes> H_;  // T(theta_i)'^-1
  mutable Eigen::Matrix3Xd n_;                               // moments T^-1 m_i
  mutable Matrixx3 W_;
  mutable Matrix3x R_;
  mutable Eigen::Vector3d spin_;                  // of Q, in its own axes
  mutable Eigen::Matrix3Xd velocity_, rotating_;  // Q'p_i', Q'w_i
  mutable body::ElasticityWork work_;
  mutable body::ViscosityWork viscous_work_;
};

}  // namespace floe::reference
