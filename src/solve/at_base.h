#pragma once
#include "floe/dynamics/system.h"

namespace floe::solve {
using namespace dynamics;

/// While it lives, the attitudes of U are their own bases and their unknowns zero, where tangents by x are tangents by
/// rotations about body axes: what multiplies angular accelerations and velocities in the constraints. Afterwards
/// bases and unknowns are as before, to the bit. Collective.
class AtBase {
 public:
  AtBase(const System& system, Vec U, Vec V, double t);
  ~AtBase();
  AtBase(const AtBase&) = delete;
  AtBase& operator=(const AtBase&) = delete;

 private:
  const System& system_;
  Vec U_;
  std::vector<Eigen::Quaterniond> bases_;
  std::vector<std::pair<PetscInt, double>> owned_;  // of U, global
};

}  // namespace floe::solve
