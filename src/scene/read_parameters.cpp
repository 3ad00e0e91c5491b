#include <algorithm>
#include <cctype>
#include <cmath>

#include "readers.h"

namespace floe::scene {

bool readable_in_formulas(const std::string& name) {
  const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; };
  return !name.empty() && letter(name[0]) && name.size() <= 100 && std::all_of(name.begin(), name.end(), [&](char c) {
    return letter(c) || std::isdigit(static_cast<unsigned char>(c));
  });
}

bool check_name(Document& document, const Where& where, const std::string& name) {
  auto reserved = math::formula_names();
  for (const char* variable : {"t", "x", "y", "z"}) reserved.push_back(variable);
  if (!readable_in_formulas(name))
    document.fault(where, "is not a valid name in formulas", "letters, digits and _, not starting with a digit");
  else if (std::count(reserved.begin(), reserved.end(), name))
    document.fault(where, "is reserved in formulas", "another name");
  else if (document.names.numbers.count(name))
    document.fault(where, "is a parameter", "another name");
  else
    return true;
  return false;
}

void read_parameters(Document& document, const Value& value) {
  const Key& key = schema_section("scene").key("parameters");
  for (const auto& entry : read_mapping(document, value, describe(key))) {
    if (!check_name(document, entry.where, entry.name)) continue;
    // After a fault the name is known all the same: its uses are no faults of their own.
    const double number = read_number(document, entry.value, key);
    document.names.numbers[entry.name] = std::isnan(number) ? 1 : number;
  }
}

}  // namespace floe::scene
