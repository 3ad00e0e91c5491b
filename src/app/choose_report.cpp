#include "choose.h"

namespace floe::app {

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
