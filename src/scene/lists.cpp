#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "values.h"

namespace floe::scene {

std::vector<Value> read_list(Document& document, const Value& value, const Key& key, std::size_t count) {
  if (!value.node.IsSequence()) {
    document.fault(value.where, shown(value.node), describe(key, document.dimension));
    return {};
  }
  if (count > 0 && value.node.size() != count) {
    const bool formulas = key.type == Type::formulas || key.type == Type::load_force || key.type == Type::load_moment ||
                          key.type == Type::formula_of_place;
    document.fault(value.where, fmt::format("has length {}", value.node.size()),
                   describe(key, document.dimension) + (formulas ? "; quote a formula that has a comma" : ""));
    return {};
  }
  std::vector<Value> items;
  int number = 0;
  for (const auto& item : value.node) {
    const std::string name = fmt::format("{}[{}]", value.where.key, ++number);
    items.push_back({item, item.IsNull() ? value.where : document.place_of(item.Mark(), name)});
    items.back().where.key = name;
  }
  return items;
}

std::vector<std::array<int, 2>> read_pairs(Document& document, const Value& value, const Key& key) {
  Key entry = key;
  entry.type = Type::pair;
  entry.range = {1, 1e8};
  const std::size_t before = document.fault_count();
  std::vector<std::array<int, 2>> pairs;
  for (const auto& item : read_list(document, value, key)) {
    const auto parts = read_list(document, item, entry, 2);
    if (parts.size() != 2) continue;
    pairs.push_back({read_integer(document, parts[0], entry), read_integer(document, parts[1], entry)});
  }
  if (document.fault_count() != before) pairs.clear();
  return pairs;
}

std::vector<std::string> read_texts(Document& document, const Value& value, const Key& key) {
  const std::size_t before = document.fault_count();
  std::vector<std::string> texts;
  for (const auto& item : read_list(document, value, key)) {
    if (!item.node.IsScalar() || item.node.Scalar().empty())
      document.fault(item.where, shown(item.node), "a text");
    else if (std::find(texts.begin(), texts.end(), item.node.Scalar()) != texts.end())
      document.fault(item.where, in_quotes(item.node.Scalar()) + " is given twice", "each once");
    else
      texts.push_back(item.node.Scalar());
  }
  if (texts.empty() && document.fault_count() == before) document.fault(value.where, "is empty", "at least one");
  if (document.fault_count() != before) texts.clear();
  return texts;
}

std::vector<Entry> read_mapping(Document& document, const Value& value, const std::string& expected) {
  if (!value.node.IsMap()) {
    document.fault(value.where, shown(value.node), expected);
    return {};
  }
  std::vector<Entry> entries;
  std::map<std::string, int> lines;
  for (const auto& pair : value.node) {
    const YAML::Node& name = pair.first;
    const std::string& path = value.where.key;
    Where where = document.place_of(name.Mark(), path);
    if (!name.IsScalar()) {
      document.fault(where, "a key that " + shown(name), "a text");
      continue;
    }
    const std::string& text = name.Scalar();
    where.key = path.empty() ? text : fmt::format("{}.{}", path, text);
    if (text == "<<") {
      document.fault(where, "merge keys are not supported", "an alias for a whole value (KEY: *NAME)");
    } else if (const auto [first, fresh] = lines.emplace(text, where.line); !fresh) {
      document.fault(where, fmt::format("is given twice, first in line {}", first->second));
    } else {
      // A mapping is best found by its name; yaml-cpp gives an absent value the place of what follows.
      const bool by_name = pair.second.IsMap() || pair.second.IsNull();
      entries.push_back(
          {text, where, {pair.second, by_name ? where : document.place_of(pair.second.Mark(), where.key)}});
    }
  }
  return entries;
}

}  // namespace floe::scene
