#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "floe/fem/section_points.h"
#include "floe/fem/structure.h"
#include "floe/math/formula.h"
#include "floe/output/reduced_file.h"

namespace floe::scene {

using Point = std::array<double, 3>;  ///< planar scenes leave the third at 0

/// Where in the file a value stands: every later complaint can name it.
struct Where {
  std::string file;
  int line = 0, column = 0;  ///< from 1
  std::string key;           ///< as `bodies.beam.section.A`
  std::string text() const;  ///< `scene.yaml:12:5: bodies.beam.section.A`
};

/// A node of a body, by name (start, end, middle, or a point pN of the polyline, N from 1; sets of a mesh in space;
/// those in the file of a reduced body) or by coordinates in the axes of the body's mesh; or a point of the ground
/// (world axes). Written `beam.end`, `{body: beam, node: [50, 0]}`, `ground`,
/// `{body: ground, node: [0, 3]}`. A ground without a point follows the other place of the joint as it is at the start.
struct Place {
  std::string body;
  std::string name;
  std::optional<Point> point;
  Where where;
  bool ground() const { return body == "ground"; }
};

/// A rectangular plate: elements[0] along its first edge, elements[1] across.
struct PlateSpec {
  Point origin{}, along{}, across{};
  std::array<int, 2> elements{};
  enum class Cells { triangles, quadrilaterals } cells = Cells::triangles;
};

/// A mesh file (.msh, .inp, .bdf, .nas, .dat).
struct MeshFileSpec {
  std::string path;
  std::vector<std::string> ignore;  ///< of a deck: types of elements that are left out
  std::string instance = {};        ///< of a deck with several
  double scale = 1;
  int refine = 0;  ///< how many times its elements are halved
};

/// The piece of a mesh that one of several frames carries, and its places on the cuts.
struct MeshPiece {
  int number = 0;                                       ///< of this piece, from 0
  std::shared_ptr<const std::vector<int>> of_elements;  ///< of each element of the whole mesh: the number of its piece
  std::vector<int> links;                               ///< of the whole mesh's rigid links, those that it keeps
  std::map<std::string, std::vector<long long>> cuts;   ///< by name: nodes of the whole mesh, ascending
};

/// Straight segments between points, each divided into elements of equal length; or a plate; or a file.
struct MeshSpec {
  std::optional<PlateSpec> plate;
  std::optional<MeshFileSpec> file;
  std::vector<Point> points;
  std::vector<std::array<int, 2>> segments;  ///< indices of points
  std::vector<int> elements;                 ///< of each segment
  Where where;
  std::shared_ptr<const MeshPiece> piece = {};  ///< only this piece of the mesh; null: all of it
};

/// Per unit length: axial and bending stiffness [N], [N m2], mass and rotary inertia [kg/m], [kg m].
struct Section {
  double EA = 0, EI = 0, rhoA = 0, rhoI = 0;
  std::optional<double> GA;  ///< absent: rigid in shear
  double E = 0;              ///< with material [N/m2]; 0: not known
  double fibre = 0;          ///< distance of the extreme fibres from the line of centroids [m]; 0: not known
  Where where;
};

/// What a part of a mesh in space is made of. The part "" stands for all that are not named.
struct PartSpec {
  std::string part;
  fem::Section section;
  Where where;
  fem::StressPoints points = {};
};

enum class Strain { averaged, pointwise };

/// Where the floating frame is attached, as the scene gives it.
struct FrameSpec {
  enum class Kind { pinned, clamped, mean_axis } kind = Kind::pinned;
  bool given = false;
  Place from, to;  ///< pinned: origin, and the place on the frame's x axis
  Place at;        ///< clamped
  Where where;
};

/// Which vibration modes, as the scene gives it.
struct ModesSpec {
  enum class Of { joints, frame } of = Of::joints;
  int count = 6;
  bool given = false;  ///< count, by the scene; else it is lowered to what the body has
  int alone = 0;       ///< how many in formulation vm; 0: as many as vm+md has columns
  Where where;
};

/// Which modal derivatives, as the scene gives it.
struct DerivativesSpec {
  enum class Choice { none, all, count, pairs } choice = Choice::all;
  int count = 0;                          ///< choice count: this many, first by maximum modal interaction
  std::vector<std::array<int, 2>> pairs;  ///< choice pairs: from 1, i <= j
  bool full = false;                      ///< METHOD: full (with inertia) instead of static
  Where where;
};

/// The reduced basis, as the scene gives it.
struct ReductionSpec {
  ModesSpec modes;
  DerivativesSpec derivatives;
  enum class Attachment { none, joints, loads, all } attachment = Attachment::joints;
  std::vector<Place> interface;  ///< Craig-Bampton: constrained by the modes, with an attachment mode for each dof
  /// Only these, of all columns that there are and their derivatives: `mode 1`, `derivative 1,2`; empty: as the rest
  /// says.
  std::vector<std::string> columns;
  Where columns_where;
  bool linear = false;  ///< elastic forces by the linear stiffness alone
  /// Share of the displacement that omitted products of coordinates in the elastic force may make up; absent, 0: none
  /// is omitted.
  std::optional<double> products;
  int responses = 0;  ///< static responses to residuals of a preliminary simulation, vm+md
  Where responses_where;
  /// Of several frames: degree of the polynomials that distribute forces and moments over the nodes of a cut.
  int interface_degree = 1;
  double drop_tolerance = 1e-7;
};

/// Damping of the elastic coordinates, as the scene gives it.
struct DampingSpec {
  double mass = 0;            ///< Rayleigh alpha [1/s]
  double stiffness = 0;       ///< Rayleigh beta [s]
  std::vector<double> modal;  ///< ratios of the first modes
  Where where;
};

/// Position, velocity and deformation at the start.
struct InitialSpec {
  Point position{};                                              ///< of the mesh's origin, world
  double angle = 0;                                              ///< of the mesh's axes [rad]; in the plane
  Point rotation{};                                              ///< likewise in space: a rotation vector, world
  Point velocity{};                                              ///< of the mesh's origin, world
  Point angular_velocity{};                                      ///< world; in the plane about z
  std::optional<std::array<math::Formula, 2>> deformation;       ///< (u, v)(x, y) in mesh axes
  std::optional<std::array<math::Formula, 2>> deformation_rate;  ///< likewise, 1/s
  /// The same in space: (u, v, w)(x, y, z) in mesh axes.
  std::optional<std::array<math::Formula, 3>> spatial_deformation, spatial_deformation_rate;
  Where where;
};

/// A body that was reduced before, from the file that `floe reduce` wrote.
struct ReducedSpec {
  std::string path;
  std::shared_ptr<const output::ReducedBodyFile> file;
  Where where;
};

/// A rigid body's mass, its centre in mesh axes, and the inertia tensor about that; in the plane about z alone.
struct RigidMass {
  double mass = 0;                  ///< [kg]
  Point centre{};                   ///< [m]
  std::array<double, 6> inertia{};  ///< J_xx, J_yy, J_zz, J_xy, J_xz, J_yz, with J_xy = -int rho x y [kg m2]
  bool has_mesh = false;            ///< of its own, to be shown; else one of a line at the centre stands for it
};

/// A rigid mass at a node, in mesh axes; space only.
struct MassSpec {
  std::string name;
  Place at;
  double mass = 0;                  ///< [kg]
  std::array<double, 6> inertia{};  ///< about its centre, as of RigidMass [kg m2]
  Point offset{};                   ///< of its centre from the node [m]
  Where where;
};

/// A structure by its mesh, or one that was reduced before; then only the name, `reduced` and the pose at the start
/// count.
struct Body {
  std::string name;
  std::string whole;  ///< of a piece that `frames` made (plan::split_frames): the name of the body in the scene
  int piece = 0;      ///< its number, from 1
  std::optional<ReducedSpec> reduced;
  MeshSpec mesh;
  Section section;              ///< in the plane
  std::vector<PartSpec> parts;  ///< in space
  std::vector<MassSpec> masses;
  Strain strain = Strain::averaged;
  std::optional<fem::Strains> strains;  ///< absent: as its elements have them by default
  bool rotary_inertia = true;
  bool rigid = false;
  std::optional<RigidMass> mass;  ///< rigid: instead of that of the mesh
  FrameSpec frame;
  int frames = 1;  ///< split into so many floating frames (plan::split_frames)
  ReductionSpec reduction;
  DampingSpec damping;
  InitialSpec initial;
  Where where;
};

/// Whether a body is flexible, with elements.
inline bool is_meshed(const Body& body) { return !body.rigid && !body.reduced; }
/// Whether some mode of the body is damped.
inline bool has_modal_damping(const Body& body) {
  return std::any_of(body.damping.modal.begin(), body.damping.modal.end(), [](double ratio) { return ratio > 0; });
}

}  // namespace floe::scene
