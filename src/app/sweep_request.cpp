#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <regex>
#include <set>

#include "campbell.h"
#include "sweep.h"

namespace floe::app {

Varied parse_varied(const std::string& text) {
  const auto fault = [&](const std::string& what) {
    return InputError(fmt::format(
        "--vary: \"{}\" {}; expected PATH=FROM:TO:STEP, as loads.tip.force[2]=0:2500:50, or PATH=A,B,C", text, what));
  };
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0) throw fault("has no path or no values");
  Varied varied{text.substr(0, equals), {}};
  const std::string values = text.substr(equals + 1);
  varied.values = parse_values(values, fault);
  return varied;
}

std::vector<std::vector<scene::Variation>> members_of(const std::vector<Varied>& varied, bool together) {
  constexpr double most = 1e6;
  std::set<std::string> paths;
  double count = together ? static_cast<double>(varied.front().values.size()) : 1;
  for (const Varied& each : varied) {
    if (!paths.insert(each.path).second) throw InputError(fmt::format("--vary: {} is varied twice", each.path));
    if (together && each.values.size() != varied.front().values.size())
      throw InputError(fmt::format("--together: {} has {} values and {} has {}; expected equal numbers of values",
                                   varied.front().path, varied.front().values.size(), each.path, each.values.size()));
    if (!together) count *= static_cast<double>(each.values.size());
  }
  if (count > most) throw InputError(fmt::format("--vary: {:.0f} members; expected at most {:.0f}", count, most));
  std::vector<std::vector<scene::Variation>> members(static_cast<std::size_t>(count));
  for (std::size_t m = 0; m < members.size(); ++m) {
    std::size_t rest = m;
    for (auto each = varied.rbegin(); each != varied.rend(); ++each) {
      const std::size_t i = together ? m : rest % each->values.size();
      rest /= each->values.size();
      members[m].insert(members[m].begin(), {each->path, each->values[i]});
    }
  }
  return members;
}

std::string without_numbers(const std::string& text) {
  static const std::regex number(
      R"((^|[^A-Za-z0-9_.])[-+]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][-+]?[0-9]+)?(?![A-Za-z0-9_]))");
  return std::regex_replace(text, number, "$1#");
}

std::string words_of(const SweepWarning& warning) {
  std::vector<std::string> values;
  for (const scene::Variation& each : warning.of) values.push_back(fmt::format("{} = {:.6g}", each.path, each.value));
  const std::size_t more = warning.members.size() - 1;
  return fmt::format("{} (member {}: {}{})", warning.text, warning.members.front(), fmt::join(values, ", "),
                     more > 0 ? fmt::format("; {} more likewise", more) : "");
}

}  // namespace floe::app
