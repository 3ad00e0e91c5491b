#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "readers.h"

namespace floe::scene {
namespace {

/// The numbers of a line, apart by commas, semicolons or blanks; nothing where a word is no number.
std::optional<std::vector<double>> numbers_of(const std::string& line) {
  constexpr const char* between = ",; \t\r";
  std::vector<double> numbers;
  for (std::size_t at = line.find_first_not_of(between); at != std::string::npos;
       at = line.find_first_not_of(between, at)) {
    const std::size_t end = std::min(line.find_first_of(between, at), line.size());
    const char* first = line.data() + at + (line[at] == '+' ? 1 : 0);
    double number = 0;
    const auto [behind, error] = std::from_chars(first, line.data() + end, number);
    if (error != std::errc() || behind != line.data() + end || !std::isfinite(number)) return {};
    numbers.push_back(number);
    at = end;
  }
  return numbers;
}

/// Two columns of a file, whose lines may be empty, begin with # or, before the first numbers, be a header.
math::Table read_columns(Document& document, const Where& where, const std::string& path, int of_t, int of_value) {
  const std::string name = in_quotes(path);
  math::Table table;
  std::ifstream file(document.beside(path));
  const auto fault = [&](int line, const std::string& wrong, const std::string& expected) {
    document.fault(where, fmt::format("{}, line {}: {}", name, line, wrong), expected);
    return math::Table{};
  };
  if (!file) {
    document.fault(where, name + " cannot be read", "a file with a column of t and one of values");
    return table;
  }
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::size_t start = line.find_first_not_of(" \t\r");
    if (start == std::string::npos || line[start] == '#') continue;
    const auto numbers = numbers_of(line);
    if (!numbers && table.x.empty()) continue;
    if (!numbers) return fault(number, fmt::format("is {}", in_quotes(line)), "numbers");
    const auto columns = static_cast<int>(numbers->size());
    if (columns < std::max(of_t, of_value))
      return fault(number, fmt::format("has {} columns", columns),
                   fmt::format("at least {}", std::max(of_t, of_value)));
    const double t = (*numbers)[static_cast<std::size_t>(of_t - 1)];
    if (!table.x.empty() && t <= table.x.back())
      return fault(number, fmt::format("t is {} after {}", t, table.x.back()), "ascending values of t");
    table.x.push_back(t);
    table.y.push_back((*numbers)[static_cast<std::size_t>(of_value - 1)]);
  }
  if (file.bad()) document.fault(where, name + " cannot be read");
  return table;
}

math::Table read_table(Document& document, const Value& value) {
  using Interpolation = math::Table::Interpolation;
  Reading reading(document, value, "table");
  const std::size_t before = document.fault_count();
  math::Table table;
  if (reading.one_of({"values", "file"}) == "file") {
    table = read_columns(document, reading.where("file"), reading.text("file"), reading.integer("t_column"),
                         reading.integer("column"));
    if (reading.given("t")) document.fault(reading.where("t"), "is given beside file", "t_column");
  } else {
    table.x = reading.numbers("t"), table.y = reading.numbers("values");
    if (table.x.size() != table.y.size())
      document.fault(reading.where("values"), fmt::format("has length {}", table.y.size()),
                     fmt::format("as many values as t has, {}", table.x.size()));
    if (std::adjacent_find(table.x.begin(), table.x.end(), [](double a, double b) { return a >= b; }) != table.x.end())
      document.fault(reading.where("t"), "is not ascending", "ascending values of t");
  }
  table.interpolation = reading.choice<Interpolation>(
      "interpolation", {{"linear", Interpolation::linear}, {"cubic", Interpolation::cubic}});
  table.periodic = reading.flag("periodic");
  if (document.fault_count() == before && table.x.size() < 2)
    document.fault(value.where, fmt::format("has {} points", table.x.size()), "at least two");
  if (document.fault_count() == before && table.periodic && table.y.front() != table.y.back())
    document.fault(reading.where("periodic"),
                   fmt::format("the first value is {} and the last one {}", table.y.front(), table.y.back()),
                   "equal values at both ends of a period");
  if (document.fault_count() != before) table = {{0, 1}, {0, 0}};
  return table;
}

}  // namespace

void read_functions(Document& document, const Value& value) {
  const Key& key = schema_section("scene").key("functions");
  for (const auto& entry : read_mapping(document, value, describe(key))) {
    if (!check_name(document, entry.where, entry.name)) continue;
    if (entry.value.node.IsMap()) {
      document.names.functions[entry.name] = math::function_of(read_table(document, entry.value));
      continue;
    }
    const std::size_t before = document.fault_count();
    const math::Formula formula = read_formula(document, entry.value, key, {"t"});
    document.names.functions[entry.name] = math::function_of(document.fault_count() == before ? formula : 0.0);
  }
}

}  // namespace floe::scene
