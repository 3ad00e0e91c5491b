#pragma once
#include <mpi.h>

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "floe/output/reduced_file.h"

namespace floe::output {

/// Numbers of each element, of all of these fields one after the other.
struct CellField {
  std::string name;
  int width = 1;  ///< 1 or 3
  std::string unit = {}, description = {};
};

/// What goes with the elements of a body: each rank gives that of some of them, which it names.
struct CellFields {
  std::vector<ReducedShapes::Cell> cells;  ///< of this rank, as in the body's mesh (plan::mesh_copy)
  std::vector<CellField> fields;           ///< of each instant
  std::function<std::vector<double>(std::size_t frame)> values;
  std::vector<CellField> constants;  ///< the same at all instants
  std::vector<double> constant_values;
};

/// Which instants of a run are written, and how far deformations are enlarged.
struct MotionRequest {
  std::filesystem::path results;  ///< folder of the run
  std::filesystem::path xdmf;     ///< and the HDF5 file beside it
  double amplify = 1;             ///< factor of the deformations
  int frames = 200;               ///< at most so many, at equal distances in time; 0: all that the run kept
  bool overwrite = false;
  std::string what = "motion";                               ///< for messages, and the data's format `floe WHAT`
  std::vector<std::size_t> rows = {};                        ///< of the instants that the run kept; empty: by `frames`
  const std::map<std::string, CellFields>* cells = nullptr;  ///< by the bodies' names; those without are left out
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
