#include "floe/output/checkpoint_file.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <limits>

#include "floe/output/folder.h"
#include "floe/petsc/error.h"
#include "floe/version.h"
#include "reduced_file_hdf5.h"
#include "reduced_file_image.h"
#include "replaceable.h"

namespace floe::output {

using nlohmann::ordered_json;

namespace {

constexpr const char* format = "floe checkpoint";
constexpr int version = 7;

/// FNV-1a, 64 bits, of the index and the numbers.
std::int64_t checksum(const std::string& index, const std::vector<double>& data) {
  std::uint64_t sum = 0xcbf29ce484222325u;
  const auto add = [&](const void* bytes, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) sum = (sum ^ static_cast<const unsigned char*>(bytes)[i]) * 0x100000001b3u;
  };
  add(index.data(), index.size());
  add(data.data(), data.size() * sizeof(double));
  return static_cast<std::int64_t>(sum);
}

/// The numbers of all ranks one after another, on rank 0, and how many each has.
std::vector<double> gather(MPI_Comm comm, const std::vector<double>& own, std::vector<int>& counts) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  const int count = static_cast<int>(own.size());
  counts.resize(ranks);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, comm);
  std::vector<int> offsets(ranks, 0);
  for (int i = 1; i < ranks; ++i) offsets[i] = offsets[i - 1] + counts[i - 1];
  std::vector<double> all(static_cast<std::size_t>(offsets.back()) + counts.back());
  MPI_Gatherv(own.data(), count, MPI_DOUBLE, all.data(), counts.data(), offsets.data(), MPI_DOUBLE, 0, comm);
  return all;
}

std::string image(const std::string& index, const std::vector<double>& data) {
  Hid memory = create_image();
  write_attribute(memory, "format", format);
  write_flag(memory, "version", version);
  write_flag(memory, "checksum", checksum(index, data));
  write_text(memory, "index", index);
  write_whole<double>(memory, "data", {data.size()}, data, {"", "what the index names, one after another"});
  const std::vector<char> bytes = bytes_of(memory);
  return {bytes.begin(), bytes.end()};
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw InputError(fmt::format("{}: {}", path.string(), why));
}

struct Contents {
  ordered_json index;
  std::vector<double> data;
};

Contents read_alone(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    refuse(path, "does not exist: the run was made without --checkpoint, or ended before its first checkpoint");
  if (!is_of_format(path, format)) refuse(path, "is not a checkpoint of floe, or is damaged");
  std::ifstream file(path, std::ios::binary);
  std::vector<char> bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (!file) refuse(path, "cannot be read");
  Contents contents;
  try {
    const Hid memory = open_image(bytes);
    if (const std::int64_t found = read_flag(memory, "version"); found != version)
      refuse(path, fmt::format("is of version {}; expected {}", found, version));
    const std::string index = read_text(memory, "index");
    contents.data = read_whole<double>(memory, "data", {any});
    if (checksum(index, contents.data) != read_flag(memory, "checksum")) refuse(path, "is damaged (checksum)");
    contents.index = ordered_json::parse(index);
  } catch (const Fault& fault) {
    refuse(path, fmt::format("is damaged ({})", fault.what()));
  } catch (const RunError& error) {
    refuse(path, fmt::format("is damaged ({})", error.what()));
  } catch (const ordered_json::exception&) {
    refuse(path, "is damaged (index)");
  }
  if (const std::string by = contents.index.value("floe", ""); by != FLOE_VERSION)
    refuse(path, fmt::format("was written by floe {}; this is floe " FLOE_VERSION, by));
  return contents;
}

}  // namespace

void write_checkpoint(MPI_Comm comm, const std::filesystem::path& path, const Checkpoint& checkpoint) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  ordered_json index{{"floe", FLOE_VERSION}, {"ranks", ranks}, {"words", checkpoint.words}};
  std::vector<double> data;
  for (const auto& [name, numbers] : checkpoint.shared) {
    index["shared"].push_back({{"name", name}, {"count", numbers.size()}});
    data.insert(data.end(), numbers.begin(), numbers.end());
  }
  for (const auto& [name, numbers] : checkpoint.own) {
    std::vector<int> counts;
    const std::vector<double> all = gather(comm, numbers, counts);
    index["own"].push_back({{"name", name}, {"counts", counts}});
    if (rank == 0) data.insert(data.end(), all.begin(), all.end());
  }
  petsc::agree_if_parallel(comm, ranks == 1, [&] {
    if (rank == 0) write_file_atomically(path, image(index.dump(), data));
  });
}

Checkpoint read_checkpoint(MPI_Comm comm, const std::filesystem::path& path) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  Contents contents;
  std::string text;
  petsc::agree(comm, [&] {
    if (rank != 0) return;
    contents = read_alone(path);
    text = contents.index.dump();
    const int wrote = contents.index["ranks"];
    if (wrote != 1 && wrote != ranks)
      refuse(path, fmt::format("was written on {} ranks, and this run has {}; expected the same number", wrote, ranks));
    if (contents.data.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()) ||
        text.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
      refuse(path, "is too large");
  });
  int sizes[2] = {static_cast<int>(text.size()), static_cast<int>(contents.data.size())};
  MPI_Bcast(sizes, 2, MPI_INT, 0, comm);
  text.resize(sizes[0]), contents.data.resize(sizes[1]);
  MPI_Bcast(text.data(), sizes[0], MPI_CHAR, 0, comm);
  MPI_Bcast(contents.data.data(), sizes[1], MPI_DOUBLE, 0, comm);
  contents.index = ordered_json::parse(text);
  Checkpoint checkpoint{contents.index["words"], {}, {}};
  auto next = contents.data.begin();
  for (const auto& each : contents.index["shared"]) {
    const std::ptrdiff_t count = each["count"];
    checkpoint.shared[each["name"]].assign(next, next + count);
    next += count;
  }
  for (const auto& each : contents.index["own"]) {
    const std::vector<std::ptrdiff_t> counts = each["counts"];
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (counts.size() == 1 || static_cast<int>(i) == rank)
        checkpoint.own[each["name"]].assign(next, next + counts[i]);
      next += counts[i];
    }
  }
  return checkpoint;
}

}  // namespace floe::output
