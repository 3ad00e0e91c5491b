#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace floe::fuzz {

/// What a reader is fed with, as a file in memory with a path, for those who read files.
class File {
 public:
  File();
  File(const File&) = delete;
  ~File();
  void put(const std::uint8_t* data, std::size_t size);
  const std::string& path() const { return path_; }

 private:
  int descriptor_;
  std::string path_;
};

/// Reads; an InputError is an answer, with a text in each of its faults. Any other exception is a finding: it ends the
/// process.
void try_to(const std::function<void()>& read);

}  // namespace floe::fuzz
