#include "floe/math/nearest.h"

#include <algorithm>
#include <cctype>

namespace floe::math {
namespace {

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string letters(std::string text) {
  std::erase_if(text, [](char c) { return c == '_' || c == '-' || c == ' '; });
  return text;
}

// Damerau-Levenshtein distance, optimal string alignment.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string nearest(const std::string& word, const std::vector<std::string>& known) {
  constexpr std::size_t longest = 100;  // the table of distances stays small whatever is given
  if (word.empty() || word.size() > longest) return "";
  const std::string sought = lower(word);
  std::string best;
  std::size_t least = longest;
  std::vector<std::string> begun, containing;
  for (const auto& candidate : known) {
    if (candidate.size() > longest) continue;
    const std::size_t wrong = distance(sought, lower(candidate));
    const std::size_t allowed = std::max<std::size_t>(1, std::max(word.size(), candidate.size()) / 3);
    if (wrong <= allowed && wrong < std::max(word.size(), candidate.size()) && wrong < least) {
      least = wrong;
      best = candidate;
    }
    if (word.size() > 1 && lower(candidate).starts_with(sought)) begun.push_back(candidate);
    if (word.size() > 3 && letters(lower(candidate)).find(letters(sought)) != std::string::npos)
      containing.push_back(candidate);
  }
  for (const auto* some : {&begun, &containing})
    if (best.empty() && some->size() == 1) return some->front();
  return best;
}

}  // namespace floe::math
