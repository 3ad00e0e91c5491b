#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "campbell.h"

namespace floe::app {
namespace {

/// Numbers between separators; nothing where a part is none, or not finite.
std::vector<double> numbers(const std::string& text, char separator) {
  std::vector<double> all;
  std::istringstream parts(text + separator);
  for (std::string part; std::getline(parts, part, separator);) {
    char* end = nullptr;
    const double value = std::strtod(part.c_str(), &end);
    while (*end == ' ') ++end;
    if (end == part.c_str() || *end != '\0' || !std::isfinite(value)) return {};
    all.push_back(value);
  }
  return all;
}

constexpr int most = 10000;

}  // namespace

std::vector<double> parse_values(const std::string& text,
                                 const std::function<InputError(const std::string& what)>& fault) {
  if (text.find(':') == std::string::npos) {
    std::vector<double> list = numbers(text, ',');
    if (list.empty()) throw fault("is not a list of numbers");
    if (list.size() > most) throw fault(fmt::format("has more than {} numbers", most));
    return list;
  }
  const std::vector<double> range = numbers(text, ':');
  if (range.size() != 3) throw fault("is not a range of three numbers");
  const double steps = (range[1] - range[0]) / range[2];
  if (!(steps >= 0) || !std::isfinite(steps)) throw fault("never reaches its end");
  if (steps > most) throw fault(fmt::format("has more than {} numbers", most));
  std::vector<double> speeds;
  for (int i = 0; i <= std::floor(steps + 1e-9); ++i) speeds.push_back(range[0] + i * range[2]);
  return speeds;
}

std::vector<double> parse_speeds(const std::string& text) {
  return parse_values(text, [&](const std::string& what) {
    return InputError(fmt::format(
        "--speeds: \"{}\" {}; expected FROM:TO:STEP, as 0:600:50, or a list, as 0,100,250 [rad/s]", text, what));
  });
}

Eigen::Vector3d parse_point(const std::string& text, const std::string& option) {
  std::string bare = text;
  if (bare.size() > 1 && bare.front() == '[' && bare.back() == ']') bare = bare.substr(1, bare.size() - 2);
  const std::vector<double> x = numbers(bare, ',');
  if (x.size() != 2 && x.size() != 3)
    throw InputError(fmt::format("{}: \"{}\" is not a point; expected three numbers, as [0,0,1]", option, text));
  return {x[0], x[1], x.size() == 3 ? x[2] : 0};
}

}  // namespace floe::app
