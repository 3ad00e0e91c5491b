#include "floe/output/folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "floe/petsc/error.h"
#include "replaceable.h"

namespace floe::output {
namespace fs = std::filesystem;
namespace {

/// Of floe's runs and comparisons. The first of each says whose the others are, and goes last.
const std::vector<std::vector<std::string>> results = {
    {"summary.json", "probes.csv", "result.h5", "campbell.csv", "checkpoint.h5", "sweep.h5", "sweep.csv", "sweep.png",
     "motion.h5", "motion.xdmf", "stress.h5", "stress.xdmf", "stress.csv", "report.html"},
    {"compare.json", "compare.md", "compare.csv", "compare.png", "compare.svg", "compare.pdf"},
    {"tradeoff.json", "tradeoff.md", "tradeoff.csv", "tradeoff.png"}};

[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
  throw InputError(fmt::format("output folder '{}': {}", path.string(), why));
}

bool of_floe(const fs::path& path, const fs::path& mark) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored) || !is_own_json(mark)) return false;
  if (path.extension() == ".xdmf") return is_own_xdmf(path);
  if (path.extension() == ".html") return is_own_page(path);
  return path.extension() != ".csv" || path.stem() != "probes" || is_series(path);
}

bool numbers(std::string_view text) { return !text.empty() && text.find_first_not_of("0123456789-.") == text.npos; }

/// Whether MPI writes such a file beside `name` while that is open, and leaves it where it is killed: Open MPI's
/// NAME-JOB-PROCESS.lock and NAME.locktest.RANK.
bool beside(std::string_view file, std::string_view name) {
  if (!file.starts_with(name)) return false;
  file.remove_prefix(name.size());
  constexpr std::string_view lock = ".lock", test = ".locktest.";
  if (file.starts_with(test)) return numbers(file.substr(test.size()));
  return file.starts_with('-') && file.ends_with(lock) && numbers(file.substr(0, file.size() - lock.size()));
}

/// What a killed run leaves of these results besides themselves: drafts, drafts of drafts, and what MPI has beside
/// them.
std::vector<fs::path> left_over(const fs::path& folder, const std::vector<std::string>& names) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string file = entry.path().filename().string();
    const bool left = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      const std::string draft = draft_of(name).string();
      return beside(file, name) || file == draft || beside(file, draft) || file == draft_of(draft).string();
    });
    if (left && fs::is_regular_file(entry.symlink_status(error))) files.push_back(entry.path());
  }
  return files;
}

/// Floe's own results in the folder, and what killed runs left of them. @throws InputError  a file of that name is not
/// floe's
std::vector<fs::path> own_results(const fs::path& folder) {
  std::vector<fs::path> own;
  for (const auto& names : results) {
    const std::vector<fs::path> left = left_over(folder, names);
    own.insert(own.end(), left.begin(), left.end());
    for (auto name = names.rbegin(); name != names.rend(); ++name) {
      const fs::path file = folder / *name;
      std::error_code ignored;
      if (!fs::exists(fs::symlink_status(file, ignored))) continue;
      if (!of_floe(file, folder / names.front()))
        refuse(folder,
               fmt::format("{} in it is not a result of floe; use another folder, or move the file away", *name));
      own.push_back(file);
    }
  }
  return own;
}

constexpr const char* lock_name = ".floe.lock";

/// @throws InputError  another process writes there, or it is not writable
Claim claim_folder(const fs::path& path) {
  try {
    return claim_at(path / lock_name, fmt::format("output folder '{}'", path.string()));
  } catch (const RunError& fault) {
    refuse(path, fmt::format("is not writable: {}", fault.what()));
  }
}

/// Whether there is nothing in it but locks. @throws InputError
bool is_free(const fs::path& path) {
  std::error_code error;
  fs::directory_iterator entries(path, error);
  if (error) refuse(path, "cannot be read: " + error.message());
  return std::all_of(begin(entries), end(entries), [](const fs::directory_entry& entry) {
    return entry.path().filename().string().find(lock_name) != std::string::npos;
  });
}

std::vector<fs::path> prepare(const fs::path& path, bool overwrite, Claim& claim) {
  if (path.empty()) refuse(path, "needs a name");
  std::error_code error;
  const auto status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_directory(status)) refuse(path, "exists and is not a folder");
  fs::create_directories(path, error);
  if (error) refuse(path, "cannot be made: " + error.message());
  claim = claim_folder(path);
  if (!overwrite && !is_free(path))
    refuse(path, "is not empty; use another name, or replace the results in it with --force");
  return own_results(path);
}

/// The first of a path's folders that does not exist; empty if all do.
fs::path first_missing(fs::path path) {
  if (!path.has_filename()) path = path.parent_path();
  fs::path missing;
  for (std::error_code error; !path.empty() && !fs::exists(path, error); path = path.parent_path()) missing = path;
  return missing;
}

[[noreturn]] void cannot_write(const fs::path& path) {
  throw RunError(fmt::format("cannot write {}: {}", path.string(), std::strerror(errno)));
}

void write_all(const fs::path& path, std::string_view text) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) cannot_write(path);
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written < 0 && errno != EINTR) {
      const int reason = errno;
      close(file);
      errno = reason;
      cannot_write(path);
    }
    if (written > 0) text.remove_prefix(written);
  }
  if (close(file) != 0) cannot_write(path);
}

void sync(const fs::path& path, int flags) {
  const int file = open(path.c_str(), flags | O_CLOEXEC);
  if (file < 0) cannot_write(path);
  const bool synced = fsync(file) == 0 || errno == EINVAL || errno == EROFS;
  const int reason = errno;
  close(file);
  errno = reason;
  if (!synced) cannot_write(path);
}

}  // namespace

ResultFolder reopen_folder(MPI_Comm comm, const fs::path& path) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  ResultFolder folder{path};
  petsc::agree(comm, [&] {
    if (rank != 0) return;
    std::error_code error;
    if (!fs::is_directory(path, error)) refuse(path, "does not exist; expected the results of a run with --checkpoint");
    folder.claim = claim_folder(path);
  });
  return folder;
}

void remove_drafts(MPI_Comm comm, const ResultFolder& folder) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  petsc::agree(comm, [&] {
    if (rank != 0) return;
    for (const fs::path& file : left_over(folder.path, results.front())) {
      std::error_code error;
      fs::remove(file, error);
    }
  });
}

ResultFolder prepare_folder(MPI_Comm comm, const fs::path& path, bool overwrite) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  ResultFolder folder{path};
  petsc::agree(comm, [&] {
    if (rank != 0) return;
    folder.made = first_missing(path);
    folder.replaces = prepare(path, overwrite, folder.claim);
  });
  return folder;
}

void remove_replaced(MPI_Comm comm, const ResultFolder& folder) {
  petsc::agree(comm, [&] {
    std::error_code error;
    for (const fs::path& old : folder.replaces)
      if (!fs::remove(old, error) && error)
        throw RunError(fmt::format("cannot remove {}: {}", old.string(), error.message()));
  });
}

void discard_if_empty(const ResultFolder& folder) noexcept {
  folder.claim.release();
  if (folder.made.empty()) return;
  for (fs::path path = folder.path; rmdir(path.c_str()) == 0 && path != folder.made;) path = path.parent_path();
}

fs::path draft_of(const fs::path& path) {
  return path.parent_path() / fmt::format(".{}.partial", path.filename().string());
}

void sync_file(const fs::path& path) { sync(path, O_RDWR); }

void publish_draft(const fs::path& draft, const fs::path& path) {
  sync(draft, O_RDWR);
  if (std::rename(draft.c_str(), path.c_str()) != 0) cannot_write(path);
  sync(path.has_parent_path() ? path.parent_path() : fs::path("."), O_RDONLY | O_DIRECTORY);
}

void write_file_atomically(const fs::path& path, std::string_view text) {
  const fs::path draft = draft_of(path);
  try {
    write_all(draft, text);
    publish_draft(draft, path);
  } catch (const RunError&) {
    std::error_code ignored;
    fs::remove(draft, ignored);
    throw;
  }
}

}  // namespace floe::output
