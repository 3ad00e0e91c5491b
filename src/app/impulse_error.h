#pragma once
#include <string>

#include "run.h"

namespace floe::app {

/// The error that reduced models of a scene make where impulses change velocities: the difference of their motions to
/// the full-order one (nlffr, same mesh and step), which is simulated when it is first asked for.
class ImpulseError {
 public:
  ImpulseError(const scene::Scene& scene, double accuracy, MPI_Comm comm)
      : scene_(scene), accuracy_(accuracy), comm_(comm) {}
  /// Of the worst probe; 0 where it is not known (unknown(), of the last call). Collective; the same on all ranks.
  double of(const Series& reduced);
  /// Why it is not known; empty: it is.
  const std::string& unknown() const { return unknown_; }

 private:
  void simulate();

  const scene::Scene& scene_;
  double accuracy_;
  MPI_Comm comm_;
  Series full_order_;
  std::string unknown_;
};

}  // namespace floe::app
