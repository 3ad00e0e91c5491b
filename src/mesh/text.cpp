#include "text.h"

#include <algorithm>
#include <cctype>

namespace floe::mesh {

std::string upper(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return result;
}

std::string quoted(std::string_view text) {
  constexpr std::size_t most = 40;
  std::string result = "'";
  for (const char c : text.substr(0, most)) result += std::isprint(static_cast<unsigned char>(c)) ? c : '?';
  return result + (text.size() > most ? "...'" : "'");
}

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
  const std::string sought = upper(word).substr(0, 80);
  std::size_t least = std::max<std::size_t>(1, sought.size() / 3) + 1;
  std::string best;
  for (const auto& candidate : known) {
    const std::string other = upper(candidate).substr(0, 80);
    std::vector<std::size_t> row(other.size() + 1);
    for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
    for (std::size_t i = 0; i < sought.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i + 1;
      for (std::size_t j = 0; j < other.size(); ++j) {
        const std::size_t changed = diagonal + (sought[i] != other[j]);
        diagonal = row[j + 1];
        row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, changed});
      }
    }
    if (row.back() < least) {
      least = row.back();
      best = candidate;
    }
  }
  return best.empty() ? "" : ", did you mean " + best + "?";
}

std::string listed(const std::vector<std::string>& words) {
  std::string all;
  for (const auto& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

}  // namespace floe::mesh
