#include "floe/output/result_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <stdexcept>

#include "dataset.h"
#include "floe/output/folder.h"
#include "floe/petsc/error.h"
#include "reserve.h"
#include "writing.h"

namespace floe::output {
namespace {

void need(bool condition, const std::string& what) {
  if (!condition) throw std::invalid_argument(what);
}

}  // namespace

ResultFile::ResultFile(MPI_Comm comm, std::filesystem::path path) : comm_(comm), path_(std::move(path)) {
  MPI_Comm_rank(comm, &rank_);
  petsc::agree(comm_, [&] { writing(path_, [&] { draft_ = open_file(draft_of(path_), Open::create, comm_); }); });
}

ResultFile::ResultFile(MPI_Comm comm, std::filesystem::path path, Existing) : comm_(comm), path_(std::move(path)) {
  MPI_Comm_rank(comm, &rank_);
  open_draft();
}

/// Structure is changed by all ranks in the draft, which starts as a copy of the published file.
void ResultFile::open_draft() {
  if (draft_) return;
  flush();
  petsc::agree(comm_, [&] {
    writing(path_, [&] {
      if (rank_ != 0) return;
      std::filesystem::copy_file(path_, draft_of(path_), std::filesystem::copy_options::overwrite_existing);
    });
  });
  petsc::agree(comm_, [&] { writing(path_, [&] { draft_ = open_file(draft_of(path_), Open::change, comm_); }); });
}

void ResultFile::reserve_in_draft(std::uint64_t bytes) {
  petsc::agree(comm_, [&] {
    if (rank_ == 0) writing(path_, [&] { reserve(draft_of(path_), bytes); });
  });
}

void ResultFile::remove(const std::string& name) {
  open_draft();
  petsc::agree(comm_, [&] { writing(path_, [&] { remove_object(draft_, name); }); });
}

void ResultFile::write_text(const std::string& name, const std::string& first) {
  std::string text = first;  // that of rank 0: HDF5's metadata must not differ between ranks
  int size = static_cast<int>(text.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, comm_);
  text.resize(size);
  MPI_Bcast(text.data(), size, MPI_CHAR, 0, comm_);
  open_draft();
  reserve_in_draft(text.size());
  petsc::agree(comm_, [&] { writing(path_, [&] { write_text_dataset(draft_, name, text, rank_ == 0); }); });
}

void ResultFile::write_array(const std::string& name, const std::vector<std::int64_t>& shape,
                             std::span<const double> data, const Label& label) {
  const Extent extent(shape.begin(), shape.end());
  need(std::accumulate(extent.begin(), extent.end(), hsize_t{1}, std::multiplies<>()) == data.size(),
       fmt::format("{}: {} numbers do not fill its shape", name, data.size()));
  open_draft();
  reserve_in_draft(data.size_bytes());
  petsc::agree(comm_, [&] {
    writing(path_, [&] {
      Hid dataset = create_array(draft_, name, extent);
      write_attribute(dataset, "unit", label.unit);
      write_attribute(dataset, "description", label.description);
      write_block(dataset, Extent(extent.size(), 0), extent, rank_ == 0 ? data : std::span<const double>(), true);
      dataset.close();
    });
  });
}

void ResultFile::write_distributed_rows(const std::string& name, std::int64_t global_rows, std::int64_t columns,
                                        std::int64_t first_row, std::span<const double> local, const Label& label) {
  petsc::agree(comm_, [&] {
    const auto size = static_cast<std::int64_t>(local.size());
    need(columns > 0 && size % columns == 0 && first_row >= 0 && first_row + size / columns <= global_rows,
         fmt::format("{}: {} numbers from row {} do not fit {} x {}", name, size, first_row, global_rows, columns));
  });
  open_draft();
  const Extent shape{hsize_t(global_rows), hsize_t(columns)}, start{hsize_t(first_row), 0};
  reserve_in_draft(shape[0] * shape[1] * sizeof(double));
  petsc::agree(comm_, [&] {
    writing(path_, [&] {
      Hid dataset = create_array(draft_, name, shape);
      write_attribute(dataset, "unit", label.unit);
      write_attribute(dataset, "description", label.description);
      write_block(dataset, start, {local.size() / shape[1], shape[1]}, local, true);
      dataset.close();
    });
  });
}

void ResultFile::publish() {
  petsc::agree(comm_, [&] { writing(path_, [&] { draft_.close(); }); });
  petsc::agree(comm_, [&] {
    if (rank_ == 0 && std::filesystem::exists(draft_of(path_))) publish_draft(draft_of(path_), path_);
  });
  written_ = std::chrono::steady_clock::now();
}

void ResultFile::finish() {
  if (!draft_) flush();
  // Only rank 0 counts the rows that it writes by itself.
  std::vector<std::int64_t> stored;
  int whole = !draft_;
  for (const Series& each : series_) {
    stored.push_back(each.stored);
    if (each.stored != each.capacity) whole = 0;
  }
  MPI_Bcast(stored.data(), static_cast<int>(stored.size()), MPI_INT64_T, 0, comm_);
  MPI_Bcast(&whole, 1, MPI_INT, 0, comm_);
  if (whole) return;
  open_draft();
  for (std::size_t i = 0; i < series_.size(); ++i) series_[i].capacity = series_[i].stored = stored[i];
  petsc::agree(comm_, [&] {
    writing(path_, [&] {
      for (std::size_t i = 0; i < series_.size(); ++i) resize_series(draft_, series_[i].name, stored[i]);
    });
  });
  publish();
}

ResultFile::~ResultFile() {
  try {
    write_replicated();
  } catch (const RunError&) {
  }
  draft_ = Hid();
  std::error_code ignored;
  if (rank_ == 0) std::filesystem::remove(draft_of(path_), ignored);
}

}  // namespace floe::output
