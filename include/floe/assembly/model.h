#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "floe/assembly/frame_by_places.h"
#include "floe/dynamics/connection.h"
#include "floe/dynamics/cut.h"
#include "floe/dynamics/event.h"
#include "floe/dynamics/joints.h"
#include "floe/dynamics/spatial_marker.h"
#include "floe/dynamics/stop.h"
#include "floe/dynamics/system.h"
#include "floe/plan/prepare.h"
#include "floe/reduction/reduce.h"
#include "floe/scene/formulation.h"

namespace floe::plan {
struct BodyMesh;
}
namespace floe::dynamics {
class StateFormula;
}
namespace floe::reference {
class SpatialElements;
}

namespace floe::assembly {
using namespace plan;
using namespace scene;

/// What came out of the reduction of one body, for the user's eyes and for redrawing.
struct BodyReport {
  std::string name;
  std::string whole = {};         ///< the body of the scene that it is, or is a piece of (`frames`)
  std::string file = {};          ///< of a body that was reduced before
  std::string reduction_of = {};  ///< the body whose reduction it has (shared_reduction.h)
  int file_version = 0;           ///< of its format
  bool file_has_shells = false;
  PetscInt dofs = 0, nodes = 0, elements = 0;
  bool rigid = false;
  std::string frame = {};                 ///< pinned, clamped, mean-axis, or of another body; set by body_sizes
  std::string strains = {};               ///< of a flexible body with a mesh: which, and of a default why
  std::vector<std::string> notices = {};  ///< of its mesh: what was left out, what may be meant
  int dimension = 2;
  int columns = 0;
  int products = 0, omitted_products = 0;  ///< of coordinates in the elastic force
  std::vector<double> omega, residual;
  std::vector<double> damped = {};            ///< frequencies of modes_for_damping(); empty: the same modes
  int left_out = 0;                           ///< reduction::Modes::left_out
  int free_motions = 0;                       ///< rigid motions that the conditions of the modes leave free
  std::vector<double> intra_deflection = {};  ///< of each mode of a body in space: fem::intra_deflections
  std::vector<reduction::ColumnOrigin> origins;
  double seconds_modes = 0, seconds_derivatives = 0, seconds_projection = 0;
  int first_coordinate = 0;                                 ///< local index of the frame's R_x; -1: it stands still
  std::shared_ptr<const dynamics::Attitude> attitude = {};  ///< in space, of a frame that moves
  int first_elastic = 0;                                    ///< local index of the first elastic coordinate
  std::shared_ptr<reduction::Basis> basis;
  PetscInt first_node = 0;                    ///< of this rank
  int first_dof = -1;                         ///< full order: local index of the first of this rank's own dofs
  std::vector<double> positions;              ///< of this rank's own nodes, x y (z), in the frame
  std::shared_ptr<const BodyMesh> mesh = {};  ///< body_mesh.h; null: of a body from a file
  std::shared_ptr<const fem::Structure> structure = {};  ///< null: rigid, from a file, or moved by a copy of the model
  bool shapes_in_file = false;                           ///< whether that file has its mesh and the basis on it
  Eigen::Vector3d place = Eigen::Vector3d::Zero();       ///< of the frame at the start, world
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();    ///< of the frame at the start, as columns in world axes
};

/// A place of a body in space. Its axes at the start are those of the world.
struct SpatialProbe {
  dynamics::SpatialMarker marker;
  std::optional<dynamics::SpatialMarker> relative_to;
  Eigen::Vector3d start = Eigen::Vector3d::Zero();  ///< position; relative to the other place, if there is one
  Eigen::Matrix3d mesh =
      Eigen::Matrix3d::Identity();  ///< deflections are given in the axes of the mesh: these by frame axes
  std::optional<SpatialFrameByPlaces> frame = {};     ///< deflection of split bodies
  std::optional<dynamics::SpatialMarker> other = {};  ///< drive, power: the first place of the joint, marker its second
  /// Deflection of a corotational body from axes that accompany it, which are `relative_to`: the place undeformed.
  std::optional<Eigen::Vector3d> undeformed = {};
};

/// The free or driven coordinate of a joint, along which its drive acts.
struct DrivenCoordinate {
  bool rotation = false;                            ///< about the axis, not along it
  bool length = false;                              ///< along the line of both places
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< at the start, world; rotates with the first place
};

/// A section through a beam, by the part of the body on one of its sides.
struct ModelSection {
  dynamics::Cut cut;
  double factor =
      1;            ///< of what it exerts on the part, in the mean of both sides: -1 or -1/2 of one beyond the section
  int origin = -1;  ///< of moments: local index of R on the last rank; -1: the place itself
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< x, y, z of the undeformed section in the body's axes
};

/// What a shell's stresses follow from (shell_stress.h).
struct ShellPoint;

/// What a joint exerts on nodes of a body that it holds without constraint rows (held_reactions.h).
struct HeldReaction;

/// A probe of a planar scene, by the markers that it looks at.
struct ModelProbe {
  std::string name;
  Probe::Quantity quantity;
  dynamics::Marker marker;
  std::optional<dynamics::Marker> relative_to;
  Eigen::Vector3d start, start_relative;
  std::optional<SpatialProbe> spatial = {};  ///< in space; the rest stands for the plane
  /// Of a joint: its terms, which are the system's; on its last rank.
  std::vector<const dynamics::Connection*> connections = {};
  std::shared_ptr<const dynamics::StateFormula> formula = {};  ///< of quantity formula, on the system's last rank
  std::string unit = {};                                       ///< likewise
  std::vector<ModelSection> sections = {};                     ///< of a section: one, or both sides
  std::shared_ptr<const ShellPoint> shell = {};                ///< of a shell
  std::optional<FrameByPlaces> frame = {};                     ///< deflection of corotational and split bodies
  std::optional<Eigen::Vector2d> undeformed = {};              ///< as of SpatialProbe
  std::optional<dynamics::Marker> other = {};                  ///< drive, power: the first place of the joint
  DrivenCoordinate drive = {};                                 ///< likewise
  std::vector<const dynamics::Term*> terms = {};  ///< of a body's energy: this rank's, which are the system's
  std::shared_ptr<const HeldReaction> held = {};  ///< of a joint that holds dofs; null: none
};

/// One side of a joint's limits.
struct ModelStop {
  std::string joint;
  bool upper = false;
  const dynamics::Stop* term = nullptr;  ///< of the system; on its last rank
};

/// The multipliers of a joint: local index of the first, and which rows of its constraint they belong to.
struct JointMultipliers {
  int first = 0;
  std::vector<int> rows;
  /// Of a cut through a body in a reduced model: rows of the full-order model x own rows, multipliers at the nodes by
  /// those of the interface vectors; empty: the same rows.
  Eigen::MatrixXd at_nodes = {};
};

/// A joint, for pictures: its kind and its two places.
struct JointPlaces {
  std::string name, kind;
  struct End {
    int body = -1;  ///< index of Model::bodies; -1: ground
    Eigen::Vector3d
        x;  ///< in the axes of its frame; of the ground in the world, not a number where it follows the other
  };
  std::array<End, 2> ends;
};

/// What a reduced model was made from: its meshes, bases and factors.
struct Offline;

/// What events change of a joint.
struct JointSwitches {
  std::shared_ptr<dynamics::ConstraintSwitch> joint = {};  ///< its own rows; none: no event unlocks it
  std::shared_ptr<dynamics::ConstraintSwitch> lock = {};   ///< the rows that it leaves free; none: no event locks it
  int first_row = 0, rows = 0;                             ///< local indices of the multipliers of the lock
};

/// A scene in one formulation, ready to move.
struct Model {
  Formulation formulation;
  std::unique_ptr<dynamics::System> system;
  petsc::VecHandle U, V;  ///< at the start, consistent with the joints
  std::vector<ModelProbe> probes;
  std::vector<BodyReport> bodies;
  std::vector<ModelStop> stops;
  std::vector<std::string> warnings;
  std::string stretched_start = {};               ///< the one of them about initial deformations; empty: none
  std::map<std::string, JointSwitches> switches;  ///< of the joints that events name
  PetscInt coordinates = 0, multipliers = 0;
  double extent = 1;               ///< a length of the scene [m]
  double force = 0;                ///< a force of the scene [N]; 0: none is known
  double velocity_correction = 0;  ///< relative change that made the velocities at the start fit the joints
  std::vector<JointMultipliers> joints;
  std::vector<JointPlaces> joint_places = {};
  std::shared_ptr<Offline> offline = {};  ///< if it was to be kept
  /// Of full-order bodies in space whose elements are not among the system's terms (residual_loads.h).
  std::vector<std::shared_ptr<const reference::SpatialElements>> elements = {};
};

/// Full-order formulations live on `comm`; reduced ones are assembled and reduced on `comm` and then live on every rank
/// by itself. @throws InputError (also where a full-order formulation meets a body without mesh), RunError. Collective.
/// @param keep_offline  of reduced models: with the factors of K, for the estimate of their error (estimate.h)
Model build(const Scene& scene, Formulation formulation, MPI_Comm comm, bool keep_offline = false);

/// The scene's events for a motion of the model until `end`, then the hits and releases of its stops; the model must
/// outlive them. Those whose formula of t does not change sign until then never happen. @throws InputError  a probe
/// that the model does not have
std::vector<dynamics::Event> events_of(const Scene& scene, const Model& model, double end);
/// Where drives and loads are not smooth in time, until `end` (dynamics::Kink). @throws InputError  an angle or
/// position that jumps
std::vector<dynamics::Kink> kinks_of(const Scene& scene, double end);
/// No constraint switch, one, or two for each joint that events name.
std::map<std::string, JointSwitches> switches_of(const Scene& scene);

/// Dofs, nodes, elements and frames of the bodies as their meshes have them; nothing is assembled. Collective.
std::vector<BodyReport> body_sizes(const Scene& scene, MPI_Comm comm);

/// Vibration modes of every flexible body as its reduction asks for them. Collective.
std::vector<BodyReport> body_modes(const Scene& scene, MPI_Comm comm);

/// The same, and their shapes into an XDMF file over an HDF5 file (output/shape_file.h): modes, attachment columns and
/// derivatives of every body with a mesh, in its axes, undeformed positions as the mesh has them.
/// @throws InputError  as output::check_shapes_path; no body with a mesh. Collective.
std::vector<BodyReport> write_modes(const Scene& scene, MPI_Comm comm, const std::filesystem::path& path,
                                    bool overwrite);

/// Stiffness and mass matrix of every flexible body with a mesh, full order, under the conditions that its modes have:
/// NAME-K.mtx and NAME-M.mtx (output/matrix_market.h) without the rows that are constrained, NAME-rows.txt with what
/// each row is.
/// @return  the bodies' names
/// @throws InputError  as output::prepare_folder; no body with a mesh. Collective; rank 0 takes a whole matrix.
std::vector<std::string> write_matrices(const Scene& scene, MPI_Comm comm, const std::filesystem::path& folder,
                                        bool overwrite);

/// Columns of the probes: `tip.x` with unit.
struct ProbeColumn {
  std::string name, unit;
  /// Beside which its values are small or not: the scene's extent [m], 1 rad, a force of the scene [N].
  double scale = 1;
  enum class Kind { place, rate, acceleration, load, stress, strain, energy, formula } kind = Kind::place;
};
std::vector<ProbeColumn> probe_columns(const Model& model);
/// How far each of model.stops is from being hit [rad], [m]; negative: hit, by this depth. For events. Collective.
std::vector<double> stop_gaps(const Model& model, double t, Vec U);
/// One of them, and its rate. Collective.
std::array<double, 2> stop_gap(const Model& model, std::size_t stop, double t, Vec U, Vec V);
/// How many bodies have a frame that moves in space.
int moving_frames(const Model& model);
/// Their attitudes at an instant, unit quaternions (w, x, y, z), w >= 0. Collective.
std::vector<double> attitudes(const Model& model, Vec U);
/// Values at an instant, the same on all ranks of the system. Collective.
/// @param A  accelerations, which forces in bodies and accelerations of places need; null: those that are consistent
/// with U and V (one factorisation
///           where a probe needs them)
std::vector<double> probe_values(const Model& model, double t, Vec U, Vec V, Vec A = nullptr);

}  // namespace floe::assembly
