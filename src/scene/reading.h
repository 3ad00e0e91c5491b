#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "values.h"

namespace floe::scene {

/// One mapping of the file, read by the keys of one section of the grammar.
///
/// Unknown keys are faults at once, missing required ones when they are asked for. A default takes the way of a value
/// that the file gives. The key must be declared in the grammar with the type that the call reads.
class Reading {
 public:
  /// @param value  should be a mapping; anything else is a fault and reads as an empty one
  Reading(Document& document, const Value& value, const std::string& section);

  const Where& where() const { return where_; }
  bool given(const std::string& key) const { return values_.count(key) > 0; }
  /// The one that is given of these keys; a fault and empty where it is none or several.
  std::string one_of(const std::vector<std::string>& keys);
  /// Fixes the section's type: keys that do not apply to it are faults when given.
  void set_kind(const std::string& kind);

  std::string text(const std::string& key);
  bool flag(const std::string& key);
  int integer(const std::string& key);
  double number(const std::string& key);
  std::optional<double> optional_number(const std::string& key);
  std::vector<double> numbers(const std::string& key);
  Point point(const std::string& key);
  std::string choice(const std::string& key);
  /// The choice as a value of an enumeration: that of its text, the first after a fault.
  template <class Enumeration>
  Enumeration choice(const std::string& key, const std::vector<std::pair<std::string, Enumeration>>& values) {
    const std::string chosen = choice(key);
    for (const auto& [text, enumeration] : values) {
      if (text == chosen) return enumeration;
    }
    return values.front().second;
  }
  math::Formula formula(const std::string& key);
  /// As many formulas of t as the scene has dimensions, zero behind.
  std::array<math::Formula, 3> force(const std::string& key);
  /// About x, y, z: in the plane one formula, that about z.
  std::array<math::Formula, 3> moment(const std::string& key);
  /// Likewise of numbers.
  Point rotating(const std::string& key);
  /// Exactly three numbers.
  std::array<double, 3> three(const std::string& key);
  /// As many formulas as variables.
  template <std::size_t n>
  std::optional<std::array<math::Formula, n>> formulas(const std::string& key,
                                                       const std::array<std::string, n>& variables) {
    std::array<math::Formula, n> all;
    const std::vector<math::Formula> found =
        formulas(key, std::vector<std::string>(variables.begin(), variables.end()));
    if (found.size() != n) return {};
    std::copy(found.begin(), found.end(), all.begin());
    return all;
  }
  /// As it stands in the file, or the default; nothing when it is absent (a fault when it is required).
  std::optional<Value> value(const std::string& key);
  const Key& key(const std::string& name) const { return section_.key(name); }
  /// Where the key's value stands, or the section when it is absent.
  Where where(const std::string& key) const;

 private:
  std::vector<math::Formula> formulas(const std::string& key, const std::vector<std::string>& variables);
  Document& document_;
  const SchemaSection& section_;
  Where where_;
  std::map<std::string, Value> values_;
  bool mapping_;
};

}  // namespace floe::scene
