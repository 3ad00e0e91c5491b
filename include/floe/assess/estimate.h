#pragma once
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "floe/assembly/kept_motion.h"

namespace floe::assess {
using namespace assembly;
using namespace plan;
using namespace scene;

/// How far a reduced motion is from that of its full-order model (same mesh, exact in time), without moving the latter.
struct Estimate {
  std::string none = "it was not asked for";  ///< why there is none, else empty
  /// Relative, of each probe as a vector (probe_columns): root mean square over the instants against that of the probe.
  std::vector<double> probes;
  /// The same of the displacements in the frames, mass-weighted over all bodies with a mesh.
  double deformation = 0;
  std::vector<double> t;                    ///< instants [s]
  std::vector<std::vector<double>> errors;  ///< of each: the error of each probe column, full order less reduced
  std::vector<double> relative;  ///< of each: error of the deformations, of the maximum root mean square so far
  std::string by;                ///< simulation that it is the difference to; empty: residuals
  int samples = 0;               ///< full-order residuals
  int columns = 0;               ///< that the bodies got for the estimate
  /// Maximum |V'r| of what |V'f| is: round-off, what omitted products do, or terms beyond the third order of energies
  /// that are condensed.
  double unbalanced = 0;
  double seconds = 0, allowed = 0;
  std::vector<std::string> notes;                                    ///< what was left out, and why
  std::vector<std::shared_ptr<const reduction::Columns>> responses;  ///< W of each body; null: none
  /// [V W] of each body, and of each instant the deviation of the coordinates on these, body by body.
  std::vector<std::shared_ptr<const reduction::Basis>> bases;
  std::vector<Eigen::VectorXd> deviations;
  Eigen::VectorXd deviation_at_start;  ///< of motions that begin deformed, in an equilibrium or steady; empty: zero
};

/// What an estimate may take of a run [s]: a tenth of it, or a second.
inline double estimate_seconds(double run) { return std::max(1.0, 0.1 * run); }

/// The full-order equations of every body are evaluated at lifted states (U = V eta) of some instants, r; the columns
/// W, the main ones of K_T^-1 P' r, join V; and the equations of the bodies on [V W] are solved for what the motion
/// lacks, d(t) (solve::deviation). Loads, joints, frames and inertia act on d as they do on the motion; joint forces
/// in r are the multipliers of the motion.
///
///   r = M(q) q'' - Q_v + dU/dq - Q_e + C_q' lambda     on the free dofs of each body,  V'r = 0
///   K_T = d2U/dq2 at rest, at the instant at which the body deforms most, and at another one that is unlike both,
///   each for the instants whose deformation is nearest to it
///
/// What [V W] cannot follow is not seen; where V is far too poor the estimate is too small.
///
/// From many_elements on, in space, elements of the full-order model are made one after another and not stored.
///
/// @param model    reduced, with its offline stage kept (build)
/// @param seconds  that it may take, about; it thins its samples, basis vectors and instants and reports it
/// Collective on the communicator of the offline stage.
Estimate estimate_error(const Model& model, const KeptMotion& motion, double seconds);

/// The same of equilibria: from some of the lifted states Newton's method goes towards the equilibrium of full order,
///
///   (dF/dU) x = -F(t, U, 0, 0),   U += x     F of the whole scene with the full-order model, KSP prefix estimate_
///
/// and what it adds is the error. A first step is the response of the full tangent to the residual; it stops where the
/// next step would be short, or when its time is over. Errors are relative to what it arrives at, here; `samples` are
/// residuals, there are no basis vectors. Made below many_elements: the tangent of the full-order model stands in
/// memory while it is made. Of the last equilibrium there is a step at least; others as time allows.
///
/// @param model   reduced, with its offline stage kept (build); factors of K are not needed
/// @param states  in ascending order of t, at rest
/// Collective on the communicator of the offline stage.
Estimate estimate_error_at_rest(const Model& model, const std::vector<solve::State>& states, double seconds);

}  // namespace floe::assess
