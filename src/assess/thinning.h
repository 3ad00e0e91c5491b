#pragma once
#include <string>
#include <vector>

#include "floe/assess/budget.h"

namespace floe::assess {

/// How fine and how coarse both models of a comparison are made: lengths of elements and steps, of those of the motion.
struct Thinning {
  double mesh = 1, step = 1;
};

/// `same mesh`, `elements 2 times as long`; `, steps 1/2 as long`, empty: as long.
std::string words(const Thinning& one);
std::string step_words(double step);

/// Processor time of a motion and of a better model of its scene [s], both thinned.
class ComparisonTime {
 public:
  /// @param took  the motion itself
  ComparisonTime(const FinishedMotion& motion, double took) : motion_(motion), took_(took) {}
  double better_step = 0;  ///< a step of the better model, on the motion's mesh

  bool can_scale(double mesh) const;
  /// Lower bound of the better model on any machine, of each rank, not thinned and as much as it can be: whether a
  /// large one is worth building.
  double least() const;
  double least_thinned() const;
  double whole() const;  ///< of the better model, not thinned
  double of(const Thinning& one) const;
  /// Those that save time, the least first. Collective.
  std::vector<Thinning> all() const;

 private:
  const FinishedMotion& motion_;
  double took_;
};

}  // namespace floe::assess
