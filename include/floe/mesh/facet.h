#pragma once
#include <Eigen/Core>
#include <numbers>

#include "floe/mesh/raw_mesh.h"

namespace floe::mesh {

constexpr bool is_flat_shell(CellKind kind) { return is_shell(kind) && !is_quadratic(kind); }

/// A flat shell element at one of its corners: unit normal of its two edges there (zero where one has no length; that
/// of the bilinear surface for quadrilaterals) and angle between them.
struct FacetCorner {
  Eigen::Vector3d normal;
  double angle;
  Eigen::Vector3d sector;  ///< integral of unit vectors from the corner into the element over the angle

  FacetCorner(const Eigen::Vector3d& previous, const Eigen::Vector3d& at, const Eigen::Vector3d& next);
  Eigen::Matrix3d weighted() const { return angle * normal * normal.transpose(); }
};

/// The normal of the surface at a node, of either sign: the axis N of greatest sum angle (n.N)^2.
/// @param sum  FacetCorner::weighted of the elements there
Eigen::Vector3d surface_normal(const Eigen::Matrix3d& sum);

/// Whether elements at a node lie on top of one another, as at the edge of a wedge: the norm of the sum of their
/// sectors exceeds by a tenth that of one flat element with the sum of their angles (at most pi).
bool is_sharp(const Eigen::Vector3d& sectors, double angles);

/// Angle [rad] between an element and the surface at a node from which on the surface is folded there; twice that
/// between two elements.
inline constexpr double fold = 21 * std::numbers::pi / 180;

}  // namespace floe::mesh
