#include "mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "floe/error.h"

namespace floe::mesh {
namespace {

struct Descriptor {
  int number;
  ~Descriptor() {
    if (number >= 0) close(number);
  }
};

}  // namespace

MappedFile::MappedFile(const std::string& path) : path_(path) {
  const Descriptor file{open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.number < 0) throw InputError(path + ": cannot be opened: " + std::strerror(errno));
  struct stat status;
  if (fstat(file.number, &status) != 0) throw InputError(path + ": cannot be read: " + std::strerror(errno));
  if (!S_ISREG(status.st_mode)) throw InputError(path + ": is not a file");
  if (status.st_size == 0) throw InputError(path + ": is empty");
  const auto size = static_cast<std::size_t>(status.st_size);
  void* begin = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.number, 0);
  if (begin == MAP_FAILED) throw InputError(path + ": cannot be read: " + std::strerror(errno));
  text_ = {static_cast<const char*>(begin), size};
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : path_(std::move(other.path_)), text_(std::exchange(other.text_, {})) {}

MappedFile::~MappedFile() {
  if (!text_.empty()) munmap(const_cast<char*>(text_.data()), text_.size());
}

}  // namespace floe::mesh
