#pragma once
#include <petscvec.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace floe::dynamics {

/// Whether the rows of a joint hold; its term and the events that change it share it.
///
/// Rows that do not hold keep their multipliers at zero: the unknowns of a system never change in number.
struct Latch {
  bool closed = true;
};

/// What happens once to a mechanism at an instant of its motion: where a step ends there, and the next one starts from
/// consistent accelerations and multipliers, order 2 is kept.
struct Event {
  std::string name;
  std::string what;  ///< `unlock joint clamp`
  double at = 0;     ///< [s]; of an event without `crosses`
  /// If given, it happens where this changes sign, located within the step by cubic interpolation (error O(h^4)).
  std::function<double(double t, Vec U, Vec V)> crosses = {};
  std::shared_ptr<Latch> latch = {};  ///< that it changes, if any
  bool closes = false;                ///< the latch; else it opens it
  int first_row = 0, rows = 0;        ///< local indices of the multipliers of the latch that closes
  bool stops = false;                 ///< the motion ends here
};

/// An event that happened. Closing rows on places that move is an impact: velocities go to the nearest ones, in kinetic
/// energy, that the rows allow (perfectly plastic).
struct EventReport {
  std::string name, what;
  double t = 0;                       ///< [s]
  double lost = 0;                    ///< kinetic energy [J]
  std::vector<double> impulses = {};  ///< on the rows that were closed [N s], [N m s]
};

}  // namespace floe::dynamics
