#pragma once
#include <Eigen/Dense>
#include <vector>

namespace floe::assess {

/// Displacements and rotations of an element's nodes in its own mean axes, in place.
/// @param X     undeformed places in the body's axes
/// @param axes  of the body, as columns in world axes
/// @param q     of cfr: places [m] and rotation vectors [rad] in world axes, 6 of each node
void take_deformation(const std::vector<Eigen::Vector3d>& X, const Eigen::Matrix3d& axes,
                      Eigen::Ref<Eigen::VectorXd> q);

/// In the plane, of an element of two nodes.
/// @param start  angle of the body's axes [rad]
/// @param q      displacements [m] and angle [rad] in world axes, 3 of each node
void take_planar_deformation(const std::vector<Eigen::Vector3d>& X, double start, Eigen::Ref<Eigen::VectorXd> q);

}  // namespace floe::assess
