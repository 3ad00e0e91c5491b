#include "reserve.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "floe/error.h"

namespace floe::output {

void reserve(const std::filesystem::path& path, std::uint64_t dataset) {
  constexpr std::uint64_t description = 1 << 16;
  const int file = open(path.c_str(), O_RDWR | O_CLOEXEC);
  const int fault =
      file < 0 ? errno : posix_fallocate(file, lseek(file, 0, SEEK_END), static_cast<off_t>(dataset + description));
  if (file >= 0) close(file);
  if (fault != 0) throw RunError(fmt::format("cannot write {}: {}", path.string(), std::strerror(fault)));
}

}  // namespace floe::output
