#pragma once
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "floe/math/formula.h"
#include "floe/scene/body.h"

namespace floe::scene {

/// Stops of a free coordinate of a joint: penalty springs beyond two values of it.
struct LimitsSpec {
  double lower = -INFINITY, upper = INFINITY;  ///< since the start [rad], [m]
  double stiffness = 0, damping = 0;           ///< [N m/rad], [N/m]; [N m s/rad], [N s/m]
  std::optional<double> width;                 ///< over which the force sets in [rad], [m]
  Where where;
};

/// Friction of a free coordinate of a joint (dynamics::FrictionLaw).
struct FrictionSpec {
  double level = 0, viscosity = 0;  ///< [N m], [N]; [N m s/rad], [N s/m]
  double speed = 0;                 ///< within which the friction changes its sign [rad/s], [m/s]
  Where where;
};

/// What holds two places together, as the scene gives it.
struct Joint {
  /// In the plane: fixed to spring.
  enum class Kind {
    fixed,
    revolute,
    prismatic,
    driven,
    spring,
    cylindrical,
    spherical,
    universal,
    planar,
    distance,
    driven_slide,
    bushing,
    support
  } kind = Kind::fixed;
  std::string name;
  Place first, second;
  math::Formula angle;                 ///< driven: angle(second) - angle(first) less its value at the start, of t [rad]
  math::Formula position;              ///< driven_slide: likewise along the axis [m]
  std::optional<math::Formula> speed;  ///< driven, driven_slide: in their place their rate [rad/s], [m/s]
  std::optional<LimitsSpec> limits,
      rotation_limits;  ///< of the slide, or of the rotation where there is none; of the rotation beside a slide
  std::optional<FrictionSpec> friction, rotation_friction;  ///< likewise
  /// Of sliding, of a hinge, normal of a planar joint; world axes at the start, carried by the first place.
  Point axis{1, 0, 0};
  bool axis_given = false;
  /// How the joint holds a place of many nodes: as one rigid region, as a line hinge (hinge_lines), or by their mean.
  /// nodes: between the pieces of a split body, each node of one place to that of the other with the same rank.
  enum class Edges { rigid, mean, line, nodes } edges = Edges::rigid;
  bool edges_given = false;
  std::array<bool, 6> hold{};                               ///< support: x, y, z, rx, ry, rz of every node, mesh axes
  std::array<bool, 3> straight{};                           ///< support: x, y, z that are linear along the edge
  Point second_axis{};                                      ///< universal: carried by the second place
  double stiffness = 0;                                     ///< spring [N/m]
  double viscosity = 0;                                     ///< spring [N s/m]
  std::optional<double> length;                             ///< spring, unstretched; absent: the distance at the start
  double torsional_stiffness = 0, torsional_viscosity = 0;  ///< spring [N m/rad], [N m s/rad]
  double preload = 0;                                       ///< spring: tension at the start, instead of a length [N]
  double rest_angle = 0;  ///< spring: rotation since the start at which its moment vanishes [rad]
  /// Bushing, along and about the axes x, y, z of the first place as it is at the start (world axes).
  std::array<double, 3> translation{}, rotation{}, translation_viscosity{}, rotation_viscosity{};
  Where where;
};

/// A force, moment or pressure, as the scene gives it.
struct Load {
  enum class Kind { force, moment, distributed, pressure } kind = Kind::force;
  std::string name;
  Place at;                                            ///< force, moment
  std::string body;                                    ///< distributed: uniform along all its segments; pressure
  std::string part;                                    ///< pressure: on this part of its mesh; empty: on all shells
  math::Formula pressure;                              ///< of t, along the normal [N/m2]
  bool follower = true;                                ///< pressure: stays normal to the shells
  std::array<math::Formula, 3> force{0.0, 0.0, 0.0};   ///< of t [N], distributed [N/m], [N/m2]
  std::array<math::Formula, 3> moment{0.0, 0.0, 0.0};  ///< of t [N m]; in the plane about z
  std::string joint;  ///< force, moment: instead of `at`, between its places; `at` is then the one that a probe has
  math::Formula on_joint;  ///< on the joint's travel, length or angle: positive increases it [N], [N m]
  /// body: they follow the frame; place: they rotate with the place.
  enum class Axes { world, body, place } axes = Axes::world;
  /// force, moment in space: the whole, or per length of the edges or area of the shells of the place [N/m], [N/m2].
  enum class Per { whole, length, area } per = Per::whole;
  std::optional<math::Formula> shape;  ///< per length or area: factor, of x, y, z in mesh axes
  Where where;
  bool spread() const { return kind == Kind::distributed || kind == Kind::pressure; }  ///< on a body, not at a place
  /// Components of a force or moment, or `on_joint`.
  std::vector<const math::Formula*> formulas() const;
  /// Whether any of them depends on what sensors measure (sensors.h).
  bool has_sensors() const;
};

/// How long, and by what steps.
struct Motion {
  double end = 0;  ///< 0: the scene has no motion
  double step = 0;
  double spectral_radius = 0.8;
  std::optional<double> tolerance;  ///< adaptive step, relative
  int every = 1;                    ///< store each so many steps
  std::optional<double> output;     ///< instead: at multiples of this time, between steps by interpolation [s]
  /// From the bodies' initial states, from the static equilibrium under loads and drives at t = 0, or from the steady
  /// rotation about the hub.
  enum class Start { given, equilibrium, steady_rotation } start = Start::given;
  Where where;
};

/// What is recorded at a place, of a joint or of a body.
struct Probe {
  std::string name;
  Place at;           ///< of a joint: its second place, or the first where the second is the ground
  std::string joint;  ///< instead of a place: what this joint exerts on its second place, or its power
  std::string body;   ///< instead: whose energy it is
  enum class Quantity {
    position,
    displacement,
    deflection,
    velocity,
    rotation,
    angular_velocity,
    acceleration,
    angular_acceleration,
    force,
    moment,
    drive,
    power,
    kinetic_energy,
    strain_energy,
    formula,
    section_force,
    section_moment,
    stress,
    principal_stress,
    von_mises_stress,
    strain,
    membrane_force,
    bending_moment,
  } quantity = Quantity::displacement;
  math::Formula formula;             ///< quantity formula, which has no place: of t and of sensors (sensors.h)
  std::string unit;                  ///< likewise
  std::optional<Place> relative_to;  ///< measured from this place, in axes that rotate with it
  bool joint_axes = false;           ///< force, moment: in the axes of the joint
  std::optional<Place> toward;       ///< sections and shells: just beside the place, on the element that leads there
  enum class Surface { middle, top, bottom } surface = Surface::middle;  ///< of a shell or its layer
  int layer = 0;              ///< of a shell, from 1, the lowest; 0: the whole, for stresses of one material
  std::optional<Point> axis;  ///< of shells: the first axis of components, projected on the surface; mesh axes
  /// Of a deflection in a split body: places that define the frame of the whole: both ends (pinned), one (clamped), or
  /// one of each part (mean axes).
  std::vector<Place> frame;
  Where where;

  bool of_section() const { return quantity == Quantity::section_force || quantity == Quantity::section_moment; }
  bool of_stress() const { return quantity >= Quantity::stress && quantity <= Quantity::strain; }
  bool of_shell() const { return quantity >= Quantity::stress; }
  bool of_joint() const { return quantity >= Quantity::force && quantity <= Quantity::power; }
  bool of_body() const { return quantity == Quantity::kinetic_energy || quantity == Quantity::strain_energy; }
  bool of_acceleration() const {
    return quantity == Quantity::acceleration || quantity == Quantity::angular_acceleration;
  }
};

/// Something that happens once: a joint lets go or is locked where it is, or the motion ends.
struct Event {
  enum class Kind { unlock, lock, stop } kind = Kind::stop;
  std::string name;
  std::string joint;                  ///< of unlock, lock
  std::optional<double> at;           ///< [s]
  std::optional<math::Formula> when;  ///< instead: where this formula of t first changes sign
  std::string probe;                  ///< instead: where this column (`tip.y`) passes `crosses`
  double crosses = 0;                 ///< in the unit of the column
  Where where;
};

/// A required maximum of the relative errors of the probes, for which floe chooses the model.
struct Accuracy {
  double share = 0;
  bool total = true;  ///< of the total error; false: of reduction and step
};

/// A scene: plain data, checked, all numbers finite. Nothing is built yet.
struct Scene {
  std::string file;
  int dimension = 2;  ///< 3 as soon as a mesh has three coordinates or comes from a file, or a reduced body is in space
  std::string title;
  std::string text;                 ///< the file as read
  std::vector<std::string> tables;  ///< files of tables among its functions
  std::map<std::string, double> parameters;
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<Load> loads;
  std::array<math::Formula, 3> gravity{0.0, 0.0, 0.0};  ///< of t [m/s2]
  std::array<math::Formula, 3> ground_acceleration{0.0, 0.0,
                                                   0.0};  ///< of t [m/s2]: axes of the world go with the ground
  bool share_frames = true;  ///< in space: bodies that are fixed to a rigid one have its frame
  Motion motion;
  std::optional<Accuracy> accuracy;
  std::vector<Probe> probes;
  std::vector<Event> events;
  std::shared_ptr<const Scene> unsplit = {};  ///< of one whose bodies were split (plan::split_frames): as it was
};

/// Reads and checks a scene. @throws InputError with a line per fault (file:line:column: key: what was expected,
/// nearest name).
Scene read_scene(const std::string& path);
/// The same from text; `name` stands for the file in messages.
Scene parse_scene(const std::string& text, const std::string& name);

/// From `0.01` or `1 %` (total), `reduction: 1 %`; above 0 and below 1. @throws InputError  anything else
Accuracy accuracy_of(const std::string& text);

/// The reference of the grammar, printed by `floe schema`: every key with type, unit, default, range, text.
std::string schema_reference();

}  // namespace floe::scene
