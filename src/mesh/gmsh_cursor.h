#pragma once
#include "faults.h"
#include "mapped_file.h"

namespace floe::mesh {

/// Reads the numbers of a Gmsh file one after the other, the same way whether they are text or binary.
///
/// All functions throw InputError with the place where something else stands than what was expected.
class GmshCursor {
 public:
  explicit GmshCursor(const MappedFile& file);

  bool binary = false;
  bool swapped = false;  // the file's byte order is the other one
  int count_width = 8;   // bytes of a count in a binary file
  int label_width = 8;   // of a node's or element's number
  const char* at;
  const char* end;
  long long line = 1;  // of `at`, in a text file

  bool done();                            // nothing but blanks is left
  std::string_view word(const char* of);  // in text; `of` says what is expected
  long long integer(const char* of);      // 4 bytes in a binary file
  long long count(const char* of);        // count_width bytes; not negative
  double real();
  std::string_view rest_of_line();
  void skip_bytes(long long count, long long width, const char* of);
  void skip_lines(long long count, const char* of);
  void expect(const std::string& text);

  Where where(const char* place) const { return {0, binary ? place - begin_ : line}; }
  [[noreturn]] void refuse(const std::string& text) const;
  [[noreturn]] void refuse_at(const char* place, const std::string& text) const;

  /// A binary number at `place`, which must lie in the file.
  template <class Number>
  Number value(const char* place) const;
  long long count_at(const char* place, int width) const;

 private:
  void skip_blanks();
  const char* bytes(int width, const char* of);

  std::string path_;
  const char* begin_;
};

}  // namespace floe::mesh
