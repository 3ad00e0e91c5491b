#pragma once
#include <mpi.h>

#include <filesystem>
#include <string_view>
#include <vector>

#include "floe/output/claim.h"

namespace floe::output {

/// Where a run leaves its results, and what they are called.
struct ResultFolder {
  std::filesystem::path path;
  std::filesystem::path made = {};  ///< `path`, or its first parent, that was not there before (rank 0); else empty
  std::vector<std::filesystem::path> replaces = {};  ///< what remove_replaced removes (rank 0)
  Claim claim = {};                                  ///< that nobody else writes into it (rank 0)
  std::filesystem::path summary() const { return path / "summary.json"; }
  std::filesystem::path probes() const { return path / "probes.csv"; }
  std::filesystem::path result() const { return path / "result.h5"; }
  std::filesystem::path sweep() const { return path / "sweep.h5"; }
  std::filesystem::path sweep_table() const { return path / "sweep.csv"; }
  std::filesystem::path checkpoint() const { return path / "checkpoint.h5"; }
};

/// Makes `path` (and its parents) ready to take results, and claims it: `.floe.lock` in it, for as long as the folder's
/// last copy lives.
///
/// A folder that holds anything is refused unless `overwrite`; then floe's own results in it are found, by name and by
/// what they hold, and stay until remove_replaced: whoever fails before that has lost nothing.
/// @throws InputError  another process writes there; not empty, not a folder, cannot be made, not writable, a file with
/// the name of a result that is not floe's: one line, the same on every rank
/// Collective; rank 0 alone touches the file system.
ResultFolder prepare_folder(MPI_Comm comm, const std::filesystem::path& path, bool overwrite);

/// The folder of a run that is taken up again, claimed: nothing in it is replaced.
/// @throws InputError  not there, not writable, another process writes there: the same on every rank. Collective.
ResultFolder reopen_folder(MPI_Comm comm, const std::filesystem::path& path);

/// Clears drafts of a run's results away that it was killed over, once it is known that this run is taken up.
/// Collective; rank 0 alone touches the file system.
void remove_drafts(MPI_Comm comm, const ResultFolder& folder);

/// Removes the results that new ones replace: to be called when these begin.
/// @throws RunError  one cannot be removed. Collective; rank 0 alone touches the file system.
void remove_replaced(MPI_Comm comm, const ResultFolder& folder);

/// Ends the claim and removes the folder, and the parents that were made for it, if nothing was written into them: for
/// runs that fail at their start.
/// Rank-local; throws nothing.
void discard_if_empty(const ResultFolder& folder) noexcept;

/// Replaces the file so that whoever reads it, at any moment, finds the old text or the new one, whole.
///
/// Writes `.NAME.partial` beside it, syncs, renames.
/// @throws RunError  path and reason ("No space left on device"); the old file is as it was
/// Rank-local.
void write_file_atomically(const std::filesystem::path& path, std::string_view text);

/// `.NAME.partial` beside `path`: the draft that is renamed to it once it is whole.
std::filesystem::path draft_of(const std::filesystem::path& path);

/// Brings the file that stands at `path` to disk. @throws RunError. Rank-local.
void sync_file(const std::filesystem::path& path);

/// The second half of write_file_atomically: brings `draft` to disk and gives it the name `path`.
///
/// @throws RunError
/// Rank-local.
void publish_draft(const std::filesystem::path& draft, const std::filesystem::path& path);

}  // namespace floe::output
