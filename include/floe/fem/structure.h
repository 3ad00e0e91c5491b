#pragma once
#include <memory>
#include <variant>
#include <vector>

#include "floe/fem/beam_releases.h"
#include "floe/fem/mesh.h"
#include "floe/fem/node_spring.h"
#include "floe/fem/planar_beam.h"
#include "floe/fem/shell_section.h"
#include "floe/fem/spatial_beam.h"

namespace floe::fem {

/// Moves values between a distributed field (a few dofs a node) and this rank's local copy with foreign nodes.
class Exchange {
 public:
  Exchange() = default;
  Exchange(const Mesh& mesh, int dofs_per_node);
  /// Collective.
  Eigen::VectorXd gather(Vec field) const;
  /// field += local contributions of all ranks. Collective.
  void add(const Eigen::VectorXd& local, Vec field) const { add(local.data(), field); }
  /// The same on bare arrays of this rank's local dofs.
  void gather(Vec field, double* local) const;
  void add(const double* local, Vec field) const;

 private:
  petsc::ScatterHandle scatter_;
  petsc::VecHandle local_;
};

/// A spatial beam's section, and a vector in body axes that rotates it (BeamPlace).
struct SpatialBeam {
  SpatialBeamSection section;
  Eigen::Vector3d orientation = Eigen::Vector3d::Zero();
  SpatialBeamStrain strain;
  BeamReleases releases = {};  ///< of elements of two nodes
  std::bitset<2> alone = {};   ///< ends of a rod at nodes that rods alone hold
};

/// A rigid mass at a node, in body axes.
struct PointMass {
  double mass;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about its centre
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();   ///< of its centre from the node
};

/// What a part of the mesh is made of: planar or spatial lines, triangles and quadrilaterals, points, springs.
using Section = std::variant<BeamSection, SpatialBeam, ShellSection, PointMass, NodeSpring>;

/// The same section in the axes of a frame, v -> R'v.
Section rotated(const Section& section, const Eigen::Matrix3d& rotation);

/// Which nodes share elements with which, by global numbers, for the rows of this rank: the pattern of K and M.
struct NodeGraph;

/// What is made once, when it is first asked for: the mass matrix without conditions, the plane of a flat body.
struct Kept;

/// Many fields side by side: a row for each local dof, foreign nodes included, a column for each field.
using FieldRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A body's finite elements: assembles and never solves. Dofs are numbered by node: in the plane (u, v, rotation), in
/// space (u, v, w, rotation vector), body axes.
struct Structure {
  Mesh mesh;
  std::vector<Section> sections;  ///< of each part
  MembraneStrain strain = MembraneStrain::averaged;
  int dofs_per_node = 3;
  Exchange exchange;
  std::shared_ptr<const NodeGraph> graph;
  std::shared_ptr<Kept> kept;

  /// Dofs by the mesh's dimension. @throws InputError  a section that its element cannot have. Collective.
  Structure(Mesh mesh, std::vector<Section> sections, MembraneStrain strain);

  int dimension() const { return mesh.dimension; }
  PetscInt dofs() const { return dofs_per_node * mesh.node_count; }
  PetscInt owned_dofs() const { return dofs_per_node * mesh.owned_nodes; }
  Eigen::Index local_dofs() const { return dofs_per_node * static_cast<Eigen::Index>(mesh.positions.size()); }
  /// Rigid motions that the body has: 3 in the plane, 6 in space.
  int rigid_motion_count() const { return dimension() == 2 ? 3 : 6; }
  /// Local dof numbers of an element.
  std::vector<int> cell_dofs(const Mesh::Cell& cell) const;
  PetscInt global_dof(int local) const {
    return dofs_per_node * mesh.global_node(local / dofs_per_node) + local % dofs_per_node;
  }
  /// The same by the numbering that does not depend on ranks.
  PetscInt original_dof(int local) const {
    return dofs_per_node * mesh.original_node(local / dofs_per_node) + local % dofs_per_node;
  }
  ElementMaps maps(const Mesh::Cell& cell) const;
  /// k K + m M of the element, without its maps where the element has a shorter way.
  Eigen::MatrixXd matrix(const Mesh::Cell& cell, double k, double m) const;
  /// Samples of the element with unit density per length (lines) or area (surfaces); none of points.
  std::vector<body::MassPoint> line(const Mesh::Cell& cell) const;
};

/// Dofs of the element's corners from those of the nodes that it acts on, q_corners = T q_nodes.
Eigen::MatrixXd following(const Mesh& mesh, const Mesh::Cell& cell);

/// Displacement and rotation of an owned node, of a dependent node as its independent node moves it; zero entries of
/// dependent nodes in a field mean nothing. @param owned  this rank's part of a field. Rank-local.
Eigen::VectorXd nodal_motion(const Structure& structure, const double* owned, int node);

/// A planar frame of beams. Collective.
Structure planar_structure(Mesh mesh, const std::vector<BeamSection>& sections, MembraneStrain strain);

/// A zero field on the structure's dofs. Collective.
petsc::VecHandle field(const Structure& structure);

/// Diagonal of the box around the body: a length to compare rotations with displacements. Collective.
double extent(const Structure& structure);

/// Rigid motions, linearised: in the plane (1, 0, 0), (0, 1, 0), (-y, x, 1) at each node; in space three translations,
/// then rotations about x, y, z through the origin. Zero at nodes that follow others, but for rotations of their own.
/// Collective.
std::vector<petsc::VecHandle> rigid_motions(const Structure& structure);

}  // namespace floe::fem
