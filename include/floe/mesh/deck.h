#pragma once
#include <petscsys.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

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
  int axis = 0;  // 1, 2, 3; 0: not turned
  double angle = 0;
};

/// A layer of COMPOSITE.
struct Ply {
  double thickness = 0;
  std::string material;
  std::string orientation;  // "" where none is named
  double angle = 0;         // degrees, against the section's orientation
};

/// *SHELL SECTION of a part: one ply, or those of COMPOSITE from the bottom up.
struct ShellSection {
  std::string part;
  std::string orientation;  // of the section; "" where none is named
  double offset = 0;        // of the nodes from the mid-surface along the normal, in thicknesses
  std::vector<Ply> plies;
};

/// Dimensions: a b | radius | outer radius, wall | a b t1 t2 t3 t4 | l h b1 b2 t1 t2 t3 | A I11 I12 I22 J.
enum class Profile { rectangle, circle, pipe, box, i_section, general };

/// *BEAM SECTION or *BEAM GENERAL SECTION of a part.
struct BeamSection {
  std::string part;
  std::string material;  // "" where the section has its own constants
  Profile profile = Profile::rectangle;
  std::vector<double> dimensions;
  Eigen::Vector3d direction_1{0, 0, -1};  // local 1-axis of the section, roughly
  double offset_1 = 0, offset_2 = 0;      // of the nodes from the centre, in thicknesses
  double youngs = 0, shear = 0;           // where `material` is ""
  std::optional<double> density;          // likewise; none where the deck gives none
};

/// *MASS at a node.
struct PointMass {
  PetscInt node;
  double mass;
};

/// Nodes that move as one rigid body with a reference node, in all six directions.
struct RigidLink {
  PetscInt reference;           // same on all ranks
  std::vector<PetscInt> nodes;  // that this rank found (the union is the set)
};

/// What an input deck says about its mesh. Same on all ranks, but for `masses` (each is on one rank) and links' nodes.
struct Deck {
  std::vector<Material> materials;
  std::vector<Orientation> orientations;
  std::vector<ShellSection> shell_sections;
  std::vector<BeamSection> beam_sections;
  std::vector<PointMass> masses;
  std::vector<RigidLink> links;
};

}  // namespace floe::mesh
