#pragma once
#include <mpi.h>

#include <fstream>
#include <functional>
#include <string>

namespace floe::mesh {

/// A file that rank 0 writes, with what each rank has to say in the order of ranks.
class GatheredFile {
 public:
  /// @throws RunError  rank 0 cannot open it
  /// Collective.
  GatheredFile(MPI_Comm comm, std::string path);

  /// Rank 0's text. Rank-local.
  void add(const std::string& text);

  /// The texts of all ranks, in pieces: record(i, text) appends record i of this rank's `count`. Collective.
  void add_all(std::size_t count, const std::function<void(std::size_t i, std::string& text)>& record);

  /// @throws RunError  something was not written
  /// Collective.
  void close();

 private:
  void receive(int from);
  MPI_Comm comm_;
  int rank_ = 0, ranks_ = 1;
  std::string path_;
  std::ofstream file_;
};

}  // namespace floe::mesh
