#pragma once
#include <mpi.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace floe::output {

/// What a run needs to go on from an instant: words, numbers that all ranks share, and numbers of each rank.
struct Checkpoint {
  nlohmann::ordered_json words;
  std::map<std::string, std::vector<double>> shared;
  std::map<std::string, std::vector<double>> own;
};

/// Replaces the file so that whoever is killed, at any moment, leaves the checkpoint before or this one, whole: HDF5
/// in memory, then a draft, synced and renamed.
///
/// @param comm  of the ranks whose `own` numbers count; rank 0 writes its words and shared numbers
/// @throws RunError  path and reason, on every rank; the old file is as it was. Collective.
void write_checkpoint(MPI_Comm comm, const std::filesystem::path& path, const Checkpoint& checkpoint);

/// Takes a checkpoint back on as many ranks as wrote it, or on any number where one did (all get its numbers).
///
/// @throws InputError  no file, not a whole checkpoint of this version of floe, other ranks: the same on every rank.
/// Collective.
Checkpoint read_checkpoint(MPI_Comm comm, const std::filesystem::path& path);

}  // namespace floe::output
