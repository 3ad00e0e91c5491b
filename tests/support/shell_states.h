#pragma once
#include "floe/fem/shell.h"

namespace floe::testing {

/// A displacement of constant membrane strain and curvature, with its rotations: the nodal values of an exact state.
///
///   u = gradient x, w = -1/2 (kappa_x x^2 + kappa_y y^2 + kappa_xy x y); rotation (w_y, -w_x, (v_x - u_y) / 2)
struct ConstantState {
  Eigen::Matrix2d gradient;
  Eigen::Vector3d curvature;

  Eigen::Vector3d strain() const { return {gradient(0, 0), gradient(1, 1), gradient(0, 1) + gradient(1, 0)}; }
  Eigen::Matrix<double, 6, 1> at(const Eigen::Vector3d& x) const {
    const Eigen::Vector2d in_plane = gradient * x.head<2>();
    const double kx = curvature[0], ky = curvature[1], kxy = curvature[2];
    Eigen::Matrix<double, 6, 1> q;
    q << in_plane, -(kx * x.x() * x.x() + ky * x.y() * x.y() + kxy * x.x() * x.y()) / 2, -ky * x.y() - kxy * x.x() / 2,
        kx * x.x() + kxy * x.y() / 2, (gradient(1, 0) - gradient(0, 1)) / 2;
    return q;
  }
  /// Twice the energy per area.
  double square(const fem::ShellSection& s) const {
    return strain().dot(s.A * strain() + s.B() * curvature) + curvature.dot(s.B() * strain() + s.D() * curvature);
  }
};

template <class Nodes>
Eigen::VectorXd nodal(const ConstantState& state, const Nodes& nodes) {
  Eigen::VectorXd q(6 * nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) q.segment<6>(6 * i) = state.at(nodes[i]);
  return q;
}

/// Small rigid motions of nodes anywhere: three translations, three rotations, as columns.
template <class Nodes>
Eigen::MatrixXd rigid_motions(const Nodes& nodes) {
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(6 * nodes.size(), 6);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (int d = 0; d < 3; ++d) {
      const Eigen::Vector3d axis = Eigen::Vector3d::Unit(d);
      motions(6 * i + d, d) = 1;
      motions.block<3, 1>(6 * i, 3 + d) = axis.cross(Eigen::Vector3d(nodes[i]));
      motions(6 * i + 3 + d, 3 + d) = 1;
    }
  return motions;
}

inline const fem::ShellMaterial carbon{140e9, 10e9, 0.3, 5e9, 1600};

/// Without any symmetry: A, B and D are full.
inline fem::ShellSection skew_laminate(double offset = 1e-3, const Eigen::Vector3d& axis = {1, 0.2, 0}) {
  return fem::shell_section({{carbon, 1e-3, 0.4}, {carbon, 2e-3, -0.9}, {fem::isotropic(70e9, 0.3, 2700), 1e-3}},
                            offset, axis);
}

inline fem::ShellSection aluminium(double thickness) {
  return fem::shell_section({{fem::isotropic(70e9, 0.3, 2700), thickness}});
}

}  // namespace floe::testing
