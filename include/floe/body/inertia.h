#pragma once
#include <Eigen/Dense>
#include <vector>

namespace floe::body {

/// A lumped sample of a body's mass: position in body axes and the displacement of that material point, u = N q.
struct MassPoint {
  double mass;        ///< [kg], quadrature weight included
  Eigen::VectorXd x;  ///< d
  Eigen::MatrixXd N;  ///< d x k
};

/// Mass that rotates rigidly: a piece of a beam about its line of centroids, a rigid mass about its centre. Its mass
/// points are MassPoints, displaced by theta x a; the rotation vector theta = turn q moves them by 1/2 theta x (theta x
/// a) besides, at second order.
struct RotatingMass {
  Eigen::Matrix3d moments;  ///< int rho a a' about the centre, body axes [kg m2]; quadrature weight included
  Eigen::MatrixXd turn;     ///< 3 x k; in the plane the third row alone
};

/// The constants of a body's inertia in d = 2 or 3 dimensions, integrated once over its mass, with k elastic
/// coordinates.
///
///   m = int rho,  s0_a = int rho x_a,  C0_ab = int rho x_a x_b,  S_a = int rho N_a,
///   h_ab = int rho x_a N_b,  M_ab = int rho N_a' N_b,  q' W_ab q = int rho a_a n_b,  n = theta x (theta x a)
///
/// Everything that the floating frame couples follows from them: the displacement is N q + n/2, and the kinetic energy
/// is kept to second order in q and q'. W, symmetric, is the part of sections and rigid masses that rotate
/// (RotatingMass): n has no mean over them. Source: Shabana, Dynamics of multibody systems, ch. 5 (linear part);
/// theory.md. Units: kg, m, and those of the elastic coordinates.
struct Inertia {
  double m = 0;
  Eigen::VectorXd s0;                           ///< d
  Eigen::MatrixXd C0;                           ///< d x d
  Eigen::MatrixXd S;                            ///< d x k
  std::vector<std::vector<Eigen::VectorXd>> h;  ///< [a][b], k
  std::vector<std::vector<Eigen::MatrixXd>> M;  ///< [a][b], k x k; M[b][a] = M[a][b]'
  std::vector<std::vector<Eigen::MatrixXd>> W;  ///< [a][b], k x k, symmetric; empty: nothing rotates by itself

  Inertia() = default;
  Inertia(int dimension, int coordinates);
  int dimension() const { return static_cast<int>(s0.size()); }
  int coordinates() const { return static_cast<int>(S.cols()); }
  void add(const MassPoint& point);
  void add(const RotatingMass& mass);
  void allocate_rotary();  ///< W = 0, unless it is there
  Inertia& operator+=(const Inertia& other);
};

/// The contractions of Inertia that a motion in the plane needs. J = [[0,-1],[1,0]].
///
///   C0 = int rho x'x,  h = int rho x'N,  g = int rho (x N_y - y N_x),  M = M_xx + M_yy,  B = int rho N'J'N (skew),
///   D = M + W_xx + W_yy
///
/// D is M without the rotary inertia of sections: their moment of inertia about the frame's origin does not change as
/// they rotate.
struct PlanarInertia {
  double m = 0;
  Eigen::Vector2d s0 = Eigen::Vector2d::Zero();
  double C0 = 0;
  Eigen::Matrix2Xd S;
  Eigen::VectorXd h, g;
  Eigen::MatrixXd M, B, D;
};

/// What W adds to it, T of a mass with moments E: W_ab += turn' T_ab turn, d = 3.
///
///   T_ab = 1/2 (e_b (E e_a)' + E e_a e_b') - E_ab 1
Eigen::Matrix3d rotary_form(const Eigen::Matrix3d& moments, int a, int b);

/// @param inertia  d = 2, or d = 3 of which x and y count
PlanarInertia planar(const Inertia& inertia);

}  // namespace floe::body
