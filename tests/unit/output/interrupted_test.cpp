// What a run leaves that is killed: first between any two system calls that write, and in the middle of each; then for
// real.
#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <petscsys.h>
#include <spawn.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <csignal>
#include <functional>
#include <random>
#include <thread>

#include "floe/output/result_file.h"
#include "read_back.h"
#include "scratch.h"

using namespace floe::output;
namespace fs = std::filesystem;

namespace {

constexpr int columns = 3;
double number(hsize_t row, int column) { return 10.0 * static_cast<double>(row) + column + 0.5; }

std::vector<double> row_of(hsize_t row) {
  std::vector<double> all;
  for (int j = 0; j < columns; ++j) all.push_back(number(row, j));
  return all;
}

/// The file opens, what was written before the series is there, its first `rows` rows are right and all others right or
/// NaN.
void check_file(const fs::path& path, hsize_t rows) {
  const Hid file = open_plain(path.string());
  CHECK(read_back(file, "basis").data == std::vector<double>{1, 2, 3, 4});
  const ReadBack q = read_back(file, "q");
  REQUIRE(q.shape.at(0) >= rows);
  bool good = true;
  for (hsize_t i = 0; i < q.data.size(); ++i) {
    const double expected = number(i / columns, i % columns);
    good = good && (q.data[i] == expected || (i >= rows * columns && std::isnan(q.data[i])));
  }
  CHECK(good);
}

std::function<void()> watcher;  ///< called whenever the files have changed

void watch() {
  if (!watcher) return;
  auto now = std::exchange(watcher, {});
  now();
  watcher = std::move(now);
}

template <class Function>
Function* original(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// These stand before those of libc, also for HDF5 and MPI-IO.
extern "C" ssize_t pwrite(int file, const void* data, size_t size, off_t offset) {
  static const auto real = original<ssize_t(int, const void*, size_t, off_t)>("pwrite");
  if (watcher && size > 1) {
    const ssize_t half = real(file, data, size / 2, offset);
    watch();
    if (half < 0) return half;
  }
  const ssize_t written = real(file, data, size, offset);
  watch();
  return written;
}

extern "C" ssize_t pwritev(int file, const iovec* parts, int count, off_t offset) {
  static const auto real = original<ssize_t(int, const iovec*, int, off_t)>("pwritev");
  const ssize_t written = real(file, parts, count, offset);
  watch();
  return written;
}

extern "C" int ftruncate(int file, off_t size) noexcept {
  static const auto real = original<int(int, off_t)>("ftruncate");
  const int status = real(file, size);
  watch();
  return status;
}

TEST_CASE("between any two writes of a run, and amid each, the result file is whole") {
  const bool distributed = GENERATE(false, true);
  Scratch scratch;
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  const fs::path path = scratch / "result.h5";
  std::vector<std::pair<fs::path, hsize_t>> moments;
  hsize_t flushed = 0;
  {
    ResultFile file(PETSC_COMM_WORLD, path);
    file.write_array("basis", {2, 2}, std::vector<double>{1, 2, 3, 4});
    file.add_series("q", columns, {}, 1100);
    file.publish();
    watcher = [&] {
      const fs::path copy = scratch / fmt::format("{}-{}.h5", scratch.rank(), moments.size());
      fs::copy_file(path, copy);
      moments.emplace_back(copy, flushed);
    };
    for (hsize_t i = 0; i < 5000; ++i) {
      const auto row = row_of(i);
      if (distributed) {
        const std::size_t first = scratch.rank() < columns ? scratch.rank() : columns;
        const std::size_t count = scratch.rank() + 1 == size ? columns - first : (first < columns ? 1 : 0);
        file.append_distributed("q", first, std::span(row).subspan(first, count));
      } else {
        file.append("q", row);
      }
      if (i % 500 != 499) continue;
      file.flush();
      flushed = i + 1;
    }
    file.finish();
    watcher = {};
  }
  int seen = static_cast<int>(moments.size());
  MPI_Allreduce(MPI_IN_PLACE, &seen, 1, MPI_INT, MPI_SUM, PETSC_COMM_WORLD);
  CHECK(seen > 20);
  for (const auto& [copy, rows] : moments) check_file(copy, rows);
  meet();
  check_file(path, 5000);
  CHECK(read_back(open_plain(path.string()), "q").shape.at(0) == 5000);
}

// The victim: writes as fast as it can and tells how far it is, until it is killed. Hidden: started by the test below.
TEST_CASE("victim", "[.]") {
  const fs::path folder = std::getenv("FLOE_TEST_FOLDER");
  ResultFile file(PETSC_COMM_SELF, folder / "result.h5");
  file.write_array("basis", {2, 2}, std::vector<double>{1, 2, 3, 4});
  file.add_series("q", columns, {}, 16);
  file.publish();
  const int count = open((folder / "count").c_str(), O_WRONLY | O_CREAT, 0666);
  for (hsize_t i = 0; i < 3000000; ++i) {
    file.append("q", row_of(i));
    if (i % 20 != 19) continue;
    file.flush();
    const hsize_t rows = i + 1;
    REQUIRE(pwrite(count, &rows, sizeof rows, 0) == sizeof rows);
  }
}

namespace {

/// Starts this program's victim as a single process that knows nothing of the mpirun around it.
pid_t start_victim(const fs::path& folder) {
  std::vector<std::string> settings{"FLOE_TEST_FOLDER=" + folder.string(), "OMPI_MCA_ess_singleton_isolated=1"};
  for (char** each = environ; *each; ++each) {
    const std::string setting = *each;
    if (!setting.starts_with("OMPI_") && !setting.starts_with("PMIX_") && !setting.starts_with("PRTE_"))
      settings.push_back(setting);
  }
  std::vector<char*> environment;
  for (auto& setting : settings) environment.push_back(setting.data());
  environment.push_back(nullptr);
  std::string program = fs::read_symlink("/proc/self/exe").string(), name = "victim";
  char* arguments[] = {program.data(), name.data(), nullptr};
  pid_t victim = 0;
  REQUIRE(posix_spawn(&victim, program.c_str(), nullptr, nullptr, arguments, environment.data()) == 0);
  return victim;
}

hsize_t count_in(const fs::path& path) {
  hsize_t rows = 0;
  std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(&rows), sizeof rows);
  return rows;
}

}  // namespace

TEST_CASE("a run killed with SIGKILL leaves a file that opens with all batches in it") {
  Scratch scratch;
  if (scratch.rank() != 0) return;
  std::mt19937 random(7);
  for (int i = 0; i < 5; ++i) {
    const fs::path folder = scratch / std::to_string(i);
    fs::create_directory(folder);
    const pid_t victim = start_victim(folder);
    for (int wait = 0; wait < 3000 && count_in(folder / "count") == 0; ++wait)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::this_thread::sleep_for(std::chrono::microseconds(std::uniform_int_distribution(0, 300000)(random)));
    kill(victim, SIGKILL);
    int status = 0;
    waitpid(victim, &status, 0);
    REQUIRE((WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL));
    REQUIRE(count_in(folder / "count") > 0);
    check_file(folder / "result.h5", count_in(folder / "count"));
  }
}
