#include "text.h"

#include <cctype>

#include "floe/math/nearest.h"

namespace floe::mesh {

std::string upper(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return result;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t most = 40;
  std::string result = "'";
  for (const char c : text.substr(0, most)) result += std::isprint(static_cast<unsigned char>(c)) ? c : '?';
  return result + (text.size() > most ? "...'" : "'");
}

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = math::nearest(word, known);
  return near.empty() ? "" : ", did you mean " + near + "?";
}

std::optional<double> fortran_number(std::string_view word, bool bare) {
  if (const auto plain = number<double>(word)) return plain;
  constexpr std::size_t longest = 64;
  if (word.size() > longest) return std::nullopt;
  std::string text(word);
  const auto letter = text.find_first_of("dD");
  const auto sign = text.find_last_of("+-");
  if (letter != std::string::npos)
    text[letter] = 'e';
  else if (bare && sign != std::string::npos && sign > 0 && text.find_first_of("eE") == std::string::npos)
    text.insert(sign, "e");
  else
    return std::nullopt;
  return number<double>(text);
}

std::string counted(long long count, const char* one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

std::string listed(const std::vector<std::string>& words) {
  std::string all;
  for (const auto& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

}  // namespace floe::mesh
