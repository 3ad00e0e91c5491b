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

std::string listed(const std::vector<std::string>& words) {
  std::string all;
  for (const auto& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

}  // namespace floe::mesh
