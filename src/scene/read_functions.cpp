#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "readers.h"

namespace floe::scene {
namespace {

/// What stands between the fields of a file: taken from its first line of numbers.
char separator_of(const std::string& line) {
  for (const char separator : {';', ','})
    if (line.find(separator) != std::string::npos) return separator;
  return ' ';
}

/// The fields of a line without the blanks around them; between blanks none is empty.
std::vector<std::string> fields_of(const std::string& line, char separator) {
  constexpr const char* blanks = " \t\r";
  std::vector<std::string> fields;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end =
        std::min(separator == ' ' ? line.find_first_of(blanks, at) : line.find(separator, at), line.size());
    const std::string field = line.substr(at, end - at);
    const std::size_t first = field.find_first_not_of(blanks);
    if (first != std::string::npos)
      fields.push_back(field.substr(first, field.find_last_not_of(blanks) - first + 1));
    else if (separator != ' ')
      fields.emplace_back();
    at = end + 1;
  }
  return fields;
}

std::optional<double> number_of(const std::string& field) {
  const std::size_t first = field.starts_with("+") ? 1 : 0;
  double number = 0;
  const auto [behind, error] = std::from_chars(field.data() + first, field.data() + field.size(), number);
  if (error != std::errc() || behind != field.data() + field.size() || !std::isfinite(number)) return {};
  return number;
}

/// Whether a line may be the header: its first field begins like no number.
bool is_header(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t\"");
  return first != std::string::npos && std::string("+-.0123456789,;").find(line[first]) == std::string::npos;
}

/// Two columns of a file. Its lines may be empty or begin with #; the first of the others may be a header.
math::Table read_columns(Document& document, const Where& where, const std::string& path, int of_t, int of_value) {
  const std::string name = in_quotes(path);
  math::Table table;
  document.tables.push_back(document.beside(path));
  std::ifstream file(document.tables.back());
  const auto fault = [&](int line, const std::string& wrong, const std::string& expected) {
    document.fault(where, fmt::format("{}, line {}: {}", name, line, wrong), expected);
    return math::Table{};
  };
  if (!file) {
    document.fault(where, name + " cannot be read", "a file with a column of t and one of values");
    return table;
  }
  std::string line;
  char separator = 0;
  bool header = false;
  for (int row = 1; std::getline(file, line); ++row) {
    if (row == 1 && line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);  // a mark of UTF-8
    const std::size_t start = line.find_first_not_of(" \t\r");
    if (start == std::string::npos || line[start] == '#') continue;
    if (table.x.empty() && !header && is_header(line)) {
      header = true;
      continue;
    }
    if (separator == 0) separator = separator_of(line);
    const std::vector<std::string> fields = fields_of(line, separator);
    const auto columns = static_cast<int>(fields.size());
    if (columns < std::max(of_t, of_value))
      return fault(row, fmt::format("has {} columns", columns), fmt::format("at least {}", std::max(of_t, of_value)));
    double numbers[2] = {0, 0};
    for (int i = 0; i < 2; ++i) {
      const std::string& field = fields[static_cast<std::size_t>((i == 0 ? of_t : of_value) - 1)];
      const auto number = number_of(field);
      if (!number)
        return fault(row, fmt::format("column {} is {}", i == 0 ? of_t : of_value, in_quotes(field)),
                     "a number with a decimal point");
      numbers[i] = *number;
    }
    if (!table.x.empty() && numbers[0] <= table.x.back())
      return fault(row, fmt::format("t is {} after {}", numbers[0], table.x.back()), "ascending values of t");
    table.x.push_back(numbers[0]), table.y.push_back(numbers[1]);
  }
  if (file.bad()) document.fault(where, name + " cannot be read");
  return table;
}

/// Sets the last value to the first one, from which it may differ by round-off (a sine from a spreadsheet).
void close_period(Document& document, const Where& where, math::Table& table) {
  constexpr double round_off = 1e-12;
  double most = 0;
  for (const double value : table.y) most = std::max(most, std::abs(value));
  if (!(std::abs(table.y.back() - table.y.front()) <= round_off * most))
    document.fault(where, fmt::format("the first value is {} and the last one {}", table.y.front(), table.y.back()),
                   "equal values at both ends of a period");
  table.y.back() = table.y.front();
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
    for (const char* key : {"t_column", "column"})
      if (reading.given(key)) document.fault(reading.where(key), "is given beside values", "a column of a file");
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
  if (document.fault_count() == before && table.periodic) close_period(document, reading.where("periodic"), table);
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
