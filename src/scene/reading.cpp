#include "reading.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace floe::scene {

Reading::Reading(Document& document, const Value& value, const std::string& section)
    : document_(document), section_(schema_section(section)), where_(value.where), mapping_(value.node.IsMap()) {
  std::vector<std::string> known;
  for (const Key& key : section_.keys) known.push_back(key.name);
  const std::string expected = fmt::format("a mapping with the keys {}", fmt::join(known, ", "));
  for (auto& entry : read_mapping(document, value, expected)) {
    if (std::count(known.begin(), known.end(), entry.name)) {
      const int dimension = section_.key(entry.name).dimension;
      if (dimension != 0 && dimension != document.dimension)
        document.fault(entry.value.where, "does not apply here",
                       dimension == 2 ? "this key only in planar scenes" : "this key only in spatial scenes");
      else
        values_.emplace(entry.name, entry.value);
    } else {
      document.fault(entry.where, "unknown key", fmt::format("one of {}", fmt::join(known, ", ")), entry.name, known);
    }
  }
}

void Reading::set_kind(const std::string& kind) {
  if (kind.empty()) return;
  for (const Key& key : section_.keys) {
    const bool applies = key.kinds.empty() || std::count(key.kinds.begin(), key.kinds.end(), kind);
    if (given(key.name) && !applies) {
      document_.fault(where(key.name), fmt::format("does not apply to type {}", kind),
                      fmt::format("this key only with type {}", fmt::join(key.kinds, ", ")));
    }
  }
}

Where Reading::where(const std::string& key) const {
  const auto found = values_.find(key);
  if (found != values_.end()) return found->second.where;
  Where where = where_;
  where.key += (where.key.empty() ? "" : ".") + key;
  return where;
}

std::optional<Value> Reading::value(const std::string& name) {
  const Key& key = section_.key(name);
  if (const auto found = values_.find(name); found != values_.end()) return found->second;
  if (key.fallback == Key::required) {
    if (mapping_) document_.fault(where(name), "is missing", describe(key, document_.dimension));
    return {};
  }
  if (key.fallback.empty()) return {};
  return Value{YAML::Load(key.fallback), where(name)};
}

std::string Reading::text(const std::string& name) {
  const auto found = value(name);
  if (!found) return "";
  if (found->node.IsScalar()) return found->node.Scalar();
  document_.fault(found->where, shown(found->node), describe(key(name), document_.dimension));
  return "";
}

bool Reading::flag(const std::string& name) {
  const auto found = value(name);
  return found && read_flag(document_, *found, key(name));
}

int Reading::integer(const std::string& name) {
  const auto found = value(name);
  return found ? read_integer(document_, *found, key(name)) : 0;
}

double Reading::number(const std::string& name) { return optional_number(name).value_or(NAN); }

std::optional<double> Reading::optional_number(const std::string& name) {
  const auto found = value(name);
  if (!found) return {};
  return read_number(document_, *found, key(name));
}

std::vector<double> Reading::numbers(const std::string& name) {
  std::vector<double> all;
  const auto found = value(name);
  if (!found) return all;
  for (const auto& item : read_list(document_, *found, key(name)))
    all.push_back(read_number(document_, item, key(name)));
  return all;
}

Point Reading::point(const std::string& name) {
  const auto found = value(name);
  return found ? read_point(document_, *found, key(name)) : Point{NAN, NAN, NAN};
}

std::string Reading::choice(const std::string& name) {
  const auto found = value(name);
  return found ? read_choice(document_, *found, key(name)) : "";
}

math::Formula Reading::formula(const std::string& name) {
  const auto found = value(name);
  return found ? read_formula(document_, *found, key(name), {"t"}) : math::Formula(NAN);
}

std::array<math::Formula, 3> Reading::force(const std::string& name) {
  std::array<math::Formula, 3> force{0.0, 0.0, 0.0};
  const auto found = value(name);
  if (!found) return force;
  const auto parts = read_list(document_, *found, key(name), document_.dimension);
  for (std::size_t i = 0; i < parts.size(); ++i) force[i] = read_formula(document_, parts[i], key(name), {"t"});
  return force;
}

std::array<math::Formula, 3> Reading::moment(const std::string& name) {
  if (document_.dimension == 3) return force(name);
  return {0.0, 0.0, formula(name)};
}

Point Reading::rotating(const std::string& name) {
  if (document_.dimension == 3) return given(name) ? point(name) : Point{};
  return {0, 0, number(name)};
}

std::string Reading::one_of(const std::vector<std::string>& keys) {
  std::vector<std::string> found;
  for (const std::string& key : keys)
    if (given(key)) found.push_back(key);
  if (found.size() == 1) return found.front();
  document_.fault(where_,
                  found.empty() ? fmt::format("has none of {}", fmt::join(keys, ", "))
                                : fmt::format("has {} together", fmt::join(found, " and ")),
                  "exactly one of " + fmt::format("{}", fmt::join(keys, ", ")));
  return "";
}

std::array<double, 3> Reading::three(const std::string& name) {
  std::array<double, 3> all{};
  const auto found = value(name);
  if (!found) return all;
  const auto parts = read_list(document_, *found, key(name), 3);
  for (std::size_t i = 0; i < parts.size(); ++i) all[i] = read_number(document_, parts[i], key(name));
  return all;
}

std::vector<math::Formula> Reading::formulas(const std::string& name, const std::vector<std::string>& variables) {
  const auto found = value(name);
  if (!found) return {};
  std::vector<math::Formula> all;
  for (const Value& part : read_list(document_, *found, key(name), variables.size()))
    all.push_back(read_formula(document_, part, key(name), variables));
  return all;
}

}  // namespace floe::scene
