#include "floe/fem/point_mass.h"

#include <cmath>

#include "floe/error.h"
#include "floe/fem/transform.h"

namespace floe::fem {

ElementMaps point_mass(const Eigen::Vector3d& node, double mass, const Eigen::Matrix3d& inertia,
                       const Eigen::Vector3d& offset) {
  if (!(mass > 0) || !std::isfinite(mass)) throw InputError("a point mass needs a positive mass");
  if (!inertia.allFinite() || !offset.allFinite()) throw InputError("a point mass has a value that is not finite");
  const double scale = inertia.cwiseAbs().maxCoeff(), tolerance = 1e-9 * scale;
  if ((inertia - inertia.transpose()).cwiseAbs().maxCoeff() > tolerance)
    throw InputError("the inertia tensor of a point mass is not symmetric");

  const Eigen::Matrix3d J = (inertia + inertia.transpose()) / 2;
  const Eigen::Matrix3d second = J.trace() / 2 * Eigen::Matrix3d::Identity() - J;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(second);
  if (principal.eigenvalues().minCoeff() < -tolerance)
    throw InputError(
        "the inertia tensor of a point mass is that of no mass: one principal moment exceeds the other two");

  ElementMaps maps;
  maps.bending = Eigen::MatrixXd::Zero(6, 6);
  const auto place = [&](double m, const Eigen::Vector3d& arm) {
    maps.mass.push_back({m, node + arm, rigid_arm(arm).topRows<3>()});
  };
  double at_centre = mass;
  for (int i = 0; i < 3; ++i) {
    const double s = principal.eigenvalues()[i];
    if (s <= tolerance) continue;
    const Eigen::Vector3d r = std::sqrt(3 * s / mass) * principal.eigenvectors().col(i);
    place(mass / 6, offset + r);
    place(mass / 6, offset - r);
    at_centre -= mass / 3;
  }
  if (at_centre > 1e-9 * mass) place(at_centre, offset);
  body::RotatingForms forms(second);
  forms.add(mass, node + offset, Eigen::Matrix3d::Identity(), offset);
  if (!forms.empty()) {
    maps.rotary.emplace_back(forms, Eigen::MatrixXd::Zero(3, 6));
    maps.rotary.back().rotation.rightCols<3>().setIdentity();
  }
  return maps;
}

}  // namespace floe::fem
