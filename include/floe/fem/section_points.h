#pragma once
#include <Eigen/Dense>
#include <vector>

#include "floe/fem/shell_section.h"

namespace floe::fem {

/// A layer of a shell: plane-stress stiffness in the section's axes, between two heights above the plane of the nodes.
struct ShellLayer {
  Eigen::Matrix3d Q;   ///< [Pa]
  double bottom, top;  ///< [m]
};

/// Where stresses are taken in a section whose material and shape are known, not its stiffness alone.
struct StressPoints {
  std::vector<ShellLayer> layers = {};       ///< of a shell, from the lowest
  double E = 0;                              ///< of a beam [Pa]
  std::vector<Eigen::Vector2d> fibres = {};  ///< of a beam: extreme ones, [y, z] from the centroid in section axes [m]
  double radius = 0;                         ///< of a beam with a round section, instead [m]
  double W = 0;                              ///< of a beam in space, as SectionShape::W [m3]
  bool known() const { return !layers.empty() || !fibres.empty() || radius > 0; }
};

/// @param offset  height of the stack's middle above the plane of the nodes, as for shell_section
std::vector<ShellLayer> shell_layers(const std::vector<Ply>& plies, double offset);

/// Corners of a rectangle, `width` along y.
std::vector<Eigen::Vector2d> rectangle_corners(double width, double height);

}  // namespace floe::fem
