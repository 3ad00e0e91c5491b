#pragma once
#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "floe/body/flexible_body.h"
#include "floe/fem/reference_frame.h"
#include "floe/fem/structure.h"
#include "floe/plan/whole_modes.h"
#include "floe/scene/formulation.h"
#include "floe/scene/scene.h"

namespace floe::reduction {
struct WeightedNode;
}

namespace floe::plan {
using namespace scene;

/// How a node moves a place in space: u += share u_node + arm theta_node + 1/2 theta_node x (theta_node x lead),
/// theta += rotation theta_node + turn u_node.
struct AveragingWeight {
  PetscInt node;  ///< global
  double share;
  Eigen::Matrix3d arm;
  Eigen::Matrix3d rotation;
  Eigen::Vector3d lead = Eigen::Vector3d::Zero();  ///< from it to those that follow it, times their shares
  double apart = 0;  ///< of moments besides `share`: those that nodes with rotations of their own take from the ones
                     ///< that they follow
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
};

/// A node that something acts on.
struct Anchor {
  int body = -1;  ///< index of Plan::bodies; -1: ground; elsewhere: a body that is not here
  PetscInt node = 0;
  Eigen::Vector3d x = Eigen::Vector3d::Zero();  ///< in the frame's axes; ground: world
  std::vector<PetscInt> nodes = {};             ///< in space, global: a place may be a set of nodes
  /// In space: what moves the mean of `nodes`, those that follow no other node and the independent nodes of those that
  /// do; `node` is the first of them.
  std::vector<AveragingWeight> averaging_weights = {};
  /// In space: weights of `nodes` in the place, of a load with a shape, a cut, or given by the mesh file; null: those
  /// of place_weights.
  std::shared_ptr<const std::vector<reduction::WeightedNode>> weights = {};
  std::vector<Eigen::Matrix3d> H = {};             ///< in space: of second order, body::PlaceMap::H
  bool line = false;                               ///< in space: a line hinge (fem::Mesh), led by `node`
  std::shared_ptr<const body::PlaceMap> map = {};  ///< of a body from a file, on all its coordinates; `node` names it

  static constexpr int elsewhere = -2;
  bool ground() const { return body == -1; }
  /// Nodes whose dofs move the place; in the plane its one node.
  std::vector<AveragingWeight> moved_by() const;
  bool moved_by(PetscInt other) const;
  /// In space: the nodes move as one node's point at an arm.
  bool rigid_arm() const;
  /// In space: a node that follows another one but for rotations of its own, so that the dofs of neither hold it.
  bool rotates_apart() const { return nodes.size() == 1 && averaging_weights.size() > 1; }
};

/// A body's finite elements in its frame, and where both stand. Made once for every formulation.
struct PlannedBody {
  Body spec;
  fem::Structure structure;  ///< positions in the axes of the floating frame; of a body from a file: none
  fem::ReferenceFrame frame;
  Eigen::Vector2d frame_origin;                            ///< in mesh axes
  double frame_angle = 0;                                  ///< of the frame in mesh axes
  std::array<Anchor, 2> frame_places;                      ///< pinned: a, b; clamped: a, a; mean-axis: none
  Eigen::Vector3d pose;                                    ///< of the frame at the start, world: (R_x, R_y, theta)
  Eigen::Vector3d velocity;                                ///< likewise
  petsc::VecHandle deformation, deformation_rate;          ///< at the start, in the frame; null if none
  fem::Conditions constrained;                             ///< dofs that joints to the ground hold
  std::vector<Anchor> interface = {};                      ///< that the modes hold (Craig-Bampton)
  mesh::NodeSets places = {};                              ///< in space: global nodes by name
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();        ///< in space: of the frame, in mesh axes
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();      ///< in space: of the frame, as columns in mesh axes
  std::vector<std::string> parts = {};                     ///< in space: names
  std::vector<fem::StressPoints> points = {};              ///< of each part
  std::vector<std::string> notices = {};                   ///< in space: of the mesh
  std::string strains = {};                                ///< in space: which, and of a default why
  Eigen::Matrix3d attitude = Eigen::Matrix3d::Identity();  ///< in space: axes of the frame at the start, world
  Eigen::Vector3d place = Eigen::Vector3d::Zero();         ///< in space: its origin, R, at the start
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();          ///< in space: R. at the start, world
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();          ///< in space: angular velocity at the start, frame axes
  /// In space: dofs that do not move in the frame: its conditions, those of all nodes of the place where it is clamped
  /// and the ground clamps the body, dependent nodes.
  fem::Conditions clamp = {};
  int parent = -1;                 ///< in space: the body whose frame it has (shared_frames); -1: its own
  int parent_joint = -1;           ///< the joint that makes it so
  double linear_start_energy = 0;  ///< 1/2 q'K q of the initial deformation as given, in mesh axes [J]
};

/// A place with the factor by which the density of a load acts there: a length or an area times the load's shape.
struct LoadPart {
  Anchor at;
  double size = 1;
};

/// The pairs of nodes that a cut through a body has on both of its sides (edges: nodes), and the interface vectors by
/// which reduced models couple them: displacements and rotations summed over the pairs with these factors. The first
/// ones are the weights of the mean; further ones the weights times polynomials of the undeformed place. Where there
/// are no further ones the mean rotates as the rigid motion nearest to the nodes (set_rotation), for nothing else holds
/// shells about their normals.
struct Interface {
  using Weights = std::shared_ptr<const std::vector<reduction::WeightedNode>>;
  std::vector<std::array<Anchor, 2>> pairs;
  Eigen::MatrixXd factors;       ///< pairs x vectors; columns but the first sum up to zero
  std::array<Weights, 2> means;  ///< of the first vector on each side
  /// Of flat shells, else zero: their normal, world; the joint's z, and its x is in their plane, across the cut.
  /// Rotations about the normal have neither mass nor much stiffness (drilling): only the first vector couples them. In
  /// place of those of the others, the last vectors, one degree higher, couple displacements across the cut.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Index across = 0;                                        ///< how many of the last vectors
  Eigen::Index whole() const { return factors.cols() - across; }  ///< vectors that couple all else
  int rows_of_higher() const { return normal.isZero(0) ? 6 : 5; }
  bool empty() const { return pairs.empty(); }
  /// Place `vector` of a side: the sum of its nodes' places.
  Anchor sum(int side, Eigen::Index vector) const;
};

/// Joints, loads and probes with their places found on the meshes.
struct Plan {
  const Scene& scene;
  MPI_Comm comm;
  std::vector<PlannedBody> bodies;
  std::vector<std::array<Anchor, 2>> joints;
  std::vector<Anchor> loads;                           ///< distributed ones: body only
  std::vector<std::array<Anchor, 2>> probes;           ///< second: relative_to, toward, or the ground
  double extent = 0;                                   ///< a length of the scene
  std::vector<std::vector<Anchor>> probe_frames = {};  ///< Probe::frame of each probe
  /// In space, of each joint: axes at the start in the world, z its axis, x the second axis of a universal one.
  std::vector<Eigen::Matrix3d> joint_axes = {};
  /// In space: whether the dofs that the modes hold do all that the joint does (to the ground only).
  std::vector<char> joint_constrained = {};
  std::map<std::size_t, std::vector<LoadPart>> load_parts = {};  ///< of loads per length or area
  std::vector<Interface> interfaces = {};    ///< in space, of each joint; of those without edges: nodes empty
  std::vector<WholeModes> whole_modes = {};  ///< of bodies in several frames that have modal damping
};

/// Where a force or moment acts: its place, or the parts of one per length or area.
std::vector<LoadPart> parts_of_load(const Plan& plan, std::size_t load);

/// The place that the joint holds in the frame of its body: by the ground, or by a rigid body whose frame it has; null
/// when the joint is between two frames.
const Anchor* constrained_place(const Plan& plan, std::size_t joint);

/// `pinned`, `clamped`, `mean-axis`.
std::string name_of(fem::ReferenceFrame::Kind kind);

/// Meshes, frames and places of a scene. Collective.
Plan prepare(const Scene& scene, MPI_Comm comm);

Eigen::Matrix2d rotation_matrix(double angle);

/// Where the system of a formulation lives: on every rank by itself, or on all together.
MPI_Comm comm_of(const Plan& plan, Formulation formulation);
/// Whether this rank holds what the ranks of a system share.
bool last_rank(MPI_Comm comm);

/// Each split body (frames: N) as bodies `name#i` that are clamped together: a single line as N lines of equal length,
/// another mesh in pieces (cut_mesh), whose joints have edges: nodes. @throws InputError  Collective.
Scene split_frames(const Scene& scene, MPI_Comm comm);

}  // namespace floe::plan
