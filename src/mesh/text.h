#pragma once
#include <charconv>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace floe::mesh {

/// The line that begins at `at`, without its end (LF or CR LF); `at` moves to the next.
inline std::string_view next_line(const char*& at, const char* end) {
  const char* begin = at;
  const char* feed = static_cast<const char*>(std::memchr(at, '\n', static_cast<std::size_t>(end - at)));
  const char* last = feed ? feed : end;
  at = feed ? feed + 1 : end;
  if (last > begin && last[-1] == '\r') --last;
  return {begin, static_cast<std::size_t>(last - begin)};
}

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

inline std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// The next word between blanks; empty at the end. `text` loses it.
inline std::string_view next_word(std::string_view& text) {
  std::size_t begin = 0;
  while (begin < text.size() && is_blank(text[begin])) ++begin;
  std::size_t end = begin;
  while (end < text.size() && !is_blank(text[end])) ++end;
  const auto word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

/// The number that the whole of `word` is.
template <class Number>
std::optional<Number> number(std::string_view word) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  Number value;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// A number that may have the exponent of Fortran: 1.0d0, and, where `bare`, 1.5+3 for 1.5e3.
std::optional<double> fortran_number(std::string_view word, bool bare = false);

/// In upper case (ASCII).
std::string upper(std::string_view text);

/// For a message: in quotes, what cannot be printed as '?', cut after 40 characters.
std::string in_quotes(std::string_view text);

/// ", did you mean ...?" with the word of `known` that is nearest to `word`, or nothing.
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

/// `1 line`, `2 lines`.
std::string counted(long long count, const char* one);

/// "a, b, c".
std::string listed(const std::vector<std::string>& words);

}  // namespace floe::mesh
