#include "floe/math/rounded.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace floe::math {

std::string rounded(double value, int digits) {
  const std::string text = fmt::format("{:.{}g}", value, digits);
  if (!(std::abs(value) >= 1) || text.find('e') == std::string::npos) return text;
  double number = value;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return std::abs(number) < 1e5 ? fmt::format("{:.0f}", number) : text;
}

std::string percent(double share, int digits) {
  return std::isfinite(share) ? rounded(100 * share, digits) + " %" : "beyond 10000 %";
}

}  // namespace floe::math
