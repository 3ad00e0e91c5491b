#include "floe/output/claim.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "floe/output/folder.h"
#include "floe/petsc/error.h"
#include "floe/petsc/rank.h"

namespace floe::output {
namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

std::string contents(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string first_line(const fs::path& path) {
  const std::string text = contents(path);
  return text.substr(0, text.find('\n'));
}

/// A word of a process's stat, from 1; empty: there is none of this number.
std::string word_of(std::int64_t pid, int number) {
  const std::string text = first_line(fmt::format("/proc/{}/stat", pid));
  std::size_t at = text.rfind(')');  // of its name, the second one, which may hold anything
  for (int word = 2; word < number && at != std::string::npos; ++word) at = text.find(' ', at + 1);
  return at == std::string::npos ? "" : text.substr(at + 1, text.find(' ', at + 1) - at - 1);
}

/// Ticks since the boot when it began.
std::string start_of(std::int64_t pid) { return word_of(pid, 22); }

/// It has ended, and whoever started it has not asked for its code.
bool is_zombie(std::int64_t pid) { return word_of(pid, 3) == "Z"; }

/// What numbers of processes belong to.
ordered_json place() {
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  std::error_code ignored;
  return {{"host", host},
          {"boot", first_line("/proc/sys/kernel/random/boot_id")},
          {"processes", fs::read_symlink("/proc/self/ns/pid", ignored).string()}};
}

ordered_json myself() {
  ordered_json j = place();
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  j["pid"] = getpid();
  j["began"] = start_of(getpid());
  j["since"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
  return j;
}

/// Who holds a lock; none: it cannot be read.
std::optional<ordered_json> holder(const fs::path& lock) {
  const ordered_json j = ordered_json::parse(contents(lock), nullptr, false);
  for (const char* key : {"host", "boot", "processes", "began", "since"})
    if (!j.is_object() || !j.contains(key) || !j[key].is_string()) return {};
  if (!j.contains("pid") || !j["pid"].is_number_integer()) return {};
  return j;
}

bool of_this_machine(const ordered_json& who) {
  const ordered_json here = place();
  return who["host"] == here["host"] && who["boot"] == here["boot"] && who["processes"] == here["processes"];
}

/// Whether the process is known to be no more.
bool gone(const ordered_json& who) {
  const ordered_json here = place();
  if (who["host"] != here["host"]) return false;
  if (who["boot"] != here["boot"]) return !here["boot"].get<std::string>().empty();  // the machine was started anew
  if (who["processes"] != here["processes"]) return false;  // a container: its numbers are others
  const std::int64_t pid = who["pid"];
  if (kill(static_cast<pid_t>(pid), 0) != 0 && errno == ESRCH) return true;
  if (is_zombie(pid)) return true;
  const std::string began = start_of(pid);
  return !began.empty() && began != who["began"].get<std::string>();
}

[[noreturn]] void refuse(const fs::path& lock, const std::string& what, const std::optional<ordered_json>& who) {
  if (!who)
    throw InputError(fmt::format(
        "{}: {}, the lock of a running floe, cannot be read; remove it if no floe writes there", what, lock.string()));
  const std::string process =
      fmt::format("{}: floe writes there (process {} on {}, since {})", what, (*who)["pid"].get<std::int64_t>(),
                  (*who)["host"].get<std::string>(), (*who)["since"].get<std::string>());
  if (of_this_machine(*who)) throw InputError(process + "; expected another place, or the end of that process");
  throw InputError(
      fmt::format("{}; expected another place, or the end of that process; if it no longer exists, remove {}", process,
                  lock.string()));
}

/// Takes the place of a lock whose holder is gone. @return  whether it is ours now; else it has changed
bool commit_step(const fs::path& lock, const fs::path& mine) {
  const int file = open(lock.c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0) return false;
  struct stat opened {
  }, there{};
  bool taken = false;
  if (flock(file, LOCK_EX) == 0 && fstat(file, &opened) == 0 && stat(lock.c_str(), &there) == 0 &&
      opened.st_ino == there.st_ino && opened.st_dev == there.st_dev) {
    const std::optional<ordered_json> who = holder(lock);
    taken = who && gone(*who) && std::rename(mine.c_str(), lock.c_str()) == 0;
  }
  close(file);  // and with it the flock
  return taken;
}

/// Makes the lock out of `mine`. @return  whether it was not there
bool make(const fs::path& lock, const fs::path& mine) {
  if (link(mine.c_str(), lock.c_str()) == 0) return true;
  if (errno == EEXIST) return false;
  // no links here: whoever creates the file, writes it
  const int file = open(lock.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0 && errno == EEXIST) return false;
  if (file < 0) throw RunError(fmt::format("cannot write {}: {}", lock.string(), std::strerror(errno)));
  const std::string text = contents(mine);
  const bool written = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  if (close(file) == 0 && written) return true;
  unlink(lock.c_str());
  throw RunError(fmt::format("cannot write {}", lock.string()));
}

}  // namespace

struct Claim::Held {
  fs::path lock;
  std::string text;
  bool released = false;

  void release() noexcept {
    if (released) return;
    released = true;
    try {
      if (contents(lock) == text) unlink(lock.c_str());
    } catch (const std::exception&) {  // it is known to be stale when this process is gone
    }
  }
  ~Held() { release(); }
};

void Claim::release() const noexcept {
  if (held_) held_->release();
}

Claim claim_at(const fs::path& lock, const std::string& what) {
  const ordered_json me = myself();
  const std::string text = me.dump() + "\n";
  const fs::path mine = fmt::format("{}.{}-{}", lock.string(), me["host"].get<std::string>(), getpid());
  write_file_atomically(mine, text);
  struct Remove {
    const fs::path& path;
    ~Remove() { unlink(path.c_str()); }
  } const remove{mine};
  std::optional<ordered_json> who;
  for (int attempt = 0; attempt < 100; ++attempt) {
    bool taken = make(lock, mine);
    if (!taken) {
      who = holder(lock);
      if (who && of_this_machine(*who) && (*who)["pid"] == me["pid"] && (*who)["began"] == me["began"]) return {};
      if (who && !gone(*who)) refuse(lock, what, who);
      taken = who && commit_step(lock, mine);
    }
    if (taken) {
      Claim claim;
      claim.held_ = std::make_shared<Claim::Held>(fs::absolute(lock), text);
      return claim;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));  // it is just written, or removed
  }
  refuse(lock, what, who);
}

Claim claim_file(MPI_Comm comm, const fs::path& path) {
  Claim claim;
  petsc::agree(comm, [&] {
    if (petsc::rank_of(comm) != 0) return;
    const std::string what = fmt::format("output file '{}'", path.string());
    try {
      claim = claim_at(path.parent_path() / fmt::format(".{}.lock", path.filename().string()), what);
    } catch (const RunError&) {  // whoever looks whether the file can be written says it in its words
    }
  });
  return claim;
}

}  // namespace floe::output
