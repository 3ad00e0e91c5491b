#include "floe/mesh/facet.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

namespace floe::mesh {

using Eigen::Vector3d;

FacetCorner::FacetCorner(const Vector3d& previous, const Vector3d& at, const Vector3d& next) {
  const Vector3d u = next - at, v = previous - at, across = u.cross(v);
  normal = across.stableNormalized();
  angle = std::atan2(across.norm(), u.dot(v));
}

Vector3d surface_normal(const Eigen::Matrix3d& sum) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum).eigenvectors().col(2);
}

}  // namespace floe::mesh
