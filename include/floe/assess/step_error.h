#pragma once
#include <string>
#include <vector>

#include "floe/assess/estimate.h"
#include "floe/solve/deviation.h"
#include "floe/solve/simulation.h"

namespace floe::assess {

/// Where a motion begins, to be begun once more: taken before it is moved. Collective.
solve::State start_of(const Model& model);

/// What the step does to a reduced motion, by the motion with another step (Richardson; the scheme is of order 2):
///
///   y - y_exact = 4/3 (y_h - y_h/2),  or, where time is short,  1/3 (y_2h - y_h)
struct StepError {
  std::string none = "it was not asked for";  ///< why there is none, else empty
  std::vector<double> probes;                 ///< relative, as Estimate::probes
  double deformation = 0;                     ///< as Estimate::deformation
  bool halved = false;                        ///< by half the step, else by twice
  double until = 0;                           ///< [s], of what was moved again
  double seconds = 0;                         ///< processor time
  std::vector<double> t;                      ///< instants [s]
  std::vector<std::vector<double>> errors;    ///< of each: the error of each probe column, exact in time less this one
};

/// @param model     reduced; its vectors end where the motion with the other step ends
/// @param how       of the motion that was kept; @param took  what it took [s], of rank 0
/// @param allowed   time that it may take, about [s]: half the step where there is time for twice the motion, else
/// twice the step, of the first part alone where that is needed; as rank 0 has it
/// @throws RunError, InputError  on every rank alike. Every rank moves its own copy.
StepError estimate_step_error(const Model& model, const solve::State& start, const KeptMotion& motion,
                              solve::Integration how, double took, double allowed);

}  // namespace floe::assess
