#pragma once
#include "floe/scene/range.h"

namespace floe::scene {

/// Of one body over the motion.
struct Seen {
  double slope = 0, spin = 0;        // greatest
  double sag = 0;                    // where the slope is greatest
  double bending = 0, membrane = 0;  // energies where membrane's is greatest
  double rate = 0, size = 0;         // sums of squares of deformations
};

/// Loads, gravity, the ground's acceleration against the frequencies that are kept.
void judge_loads(const Scene& scene, const Model& model, std::vector<OutOfRange>& out);
/// The step against the fastest of what moves.
void judge_step(const Scene& scene, const Model& model, const std::vector<Seen>& seen, std::vector<OutOfRange>& out);

}  // namespace floe::scene
