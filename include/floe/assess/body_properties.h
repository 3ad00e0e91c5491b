#pragma once
#include <optional>
#include <string>
#include <vector>

#include "floe/scene/scene.h"

namespace floe::assess {
using namespace scene;

/// What one compares with another program before anything is simulated. In the axes of the mesh; of a body from a file
/// in those of its floating frame. In the plane the entries of z are 0, and the moment of inertia is zz.
struct BodyProperties {
  std::string name;
  double mass = 0;                                    ///< m [kg]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();   ///< of gravity [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about it, int rho (r'r 1 - r r') dV [kg m2]
  struct Box {
    Eigen::Vector3d low, high;
  };
  std::optional<Box> box;           ///< about the nodes [m]; none: of a body from a file
  std::vector<double> free;         ///< [rad/s], of the body without supports; rigid motions are not counted
  std::vector<double> constrained;  ///< [rad/s], under the conditions that its modes have; empty: these are free
};

/// Of every body. Rigid regions at the places of joints are rigid here, too. Collective.
/// @param frequencies  how many to find of each kind; fewer where the body has fewer; 0: nothing is assembled
std::vector<BodyProperties> body_properties(const Scene& scene, MPI_Comm comm, int frequencies);

}  // namespace floe::assess
