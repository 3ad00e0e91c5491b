#include "values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>

#include "floe/scene/scene.h"

namespace floe::scene {
namespace {

constexpr std::size_t longest_formula = 2000;
constexpr double least_size = 1e-120, greatest_size = 1e120;  // squares and their quotients stay finite

bool out_of_size(double number) {
  const double size = std::abs(number);
  return size != 0 && !(size >= least_size && size <= greatest_size);  // NaN was reported before
}

// The number that a text is: digits as in C or YAML's .inf and .nan; nothing for any other text.
std::optional<double> plain_number(std::string text) {
  if (text.starts_with("+")) text.erase(0, 1);
  const bool negative = text.starts_with("-");
  const std::string bare = text.substr(negative ? 1 : 0);
  if (bare == ".inf" || bare == ".Inf" || bare == ".INF") return negative ? -INFINITY : INFINITY;
  if (bare == ".nan" || bare == ".NaN" || bare == ".NAN") return NAN;
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (end != text.data() + text.size() || error == std::errc::invalid_argument) return {};
  if (error == std::errc::result_out_of_range) return std::strtod(text.c_str(), nullptr);  // 0 or infinite
  return number;
}

std::vector<std::string> names_known(const Document& document, const std::vector<std::string>& variables) {
  std::vector<std::string> names = variables;
  for (const auto& parameter : document.names.numbers) names.push_back(parameter.first);
  for (const auto& function : document.names.functions) names.push_back(function.first);
  for (const auto& name : math::formula_names()) names.push_back(name);
  return names;
}

std::string expected_number(const Key& key, const char* kind) {
  const std::string range = key.range.text();
  return range.empty() ? kind : fmt::format("{} {}", kind, range);
}

}  // namespace

std::string shown(const YAML::Node& node) {
  if (node.IsSequence()) return "is a list";
  if (node.IsMap()) return "is a mapping";
  if (!node.IsScalar()) return "is empty";
  return "is " + in_quotes(node.Scalar());
}

std::string in_quotes(const std::string& text) {
  return text.size() > 60 ? fmt::format("\"{}...\"", text.substr(0, 60)) : fmt::format("\"{}\"", text);
}

math::Formula read_formula(Document& document, const Value& value, const Key& key,
                           const std::vector<std::string>& variables) {
  const bool of_sensors =
      key.type == Type::load_force || key.type == Type::load_moment || key.type == Type::formula_of_sensors;
  const std::string expected =
      of_sensors          ? "a number or a formula of t, sensors and the parameters"
      : variables.empty() ? "a number or a formula of the parameters"
                          : fmt::format("a number or a formula of {} and the parameters", fmt::join(variables, ", "));
  if (!value.node.IsScalar()) {
    document.fault(value.where, shown(value.node), expected);
    return NAN;
  }
  const std::string& text = value.node.Scalar();
  if (const auto number = plain_number(text)) {
    if (std::isfinite(*number)) return *number;
    document.fault(value.where, fmt::format("is {}, which is not finite", text), expected_number(key, "a number"));
    return NAN;
  }
  if (text.size() > longest_formula) {
    document.fault(value.where, shown(value.node), fmt::format("a formula of at most {} characters", longest_formula));
    return NAN;
  }
  try {
    return of_sensors ? math::Formula::of_sensors(text, document.names)
                      : math::Formula(text, variables, document.names);
  } catch (const math::FormulaError& error) {
    document.fault(value.where, error.what(), expected, error.unknown, names_known(document, variables));
    return NAN;
  }
}

double read_number(Document& document, const Value& value, const Key& key) {
  const math::Formula formula = read_formula(document, value, key, {});
  const std::size_t before = document.fault_count();
  double number = NAN;
  try {
    number = formula();
  } catch (const math::FormulaError&) {
    return NAN;  // reported by read_formula
  }
  if (!key.range.contains(number)) {
    const std::string& text = value.node.Scalar();
    const std::string is = plain_number(text) ? "is " + text : fmt::format("{} is {}", in_quotes(text), number);
    document.fault(value.where, is, expected_number(key, "a number"));
  } else if (key.type != Type::parameters && out_of_size(number)) {
    document.fault(value.where, fmt::format("is {}, whose products exceed the range of double precision", number),
                   fmt::format("0 or a size from {:.0e} to {:.0e}, in units of the problem's own size", least_size,
                               greatest_size));
  }
  return document.fault_count() == before ? number : NAN;
}

namespace {

/// `1 %` or `0.01`; nothing for any other text.
std::optional<double> plain_share(const std::string& text) {
  if (!text.ends_with('%')) return plain_number(text);
  const std::string before = text.substr(0, text.size() - 1);
  const auto number = plain_number(before.substr(0, before.find_last_not_of(' ') + 1));
  return number ? std::optional(*number / 100) : std::nullopt;
}

}  // namespace

double read_share(Document& document, const Value& value, const Key& key) {
  if (!value.node.IsScalar() || !value.node.Scalar().ends_with('%')) return read_number(document, value, key);
  const auto share = plain_share(value.node.Scalar());
  if (share && key.range.contains(*share)) return *share;
  document.fault(value.where, shown(value.node), fmt::format("{}, {}", describe(key), key.range.text()));
  return NAN;
}

Accuracy accuracy_of(const std::string& text) {
  const std::string part = "reduction:";
  const bool total = !text.starts_with(part);
  const std::string value = total ? text : text.substr(part.size());
  const auto first = value.find_first_not_of(' ');
  const auto share = plain_share(first == std::string::npos ? "" : value.substr(first));
  if (!share || !(*share > 0 && *share < 1))
    throw InputError(
        fmt::format("--accuracy: is \"{}\"; expected a fraction, as 0.01, a percentage, as 1%, or reduction:1%", text));
  return {*share, total};
}

int read_integer(Document& document, const Value& value, const Key& key) {
  Key unbounded = key;
  unbounded.range = {};
  const double number = read_number(document, value, unbounded);
  if (std::isnan(number)) return 0;
  if (number == std::round(number) && key.range.contains(number)) return static_cast<int>(number);
  document.fault(value.where, fmt::format("is {}", value.node.Scalar()), expected_number(key, "an integer"));
  return 0;
}

bool read_flag(Document& document, const Value& value, const Key& key) {
  bool flag = false;
  if (value.node.IsScalar() && YAML::convert<bool>::decode(value.node, flag)) return flag;
  document.fault(value.where, shown(value.node), describe(key, document.dimension));
  return false;
}

std::string read_choice(Document& document, const Value& value, const Key& key) {
  std::string word = value.node.IsScalar() ? value.node.Scalar() : "";
  for (const auto& choice : key.choices) {
    if (word == choice) return word;
  }
  document.fault(value.where, shown(value.node), describe(key, document.dimension), word, key.choices);
  return "";
}

Point read_point(Document& document, const Value& value, const Key& key) {
  Point point{};
  const auto parts = read_list(document, value, key, document.dimension);
  for (std::size_t i = 0; i < parts.size(); ++i) point[i] = read_number(document, parts[i], key);
  return point;
}

}  // namespace floe::scene
