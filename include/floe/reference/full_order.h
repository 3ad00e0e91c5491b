#pragma once
#include <map>
#include <memory>

#include "floe/dynamics/coordinates.h"
#include "floe/dynamics/marker.h"
#include "floe/dynamics/term.h"
#include "floe/fem/reference_frame.h"

namespace floe::reference {

/// Where the nodes of a distributed body stand among a system's local coordinates.
///
/// Owned nodes, the mesh's foreign ones, and on the last rank also the nodes that joints, loads and probes act on:
/// these terms live there, beside the frames and the multipliers. On every rank where loads on elements depend on them.
class NodeCoordinates {
 public:
  /// @param visited     global nodes that the last rank must see. Collective (in order with other blocks).
  /// @param everywhere  so must this rank
  NodeCoordinates(dynamics::Coordinates& coordinates, const fem::Mesh& mesh, const std::vector<PetscInt>& visited,
                  int dofs_per_node = 3, bool everywhere = false);
  /// Local index of the first dof of a node that this rank sees.
  int of_local_node(int local) const { return first_ + dofs_ * local; }
  /// Likewise from the global number; throws std::out_of_range where it is not seen.
  int of_node(PetscInt global) const { return first_of_node_.at(global); }
  bool sees(PetscInt global) const { return first_of_node_.contains(global); }
  int first() const { return first_; }

 private:
  int first_ = 0, dofs_ = 3;
  std::map<PetscInt, int> first_of_node_;
};

enum class ElasticForce { von_karman, linear };

/// Terms of one full-order body in its floating frame (formulations nlffr and lffr): one FloatingBody for each element,
/// the equations that hold the frame's conditions, and for mean_axis the constraints Phi_r' M q = 0.
///
/// @param frame        local index of (R_x, R_y, theta)
/// @param multipliers  local index of three multipliers (mean_axis only)
/// @param viscosity    beta of Kelvin-Voigt damping on the strain rates [s]
/// Rank-local: each rank gets the terms of its own elements.
std::vector<std::unique_ptr<dynamics::Term>> full_order_terms(const fem::Structure& structure,
                                                              const fem::ReferenceFrame& reference,
                                                              const NodeCoordinates& nodes, int frame, int multipliers,
                                                              ElasticForce force, double viscosity = 0);

/// Of each of this rank's cells whether it counts; null: all do.
using CellsOfPart = const std::vector<char>*;
inline bool counts(CellsOfPart part, std::size_t cell) { return !part || (*part)[cell] != 0; }

/// The inertia alone of the elements, each as a FloatingBody without elasticity. Rank-local.
std::vector<std::unique_ptr<dynamics::Term>> inertia_terms(const fem::Structure& structure,
                                                           const fem::Conditions& constrained,
                                                           const NodeCoordinates& nodes, int frame,
                                                           CellsOfPart part = nullptr);

/// A uniform force density on every element (of this rank), as a marker each: [kg] of mass, or [m] of line.
///
/// @param constrained  dofs that the frame holds: a force on them acts on the frame alone
enum class Density { mass, line };
std::vector<dynamics::Marker> density_markers(const fem::Structure& structure, const fem::Conditions& constrained,
                                              const NodeCoordinates& nodes, int frame, Density density,
                                              CellsOfPart part = nullptr);

/// The place of a node of a full-order body, which does not move with the dofs that the frame holds.
dynamics::Marker node_marker(const fem::Conditions& constrained, const NodeCoordinates& nodes, int frame, PetscInt node,
                             const Eigen::Vector3d& x);

/// Line density on the elements of a corotational body (world axes): each half element's load goes to its node. [m]
std::vector<dynamics::Marker> corotational_line_markers(const fem::Structure& structure, const NodeCoordinates& nodes,
                                                        CellsOfPart part = nullptr);

/// r = A q with A fixed: a linear equation among coordinates, in terms of dynamics::Term. Weight 1 at every level.
///
/// With multipliers: r_q = C' lambda, r_lambda = C q.
class LinearConstraint final : public dynamics::Term {
 public:
  /// @param coordinates  of q, then of the multipliers; C is (multipliers) x (q)
  LinearConstraint(std::vector<int> coordinates, Eigen::MatrixXd C);
  const std::vector<int>& coordinates() const override { return coordinates_; }
  void residual(const dynamics::Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const dynamics::Motion& motion, dynamics::Weights weights, Eigen::MatrixXd& J) const override;

 private:
  std::vector<int> coordinates_;
  Eigen::MatrixXd C_;
};

/// r = scale * q: a dof that the frame holds at zero.
class ConstrainedDof final : public dynamics::Term {
 public:
  ConstrainedDof(int coordinate, double scale) : coordinates_{coordinate}, scale_(scale) {}
  const std::vector<int>& coordinates() const override { return coordinates_; }
  void residual(const dynamics::Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const dynamics::Motion& motion, dynamics::Weights weights, Eigen::MatrixXd& J) const override;

 private:
  std::vector<int> coordinates_;
  double scale_;
};

}  // namespace floe::reference
