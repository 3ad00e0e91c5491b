#pragma once
#include "floe/dynamics/spatial_body.h"
#include "floe/dynamics/spatial_marker.h"
#include "floe/reference/full_order.h"

namespace floe::reference {

/// A shell's rotations about its normal carry no mass, and a motion of full order needs some: they get as much as those
/// about the other axes have, half the trace of a node's rotary inertia. Frequencies change by the order of
/// (thickness/length)^2.
/// @param mass  of the element; returned with what it lacks
Eigen::MatrixXd with_drilling_inertia(const fem::Structure& structure, const fem::Mesh::Cell& cell,
                                      Eigen::MatrixXd mass);

/// The greatest diagonal entry of an element's bending stiffness, of all its stiffness where strains include bending: a
/// scale for equations that hold dofs.
double stiffest(const fem::ElementMaps& maps);

/// The dofs of a cell that are free: a selection matrix of their columns (cell dofs x free), and their numbers among
/// the system's local coordinates.
struct FreeDofs {
  Eigen::MatrixXd V;
  std::vector<int> coordinates;
};
FreeDofs free_dofs(const fem::Structure& structure, const fem::Conditions& constrained, const fem::Mesh::Cell& cell,
                   const NodeCoordinates& nodes);

/// A frame in space among a system's local coordinates.
struct SpatialFrame {
  int first = 0;        ///< local index of R; x follows
  int multipliers = 0;  ///< local index of six multipliers (mean axes only)
  std::shared_ptr<const dynamics::Attitude> attitude;
};

/// Terms of one full-order body that floats in space (formulations nlffr and lffr): a SpatialBody for each element, the
/// equations that hold the dofs of `constrained` at zero, and for mean_axis the constraints Phi_r' M q = 0.
///
/// @param constrained       dofs that the frame holds, and those of nodes that follow others
/// @param viscosity  beta of Kelvin-Voigt damping on the strain rates [s]
/// Each rank gets the terms of its own elements. Collective.
std::vector<std::unique_ptr<dynamics::Term>> spatial_full_order_terms(
    const fem::Structure& structure, const fem::ReferenceFrame& reference, const fem::Conditions& constrained,
    const NodeCoordinates& nodes, const SpatialFrame& frame, ElasticForce force, double viscosity = 0);

/// The inertia alone of the elements, each as a SpatialBody without elasticity. Rank-local.
std::vector<std::unique_ptr<dynamics::Term>> spatial_inertia_terms(const fem::Structure& structure,
                                                                   const fem::Conditions& constrained,
                                                                   const NodeCoordinates& nodes,
                                                                   const SpatialFrame& frame,
                                                                   CellsOfPart part = nullptr);

/// Of the mass, or of the length or area, of an element on the columns of V.
body::Inertia density_inertia(const fem::Structure& structure, const fem::Mesh::Cell& cell, Density density,
                              const Eigen::MatrixXd& V);

/// A uniform force density on every element (of this rank), as a marker each: [kg] of mass, or of line and area.
std::vector<dynamics::SpatialMarker> spatial_density_markers(const fem::Structure& structure,
                                                             const fem::Conditions& constrained,
                                                             const NodeCoordinates& nodes, const SpatialFrame& frame,
                                                             Density density, CellsOfPart part = nullptr);

}  // namespace floe::reference
