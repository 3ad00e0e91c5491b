#pragma once
#include <mpi.h>

#include <filesystem>
#include <memory>
#include <string>

namespace floe::output {

/// That this process alone writes into a folder, or a file, for as long as the last copy lives.
///
/// A small file says who holds it: host, process, when that began, since when. It is made whole under another name and
/// then linked, which one process alone succeeds in, also on file systems that hosts share. What a killed process
/// leaves is taken over: on the same host (same boot, same process namespace) one that is no more, or whose number
/// another process has got, is known. Of two who find it so the one goes first that has the old file's flock. Nothing
/// is known of processes on other hosts: who finds one of theirs is refused, and told what to remove.
class Claim {
 public:
  Claim() = default;
  /// Ends it now, for all copies. Rank-local.
  void release() const noexcept;

 private:
  friend Claim claim_at(const std::filesystem::path& lock, const std::string& what);
  struct Held;
  std::shared_ptr<Held> held_;
};

/// Claims by the file `lock`; one that this process holds already counts.
///
/// @param what  for messages: `output folder 'out'`
/// @throws InputError  another process holds it; RunError  it cannot be written
/// Rank-local.
Claim claim_at(const std::filesystem::path& lock, const std::string& what);

/// `.NAME.lock` beside a file that is to be written, by rank 0. @throws InputError  as claim_at, or the file's folder
/// cannot be written into. Collective.
Claim claim_file(MPI_Comm comm, const std::filesystem::path& path);

}  // namespace floe::output
