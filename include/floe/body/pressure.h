#pragma once
#include <Eigen/Dense>
#include <vector>

namespace floe::body {

/// What a unit pressure on a body's surface does in a floating frame, with k elastic coordinates q; body axes.
///
/// A facet of area dA with the normal n, whose corners move by u = N q, has the area vector
///
///   n dA + L q dA + O(q^2),   L q = n div u - grad (n.u)
///
/// (in-plane divergence and gradient of the corners' linear interpolation: the slopes of the von Karman strain). A
/// pressure that follows the surface is this vector; all to first order in q:
///
///   force = int n,  force_by = int L,   moment = int x ~ n,  moment_by = int (~x L - ~n N),
///   load = int N'n,  load_by = int N'L
///
/// One that keeps its direction needs int (x + N q) n': spread and spread_by.
struct Pressure {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
  Eigen::Matrix3Xd force_by, moment_by;  ///< 3 x k
  Eigen::VectorXd load;                  ///< k
  Eigen::MatrixXd load_by;               ///< k x k
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  std::vector<Eigen::Matrix3d> spread_by;  ///< k

  explicit Pressure(Eigen::Index coordinates = 0);
  Eigen::Index coordinates() const { return load.size(); }
  /// @param N  3 x k, displacement at x; L as above
  void add(double area, const Eigen::Vector3d& x, const Eigen::Vector3d& normal, const Eigen::MatrixXd& N,
           const Eigen::MatrixXd& L);
  Pressure& operator+=(const Pressure& other);
};

/// On other coordinates, q = V q'.
Pressure projected(const Pressure& pressure, const Eigen::MatrixXd& V);

}  // namespace floe::body
