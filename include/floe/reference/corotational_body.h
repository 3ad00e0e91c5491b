#pragma once
#include <map>
#include <memory>
#include <vector>

#include "floe/dynamics/spatial_joint.h"
#include "floe/dynamics/spatial_marker.h"
#include "floe/dynamics/system.h"
#include "floe/fem/structure.h"
#include "floe/reference/corotational_element.h"
#include "floe/reference/full_order.h"

namespace floe::reference {

/// Where a body stands at the start: R and A of its floating frame, their rates, and its deformation in it.
struct CorotationalStart {
  Eigen::Vector3d place;
  Eigen::Matrix3d attitude;
  Eigen::Vector3d rate = Eigen::Vector3d::Zero(), spin = Eigen::Vector3d::Zero();  ///< spin in frame axes
  Vec deformation = nullptr, deformation_rate = nullptr;                           ///< fields of the structure, or null
};

/// A body of beams and shells in space without a floating frame (formulation cfr): every node is a rigid frame of its
/// own, position R in world axes and attitude A with A the frame axes' rotation of the whole body when it moves
/// rigidly, and every element a CorotationalElement between places of these frames; a quadrilateral is its four
/// triangles at half weight. Nodes that follow others are places of the frames of these, with their arms rotated by
/// finite rotations; nodes with rotations of their own are joined to the frame of their independent node by hinges,
/// ball joints or universal joints, and nodes of rigid pieces (edges that joints clamp) to that of the piece's first
/// node by fixed joints.
///
/// Mass is carried rigidly by the nodes: of a beam half its mass by each, at the Gauss points of two-point quadrature,
/// with the rotary inertia of the section; of a triangle a third by each corner, with a third of
/// its remaining second moments. So the kinetic energy is one of rigid bodies, exact for rigid motions of the
/// undeformed body, of order 2 in the element's length for others; linear and angular momentum of the nodes are those
/// of the body, and nothing but the loads changes them.
class CorotationalBody {
 public:
  /// @param visited  global nodes that the last rank must see (NodeCoordinates)
  /// @param pieces   global nodes that follow none, disjoint; the same on all ranks
  /// @param everywhere  this rank sees what is visited, too
  /// Collective (in order with other blocks).
  CorotationalBody(dynamics::Coordinates& coordinates, const fem::Structure& structure, std::vector<PetscInt> visited,
                   const std::vector<std::vector<PetscInt>>& pieces, const CorotationalStart& start,
                   bool everywhere = false);

  const NodeCoordinates& nodes() const { return *nodes_; }
  /// Whether this rank sees the frame of the node.
  bool has_frame(PetscInt node) const { return attitude_.contains(node); }
  /// The place of a node with a frame that this rank sees; body axes.
  dynamics::SpatialMarker place(PetscInt node) const;
  /// The places of a cell's corners.
  std::vector<dynamics::SpatialMarker> places(const fem::Mesh::Cell& cell) const;
  /// A linear function of a node's rotation from one of its dofs 3 to 5, of which a node with rotations of its own has
  /// these.
  Eigen::Matrix3d of_rotation(PetscInt node, const Eigen::Matrix3d& of_dofs) const;
  /// Index of the piece of a node; -1: none.
  int piece_of(PetscInt node) const;
  /// A point of a rigid piece, body axes. On the last rank.
  dynamics::SpatialMarker place_on_piece(int piece, const Eigen::Vector3d& x) const;

  /// Elements, masses, hinges of lines, and the rows of dofs that stand for nothing. Each rank gets those of its own
  /// cells and nodes. Collective.
  /// @param viscosity  beta of Kelvin-Voigt damping [s]
  std::vector<std::unique_ptr<dynamics::Term>> terms(double viscosity) const;
  /// The mass that a node's frame carries, as far as this rank's cells bring it: constants in the frame's axes about x,
  /// the node undeformed in body axes.
  struct NodeMass {
    dynamics::SpatialMarker at;
    body::Inertia inertia;
    Eigen::Vector3d x;
  };
  std::vector<NodeMass> masses() const { return carried(Density::mass); }
  /// The element of a cell that is no point, or the i-th of a quadrilateral's four triangles; null: all its places have
  /// one frame. Rank-local.
  std::unique_ptr<dynamics::Term> spring(const fem::Mesh::Cell& cell, double viscosity) const;
  std::unique_ptr<CorotationalElement> element(const fem::Mesh::Cell& cell, std::size_t i, double viscosity) const;
  /// Elements and masses of some cells alone. Rank-local.
  std::vector<std::unique_ptr<dynamics::Term>> terms_of(CellsOfPart part, double viscosity) const;
  /// Force densities per mass, or per line and area, as a marker for each frame (SpatialMarker::mass).
  std::vector<dynamics::SpatialMarker> density(Density density, CellsOfPart part = nullptr) const;
  /// Of the frames that this rank sees.
  void add_attitudes(dynamics::Attitudes& attitudes) const;
  /// The start of this rank's own frames. @param global  Coordinates::global(), numbered
  void set_start(const std::vector<PetscInt>& global, Vec U, Vec V) const;

 private:
  struct Moving {
    Eigen::Vector3d R, rate, spin;
  };
  /// A node that another one's frame holds: wholly, or but for rotations (fem::Mesh::Spin).
  struct Link {
    PetscInt node, independent_node;
    Eigen::Vector3d arm, axis;
    bool others;
    bool spins() const { return others || !axis.isZero(0); }
    Eigen::Matrix3d own() const { return fem::Mesh::Spin{0, axis, others}.own(); }
    dynamics::SpatialConstraint constraint() const;
    int rows() const { return dynamics::rows(constraint()); }
  };
  std::vector<NodeMass> carried(Density density, CellsOfPart part = nullptr) const;
  void add_elements(double viscosity, std::vector<std::unique_ptr<dynamics::Term>>& terms,
                    CellsOfPart part = nullptr) const;
  void add_links(std::vector<std::unique_ptr<dynamics::Term>>& terms) const;
  void add_idle(std::vector<std::unique_ptr<dynamics::Term>>& terms) const;
  void find_links(const std::vector<std::vector<PetscInt>>& pieces);
  void start(const CorotationalStart& start);

  const fem::Structure& structure_;
  std::unique_ptr<NodeCoordinates> nodes_;
  std::vector<Link> links_;                                             // of all ranks
  int link_multipliers_ = 0;                                            // local index of the first
  std::vector<std::pair<PetscInt, Eigen::Vector3d>> independent_node_;  // of each piece, and where it is
  std::map<PetscInt, int> piece_;                                       // of nodes
  std::map<PetscInt, std::shared_ptr<dynamics::Attitude>> attitude_;    // of the nodes seen that have a frame
  std::map<PetscInt, Moving> start_;                                    // of owned ones
  bool owner_;
};

}  // namespace floe::reference
