// The time series of a ResultFile: rows wait in memory and are written in place, into room that the published file has.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "dataset.h"
#include "floe/output/folder.h"
#include "floe/output/result_file.h"
#include "floe/petsc/error.h"
#include "reserve.h"
#include "writing.h"

namespace floe::output {
namespace {

constexpr std::chrono::seconds wait_at_most{1};
constexpr std::size_t bytes_at_most = 4 << 20;

}  // namespace

void ResultFile::add_series(const std::string& name, std::int64_t columns, const Label& label,
                            std::int64_t expected_rows) {
  if (columns < 1) throw std::invalid_argument(name + ": a series needs a column");
  open_draft();
  const std::int64_t guess = std::clamp<std::int64_t>(131072 / columns, 16, 4096);
  const std::int64_t capacity = expected_rows > 0 ? expected_rows : guess;
  reserve_in_draft(series_bytes(capacity, columns));
  petsc::agree(comm_, [&] {
    writing(path_, [&] {
      Hid dataset = create_series(draft_, name, capacity, columns);
      write_attribute(dataset, "unit", label.unit);
      write_attribute(dataset, "description", label.description);
      dataset.close();
    });
  });
  series_.push_back({.name = name, .columns = columns, .capacity = capacity});
}

void ResultFile::continue_series(const std::string& name, std::int64_t columns, std::int64_t rows,
                                 std::int64_t expected_rows) {
  open_draft();
  const std::int64_t capacity = std::max(rows + 16, expected_rows);
  reserve_in_draft(series_bytes(capacity, columns));
  petsc::agree(comm_, [&] {
    writing(path_, [&] {
      const Extent found = series_extent(draft_, name);
      if (found.size() != 2 || found[1] != static_cast<hsize_t>(columns))
        throw RunError(fmt::format("cannot write {}: {} in it is not that of the run", path_.string(), name));
      if (found[0] < static_cast<hsize_t>(rows))
        throw RunError(fmt::format("cannot write {}: {} has {} rows, and the checkpoint comes after {}", path_.string(),
                                   name, found[0], rows));
      resize_series(draft_, name, rows);
      resize_series(draft_, name, capacity);
    });
  });
  series_.push_back({.name = name, .columns = columns, .capacity = capacity, .stored = rows});
}

ResultFile::Series& ResultFile::series(const std::string& name) {
  if (draft_) throw std::logic_error(name + ": rows before publish()");
  const auto found =
      std::find_if(series_.begin(), series_.end(), [&](const Series& each) { return each.name == name; });
  if (found == series_.end()) throw std::invalid_argument(name + ": no such series");
  return *found;
}

bool ResultFile::due() const {
  std::size_t bytes = 0;
  for (const Series& each : series_) {
    if (each.waiting > 0 && each.stored + each.waiting == each.capacity)
      return true;  // growing may fail: be safe first
    bytes += each.waiting * each.columns * sizeof(double);
  }
  return bytes > bytes_at_most || std::chrono::steady_clock::now() - written_ > wait_at_most;
}

void ResultFile::append(const std::string& name, std::span<const double> row) {
  if (rank_ != 0) return;
  Series& to = series(name);
  if (static_cast<std::int64_t>(row.size()) != to.columns)
    throw std::invalid_argument(fmt::format("{}: {} numbers for {} columns", name, row.size(), to.columns));
  to.rows.insert(to.rows.end(), row.begin(), row.end());
  ++to.waiting;
  if (due()) write_replicated();
}

void ResultFile::append_distributed(const std::string& name, std::int64_t first_column, std::span<const double> part) {
  Series& to = series(name);
  to.distributed = true;
  to.first_column = first_column;
  to.local_columns = static_cast<std::int64_t>(part.size());
  to.rows.insert(to.rows.end(), part.begin(), part.end());
  ++to.waiting;
  int now = due();
  MPI_Bcast(&now, 1, MPI_INT, 0, comm_);
  if (now) write_distributed();
}

/// Doubles the series that are too short for what waits, in a draft. Rank 0.
void ResultFile::make_room(bool distributed) {
  Hid file;
  for (Series& each : series_) {
    if (each.distributed != distributed || each.stored + each.waiting <= each.capacity) continue;
    if (!file) {
      std::filesystem::copy_file(path_, draft_of(path_), std::filesystem::copy_options::overwrite_existing);
      file = open_file(draft_of(path_), Open::change, MPI_COMM_NULL);
    }
    const std::int64_t capacity = std::max(2 * each.capacity, each.stored + each.waiting);
    reserve(draft_of(path_), series_bytes(capacity, each.columns));
    resize_series(file, each.name, capacity);
    each.capacity = capacity;
  }
  if (!file) return;
  file.close();
  publish_draft(draft_of(path_), path_);
}

/// Puts the waiting rows in their place. The file is open only here.
void ResultFile::write_in_place(bool distributed) {
  Hid file = open_file(path_, Open::change, distributed ? comm_ : MPI_COMM_NULL);
  for (Series& each : series_) {
    if (each.distributed != distributed || each.waiting == 0) continue;
    Hid dataset(H5Dopen2(file, each.name.c_str(), H5P_DEFAULT), H5Dclose);
    const hsize_t columns = distributed ? each.local_columns : each.columns;
    write_block(dataset, {hsize_t(each.stored), hsize_t(each.first_column)}, {hsize_t(each.waiting), columns},
                each.rows, distributed);
    dataset.close();
  }
  file.close();
  for (Series& each : series_) {
    if (each.distributed != distributed) continue;
    each.stored += std::exchange(each.waiting, 0);
    each.rows.clear();
  }
  written_ = std::chrono::steady_clock::now();
}

bool ResultFile::any_waiting(bool distributed) const {
  return std::any_of(series_.begin(), series_.end(),
                     [&](const Series& each) { return each.distributed == distributed && each.waiting > 0; });
}

void ResultFile::write_replicated() {
  if (rank_ != 0 || !any_waiting(false)) return;
  writing(path_, [&] {
    make_room(false);
    write_in_place(false);
  });
}

void ResultFile::write_distributed() {
  if (!any_waiting(true)) return;
  petsc::agree(comm_, [&] {
    if (rank_ == 0) writing(path_, [&] { make_room(true); });
  });
  petsc::agree(comm_, [&] { writing(path_, [&] { write_in_place(true); }); });
}

void ResultFile::flush() {
  petsc::agree(comm_, [&] { write_replicated(); });
  write_distributed();
}

void ResultFile::save(bool alone) {
  const auto sync = [&] {
    if (rank_ == 0) sync_file(path_);
  };
  if (alone) {
    write_replicated();
    sync();
    return;
  }
  flush();
  petsc::agree(comm_, sync);
}

}  // namespace floe::output
