#pragma once
#include "floe/assess/budget.h"
#include "probe_history.h"

namespace floe::assess {

/// What the estimates of model and mesh have in common.

/// y = weight (other - one), of the columns of `own` (by name), less the rows of `less` where there are any; fills in
/// t, errors, probes and until. Columns that a model does not have are NaN.
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
inline constexpr PetscInt look_every = 32;  ///< steps between looks at the time

/// The motion itself, in steps `times` as long, until `end`. Collective where the system is.
Simulated again(const FinishedMotion& motion, const ProbeSeries& own, double times, double end);

/// Where another model of the scene is built: up to 2000 elements by every rank for itself, as small ones are faster.
MPI_Comm comm_of_others(const FinishedMotion& motion);

/// Names of bodies with a mesh, generated or from a file.
std::vector<std::string> meshed_bodies(const Scene& scene, bool imported);

}  // namespace floe::assess
