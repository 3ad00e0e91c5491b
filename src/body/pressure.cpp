#include "floe/body/pressure.h"

#include <Eigen/Geometry>

namespace floe::body {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

Matrix3d cross(const Vector3d& a) {
  Matrix3d A;
  A << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return A;
}

}  // namespace

Pressure::Pressure(Index k)
    : force_by(Eigen::Matrix3Xd::Zero(3, k)),
      moment_by(Eigen::Matrix3Xd::Zero(3, k)),
      load(Eigen::VectorXd::Zero(k)),
      load_by(Eigen::MatrixXd::Zero(k, k)),
      spread_by(k, Matrix3d::Zero()) {}

void Pressure::add(double area, const Vector3d& x, const Vector3d& normal, const Eigen::MatrixXd& N,
                   const Eigen::MatrixXd& L) {
  force += area * normal;
  moment += area * x.cross(normal);
  spread += area * x * normal.transpose();
  force_by += area * L;
  moment_by += area * (cross(x) * L - cross(normal) * N);
  load += area * N.transpose() * normal;
  load_by += area * N.transpose() * L;
  for (Index j = 0; j < coordinates(); ++j) spread_by[j] += area * N.col(j) * normal.transpose();
}

Pressure& Pressure::operator+=(const Pressure& other) {
  force += other.force, moment += other.moment, spread += other.spread;
  force_by += other.force_by, moment_by += other.moment_by;
  load += other.load, load_by += other.load_by;
  for (Index j = 0; j < coordinates(); ++j) spread_by[j] += other.spread_by[j];
  return *this;
}

Pressure projected(const Pressure& p, const Eigen::MatrixXd& V) {
  Pressure out(V.cols());
  out.force = p.force, out.moment = p.moment, out.spread = p.spread;
  out.force_by = p.force_by * V, out.moment_by = p.moment_by * V;
  out.load = V.transpose() * p.load;
  out.load_by = V.transpose() * p.load_by * V;
  for (Index j = 0; j < V.cols(); ++j)
    for (Index i = 0; i < V.rows(); ++i)
      if (V(i, j) != 0) out.spread_by[j] += V(i, j) * p.spread_by[i];
  return out;
}

}  // namespace floe::body
