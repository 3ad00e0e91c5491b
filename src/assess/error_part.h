#pragma once
#include <functional>

#include "estimate_parts.h"
#include "floe/assess/budget.h"
#include "probe_history.h"

namespace floe::assess {

/// What the estimates of model and mesh have in common.

/// y = weight (other - one), of the columns of `own` (by name), less the rows of `less` where there are any; fills in
/// t, errors, probes and until. Columns that a model does not have are NaN; so are instants that are not to be
/// compared, which do not count.
struct Simulated {
  std::vector<ProbeColumn> columns;
  std::vector<std::vector<double>> values;  ///< of each instant of ProbeSeries::t that was reached
};
void set_errors(const ProbeSeries& own, const Simulated& other, const Simulated& one, double weight,
                const std::vector<std::vector<double>>& less, ErrorPart& part);

/// The first line.
std::string first_line(const std::string& text);

/// Why a simulation was ended: it took more than `limit` [s].
std::string too_long(double limit);

/// Builds another model of the scene, up to 2000 elements on every rank for itself, as small ones are faster.
/// @throws  a fault of any rank, on all. Collective.
Model built(const FinishedMotion& motion, const Scene& scene, Formulation formulation);

/// Whether a simulation is to end: called with processor time [s], the same on all ranks, after each of the first 50
/// steps and then every 32 steps.
using Enough = std::function<bool(const solve::Instant& instant, double spent)>;
inline constexpr PetscInt looked_at = 50, look_every = 32;

/// Whether longer steps save time: not of equilibria, nor where a tolerance sets the step.
bool can_lengthen(const FinishedMotion& motion);

/// The probes of a model that built() made, or of the motion's own: simulated, or its equilibria. Where every rank has
/// its own copy, one that fails stops all of them when they look at the time next: they have as many values, and the
/// reason (ProbeHistory::stopped) is that of the first one that failed. Collective.
/// @param own  probes at whose instants they are wanted. Between the times that an event which changes joints has in
/// both motions they are NaN; behind the time of one that happens in one motion only there are none (`stopped`).
ProbeHistory simulated(const FinishedMotion& motion, const TimeBudget& time, const Scene& scene, const Model& model,
                       const solve::Integration& how, const ProbeSeries& own, const Enough& enough = {});

/// A share of the motion: what simulates less than that is no estimate.
inline constexpr double min_fraction = 0.2;

/// Probes of a motion that a part is compared with; one that stopped early says so in the notes.
/// @param what  was simulated, for the note
/// @throws RunError  it stopped before a fifth of the motion
Simulated compared(const FinishedMotion& motion, std::vector<ProbeColumn> columns, ProbeHistory history,
                   const std::string& what, ErrorPart& part);

/// The motion itself, in steps `times` as long, until `end`. @throws RunError  as compared(). Collective.
Simulated again(const FinishedMotion& motion, const ProbeSeries& own, const TimeBudget& time, double times, double end,
                ErrorPart& part);

/// Runs `work`, which fills the part in: a fault of any rank, also of models that every rank has for itself, leaves the
/// part out on all of them, with the reason. @return whether there was none. Collective.
bool fill_in(const FinishedMotion& motion, ErrorPart& part, const std::function<void()>& work);

/// Why no body has a full-order model: `no body is flexible`, `no flexible body has a mesh`; empty: one has.
std::string without_mesh(const Scene& scene);

}  // namespace floe::assess
