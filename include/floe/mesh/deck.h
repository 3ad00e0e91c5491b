#pragma once
#include <petscsys.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "floe/mesh/raw_mesh.h"

namespace floe::mesh {

enum class Elasticity { none, isotropic, engineering_constants, lamina };

/// *MATERIAL. Constants in the order of the deck: E, nu; or E1 E2 E3 nu12 nu13 nu23 G12 G13 G23; or E1 E2 nu12 G12 G13
/// G23.
struct Material {
  std::string name;
  Elasticity elasticity = Elasticity::none;
  std::vector<double> constants;
  double density = 0;  // 0 where the deck gives none
};

/// *ORIENTATION, SYSTEM=RECTANGULAR: x through a, b in the x-y plane; then rotated by `angle` degrees about local
/// `axis`.
struct Orientation {
  std::string name;
  Eigen::Vector3d a, b;
  int axis = 0;  // 1, 2, 3; 0: not rotated
  double angle = 0;
};

/// Its local axes as columns, rotated.
Eigen::Matrix3d axes_of(const Orientation& orientation);

/// A layer of COMPOSITE.
struct Ply {
  double thickness = 0;
  std::string material;
  std::string orientation;  // "" where none is named
  double angle = 0;         // degrees, against the section's orientation
};

/// *SHELL GENERAL SECTION by numbers: (N11, N22, N12, M11, M22, M12) from the strains and changes of curvature.
struct ShellStiffness {
  Eigen::Matrix<double, 6, 6> values;
  std::optional<double> density;  // mass per area; none where the deck gives none
};

/// PSHELL whose bending is not that of its one ply: D = factor T^3 / 12 Q of the material.
struct ShellBending {
  std::string material;
  double factor = 1;  // 12 I / T^3
};

/// *SHELL SECTION of a part: one ply, or those of COMPOSITE from the bottom up; or none, where it has its stiffness.
struct ShellSection {
  std::string part;
  int number = -1;  // of the part in RawMesh::parts, which may have several of one name: sections of the same set
  std::string orientation;  // of the section; "" where none is named
  double offset = 0;        // of the nodes from the mid-surface along the normal, in thicknesses
  std::vector<Ply> plies;
  std::optional<ShellStiffness> stiffness = {};
  std::optional<ShellBending> bending = {};
  double shear = 0;       // transverse, of elements of second order; 0: as of a homogeneous shell
  double added_mass = 0;  // per area, besides that of the plies, over which it is spread
  // Of elements whose thickness varies: the mean of t^3 over the third power of the mean t, and the greatest t by the
  // mean.
  double taper = 1, thickest = 1;
};

/// Dimensions: a b | radius, or half axes | outer radius, wall | a b t1 t2 t3 t4 | l h b1 b2 t1 t2 t3 | A I11 I12 I22
/// J.
enum class Profile { rectangle, circle, pipe, box, i_section, general };

/// *BEAM SECTION or *BEAM GENERAL SECTION of a part.
struct BeamSection {
  std::string part;
  int number = -1;       // as of ShellSection
  std::string material;  // "" where the section has its own constants
  Profile profile = Profile::rectangle;
  std::vector<double> dimensions;
  Eigen::Vector3d direction_1{0, 0, -1};  // local 1-axis of the section, roughly
  double offset_1 = 0, offset_2 = 0;      // of the nodes from the centre, in thicknesses
  bool quarter_turn = false;              // the dimensions' directions 1 and 2 are those of -2 and 1
  std::array<double, 2> shear_factors{};  // A_s / A for forces along 1 and 2; 0: no shear deformation
  double youngs = 0, shear = 0;           // where `material` is ""
  std::optional<double> density;          // likewise; none where the deck gives none
  unsigned releases = 0;                  // bits: dofs of the ends without force, as fem::BeamReleases
  unsigned alone = 0;                     // bits: ends of a rod at nodes that rods alone hold
  std::vector<Eigen::Vector2d> fibres;    // of Profile::general, along 1 and 2 from the centre; empty: not known
  double torsion_modulus = 0;             // likewise, fem::SectionShape::W
  /// Along 1 and 2 from the line between the nodes, where that is the line of shear centres; else shear centre and
  /// centre of the area are one.
  std::optional<Eigen::Vector2d> centroid = {};
};

/// What a spring between two nodes measures where these rotate (fem::NodeSpring).
enum class SpringKind {
  bushing,  ///< motions along and about axes that rotate with the first node
  line,     ///< its length
  linear    ///< small motions along and about axes that stand still
};

/// A linear spring between two nodes, about the point that divides the way from the first to the second.
struct NodeSpring {
  std::array<PetscInt, 2> nodes;
  std::array<double, 6> stiffness;
  Eigen::Matrix3d axes;  // columns
  double at = 0.5;
  long long label = 0;
  SpringKind kind = SpringKind::bushing;
};

/// *MASS at a node.
struct PointMass {
  PetscInt node;
  double mass;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();   // of its centre from the node
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  // about its centre
};

/// What a scene says about the elements of a deck.
struct DeckRequest {
  std::vector<std::string> parts;   // element sets that the scene gives a section
  bool section = false;             // the scene has a section for all other elements
  std::vector<std::string> ignore;  // types of elements to leave out, with the nodes that only they use
  std::string instance = {};        // of a deck with several
};

/// Nodes that move as one rigid body with a reference node, in all six directions but for rotations of their own: about
/// the axis, or with `others` about all axes normal to it (about all, where it has none).
struct RigidLink {
  PetscInt reference;               // same on all ranks
  std::vector<PetscInt> nodes;      // that this rank found (the union is the set)
  std::array<double, 3> axis = {};  // unit vector; zero: none
  bool others = false;
};

/// What an input deck says about its mesh. Same on all ranks, but for `masses` and `springs` (each is on one rank) and
/// links' nodes.
struct Deck {
  std::vector<Material> materials;
  std::vector<Orientation> orientations;
  std::vector<ShellSection> shell_sections;
  std::vector<BeamSection> beam_sections;
  std::vector<PointMass> masses;
  std::vector<RigidLink> links;
  std::vector<NodeSpring> springs;
  bool nastran = false;  // of Nastran's cards, for messages
};

/// What a file with a deck holds.
struct DeckFile {
  RawMesh mesh;
  Deck deck;
  std::vector<std::string> notices;  // same on all ranks: what was left out
};

/// A mesh file and those that it includes, as far as they can be read, each once. Rank-local.
std::vector<std::string> files_of(const std::string& path);

}  // namespace floe::mesh
