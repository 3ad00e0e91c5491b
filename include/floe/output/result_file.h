#pragma once
#include <mpi.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "floe/output/hdf5.h"

namespace floe::output {

struct ReducedShapes;

/// Kept beside a dataset as its attributes `unit` and `description` (left out where empty).
struct Label {
  std::string unit, description;
};

/// result.h5: texts, arrays and time series under names such as "motion/q". The file is whole and readable at every
/// moment, also when the run is killed.
///
/// The structure is only ever changed in a draft (a copy, `.result.h5.partial`) that publish() renames to the file.
/// Rows of a series then go in place into space that the published file already has, filled with NaN; a growth step
/// doubles that space in a new draft. The file is closed between batches (one a second, or 4 MiB), so it can be read
/// while the run goes on. finish() cuts every series to its rows; in the file of a killed run the rows behind the last
/// batch are NaN.
///
/// A file of a run that is taken up again is continued: continue_series... ; publish() ; append...
///
/// Order of use: write_..., add_series... ; publish() ; append... ; then again, or finish().
class ResultFile {
 public:
  /// Begins the draft of a new file; an old file stays until publish(). Collective.
  /// @throws RunError  here and in all members: path and reason; on every rank, but for append()
  ResultFile(MPI_Comm comm, std::filesystem::path path);
  /// Begins with a draft of the file that is there. Collective. @throws RunError  it is not there or no HDF5
  enum class Existing { keep };
  ResultFile(MPI_Comm comm, std::filesystem::path path, Existing);
  ResultFile(const ResultFile&) = delete;
  ResultFile& operator=(const ResultFile&) = delete;
  /// Saves what rank 0 still holds, as far as it can, and drops an unpublished draft; call finish() first. Collective.
  ~ResultFile();

  /// Removes a dataset, or a group with all that it holds, where it is there. Collective.
  void remove(const std::string& name);
  /// A text as a scalar string dataset (UTF-8); replaces one of that name. Rank 0's text counts. Collective.
  void write_text(const std::string& name, const std::string& text);
  /// A replicated array, row-major; replaces one of that name. Collective; rank 0 writes.
  /// @throws std::invalid_argument  the product of `shape` is not the size of `data`
  void write_array(const std::string& name, const std::vector<std::int64_t>& shape, std::span<const double> data,
                   const Label& label = {});
  /// A distributed array, global_rows x columns, row-major; each rank gives its rows from `first_row` on (any number,
  /// also none). Collective: one MPI-IO transfer of all ranks.
  void write_distributed_rows(const std::string& name, std::int64_t global_rows, std::int64_t columns,
                              std::int64_t first_row, std::span<const double> local, const Label& label = {});

  /// A body's mesh as GROUP/positions, GROUP/cells/{nodes, part, kind} and, where it has columns, GROUP/basis (columns
  /// x nodes x dofs): as in a reduced body's file (reduced_file.h), in original order on any number of ranks.
  /// @param nodes    of all ranks
  /// @param columns  that shapes.column fills
  /// Collective.
  void write_shapes(const std::string& group, std::int64_t nodes, std::int64_t columns, const ReducedShapes& shapes,
                    const Label& basis = {});
  /// Vectors of the dofs at the nodes alone, columns x nodes x dofs, as the basis of write_shapes. Collective.
  void write_vectors(const std::string& name, std::int64_t nodes, std::int64_t columns, const ReducedShapes& shapes,
                     const Label& label);
  /// Some numbers of each node, nodes x columns, in original order; each rank gives those of shapes.nodes. Collective.
  void write_of_nodes(const std::string& name, std::int64_t nodes, std::int64_t columns, const ReducedShapes& shapes,
                      std::span<const double> rows, const Label& label = {});
  /// A link to what another HDF5 file holds under `object`; its absolute path is kept. Collective.
  void write_link(const std::string& name, const std::filesystem::path& file, const std::string& object);

  /// A time series, rows x columns, that starts empty.
  /// @param expected_rows  room to begin with; the right number spares all copying (0: a guess)
  /// Collective.
  void add_series(const std::string& name, std::int64_t columns, const Label& label = {},
                  std::int64_t expected_rows = 0);

  /// A series that is there, after its first `rows`; what is behind them is lost.
  /// @throws RunError  it is not there, has other columns, fewer rows. Collective.
  void continue_series(const std::string& name, std::int64_t columns, std::int64_t rows,
                       std::int64_t expected_rows = 0);

  /// Brings the draft to disk and makes it the file. Collective.
  void publish();

  /// Adds a row, replicated or on rank 0 only. Rank-local: rank 0 writes by itself, elsewhere nothing happens; where
  /// ranks run in step, call it within petsc::agree.
  void append(const std::string& name, std::span<const double> row);
  /// Adds a row of which each rank gives the part from `first_column` on (any number, also none). Collective.
  void append_distributed(const std::string& name, std::int64_t first_column, std::span<const double> part);

  /// Writes the rows that wait, now. Collective.
  void flush();
  /// flush(), and on to disk; `alone`: where no series is distributed, by rank 0 itself and rank-local.
  void save(bool alone);
  /// Writes all rows, cuts the series to their rows, publishes. Collective.
  void finish();

 private:
  struct Series {
    std::string name = {};
    std::int64_t columns, capacity, stored = 0, waiting = 0, first_column = 0, local_columns = 0;
    bool distributed = false;
    std::vector<double> rows = {};  ///< waiting x columns; distributed: waiting x local_columns
  };
  Series& series(const std::string& name);
  bool due() const;
  bool any_waiting(bool distributed) const;
  void open_draft();
  void reserve_in_draft(std::uint64_t bytes);
  void make_room(bool distributed);
  void write_in_place(bool distributed);
  void write_replicated();
  void write_distributed();

  MPI_Comm comm_;
  int rank_ = 0;
  std::filesystem::path path_;
  Hid draft_;
  std::vector<Series> series_;
  std::chrono::steady_clock::time_point written_;
};

}  // namespace floe::output
