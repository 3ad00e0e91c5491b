#include "floe/mesh/facet.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace floe::mesh {

using Eigen::Vector3d;

FacetCorner::FacetCorner(const Vector3d& previous, const Vector3d& at, const Vector3d& next) {
  const Vector3d u = next - at, v = previous - at, across = u.cross(v);
  normal = across.stableNormalized();
  angle = std::atan2(across.norm(), u.dot(v));
  sector = 2 * std::sin(angle / 2) * (u.stableNormalized() + v.stableNormalized()).stableNormalized();
}

Vector3d surface_normal(const Eigen::Matrix3d& sum) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum).eigenvectors().col(2);
}

bool is_sharp(const Vector3d& sectors, double angles) {
  return sectors.norm() > 1.1 * 2 * std::sin(std::min(angles, std::numbers::pi) / 2);
}

}  // namespace floe::mesh
