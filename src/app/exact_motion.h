#pragma once
#include <string>
#include <vector>

#include "run.h"

namespace floe::app {

/// Elements of a scene, two for each quadrilateral; a mesh file, which is not read, counts as a million.
int elements_of(const scene::Scene& scene);

/// What a total accuracy is measured against: formulation cfr, elements and steps halved until little changes.
///
///   y = y(h, dt) + [y(0, dt) - y(h, dt)] + [y(h, 0) - y(h, dt)]
///
/// y(0, dt), y(h, 0) by Richardson's extrapolation (order 2). What is left of each direction: a third of what the last
/// halving changed where there is one halving, a twelfth where two of them show the order, all of it where they show a
/// lower one.
struct ExactMotion {
  std::string none;             ///< why there is none; empty: there is one
  Series series;                ///< y
  Series in_own_steps;          ///< y(0, dt)
  double error = 0;             ///< of `series`, of the worst probe
  std::vector<double> of_mesh;  ///< what meshes do: of the scene's, and of each halved one, of the worst probe
  double of_step = 0;           ///< error of the scene's step, of the worst probe
  int halved_steps = 0;         ///< how often
  bool mesh_ordered = true;     ///< `series` is extrapolated from the last two meshes
};

/// @param accuracy  that is asked for: halvings end where the error is below a tenth of it, or would take too long
/// @param most      processor time of one simulation [s]
/// Collective: up to 2000 elements every rank moves its own copy.
ExactMotion exact_motion(const scene::Scene& scene, double accuracy, double most, MPI_Comm comm);

/// y(0, n dt), on the meshes of `exact`, which has the motion in the scene's own steps.
/// @throws InputError, RunError on every rank. Collective.
Series exact_in_steps(const scene::Scene& scene, int n, const ExactMotion& exact, double accuracy, MPI_Comm comm);

/// y += factor (a - b), at the instants that all three have.
void add_difference(Series& y, double factor, const Series& a, const Series& b);

/// Simulates a full-order model quietly, the equations of a step solved to 1e-5 of the accuracy (0: as usual):
/// @throws InputError, RunError on every rank. Collective.
Series quiet_motion(const scene::Scene& scene, scene::Formulation formulation, double accuracy, MPI_Comm comm);

}  // namespace floe::app
