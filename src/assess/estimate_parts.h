#pragma once
#include <algorithm>
#include <ctime>
#include <limits>
#include <utility>
#include <vector>

#include "floe/assembly/residual_loads.h"
#include "floe/assess/estimate.h"
#include "floe/assess/probe_errors.h"
#include "floe/petsc/together.h"

/// What the estimates of motions and of equilibria have in common.
namespace floe::assess {

/// Processor time that is left, as rank 0 sees it: all ranks decide alike, and not by what else the machine does.
class TimeBudget {
 public:
  TimeBudget(MPI_Comm comm, double seconds) : comm_(comm), begin_(now()), allowed_(of_first(seconds)) {}
  double spent() const { return of_first(spent_here()); }
  double spent_here() const { return now() - begin_; }  ///< as this rank sees it
  double left() const { return left_after(spent()); }
  double left_after(double spent) const { return std::max(0.0, allowed_ - spent); }
  bool half_left() const { return left() > 0.5 * allowed_; }
  double of_first(double value) const {
    MPI_Bcast(&value, 1, MPI_DOUBLE, 0, comm_);
    return value;
  }

 private:
  static double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
  MPI_Comm comm_;
  double begin_, allowed_;
};

/// Why there can be no estimate for bodies like these; empty: there can.
std::string without_estimate(const Offline& offline);

/// Runs `make`, which fills the estimate in within the time; where it cannot, the estimate says why and the result
/// stands without it. Collective. @throws  what this rank alone has failed of (petsc::failed_together)
template <class Make>
void fill_in(Estimate& estimate, MPI_Comm comm, const TimeBudget& time, double seconds, const Make& make) {
  if (const std::string why = petsc::failed_together(comm, make); !why.empty()) estimate.none = why;
  estimate.seconds = time.spent(), estimate.allowed = seconds;
}

/// An error beyond a hundred times what it is an error of is no estimate, whatever its size: infinite.
inline double known(double error) { return error <= 100 ? error : std::numeric_limits<double>::infinity(); }

/// `known` of each, with none that is no number.
std::vector<double> known(std::vector<double> errors);

/// Squares of deformations that are round-off of where the bodies are: 64 eps of the scene's length, of columns that
/// are normalised by mass.
double round_off_of(const Offline& offline);

/// Notes of the bodies whose own error is not seen.
void note_files(const Offline& offline, Estimate& estimate);

}  // namespace floe::assess
