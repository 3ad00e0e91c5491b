#pragma once
#include <optional>

#include "connections.h"
#include "damping_axes.h"
#include "floe/assembly/reduce_bodies.h"
#include "floe/dynamics/sensor.h"
#include "floe/reference/full_order.h"
#include "floe/reference/mass_damping.h"
#include "full_order_modes.h"
#include "sections.h"
#include "state_loads.h"
#include "whole_modes.h"

namespace floe::assembly {

/// Turns planned bodies into coordinates, terms, joints and a state at the start.
///
/// Reduced systems are built on PETSC_COMM_SELF by every rank alike; full-order ones on the scene's communicator, where
/// the last rank holds what is shared.
class PlanarAssembly {
 public:
  /// @param reduced  one for each body: full for reduced formulations; rigid bodies only for full-order ones
  PlanarAssembly(const Plan& plan, Formulation formulation, const std::vector<ReducedBody>& reduced);
  /// Collective.
  Model model();

 private:
  struct Slot {
    int frame = -1;                                      // local index of (R_x, R_y, theta); -1: none (corotational)
    int elastic = -1;                                    // local index of reduced coordinates
    int multipliers = -1;                                // of the mean axes
    std::optional<reference::MassDamping> damping = {};  // at full order
    std::optional<reference::ModalDamping> modal = {};   // likewise
    std::unique_ptr<reference::NodeCoordinates> nodes;
  };
  bool compact(int body) const;  // described by a ReducedBody
  void add_coordinates();
  void add_body_terms(int body);
  void add_damping_axes();
  void add_damping(const DampedWhole& whole, Model& model);
  /// Dampers of a body's masses. Returns these where they say how the axes of the damping move.
  std::vector<CarriedMass> add_masses(const DampedWhole& whole, int body);
  /// In the body's frame.
  CarriedMass add_mass(const DampedWhole& whole, int body, const std::vector<int>& elastic,
                       const body::Inertia& inertia);
  CarriedMass add_element_mass(const DampedWhole& whole, int body, const fem::Mesh::Cell& cell);
  void add_corotational_mass(const DampedWhole& whole, int body, const fem::Mesh::Cell& cell);
  std::vector<ConstrainedPlace> constrained_places(const WholeAxes& whole, int body);
  std::vector<CarriedMass> corotational_masses(int body) const;
  void add_axes(WholeAxes& axes);
  /// Of corotational bodies: axes that follow them as their floating frames would.
  void add_body_axes();
  void start_body_axes(Model& model);
  dynamics::MovingAxes node_axes(int body, int first, const Eigen::Vector3d& x) const;
  void start_damping(const DampedWhole& whole, std::vector<std::unique_ptr<dynamics::AccompanyingAxes>>& rows,
                     Model& model);
  void set_shared(const std::vector<int>& local, const std::vector<double>& values, Vec into) const;
  void add_corotational(int body, const BodyPart* part = nullptr);
  void add_gravity(int body, const BodyPart* part = nullptr);
  void add_load(std::size_t load, const BodyPart* part = nullptr);
  std::vector<std::shared_ptr<const dynamics::Term>> terms_of(int body, const BodyPart& part);
  std::vector<ModelSection> sections(std::size_t probe, Model& model);
  /// The terms of a load that is not on a joint, of which `value` gives the force or the moment. Collective.
  std::vector<std::unique_ptr<dynamics::Term>> load_terms(std::size_t load,
                                                          const std::function<Eigen::Vector3d(double)>& value,
                                                          const BodyPart* part = nullptr);
  /// Loads on joints, those that depend on sensors, and probes that are formulas. After joints and probes.
  void add_state_loads(Model& model, const Eigen::VectorXd& q);
  std::vector<std::unique_ptr<dynamics::Sensor>> sensors(const math::Formula& formula, const Model& model,
                                                         const Eigen::VectorXd& q) const;
  void connect(std::size_t joint, std::unique_ptr<dynamics::Connection> term);
  void add_joints(Model& model, const Eigen::VectorXd& q);
  using Of = dynamics::RelativeCoordinate::Of;
  /// Of a joint, on its rank: since the start, but for a length.
  std::unique_ptr<dynamics::PlanarCoordinate> coordinate_of(std::size_t joint, Of of,
                                                            const std::array<dynamics::Marker, 2>& places,
                                                            const Eigen::VectorXd& q) const;
  void add_stops(std::size_t index, const std::array<dynamics::Marker, 2>& places, const Eigen::VectorXd& q,
                 std::vector<ModelStop>& stops);
  void add_joint(std::size_t index, const std::array<dynamics::Marker, 2>& places, const Eigen::VectorXd& q);
  Eigen::Vector2d in_mesh_axes(const Anchor& place) const;  // undeformed
  /// A place with the axes that forces of a joint are given in.
  dynamics::Marker axes_of_joint(std::size_t joint, const Eigen::VectorXd& q) const;
  void add_probes(Model& model, const Eigen::VectorXd& q);
  /// That which a deflection is measured from where its place has none of the whole body; none: it has.
  std::optional<FrameByPlaces> frame_of_deflection(std::size_t probe);
  void set_start(Model& model);
  void set_full_order_start(int body, Vec U, Vec V);
  dynamics::Marker marker(const Anchor& place);
  dynamics::Marker with_mesh_axes(const Anchor& place);  // axes of the mesh, rotated with the section
  dynamics::Marker density(int body, const body::Inertia& inertia);
  Eigen::Vector3d pose_at(const dynamics::Marker& marker, const Eigen::VectorXd& q) const;

  const Plan& plan_;
  Formulation formulation_;
  const std::vector<ReducedBody>& reduced_;
  bool owner_;  // this rank has the shared terms
  bool sees_;   // it sees what sensors look at
  dynamics::Coordinates coordinates_;
  std::vector<Slot> slots_;
  std::vector<DampedWhole> damped_;
  std::vector<WholeDamping> modal_wholes_;
  std::map<int, WholeAxes> body_axes_;  // of corotational bodies, in the axes of their meshes
  std::vector<int> joint_multipliers_;
  std::vector<std::vector<int>> joint_rows_;  // that stand, of each joint
  std::vector<std::array<dynamics::Marker, 2>> joint_places_;
  std::vector<std::unique_ptr<dynamics::Term>> terms_;
  std::vector<std::vector<const dynamics::Term*>> body_terms_;    // of each body, among terms_
  Connections connections_;                                       // of the joints, among terms_
  std::multimap<std::size_t, const dynamics::Term*> load_terms_;  // of those at places, among terms_
  std::map<std::size_t, StateFormulas> state_formulas_;  // of loads that depend on sensors, but for those of joints
  std::vector<int> undetermined_;                        // joints whose multipliers are not determined
  std::vector<std::string> notes_;                       // of joints that lose redundant rows
  std::map<std::string, JointSwitches> switches_;
};

/// World position of a point of a corotational body, undeformed at the start. @param x  in the frame's axes
Eigen::Vector2d undeformed_place(const PlannedBody& body, const Eigen::Vector3d& x);

}  // namespace floe::assembly
