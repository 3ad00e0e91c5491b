#pragma once
#include <Eigen/Dense>
#include <vector>

#include "floe/petsc/handle.h"

namespace floe::plan {

/// Modal damping of a body in several floating frames, whose modes phi_i are those of the whole body:
///
///   y_i = sum over its pieces of f_i'q,  f_i = K phi_i / omega_i^2,   viscous forces 2 zeta_i omega_i y_i' on y_i
///
/// with K and the displacements q of a piece in its own frame. K sees no rigid motion of a piece, so that the body is
/// damped alike however far its pieces have rotated, and its rigid motions are not damped.
struct WholeModes {
  std::vector<int> bodies;                            ///< of the plan: its pieces
  Eigen::VectorXd viscosity;                          ///< 2 zeta_i omega_i [1/s]
  std::vector<std::vector<petsc::VecHandle>> forces;  ///< f_i of each piece
};

}  // namespace floe::plan
