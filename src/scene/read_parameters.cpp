#include <algorithm>
#include <cctype>
#include <cmath>

#include "readers.h"

namespace floe::scene {
namespace {

bool identifier(const std::string& name) {
  const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; };
  return !name.empty() && letter(name[0]) && name.size() <= 100 && std::all_of(name.begin(), name.end(), [&](char c) {
    return letter(c) || std::isdigit(static_cast<unsigned char>(c));
  });
}

}  // namespace

void read_parameters(Document& document, const Value& value) {
  const Key& key = schema_section("scene").key("parameters");
  auto reserved = math::formula_names();
  for (const char* variable : {"t", "x", "y", "z"}) reserved.push_back(variable);
  for (const auto& entry : read_mapping(document, value, describe(key))) {
    if (!identifier(entry.name)) {
      document.fault(entry.where, "is not a valid parameter name", "letters, digits and _, not starting with a digit");
    } else if (std::count(reserved.begin(), reserved.end(), entry.name)) {
      document.fault(entry.where, "is reserved in formulas", "another name");
    } else {
      // After a fault the name is known all the same: its uses are no faults of their own.
      const double number = read_number(document, entry.value, key);
      document.parameters[entry.name] = std::isnan(number) ? 1 : number;
    }
  }
}

}  // namespace floe::scene
