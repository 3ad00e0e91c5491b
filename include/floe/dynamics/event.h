#pragma once
#include <petscvec.h>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace floe::dynamics {

/// Whether the rows of a joint hold; its term and the events that change it share it.
///
/// Rows that do not hold keep their multipliers at zero: the unknowns of a system never change in number.
struct ConstraintSwitch {
  bool closed = true;
};

/// What happens to a mechanism at an instant of its motion: where a step ends there, and the next one starts from
/// consistent accelerations and multipliers, order 2 is kept. It happens once, or (`gap`) again and again.
struct Event {
  std::string name;
  std::string what;  ///< `unlock joint clamp`
  double at = 0;     ///< [s]; of an event without `crosses`
  /// If given, it happens where this changes sign, located within the step by cubic interpolation (error O(h^4)).
  std::function<double(double t, Vec U, Vec V)> crosses = {};
  /// In place of `crosses`, of a stop: how far it is from being hit, and the rate of that. `what` happens whenever it
  /// becomes negative, `what_back` when it becomes positive again; nothing is changed there but that a step ends.
  std::function<std::array<double, 2>(double t, Vec U, Vec V)> gap = {};
  double width = 0;  ///< of a stop: over which its force sets in
  std::string what_back = {};
  std::shared_ptr<ConstraintSwitch> constraint_switch = {};  ///< that it changes, if any
  bool closes = false;                                       ///< the constraint switch; else it opens it
  int first_row = 0, rows = 0;  ///< local indices of the multipliers of the constraint switch that closes
  bool stops = false;           ///< the motion ends here

  bool repeats() const { return static_cast<bool>(gap); }
  /// Whether the motion decides when it happens.
  bool watched() const { return crosses || gap; }
};

/// An event that happened. Closing rows on places that move is an impact: velocities go to the nearest ones, in kinetic
/// energy, that the rows allow (perfectly plastic).
struct EventReport {
  std::string name, what;
  double t = 0;         ///< [s]
  double lost = 0;      ///< kinetic energy [J]
  double damped = 0;    ///< besides: by the damping of strains, within the step that follows [J]
  double released = 0;  ///< kinetic energy that strained bodies gain where it opens a joint (give_way) [J]
  std::vector<double> impulses = {};  ///< on the rows that were closed [N s], [N m s]
  std::optional<double> speed = {};   ///< at a stop: of the places against one another [m/s], [rad/s]
  std::optional<double> work = {};    ///< at a kink of drives: what their impulses add to the kinetic energy [J]
  bool switches = false;              ///< it has locked or unlocked a joint
};

/// An instant at which drives or loads are not smooth in time. A step ends `before` it, with what drives and loads are
/// there; the next one starts `after` it, which differs by round-off, from consistent accelerations and multipliers.
struct Kink {
  double before = 0, after = 0;  ///< [s]
  std::string name = {};
  /// Where velocities jump: `speed of the drive jumps from 0 to 5 rad/s`. They go to the nearest ones, in kinetic
  /// energy, that the drives allow. Empty: they do not jump, lose what violates the constraints' rates, and nothing is
  /// reported.
  std::string what = {};
};

}  // namespace floe::dynamics
