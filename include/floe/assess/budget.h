#pragma once
#include <string>
#include <vector>

#include "floe/assess/step_error.h"

namespace floe::assess {

/// Values of a motion's probes at some of its instants.
struct ProbeSeries {
  std::vector<ProbeColumn> columns;
  std::vector<double> t;                    ///< ascending [s]
  std::vector<std::vector<double>> values;  ///< of each instant, each column
  std::vector<JointChange> changes = {};    ///< of the motion
  double event_error = 0;                   ///< KeptMotion::event_error
  bool impulsive = false;                   ///< KeptMotion::impulsive
};

/// The estimate of the reduction by residuals where it covers the motion. Where the equations of the error end before,
/// since they diverge, their last values are far off and nothing is known of what comes later: then there is none, with
/// the reason.
Estimate of_whole(Estimate reduction, const KeptMotion& motion);

/// Those of the kept states: at the instants of the estimate of the reduction, at all where there is none. Collective
/// where the system is.
ProbeSeries probe_series(const Model& model, const KeptMotion& motion, const Estimate& reduction);

/// A part of the error of the probes: how far the motion of a better model is away.
struct ErrorPart {
  std::string none = "it was not asked for";  ///< why there is none, else empty
  /// Relative, as Estimate::probes, over the instants until `until`; NaN: not known of this probe (see notes).
  std::vector<double> probes;
  std::string by;                           ///< what it was found by
  double until = 0;                         ///< [s], of what was simulated
  double seconds = 0;                       ///< processor time
  std::vector<std::string> notes;           ///< what was left out, and why
  bool apart = true;                        ///< of the model: it does not contain what meshes do to the better one
  bool with_reduction = false;              ///< of the model: it contains the error of the reduction, unknown by itself
  std::vector<double> t;                    ///< instants [s]
  std::vector<std::vector<double>> errors;  ///< of each: the error of each probe column, better model less this one
};

/// Leaves probes out of a part that covers only a beginning in which they move by less than a tenth of what they move
/// later: its errors there say nothing. They are NaN and named in the notes.
void leave_out_quiet(const ProbeSeries& own, ErrorPart& part);

/// A finished motion of a reduced model, or its equilibria under loads that grow with t, `how.step` apart.
struct FinishedMotion {
  const Scene& scene;
  const Model& model;  ///< its vectors are overwritten
  const solve::State& start;
  solve::Integration how;
  PetscInt steps = 0;             ///< that it took
  double seconds = 0;             ///< processor time of the motion
  double offline = 0;             ///< processor time of building the model
  MPI_Comm comm = MPI_COMM_NULL;  ///< of the offline stage
  bool at_rest = false;           ///< equilibria; `start` is not used
};

/// The error of strains and floating frames: geometrically exact (corotational) elements are simulated, or brought to
/// equilibrium,
///
///   e_model = (y_cfr - y) - e_reduction - e_mesh      at every instant, of every probe column
///
/// y_cfr is extrapolated (order 2) from the same mesh and that of elements half as long, or twice as long of plates.
/// Where the time is too short for that, or e_mesh is known of a shorter time, it is of the same mesh, e_mesh is not
/// subtracted, and e_model contains the difference of the meshes' errors in both models (ErrorPart::apart). Where it is
/// shorter, both models take steps two or four times as long; then lines have elements two or four times as long in
/// both; then only the first part is simulated, at least a fifth.
///
/// @param own        the probes of the motion
/// @param reduction  error of the reduction at the instants of `own`; without one, e_model contains it
/// @param mesh       error of the mesh at the instants of `own`
/// @param allowed    processor time that it may take, about [s]
/// Not estimated: where formulation cfr does not support the scene (the reason is given), deflections in space, and
/// scenes with events that watch these.
/// A fault of any rank leaves the part out on all ranks, with the reason. Collective on the communicator of the offline
/// stage; up to 2000 elements every rank simulates its own copy.
ErrorPart estimate_model_error(const FinishedMotion& motion, const ProbeSeries& own, const Estimate& reduction,
                               const ErrorPart& mesh, double allowed);

/// The error of the reduction where events change joints or impulses velocities, for which estimate_error() has no
/// equations: the full-order model (nlffr) of the same mesh is simulated, in the same steps,
///
///   e_reduction = y_nlffr - y     at every instant, of every probe column
///
/// Where the time is too short, both models are thinned as in estimate_model_error().
/// Faults, collective: as estimate_model_error.
Estimate estimate_by_full_order(const FinishedMotion& motion, const ProbeSeries& own, double allowed);

/// The error of the meshes: the reduced model is built and simulated on the mesh of elements half as long, or, where
/// that takes too much time, twice as long. Errors of order 2 in the length,
///
///   e_mesh = 4/3 (y_h/2 - y_h)     or     1/3 (y_h - y_2h)
///
/// Errors of higher order are overestimated by a third at most by the first, and by the power of two of the difference
/// of orders by the second.
/// Faults, collective: as estimate_model_error.
ErrorPart estimate_mesh_error(const FinishedMotion& motion, const ProbeSeries& own, double allowed);

/// The error of the answer, of each probe: the sum of the parts at every instant, root mean square over that of the
/// probe. Parts of which only a beginning is known are added by their size.
/// @param parts   those that are known; an error that is NaN does not count
/// @param beside  those whose sign is unknown among the others: added in quadrature
std::vector<double> total_error(const ProbeSeries& own, const std::vector<const ErrorPart*>& parts,
                                const std::vector<const ErrorPart*>& beside = {});

/// The scene with the meshes of its bodies refined (2, 4) or coarsened (0.5, 0.25).
/// @return false: a number of elements cannot be divided, or an imported mesh is not refined so far
bool scale_meshes(Scene& scene, double factor);
/// Whether a mesh may be of shells, whose number grows with the square of the factor.
bool any_shells(const Scene& scene);

}  // namespace floe::assess
