#pragma once
#include "floe/dynamics/moving_axes.h"
#include "floe/dynamics/term.h"

namespace floe::dynamics {

/// Moving axes at a motion, in three dimensions. Rotations dphi in world axes are E dtheta, and dtheta = T dx.
struct SeenAxes {
  int p = 0, o = 0, d = 3, n = 3;  ///< rows of position and rotation in the term's coordinates, and how many of each
  Eigen::Vector3d R = Eigen::Vector3d::Zero(), v = Eigen::Vector3d::Zero(), w = Eigen::Vector3d::Zero(),
                  vd = Eigen::Vector3d::Zero(), wd = Eigen::Vector3d::Zero();  ///< world; of rotation w, wd
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity();
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> E;
  Eigen::MatrixXd T;
};

/// @param coordinates  the term's
SeenAxes see(const MovingAxes& axes, const std::vector<int>& coordinates, const Motion& motion);

}  // namespace floe::dynamics
