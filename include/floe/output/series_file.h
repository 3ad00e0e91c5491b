#pragma once
#include <mpi.h>

#include <chrono>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace floe::output {

/// Name and unit of a column.
struct SeriesColumn {
  std::string name, unit;
};

/// A time series as CSV: a header `t [s],tip.x [m],...`, then a line per row, each number as short as reads back
/// exactly.
///
/// Whole lines reach the file once a second or every thousand rows and at the end, so that a run that is killed leaves
/// what it had.
class SeriesFile {
 public:
  /// Creates the file with its header. Collective; rank 0 writes.
  /// @param columns  without the time
  /// @throws RunError  on every rank
  SeriesFile(MPI_Comm comm, const std::filesystem::path& path, const std::vector<SeriesColumn>& columns,
             const std::string& time_unit = "s");
  /// Continues the file of a run that is taken up again after its first rows; what is behind them is cut off.
  /// @param rows  receives these rows, the time first; on all ranks
  /// @throws RunError  the file is not there, has another header, fewer rows: on every rank. Collective.
  SeriesFile(MPI_Comm comm, const std::filesystem::path& path, const std::vector<SeriesColumn>& columns,
             std::size_t keep, std::vector<std::vector<double>>& rows, const std::string& time_unit = "s");
  SeriesFile(const SeriesFile&) = delete;
  SeriesFile& operator=(const SeriesFile&) = delete;
  /// Writes what is left; a failure here is lost, so call finish() first.
  ~SeriesFile();

  /// Adds a line. Rank 0 only (elsewhere nothing happens): where ranks run in step, call it within petsc::agree.
  /// @throws RunError  path and reason
  void row(double t, std::span<const double> values);
  /// Brings all rows to disk. Rank-local, as row(). @throws RunError
  void save();
  /// Writes what is left and closes; rows after it are lost. Collective.
  /// @throws RunError  on every rank
  void finish();

 private:
  void write();
  void keep_whole_lines(std::size_t written);
  MPI_Comm comm_;
  std::string path_;
  int descriptor_ = -1;
  std::size_t columns_, pending_rows_ = 0;
  std::string pending_;
  std::chrono::steady_clock::time_point written_;
};

}  // namespace floe::output
