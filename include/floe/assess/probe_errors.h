#pragma once
#include <string>
#include <vector>

#include "floe/assembly/model.h"

namespace floe::assess {
using namespace assembly;
using namespace plan;
using namespace scene;

/// `tip` of the columns `tip.x`, `tip.y`.
std::string probe_of(const ProbeColumn& column);

/// What relative errors of probes refer to: their sizes s_p (root mean squares or maximum values, of each probe as a
/// vector in the order of the columns), but of those that hardly move beside what moves most, as where symmetry holds
/// them, at least
///
///   S_p max(1e-7 min(1, max_q s_q / S_q), 1e-10),   S = extent of the scene [m], 1 rad (ProbeColumn::scale):
///
/// what is below is round-off, or of no account. For velocities S = extent / duration (they do not count as q), or 1e-7
/// of the maximum of them where that is more; of forces and moments 1e-7 of their maximum or of S, a force of the scene
/// (Model::force; times the extent); of formulas 1e-7 of the maximum of those with the same unit.
/// @param duration  of the motion [s]; 0: a second
std::vector<double> reference_sizes(const std::vector<ProbeColumn>& columns, const std::vector<double>& sizes,
                                    double duration);

/// Errors of probes along a motion: root mean squares of each probe as a vector, relative to reference_sizes.
///
///   e_p = sqrt(sum_i |error_p(t_i)|^2 / n) / reference_p
class ProbeErrors {
 public:
  explicit ProbeErrors(std::vector<ProbeColumn> columns);
  /// @param error, value  of each column at one more instant
  void add(const std::vector<double>& error, const std::vector<double>& value);
  /// Of each probe; NaN where an error was. @param duration  as of reference_sizes
  std::vector<double> relative(double duration) const;

 private:
  std::vector<ProbeColumn> columns_;
  std::vector<std::size_t> probe_;  // of each column
  std::vector<double> error_, size_;
  double count_ = 0;
};

}  // namespace floe::assess
