#include <fmt/format.h>

#include <cmath>
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
  if (equals == std::string::npos || equals == 0) throw fault("names no path and values");
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
      throw InputError(fmt::format("--together: {} has {} values and {} has {}; expected as many", varied.front().path,
                                   varied.front().values.size(), each.path, each.values.size()));
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

}  // namespace floe::app
