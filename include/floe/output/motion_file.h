#pragma once
#include <mpi.h>

#include <filesystem>
#include <string>
#include <vector>

namespace floe::output {

/// Which instants of a run are written, and how far deformations are enlarged.
struct MotionRequest {
  std::filesystem::path results;  ///< folder of the run
  std::filesystem::path xdmf;     ///< and the HDF5 file beside it
  double amplify = 1;             ///< factor of the deformations
  int frames = 200;               ///< at most so many, at equal distances in time; 0: all that the run kept
  bool overwrite = false;
};

/// What was written, for those who asked for it.
struct MotionWritten {
  std::vector<double> t;  ///< of the frames [s]
  std::vector<std::string> bodies;
  std::vector<std::string> without;  ///< bodies whose mesh the results do not have
  std::int64_t nodes = 0, cells = 0;
};

/// Writes the moving mechanism for ParaView from the results of a run alone, whatever made them, on any number of
/// ranks: an XDMF file over an HDF5 file, a grid a body and an instant, all nodes of the mesh at
///
///   x = R + A (X + a u)     a: amplify;  u = basis eta, or the dofs of the node (result_file.h, docs/runs.md)
///
/// and at each node the vector `deformation`, A u in world axes [m], not enlarged; `part` of each element.
/// HDF5: NAME/cells (XDMF's mixed topology), NAME/part, NAME/frame_I/positions and deformation (n x 3), I from 1.
///
/// @throws InputError  no results there, or none that say where nodes are; a name that is taken: one line on every rank
/// @throws RunError    path and reason: nothing is left. Collective; each rank makes its share of all nodes.
MotionWritten write_motion(MPI_Comm comm, const MotionRequest& request);

}  // namespace floe::output
