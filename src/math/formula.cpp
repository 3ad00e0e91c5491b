#include "floe/math/formula.h"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
#include <set>

#include "expression.h"

namespace floe::math {
namespace {

double triangle(double t, double rise, double fall) {
  if (t <= 0 || t >= rise + fall) return 0;
  return t < rise ? t / rise : (rise + fall - t) / fall;
}
double ramp(double t, double from, double to) { return t <= from ? 0 : t >= to ? 1 : (t - from) / (to - from); }
double pulse(double t, double from, double to) { return from <= t && t < to ? 1 : 0; }

void define_names(mu::Parser& parser) {
  parser.ClearConst();
  parser.DefineConst("pi", std::numbers::pi);
  parser.DefineConst("e", std::numbers::e);
  parser.DefineFun("triangle", triangle);
  parser.DefineFun("ramp", ramp);
  parser.DefineFun("pulse", pulse);
}

bool starts_name(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool in_number(char c) { return std::isdigit(static_cast<unsigned char>(c)) || c == '.'; }

struct Name {
  std::string text;
  std::size_t position;
};

// muParser reports one unknown name at a time and some of them as "unexpected value": look them up beforehand.
std::vector<Name> names_in(const std::string& text) {
  std::vector<Name> names;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t start = i;
    if (in_number(text[i])) {
      while (i < text.size() && in_number(text[i])) ++i;
      std::size_t exponent = i;
      if (exponent < text.size() && (text[exponent] == 'e' || text[exponent] == 'E')) ++exponent;
      if (exponent > i && exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
      if (exponent > i && exponent < text.size() && in_number(text[exponent])) i = exponent;
      while (i < text.size() && in_number(text[i])) ++i;
    } else if (starts_name(text[i])) {
      while (i < text.size() && (starts_name(text[i]) || std::isdigit(static_cast<unsigned char>(text[i])))) ++i;
      names.push_back({text.substr(start, i - start), start});
    } else {
      ++i;
    }
  }
  return names;
}

}  // namespace

struct Formula::Parser {
  std::string text;
  double value = 0;  // of a formula without variables
  bool constant = true;
  std::vector<std::string> variables;
  std::array<double, 3> arguments{};
  std::unique_ptr<mu::Parser> parser;      // none for a number: it is large
  std::shared_ptr<const Expression> tree;  // for derivatives

  void refuse_unknown_names(const std::map<std::string, double>& constants) {
    for (const auto& [name, position] : names_in(text)) {
      if (std::count(variables.begin(), variables.end(), name)) {
        constant = false;
      } else if (!constants.count(name) && name != "pi" && name != "e" && !parser->GetFunDef().count(name)) {
        throw FormulaError(fmt::format("\"{}\" at character {} of \"{}\" is unknown", name, position + 1, text), name);
      }
    }
  }

  double evaluate() {
    try {
      const double result = parser->Eval();
      if (parser->GetNumResults() != 1) throw FormulaError(fmt::format("\"{}\" is more than one formula", text));
      return result;
    } catch (const mu::ParserError& error) {
      throw FormulaError(fmt::format("\"{}\" does not parse: {}", text, error.GetMsg()));
    }
  }
};

Formula::Formula(double constant) : parser_(std::make_shared<Parser>()) {
  parser_->value = constant;
  parser_->text = fmt::format("{}", constant);
}

Formula::Formula(const std::string& text, const std::vector<std::string>& variables,
                 const std::map<std::string, double>& constants)
    : parser_(std::make_shared<Parser>()) {
  parser_->text = text;
  parser_->variables = variables;
  parser_->parser = std::make_unique<mu::Parser>();
  mu::Parser& parser = *parser_->parser;
  define_names(parser);
  parser_->refuse_unknown_names(constants);
  // muParser would take `t=1` for an assignment.
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    const bool comparison = (i > 0 && std::string("<>!=").find(text[i - 1]) != std::string::npos) ||
                            (i + 1 < text.size() && text[i + 1] == '=');
    if (!comparison) throw FormulaError(fmt::format("\"{}\" assigns at character {}; compare with ==", text, i + 1));
  }
  try {
    for (const auto& [name, number] : constants) parser.DefineConst(name, number);
    for (std::size_t i = 0; i < variables.size(); ++i) parser.DefineVar(variables[i], &parser_->arguments.at(i));
    parser.SetExpr(text);
  } catch (const mu::ParserError& error) {
    throw FormulaError(fmt::format("\"{}\" does not parse: {}", text, error.GetMsg()));
  }
  parser_->value = parser_->evaluate();  // compiles, and throws when the text is no formula
  if (constant()) (*this)();
  parser_->tree = Expression::read(text, variables, constants);
}

double Formula::finite(double value, const char* what, double first, double second, double third) const {
  if (std::isfinite(value)) return value;
  const auto& variables = parser_->variables;
  std::string where;
  if (!parser_->constant) where = fmt::format(" at {} = {}", variables[0], first);
  if (!parser_->constant && variables.size() > 1) where += fmt::format(", {} = {}", variables[1], second);
  if (!parser_->constant && variables.size() > 2) where += fmt::format(", {} = {}", variables[2], third);
  throw FormulaError(
      fmt::format("{}\"{}\" is {}{}", what, text(), std::isnan(value) ? "not a number" : "infinite", where));
}

double Formula::operator()(double first, double second, double third) const {
  double value = parser_->value;
  if (!parser_->constant) {
    parser_->arguments = {first, second, third};
    value = parser_->evaluate();
  }
  return finite(value, "", first, second, third);
}

double Formula::derivative(double first, double second) const {
  if (constant()) return 0;
  return finite(tree()({first, second}).first, "the derivative of ", first, second);
}

double Formula::second_derivative(double first, double second) const {
  if (constant()) return 0;
  return finite(tree()({first, second}).second, "the second derivative of ", first, second);
}

const Expression& Formula::tree() const {
  if (!parser_->tree) throw FormulaError(fmt::format("\"{}\" is written in a way that has no derivative", text()));
  return *parser_->tree;
}

const Expression* Formula::expression() const { return constant() ? nullptr : parser_->tree.get(); }

bool Formula::constant() const { return parser_->constant; }
const std::string& Formula::text() const { return parser_->text; }

std::vector<std::string> formula_names() {
  mu::Parser parser;
  define_names(parser);
  std::set<std::string> names{"pi", "e"};
  for (const auto& function : parser.GetFunDef()) names.insert(function.first);
  return {names.begin(), names.end()};
}

}  // namespace floe::math
