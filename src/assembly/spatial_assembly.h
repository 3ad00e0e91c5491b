#pragma once
#include <optional>
#include <span>

#include "connections.h"
#include "damping_axes.h"
#include "floe/assembly/reduce_bodies.h"
#include "floe/dynamics/sensor.h"
#include "floe/dynamics/spatial_joint.h"
#include "floe/plan/fixed_frames.h"
#include "floe/reference/corotational_body.h"
#include "floe/reference/mass_damping.h"
#include "floe/reference/spatial_full_order.h"
#include "full_order_modes.h"
#include "held_reactions.h"
#include "sections.h"
#include "state_loads.h"
#include "whole_modes.h"

namespace floe::assembly {

/// Turns planned bodies in space into coordinates, terms, joints and a state at the start.
///
/// A body whose frame is clamped to the ground has elastic coordinates only, without the dofs that are constrained to
/// the ground. Reduced systems are built on PETSC_COMM_SELF by every rank alike; full-order ones on the scene's
/// communicator, where the last rank holds what is shared.
class SpatialAssembly {
 public:
  /// @param reduced  one for each body: full for reduced formulations; rigid bodies and those from files else
  /// @param apart    elements of full-order bodies are not among the system's terms, but Model::elements
  SpatialAssembly(const Plan& plan, Formulation formulation, const std::vector<ReducedBody>& reduced,
                  bool apart = false);
  /// @throws InputError  joints whose places are apart, that contradict one another, or that a full-order formulation
  /// does not know. Collective.
  Model model();

 private:
  struct Slot {
    bool still = false;
    std::shared_ptr<dynamics::Attitude> attitude;        // none: stands still
    int frame = -1;                                      // local index of R, x; -1: stands still
    int elastic = -1;                                    // local index of reduced coordinates
    int multipliers = -1;                                // of the mean axes
    int released = -1;                                   // while its held dofs move: the first of these behind others
    int kept = 0;                                        // likewise of a reduced body: elastic coordinates before them
    std::optional<reference::MassDamping> damping = {};  // at full order
    std::optional<reference::ModalDamping> modal = {};   // likewise
    std::unique_ptr<reference::NodeCoordinates> nodes;
    std::unique_ptr<reference::CorotationalBody> corotated;  // formulation cfr: no frame, no nodes of the above
  };
  /// A joint with rows, or a spring, ready to become a term.
  struct PlacedJoint {
    std::array<dynamics::SpatialMarker, 2> places;
    dynamics::SpatialConstraint constraint;
  };

  void refuse() const;
  bool compact(int body) const;    // described by a ReducedBody
  bool corotated(int body) const;  // a CorotationalBody
  bool stands(int joint) const;    // it fixes a fixed-frame body to the ground: nothing is left to do
  const fem::Conditions& constrained(int body) const;
  int owner_of_frame(std::size_t body) const;  // itself, or the body whose frame it has
  std::vector<PetscInt> visited(int body) const;
  /// Of a deflection: the places that its frame follows from; none: it has a frame of its own.
  std::vector<Anchor> places_of_frame(std::size_t probe) const;
  std::vector<int> coordinates_of(int body) const;  // of a reduced body: frame, elastic
  reference::SpatialFrame frame_of(int body) const;

  std::vector<std::vector<PetscInt>> clamped_edges(int body) const;
  /// Of joints that constrain nodes of a corotational body one by one: supports, and clamps of edges until they are
  /// released. Which dofs, in the axes of the mesh, and the joints whose reaction they are, in equal parts: edges may
  /// have nodes in common, whose dofs are rows of one joint, of one that is not released if there is any.
  struct ConstrainedNode {
    PetscInt node;
    std::vector<int> dofs;
    std::vector<int> joints;
  };
  std::vector<ConstrainedNode> nodes_constrained_by(std::size_t joint, bool released) const;
  void find_constrained_nodes();
  std::vector<PlacedJoint> place_constrained_nodes(int joint);
  void add_corotated(int body);
  std::unique_ptr<dynamics::Term> corotated_pressure(const Load& load, int body,
                                                     const std::function<double(double)>& value,
                                                     const fem::Mesh::Cell& cell) const;

  void add_frame(int body);
  void add_coordinates();
  void add_body(int body);
  void add_damping_axes();
  void add_damping(const DampedWhole& whole, Model& model);
  /// Dampers of a body's masses. Returns these where they say how the axes of the damping move.
  std::vector<CarriedMass> add_masses(const DampedWhole& whole, int body);
  std::vector<ConstrainedPlace> constrained_places(const WholeAxes& whole, int body);
  /// Unknowns of axes, their multipliers and their attitude, the last of axes_attitudes_.
  void add_axes(WholeAxes& axes);
  /// Of corotational bodies: those that follow them as their floating frames would, and those of places of several
  /// nodes.
  void add_corotated_axes();
  std::vector<CarriedMass> corotated_masses(int body) const;
  AxesTerms rows_of_mean(const WholeAxes& mean, const Anchor& place) const;
  void start_corotated_axes(Model& model);
  void start_axes(int body, const WholeAxes& axes, AxesTerms rows, Model& model);
  void set_shared(int first, const Eigen::VectorXd& values, Vec into) const;
  struct MeanAxes {
    Anchor place;
    WholeAxes axes;
  };
  /// Of the same nodes with the same weights; null: none.
  const MeanAxes* find_mean(const Anchor& place) const;
  void add_gravity(int body, const BodyPart* part = nullptr);
  std::vector<std::unique_ptr<dynamics::Term>> density_terms(int body, reference::Density density,
                                                             const std::function<Eigen::Vector3d(double)>& force,
                                                             bool of_body, bool conservative, const BodyPart* part);
  void add_load(std::size_t load, const BodyPart* part = nullptr);
  std::vector<std::unique_ptr<dynamics::Term>> pressure_terms(const Load& load, int body,
                                                              const std::function<double(double)>& value,
                                                              const BodyPart* part);
  std::vector<std::shared_ptr<const dynamics::Term>> terms_of(int body, const BodyPart& part);
  std::vector<ModelSection> sections(std::size_t probe, Model& model);
  std::shared_ptr<const ShellPoint> shell_point(std::size_t probe) const;
  /// The terms of a load that is not on a joint, of which `value` gives the components, a pressure as the first.
  /// Collective.
  std::vector<std::unique_ptr<dynamics::Term>> load_terms(std::size_t load,
                                                          const std::function<Eigen::Vector3d(double)>& value,
                                                          const BodyPart* part);
  std::vector<std::unique_ptr<dynamics::Term>> load_terms(const Load& load, const LoadPart& part,
                                                          const std::function<Eigen::Vector3d(double)>& value);
  /// Loads on joints, those that depend on sensors, and probes that are formulas. After joints and probes.
  void add_state_loads(Model& model);
  std::vector<std::unique_ptr<dynamics::Sensor>> sensors(const math::Formula& formula, const Model& model) const;
  void refuse_loose_supports() const;
  void refuse_unsatisfied_edges() const;
  /// Gives probes of reactions what their joints exert on dofs that these hold without rows. Collective.
  void add_held_reactions(Model& model);
  /// Null: on none. Collective.
  std::shared_ptr<const HeldReaction> held_reaction(int joint);
  std::shared_ptr<const HeldReaction> reaction_of_nodes(int joint);
  void add_body_and_loads(int body, const BodyPart* part);
  void add_joints(Model& model);
  void connect(int joint, std::unique_ptr<dynamics::Connection> term);
  /// @param first  of its multipliers
  void add_joint(int joint, const PlacedJoint& placed, int first, const std::vector<int>& independent);
  int row_count(int joint) const;
  void count_uses();
  /// What couples the nodes of a cut (Interface), or the joint itself. Collective.
  std::vector<PlacedJoint> place_all(int joint);
  /// Of the pieces of place_all, whether no other row has the dofs of one of its nodes, so that its rows are
  /// independent.
  bool stands_apart(int joint, std::size_t piece) const;
  JointMultipliers multipliers_of(int joint) const;
  void add_spring(int joint, const PlacedJoint& placed);
  using Of = dynamics::RelativeCoordinate::Of;
  /// Of a joint, on its rank: since the start, but for a length.
  std::unique_ptr<dynamics::SpatialCoordinate> coordinate_of(int joint, Of of, const PlacedJoint& placed) const;
  /// And friction.
  void add_stops(int joint, const PlacedJoint& placed, std::vector<ModelStop>& stops);
  void add_probes(Model& model);
  /// A place with the axes that forces of a joint are given in. Collective.
  dynamics::SpatialMarker axes_of_joint(int joint);
  /// That of the whole of a split body, from places of its parts.
  SpatialFrameByPlaces whole_frame(const std::vector<Anchor>& places, const Anchor& probe);
  void set_deformation(int body, Vec shape, Vec into) const;
  void set_start(Model& model);

  dynamics::SpatialMarker marker(const Anchor& place);
  /// Places whose sum the mean of the place's nodes is, and the share of each in a moment. On the last rank.
  std::vector<std::pair<dynamics::SpatialMarker, double>> corotated_parts(const Anchor& place) const;
  /// Whether the place is, with formulation cfr, the mean of nodes that move by themselves. Collective.
  bool is_corotated_mean(const Anchor& place) const;
  dynamics::SpatialMarker density_marker(int body, const body::Inertia& inertia) const;
  /// Where a marker is at the start.
  dynamics::SpatialPose start_of(const dynamics::SpatialMarker& marker) const;
  PlacedJoint place(int joint, const std::array<Anchor, 2>& anchors);

  const Plan& plan_;
  Formulation formulation_;
  std::span<const ReducedBody> reduced_;  // held_reaction() puts others in their place for a moment
  bool owner_;                            // this rank has the shared terms
  bool sees_;                             // it sees what sensors look at
  bool apart_;
  dynamics::Coordinates coordinates_;
  std::vector<Slot> slots_;
  std::vector<DampedWhole> damped_;
  std::vector<WholeDamping> modal_wholes_;
  std::map<int, std::vector<ConstrainedNode>> constrained_nodes_;  // of joints
  std::map<int, WholeAxes> body_axes_;            // of corotational bodies, in the axes of their meshes
  std::vector<MeanAxes> means_;                   // of corotational bodies, in the axes of their frames
  dynamics::Attitudes axes_attitudes_;            // of all these
  std::vector<int> multipliers_;                  // of each joint, the first
  std::vector<PlacedJoint> placed_;               // every joint
  std::map<std::pair<int, PetscInt>, int> uses_;  // of a body's node, by rows of joints
  Eigen::VectorXd start_;                         // local coordinates at the start
  std::vector<std::unique_ptr<dynamics::Term>> terms_;
  std::vector<std::shared_ptr<const reference::SpatialElements>> elements_;  // that are apart
  std::vector<std::vector<const dynamics::Term*>> body_terms_;               // of each body, among terms_
  Connections connections_;                                                  // of the joints, among terms_
  std::multimap<std::size_t, const dynamics::Term*> load_terms_;             // of those at places, among terms_
  std::map<std::size_t, StateFormulas> state_formulas_;  // of loads that depend on sensors, but for those of joints
  std::vector<int> undetermined_;                        // joints whose multipliers are not determined
  std::map<std::string, JointSwitches> switches_;
};

/// Rows that the kind of joint holds in space; none: a spring or bushing.
int spatial_rows(Joint::Kind kind);

}  // namespace floe::assembly
