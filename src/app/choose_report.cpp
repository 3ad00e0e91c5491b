#include <fmt/format.h>
#include <fmt/ranges.h>

#include "choose.h"

namespace floe::app {

std::string summary_of(const Chosen& chosen) {
  std::vector<std::string> words;
  for (const Decision& one : chosen.decisions) {
    if (one.what == "model") return one.choice + " model";
    if (one.what == "mesh and frames" || one.what == "elements") words.push_back(one.choice);
    if (one.what == "bodies" && one.choice == "rigid") words.emplace_back("rigid");
    if (one.what == "basis vectors") words.push_back(one.choice + " basis vectors");
    if (one.what == "elastic force" && one.choice == "linear") words.emplace_back("linear elastic force");
    if (one.what == "step") words.push_back("step " + one.choice);
  }
  return fmt::format("{}", fmt::join(words, "; "));
}

nlohmann::ordered_json to_json(const Chosen& chosen) {
  nlohmann::ordered_json j;
  j["asked"] = chosen.asked;
  j["of"] = chosen.total ? "total" : "reduction";
  j["supported"] = chosen.supported;
  j["of_richest_model"] = chosen.richest;
  j["within"] = chosen.within() && chosen.unbounded.empty();
  for (const auto& [part, why] : chosen.unbounded) j["unbounded"][part] = why;
  if (!chosen.before.is_null()) j["before"] = chosen.before;
  j["trials"] = chosen.trials;
  j["seconds"] = chosen.seconds;
  for (const Decision& one : chosen.decisions)
    j["decisions"].push_back({{"what", one.what}, {"choice", one.choice}, {"reason", one.reason}});
  return j;
}

output::Table decisions_table(const Chosen& chosen) {
  output::Table table;
  table.columns = {{"decision", ""}, {"choice", ""}, {"reason", ""}};
  for (const Decision& one : chosen.decisions) table.rows.push_back({one.what, one.choice, one.reason});
  return table;
}

}  // namespace floe::app
