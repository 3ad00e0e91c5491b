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

/// The constants of a body's inertia in d = 2 or 3 dimensions, integrated once over its mass, with k elastic
/// coordinates.
///
///   m = int rho,  s0_a = int rho x_a,  C0_ab = int rho x_a x_b,  S_a = int rho N_a,
///   h_ab = int rho x_a N_b,  M_ab = int rho N_a' N_b
///
/// Everything that the floating frame couples follows from them, because N q is linear in q. Source: Shabana, Dynamics
/// of multibody systems, ch. 5. Units: kg, m, and those of the elastic coordinates.
struct Inertia {
  double m = 0;
  Eigen::VectorXd s0;                           ///< d
  Eigen::MatrixXd C0;                           ///< d x d
  Eigen::MatrixXd S;                            ///< d x k
  std::vector<std::vector<Eigen::VectorXd>> h;  ///< [a][b], k
  std::vector<std::vector<Eigen::MatrixXd>> M;  ///< [a][b], k x k; M[b][a] = M[a][b]'

  Inertia() = default;
  Inertia(int dimension, int coordinates);
  int dimension() const { return static_cast<int>(s0.size()); }
  int coordinates() const { return static_cast<int>(S.cols()); }
  void add(const MassPoint& point);
  Inertia& operator+=(const Inertia& other);
};

/// The contractions of Inertia that a motion in the plane needs. J = [[0,-1],[1,0]].
///
///   C0 = int rho x'x,  h = int rho x'N,  g = int rho (x N_y - y N_x),  M = M_xx + M_yy,  B = int rho N'J'N (skew)
struct PlanarInertia {
  double m = 0;
  Eigen::Vector2d s0 = Eigen::Vector2d::Zero();
  double C0 = 0;
  Eigen::Matrix2Xd S;
  Eigen::VectorXd h, g;
  Eigen::MatrixXd M, B;
};

/// @param inertia  d = 2, or d = 3 of which x and y count
PlanarInertia planar(const Inertia& inertia);

}  // namespace floe::body
