#include "floe/output/matrix_market.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <tuple>

#include "floe/petsc/error.h"
#include "writing.h"

namespace floe::output {

using petsc::check;

namespace {

/// Of the lower triangle, by numbers of the file.
struct Entry {
  std::int64_t column, row;
  double value;
};

/// `numbers` of all ranks' rows, in their global order.
std::vector<std::int64_t> of_all(MPI_Comm comm, const std::vector<std::int64_t>& numbers) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  const int mine = static_cast<int>(numbers.size());
  std::vector<int> counts(ranks), from(ranks);
  MPI_Allgather(&mine, 1, MPI_INT, counts.data(), 1, MPI_INT, comm);
  for (int r = 1; r < ranks; ++r) from[r] = from[r - 1] + counts[r - 1];
  std::vector<std::int64_t> all(from.back() + counts.back());
  MPI_Allgatherv(numbers.data(), mine, MPI_INT64_T, all.data(), counts.data(), from.data(), MPI_INT64_T, comm);
  return all;
}

/// Of this rank's rows. MATSBAIJ has the upper triangle, and whole blocks on the diagonal.
std::vector<Entry> entries(Mat A, const std::vector<std::int64_t>& number) {
  std::vector<Entry> found;
  PetscInt first = 0, end = 0;
  check(MatGetOwnershipRange(A, &first, &end));
  check(MatGetRowUpperTriangular(A));
  for (PetscInt i = first; i < end; ++i) {
    PetscInt count = 0;
    const PetscInt* columns = nullptr;
    const PetscScalar* values = nullptr;
    check(MatGetRow(A, i, &count, &columns, &values));
    for (PetscInt c = 0; c < count && number[i] >= 0; ++c) {
      const PetscInt j = columns[c];
      if (j < i || number[j] < 0 || values[c] == 0) continue;
      found.push_back({std::min(number[i], number[j]), std::max(number[i], number[j]), values[c]});
    }
    check(MatRestoreRow(A, i, &count, &columns, &values));
  }
  check(MatRestoreRowUpperTriangular(A));
  return found;
}

/// Those of all ranks on the first, in the order of the file.
std::vector<Entry> on_first_rank(MPI_Comm comm, const std::vector<Entry>& mine) {
  int ranks = 1, rank = 0;
  MPI_Comm_size(comm, &ranks);
  MPI_Comm_rank(comm, &rank);
  std::int64_t total = std::ssize(mine);
  MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPI_INT64_T, MPI_SUM, comm);
  if (total > std::numeric_limits<int>::max())
    throw InputError(fmt::format("a matrix of {} entries is too large for Matrix Market files", total));
  const int count = static_cast<int>(mine.size());
  std::vector<int> counts(ranks), from(ranks);
  MPI_Gather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, comm);
  for (int r = 1; r < ranks; ++r) from[r] = from[r - 1] + counts[r - 1];
  std::vector<Entry> all(rank == 0 ? total : 0);
  MPI_Datatype one;
  MPI_Type_contiguous(sizeof(Entry), MPI_BYTE, &one);
  MPI_Type_commit(&one);
  MPI_Gatherv(mine.data(), count, one, all.data(), counts.data(), from.data(), one, 0, comm);
  MPI_Type_free(&one);
  std::sort(all.begin(), all.end(),
            [](const Entry& a, const Entry& b) { return std::tie(a.column, a.row) < std::tie(b.column, b.row); });
  return all;
}

void put(std::ofstream& file, const fmt::memory_buffer& text) {
  if (!file.write(text.data(), static_cast<std::streamsize>(text.size()))) throw RunError(std::strerror(errno));
}

void write_text(const std::filesystem::path& path, std::int64_t rows, const std::vector<Entry>& all,
                const std::vector<std::string>& comments) {
  constexpr std::size_t piece = 1 << 20;
  std::ofstream file(path, std::ios::binary);
  if (!file) throw RunError(std::strerror(errno));
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "%%MatrixMarket matrix coordinate real symmetric\n");
  for (const std::string& comment : comments) fmt::format_to(out, "% {}\n", comment);
  fmt::format_to(out, "{} {} {}\n", rows, rows, all.size());
  for (const Entry& entry : all) {
    fmt::format_to(out, "{} {} {}\n", entry.row + 1, entry.column + 1, entry.value);
    if (text.size() < piece) continue;
    put(file, text);
    text.clear();
  }
  put(file, text);
  file.close();
  if (!file) throw RunError(std::strerror(errno));
}

}  // namespace

void write_matrix_market(Mat A, const std::vector<std::int64_t>& numbers, std::int64_t rows,
                         const std::filesystem::path& path, const std::vector<std::string>& comments) {
  const MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(A));
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const std::vector<Entry> all = on_first_rank(comm, entries(A, of_all(comm, numbers)));
  petsc::agree(comm, [&] {
    if (rank != 0) return;
    const std::filesystem::path draft = draft_of(path);
    try {
      writing(path, [&] { write_text(draft, rows, all, comments), publish_draft(draft, path); });
    } catch (const RunError& fault) {
      std::error_code ignored;
      std::filesystem::remove(draft, ignored);
      throw RunError(with_name(fault.what(), path));
    }
  });
}

}  // namespace floe::output
