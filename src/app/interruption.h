#pragma once
#include <mpi.h>

#include <csignal>

namespace floe::app {

/// While it lives, the first SIGINT, SIGTERM or SIGHUP is only noted, so that the step under way ends and the files are
/// finished; the second one ends the program as always. One within the life of another changes nothing.
class Interruption {
 public:
  Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;
  ~Interruption();
  /// @throws RunError  one of the ranks of `comm` was asked to end. Collective.
  void check(MPI_Comm comm) const;
  /// Whether a rank of `comm` was asked to end since the last outermost Interruption began. Collective.
  static bool happened(MPI_Comm comm);

 private:
  struct sigaction before_[3];
};

}  // namespace floe::app
