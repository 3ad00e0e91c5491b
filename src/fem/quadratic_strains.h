#pragma once
#include <array>

#include "floe/fem/quadratic_shell.h"
#include "floe/math/rotation.h"
#include "quadratic_shape.h"

/// The parts of a shell of second order.
namespace floe::fem::quadratic {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Matrix2Xd;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// The surface at a point.
struct Surface {
  VectorXd N;
  Matrix2Xd dN;       ///< d/dr, d/ds
  Vector3d at, r, s;  ///< X, X_r, X_s
  Vector3d normal;    ///< of the length of the area per dr ds
};
Surface surface_at(const Shape& shape, ShellNodes nodes, const Point& point);

/// Axes of the section on the surface, and derivatives along them.
struct LocalAxes {
  Vector3d x, y;
  Matrix2d from_covariant;  ///< of components and derivatives
  Matrix2Xd dN;             ///< along x, y
};
/// @throws InputError  `axis` is normal to the surface; zero: X_r
LocalAxes axes_at(const Surface& at, const Vector3d& axis);

/// Normals at the nodes. @throws InputError  no area there, or folded
std::vector<Vector3d> directors(const Shape& shape, ShellNodes nodes);

/// Strains under way: rows on the nodes' dofs and products of `G`'s rows.
struct Strains3 {
  MatrixXd L, G;
  std::vector<MatrixXd> P;
};

/// What all strains of an element are made of.
struct Element {
  const Shape& shape;
  ShellNodes nodes;
  const ShellSection& section;
  std::vector<Vector3d> director;
  bool second_order;

  Element(ShellNodes n, const ShellSection& s)
      : shape(quadratic::shape_of(n.size())),
        nodes(n),
        section(s),
        director(directors(shape, n)),
        second_order(s.strains == fem::Strains::second_order) {}
  Index count() const { return static_cast<Index>(nodes.size()); }
  Index dofs() const { return 6 * count(); }

  Strains3 empty(Index strains, Index gradients) const {
    return {MatrixXd::Zero(strains, dofs()), MatrixXd::Zero(gradients, dofs()),
            std::vector<MatrixXd>(static_cast<std::size_t>(strains), MatrixXd::Zero(gradients, gradients))};
  }
  /// row += t.(sum f_i u_i)
  template <class Row>
  void add_displacement(Row&& row, const Vector3d& t, const VectorXd& f) const {
    for (Index i = 0; i < count(); ++i) row.template segment<3>(6 * i) += f[i] * t.transpose();
  }
  /// row += t.(sum f_i theta_i x n_i)
  template <class Row>
  void add_director(Row&& row, const Vector3d& t, const VectorXd& f) const {
    for (Index i = 0; i < count(); ++i)
      row.template segment<3>(6 * i + 3) += f[i] * director[static_cast<std::size_t>(i)].cross(t).transpose();
  }
  /// P of t.(sum f_i theta_i x (theta_i x n_i)) / 2 on the rotation vectors of the nodes, from row `first` on.
  void add_rotations(MatrixXd& P, Index first, const Vector3d& t, const VectorXd& f) const {
    for (Index i = 0; i < count(); ++i) {
      const Matrix3d product = t * director[static_cast<std::size_t>(i)].transpose();
      P.block<3, 3>(first + 3 * i, first + 3 * i) +=
          f[i] * ((product + product.transpose()) / 2 - product.trace() * Matrix3d::Identity());
    }
  }
  /// Rows of G: sum f_i u_i, and sum f_i theta_i x n_i, each three from `first` in steps.
  void set_displacements(MatrixXd& G, Index first, Index step, const VectorXd& f) const {
    for (Index i = 0; i < count(); ++i)
      for (Index c = 0; c < 3; ++c) G(first + step * c, 6 * i + c) = f[i];
  }
  void set_directors(MatrixXd& G, Index first, Index step, const VectorXd& f) const {
    for (Index i = 0; i < count(); ++i) {
      const Matrix3d rotation = -f[i] * math::skew(director[static_cast<std::size_t>(i)]);
      for (Index c = 0; c < 3; ++c) G.block<1, 3>(first + step * c, 6 * i + 3) = rotation.row(c);
    }
  }
  void set_rotations(MatrixXd& G, Index first) const {
    for (Index i = 0; i < count(); ++i) G.block<3, 3>(first + 3 * i, 6 * i + 3).setIdentity();
  }
};

/// eps_xx, eps_yy, gamma_xy at a point. G: the gradients of each component along x, y in turn; of von Karman's n.u
/// alone.
Strains3 membrane(const Element& e, const Surface& at, const LocalAxes& axes);

/// What the membrane of a triangle is taken from: the axis of all local axes, and the strain at a point, linear over
/// the element, from the stretches at its ties.
struct TiedMembrane {
  Vector3d axis;
  Eigen::Matrix<double, 9, 9> from_ties;  ///< eps_xx, eps_yy, gamma_xy: constants, of r, of s

  explicit TiedMembrane(const Element& e);
  Eigen::Matrix<double, 3, 9> at(const Point& point) const {
    return from_ties.topRows<3>() + point.x() * from_ties.middleRows<3>(3) + point.y() * from_ties.bottomRows<3>();
  }
};

/// The same of a triangle, from the stretches t.u' + 1/2 u'.u' at its ties. G: of each tie u', the derivative along it,
/// all x first, then y, z; in units in which their squares add up to about those of the gradients.
Strains3 tied_membrane(const Element& e, const Eigen::Matrix<double, 3, 9>& T);

/// kappa_xx, kappa_yy, 2 kappa_xy. G: n.u_x, n.u_y and the rotation w about n, then n, x and y on d_x and on d_y, and
/// the rotation vectors.
Strains3 curvature(const Element& e, const Surface& at, const LocalAxes& axes);

/// Shear at the ties, t along them, s = n x t. G: of each point of these n.u_t, t.u_t, 2/3 s.u_t - 1/3 t.u_s and n.d,
/// t.d, s.d, then the rotation vectors.
Strains3 tied_shear(const Element& e);

}  // namespace floe::fem::quadratic
