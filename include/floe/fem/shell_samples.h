#pragma once
#include "floe/fem/structure.h"

namespace floe::fem {

/// Where the strains of a shell element are known best: the centroid of a flat triangle, the Gauss points of an element
/// of second order. The mean of a quadrilateral's four triangles counts at its middle. Those of elements of first order
/// are means over the element.
///
/// In axes x, y of the surface, s = (e, kappa), e = eps + C kappa (ShellSection):
///
///   s_i = L_i q + 1/2 (G q)' P_i (G q),   N = A e,   M = C'A e + D* kappa,   eps = e - C kappa
struct ShellSample {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< body axes
  Eigen::Matrix3d axes;                          ///< x, y and the normal as columns in body axes
  /// int (x - at)(x - at)' over the area that the strains are the mean of, per area; zero: they are those at the point.
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  double share = 1;  ///< of the samples at this point: their shares add up to one
  /// Of a quadrilateral, which corners the triangle has, otherwise all: the dofs are theirs.
  std::vector<int> corners;
  Eigen::MatrixXd L;               ///< 6 x dofs
  Eigen::MatrixXd G;               ///< gradients x dofs
  std::vector<Eigen::MatrixXd> P;  ///< six
};

/// Of a shell element, on the dofs of its own corners (also where these follow other nodes). Rank-local.
std::vector<ShellSample> shell_samples(const Structure& structure, const Mesh::Cell& cell);

}  // namespace floe::fem
