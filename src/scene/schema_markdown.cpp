#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "floe/scene/schema.h"

namespace floe::scene {
namespace {

/// What Markdown would take for its own, but for what stands between backticks.
std::string escaped(const std::string& text) {
  std::string out;
  bool code = false;
  for (const char c : text) {
    if (c == '`') code = !code;
    if (c == '|' || (!code && (c == '*' || c == '<' || c == '_' || c == '[' || c == ']'))) out += '\\';
    out += c;
  }
  return out;
}

std::string target(const std::string& section) {
  std::string name = "scene-" + section;
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

/// A section's name in backticks becomes a link to it.
std::string linked(std::string text, const std::string& section) {
  const std::string word = "`" + section + "`";
  const auto at = section.empty() ? std::string::npos : text.find(word);
  return at == std::string::npos ? text : text.replace(at, word.size(), fmt::format("[{}]({})", word, target(section)));
}

std::string where_it_applies(const Key& key) {
  std::vector<std::string> words;
  if (key.dimension != 0) words.push_back(key.dimension == 2 ? "in planar scenes" : "in spatial scenes");
  if (!key.kinds.empty()) words.push_back(fmt::format("type {}", fmt::join(key.kinds, ", ")));
  return words.empty() ? "" : fmt::format(" *(only {})*", escaped(fmt::format("{}", fmt::join(words, "; "))));
}

std::string row(const SchemaSection& section, const Key& key) {
  std::string value = linked(escaped(described(section, key)), key.section);
  if (const std::string range = key.range.text(); !range.empty()) value += fmt::format("; `{}`", range);
  const std::string number = default_text(key);
  const std::string fallback = key.fallback == Key::required ? "**required**"
                               : number.empty()              ? ""
                                                             : "`" + number + "`";
  return fmt::format("| `{}` | {}{} | {} | {} | {} |\n", key.name, escaped(key.text), where_it_applies(key), value,
                     escaped(key.unit), fallback);
}

}  // namespace

std::string schema_markdown() {
  std::string out;
  for (const SchemaSection& section : schema()) {
    out += fmt::format("({})=\n## {}\n\n{}\n\n", target(section.name), section.name, escaped(section.text));
    out += "| key | what it is | value | unit | default |\n|---|---|---|---|---|\n";
    for (const Key& key : section.keys) out += row(section, key);
    out += fmt::format("\n```yaml\n{}\n```\n\n", section.example);
  }
  return out;
}

}  // namespace floe::scene
