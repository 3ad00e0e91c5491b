#pragma once
#include <mpi.h>

#include <optional>
#include <string>
#include <vector>

namespace floe::app {

/// What `floe stress` was asked for.
struct StressRequest {
  std::string folder;                  ///< of the run
  std::string scene;                   ///< empty: that of the run
  std::optional<std::string> out;      ///< FILE.xdmf; absent: DIR/stress.xdmf
  std::vector<double> at;              ///< instants [s]; the nearest that the run kept
  int frames = 0;                      ///< at equal distances; neither: those of the greatest stress of each body
  std::vector<std::string> histories;  ///< BODY:x,y,z
  std::vector<std::string> sources;    ///< BODY:SCENE.yaml: of bodies from files, what they were reduced from
  double amplify = 1;
  bool uncorrected = false, force = false;
};

/// Recovers stresses of all flexible bodies from the results of a run: their extremes, the fields at some instants for
/// ParaView, and histories as CSV. Prints a table.
/// @throws InputError, RunError  the same on all ranks. Collective.
void stress(const StressRequest& request, MPI_Comm comm);

}  // namespace floe::app
