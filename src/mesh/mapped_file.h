#pragma once
#include <string>
#include <string_view>

namespace floe::mesh {

/// A file in memory, read by the pages that are touched; this rank's own.
class MappedFile {
 public:
  /// @throws InputError  where the file is missing, cannot be read, is no file or is empty
  explicit MappedFile(const std::string& path);
  MappedFile(MappedFile&& other) noexcept;
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  const std::string& path() const { return path_; }
  /// Without the mark of UTF-8 at its beginning.
  std::string_view text() const { return text_.substr(text_.starts_with("\xEF\xBB\xBF") ? 3 : 0); }

 private:
  std::string path_;
  std::string_view text_;
};

}  // namespace floe::mesh
