#pragma once
#include <Eigen/Dense>
#include <array>
#include <vector>

namespace floe::body {

/// A lumped sample of a body's mass: position in body axes and the displacement of that material point, u = N q.
struct MassPoint {
  double mass;        ///< [kg], quadrature weight included
  Eigen::VectorXd x;  ///< d
  Eigen::MatrixXd N;  ///< d x k
};

/// Integrals over mass whose displacement has a part of second order, n/2 beside N q (MassPoint). What rotates rigidly
/// by the rotation vector theta about a point that q displaces, at the arm c from it, has n = theta x (theta x c):
///
///   int rho n_a = theta' first[a] theta,   int rho x_a n_b = theta' moments[a][b] theta      all 3 x 3, symmetric
///
/// x: undeformed position; all in the frame's axes. Sections of beams, rigid masses, what follows a node at an arm.
struct RotatingForms {
  using Form = Eigen::Matrix3d;
  std::array<Form, 3> first;
  std::array<std::array<Form, 3>, 3> moments;

  RotatingForms();  ///< zero
  /// A piece about its centre, which q displaces: int rho c = 0. @param second  int rho c c' about the centre [kg m2],
  /// quadrature weight included
  explicit RotatingForms(const Eigen::Matrix3d& second);
  /// Adds mass at x, displaced by N n/2 besides, n of a point at the arm. @param N  d x d; 1: mass at that point
  void add(double mass, const Eigen::VectorXd& x, const Eigen::MatrixXd& N, const Eigen::Vector3d& arm);
  /// The same in other axes of the frame. @param R  its columns are the present axes in the new ones
  void rotate(const Eigen::Matrix3d& R);
  bool has_first() const;
  bool empty() const;
};

/// Such mass, theta = rotation q.
struct RotatingMass : RotatingForms {
  Eigen::MatrixXd rotation;  ///< 3 x k; in the plane the third row alone
  RotatingMass(RotatingForms forms, Eigen::MatrixXd by) : RotatingForms(std::move(forms)), rotation(std::move(by)) {}
};

/// The constants of a body's inertia in d = 2 or 3 dimensions, integrated once over its mass, with k elastic
/// coordinates.
///
///   m = int rho,  s0_a = int rho x_a,  C0_ab = int rho x_a x_b,  S_a = int rho N_a,
///   h_ab = int rho x_a N_b,  M_ab = int rho N_a' N_b,  q' Q_a q = int rho n_a,  q' W_ab q = int rho x_a n_b
///
/// Everything that the floating frame couples follows from them: the displacement is N q + n/2, n of second order
/// (RotatingMass), and the kinetic energy is kept to second order in q and q'. Q, W are symmetric; Q vanishes where
/// what rotates rotates about its centre. Source: Shabana, Dynamics of multibody systems, ch. 5 (linear part);
/// theory.md. Units: kg, m, and those of the elastic coordinates.
struct Inertia {
  double m = 0;
  Eigen::VectorXd s0;                           ///< d
  Eigen::MatrixXd C0;                           ///< d x d
  Eigen::MatrixXd S;                            ///< d x k
  std::vector<std::vector<Eigen::VectorXd>> h;  ///< [a][b], k
  std::vector<std::vector<Eigen::MatrixXd>> M;  ///< [a][b], k x k; M[b][a] = M[a][b]'
  std::vector<Eigen::MatrixXd> Q;               ///< [a], k x k, symmetric; empty: zero
  std::vector<std::vector<Eigen::MatrixXd>> W;  ///< [a][b], k x k, symmetric; empty: zero

  Inertia() = default;
  Inertia(int dimension, int coordinates);
  int dimension() const { return static_cast<int>(s0.size()); }
  int coordinates() const { return static_cast<int>(S.cols()); }
  void add(const MassPoint& point);
  void add(const RotatingMass& mass);
  void allocate_first();   ///< Q = 0, unless it is there
  void allocate_rotary();  ///< W = 0, unless it is there
  Inertia& operator+=(const Inertia& other);
};

/// The contractions of Inertia that a motion in the plane needs. J = [[0,-1],[1,0]].
///
///   C0 = int rho x'x,  h = int rho x'N,  g = int rho (x N_y - y N_x),  M = M_xx + M_yy,  B = int rho N'J'N (skew),
///   D = M + W_xx + W_yy,  Y = W_xy - W_yx
///
/// D is M without the rotary inertia of sections: their moment of inertia about the frame's origin does not change as
/// they rotate. Q, Y: empty where they vanish.
struct PlanarInertia {
  double m = 0;
  Eigen::Vector2d s0 = Eigen::Vector2d::Zero();
  double C0 = 0;
  Eigen::Matrix2Xd S;
  Eigen::VectorXd h, g;
  Eigen::MatrixXd M, B, D, Y;
  std::vector<Eigen::MatrixXd> Q;  ///< x, y
};

/// @param inertia  d = 2, or d = 3 of which x and y count
PlanarInertia planar(const Inertia& inertia);

}  // namespace floe::body
