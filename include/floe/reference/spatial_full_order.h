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

/// The elements of one full-order body in space (formulations nlffr and lffr): of each a SpatialBody, or a
/// FixedFrameBody where the frame is fixed; before it the damping of its strain rates and for mean_axis its part of
/// the constraints Phi_r' M q = 0, where there are any.
///
/// Terms are created on request: those of a shell triangle take 31 kB, those of a body may exceed the memory.
class SpatialElements {
 public:
  using Terms = std::vector<std::unique_ptr<dynamics::Term>>;
  /// @param structure    borrowed
  /// @param constrained  dofs constrained by the frame, and those of dependent nodes
  /// @param frame        without attitude: a fixed frame
  /// @param viscosity    beta of Kelvin-Voigt damping on the strain rates [s]
  /// Collective.
  SpatialElements(const fem::Structure& structure, const fem::ReferenceFrame& reference, fem::Conditions constrained,
                  const NodeCoordinates& nodes, SpatialFrame frame, ElasticForce force, double viscosity = 0);
  /// Of this rank.
  std::size_t count() const { return structure_.mesh.cells.size(); }
  /// @param stiffest  raised to the stiffness of the element. Rank-local.
  Terms terms(std::size_t cell, double& stiffest) const;
  /// The equations that keep the constrained dofs at zero, scaled. Rank-local.
  Terms constraints(double scale) const;
  /// All of them. Collective.
  Terms all() const;

 private:
  const fem::Structure& structure_;
  fem::Conditions constrained_;
  NodeCoordinates nodes_;
  SpatialFrame frame_;
  ElasticForce force_;
  double viscosity_;
  std::vector<Eigen::VectorXd> rigid_;  // of mean axes, at this rank's dofs
};

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
