#include "floe/output/series_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "floe/petsc/error.h"

namespace floe::output {
namespace {
constexpr std::size_t rows_at_most = 1000;
constexpr std::chrono::seconds wait_at_most{1};

std::string header_of(const std::vector<SeriesColumn>& columns, const std::string& time_unit) {
  std::string header = fmt::format("t [{}]", time_unit);
  for (const auto& column : columns) header += fmt::format(",{} [{}]", column.name, column.unit);
  return header + '\n';
}

std::vector<double> numbers_of(std::string_view line, std::size_t count) {
  std::vector<double> numbers(count);
  const char *next = line.data(), *end = next + line.size();
  for (double& number : numbers) {
    const auto [stop, fault] = std::from_chars(next, end, number);
    if (fault != std::errc() || (stop != end && *stop != ',')) return {};
    next = stop == end ? end : stop + 1;
  }
  return numbers;
}

/// How many bytes the header and the first rows take. @throws RunError
std::size_t read_rows(const std::string& path, const std::string& header, std::size_t columns, std::size_t keep,
                      std::vector<std::vector<double>>& rows) {
  std::ifstream file(path, std::ios::binary);
  const auto refuse = [&](const std::string& why) { throw RunError(fmt::format("{}: {}", path, why)); };
  if (!file) refuse("cannot be read");
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (!text.starts_with(header)) refuse("is not that of the run: its header is another");
  std::size_t at = header.size();
  for (std::size_t i = 0; i < keep; ++i) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) refuse(fmt::format("has {} rows, and the checkpoint comes after {}", i, keep));
    rows.push_back(numbers_of(std::string_view(text).substr(at, end - at), columns + 1));
    if (rows.back().empty()) refuse(fmt::format("row {} cannot be read", i + 1));
    at = end + 1;
  }
  return at;
}

}  // namespace

SeriesFile::SeriesFile(MPI_Comm comm, const std::filesystem::path& path, const std::vector<SeriesColumn>& columns,
                       const std::string& time_unit)
    : comm_(comm), path_(path.string()), columns_(columns.size()) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  petsc::agree(comm, [&] {
    if (rank != 0) return;
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor_ < 0) throw RunError(fmt::format("cannot write {}: {}", path_, std::strerror(errno)));
    pending_ = header_of(columns, time_unit);
    write();
  });
}

SeriesFile::SeriesFile(MPI_Comm comm, const std::filesystem::path& path, const std::vector<SeriesColumn>& columns,
                       std::size_t keep, std::vector<std::vector<double>>& rows, const std::string& time_unit)
    : comm_(comm), path_(path.string()), columns_(columns.size()) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  petsc::agree(comm, [&] {
    if (rank != 0) return;
    const std::size_t size = read_rows(path_, header_of(columns, time_unit), columns_, keep, rows);
    descriptor_ = open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (descriptor_ < 0 || ftruncate(descriptor_, static_cast<off_t>(size)) != 0)
      throw RunError(fmt::format("cannot write {}: {}", path_, std::strerror(errno)));
  });
  written_ = std::chrono::steady_clock::now();
  rows.resize(keep, std::vector<double>(columns_ + 1));
  for (auto& row : rows) MPI_Bcast(row.data(), static_cast<int>(row.size()), MPI_DOUBLE, 0, comm);
}

void SeriesFile::save() {
  if (descriptor_ < 0) return;
  write();
  if (fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS)
    throw RunError(fmt::format("cannot write {}: {}", path_, std::strerror(errno)));
}

SeriesFile::~SeriesFile() {
  if (descriptor_ < 0) return;
  try {
    write();
  } catch (const RunError&) {
  }
  close(descriptor_);
}

void SeriesFile::row(double t, std::span<const double> values) {
  if (descriptor_ < 0) return;
  if (values.size() != columns_)
    throw std::invalid_argument(fmt::format("{}: {} values for {} columns", path_, values.size(), columns_));
  auto out = std::back_inserter(pending_);
  fmt::format_to(out, "{}", t);
  for (const double value : values) fmt::format_to(out, ",{}", value);
  pending_ += '\n';
  if (++pending_rows_ >= rows_at_most || std::chrono::steady_clock::now() - written_ > wait_at_most) write();
}

/// Takes the line that was written in part back out of the file, which holds the first `written` bytes of what waits.
void SeriesFile::keep_whole_lines(std::size_t written) {
  const std::size_t lines = written == 0 ? 0 : pending_.rfind('\n', written - 1) + 1;  // npos + 1: none
  const off_t size = lseek(descriptor_, 0, SEEK_END);
  const bool cut = written == lines || ftruncate(descriptor_, size - static_cast<off_t>(written - lines)) == 0;
  pending_.erase(0, cut ? lines : written);
}

void SeriesFile::write() {
  const char* next = pending_.data();
  const char* end = next + pending_.size();
  while (next < end) {
    const ssize_t written = ::write(descriptor_, next, end - next);
    if (written < 0 && errno != EINTR) {
      const int reason = errno;
      keep_whole_lines(next - pending_.data());
      throw RunError(fmt::format("cannot write {}: {}", path_, std::strerror(reason)));
    }
    if (written > 0) next += written;
  }
  pending_.clear();
  pending_rows_ = 0;
  written_ = std::chrono::steady_clock::now();
}

void SeriesFile::finish() {
  petsc::agree(comm_, [&] {
    if (descriptor_ < 0) return;
    write();
    if (close(std::exchange(descriptor_, -1)) != 0)
      throw RunError(fmt::format("cannot write {}: {}", path_, std::strerror(errno)));
  });
}

}  // namespace floe::output
