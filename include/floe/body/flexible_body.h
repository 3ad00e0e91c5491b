#pragma once
#include <string>
#include <vector>

#include "floe/body/elasticity.h"
#include "floe/body/inertia.h"

namespace floe::body {

/// A reduced body: a few kilobytes, the same to the bit on every rank. k generalised coordinates.
struct FlexibleBody {
  Inertia inertia;
  Elasticity elasticity;
  Inertia line;  ///< the same integrals over unit density per length: what a uniform distributed load acts on
  int coordinates() const { return static_cast<int>(elasticity.bending.rows()); }
};

/// How a place of a body moves with its elastic coordinates: displacement S q + 1/2 Q(q, q) [d x k], rotation
/// b + 1/2 H(b, b), b = psi q.
struct PlaceMap {
  Eigen::VectorXd x;  ///< undeformed, in the axes of the floating frame
  Eigen::MatrixXd S;
  Eigen::MatrixXd psi;
  std::vector<Eigen::MatrixXd> Q = {};  ///< [a], k x k, symmetric, of nodes at arms; empty: zero
  std::vector<Eigen::Matrix3d> H = {};  ///< [a], symmetric, in space, of rotations by displacements; empty: zero
};

}  // namespace floe::body
