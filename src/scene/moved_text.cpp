#include "moved_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace floe::scene {
namespace {

// yaml-cpp gives marks to what it parses alone: the text is parsed from the line and column of `at`.
YAML::Node parsed_at(const YAML::Node& at, const std::string& yaml) {
  const YAML::Mark mark = at.Mark();
  return YAML::Load(std::string(static_cast<std::size_t>(std::max(mark.line, 0)), '\n') +
                    std::string(static_cast<std::size_t>(std::max(mark.column, 0)), ' ') + yaml);
}

void add_term(std::vector<std::string>& terms, double factor, const std::string& text) {
  if (factor == 0 || text == "0") return;
  if (factor == 1)
    terms.push_back(fmt::format("({})", text));
  else
    terms.push_back(fmt::format("({})*({})", factor, text));
}

std::string sum(const std::vector<std::string>& terms) {
  return terms.empty() ? "0" : fmt::format("{}", fmt::join(terms, " + "));
}

}  // namespace

YAML::Node text_at(const YAML::Node& at, const std::string& text) {
  YAML::Emitter quoted;
  quoted << YAML::DoubleQuoted << text;
  return parsed_at(at, quoted.c_str());
}

YAML::Node empty_list_at(const YAML::Node& at) { return parsed_at(at, "[]"); }
YAML::Node empty_map_at(const YAML::Node& at) { return parsed_at(at, "{}"); }

YAML::Node numbers_at(const YAML::Node& at, const Eigen::VectorXd& numbers) {
  YAML::Node list = empty_list_at(at);
  for (const double number : numbers) list.push_back(text_at(at, fmt::format("{}", number)));
  return list;
}

YAML::Node GroupMotion::moved(const YAML::Node& list, bool with_position) const {
  if (!list.IsSequence() || list.size() != static_cast<std::size_t>(dimension)) return list;
  for (const auto& item : list)
    if (!item.IsScalar()) return list;
  YAML::Node moved = empty_list_at(list);
  for (int i = 0; i < dimension; ++i) {
    std::vector<std::string> terms;
    for (int j = 0; j < dimension; ++j) add_term(terms, R(i, j), list[static_cast<std::size_t>(j)].Scalar());
    if (with_position && p[i] != 0) terms.push_back(fmt::format("({})", p[i]));
    moved.push_back(text_at(list[static_cast<std::size_t>(i)], sum(terms)));
  }
  return moved;
}

std::string GroupMotion::moved_back(int i, const std::vector<std::string>& x, bool with_position) const {
  std::vector<std::string> terms;
  for (int j = 0; j < static_cast<int>(x.size()); ++j) {
    const bool shifted = with_position && p[j] != 0;
    add_term(terms, R(j, i),
             shifted ? fmt::format("{} - ({})", x[static_cast<std::size_t>(j)], p[j]) : x[static_cast<std::size_t>(j)]);
  }
  return "(" + sum(terms) + ")";
}

}  // namespace floe::scene
