#include "gmsh_cursor.h"

#include <algorithm>
#include <cstdint>

#include "floe/error.h"
#include "text.h"

namespace floe::mesh {

GmshCursor::GmshCursor(const MappedFile& file)
    : at(file.text().data()), end(at + file.text().size()), path_(file.path()), begin_(at) {}

void GmshCursor::refuse_at(const char* place, const std::string& text) const {
  Faults here(binary);
  here.add_file(path_);
  throw InputError(here.text_of(where(place)) + ": " + text);
}

void GmshCursor::refuse(const std::string& text) const { refuse_at(at, text); }

void GmshCursor::skip_blanks() {
  for (; at != end && is_blank(*at); ++at) line += *at == '\n';
}

bool GmshCursor::done() {
  skip_blanks();
  return at == end;
}

std::string_view GmshCursor::word(const char* of) {
  skip_blanks();
  if (at == end) refuse(std::string("the file ends where ") + of + " was expected");
  const char* begin = at;
  while (at != end && !is_blank(*at)) ++at;
  return {begin, static_cast<std::size_t>(at - begin)};
}

std::string_view GmshCursor::rest_of_line() {
  const auto text = next_line(at, end);
  ++line;
  return text;
}

template <class Number>
Number GmshCursor::value(const char* place) const {
  char bytes[sizeof(Number)];
  std::memcpy(bytes, place, sizeof(Number));
  if (swapped) std::reverse(bytes, bytes + sizeof(Number));
  Number result;
  std::memcpy(&result, bytes, sizeof(Number));
  return result;
}
template double GmshCursor::value<double>(const char*) const;
template std::int32_t GmshCursor::value<std::int32_t>(const char*) const;

long long GmshCursor::count_at(const char* place, int width) const {
  return width == 4 ? value<std::uint32_t>(place) : static_cast<long long>(value<std::uint64_t>(place));
}

const char* GmshCursor::bytes(int width, const char* of) {
  if (end - at < width) refuse(std::string("the file ends where ") + of + " was expected");
  return std::exchange(at, at + width);
}

long long GmshCursor::integer(const char* of) {
  if (binary) return value<std::int32_t>(bytes(4, of));
  const auto text = word(of);
  const auto read = number<long long>(text);
  if (!read) refuse(std::string("expected ") + of + ", found " + in_quotes(text));
  return *read;
}

long long GmshCursor::count(const char* of) {
  const char* place = at;
  const long long read = binary ? count_at(bytes(count_width, of), count_width) : integer(of);
  if (read < 0) refuse_at(place, std::string(of) + " is negative: " + std::to_string(read));
  return read;
}

double GmshCursor::real() {
  if (binary) return value<double>(bytes(8, "a real number"));
  const auto text = word("a real number");
  const auto read = number<double>(text);
  if (!read) refuse("expected a real number, found " + in_quotes(text));
  return *read;
}

void GmshCursor::skip_bytes(long long count, long long width, const char* of) {
  if (count > (end - at) / width)
    refuse("expected " + std::to_string(count) + " " + of + ", but the rest of the file has room for " +
           std::to_string((end - at) / width) + " only");
  at += count * width;
}

void GmshCursor::skip_lines(long long count, const char* of) {
  for (long long i = 0; i < count; ++i) {
    if (at == end || *at == '$')
      refuse("expected " + std::to_string(count) + " " + of + ", found " + std::to_string(i) + " before the " +
             (at == end ? "file" : "section") + " ends");
    const void* feed = std::memchr(at, '\n', static_cast<std::size_t>(end - at));
    at = feed ? static_cast<const char*>(feed) + 1 : end;
    ++line;
  }
}

void GmshCursor::expect(const std::string& text) {
  const std::string name = "'" + text + "'";
  skip_blanks();
  const char* place = at;
  const auto found = word(name.c_str());
  if (found != text) refuse_at(place, "expected " + name + ", found " + in_quotes(found));
}

}  // namespace floe::mesh
