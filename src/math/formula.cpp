#include "floe/math/formula.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "expression.h"
#include "function.h"
#include "functions.h"

namespace floe::math {

Formula::Formula(double constant) : text_(fmt::format("{}", constant)), value_(constant) {}

Formula::Formula(const std::string& text, const std::vector<std::string>& variables, const Names& names)
    : text_(text), variables_(variables), tree_(std::make_shared<Expression>(text, variables, names)) {
  if (!tree_->constant()) return;
  value_ = tree_->value({});
  tree_ = nullptr;
  finite(value_, "", 0, 0);
}

double Formula::finite(double value, const char* what, double first, double second, double third) const {
  if (std::isfinite(value)) return value;
  std::string where;
  if (!constant()) {
    const std::array<double, 3> arguments{first, second, third};
    for (std::size_t i = 0; i < variables_.size(); ++i)
      where += fmt::format("{}{} = {}", i == 0 ? " at " : ", ", variables_[i], arguments.at(i));
  }
  throw FormulaError(
      fmt::format("{}\"{}\" is {}{}", what, text(), std::isnan(value) ? "not a number" : "infinite", where));
}

double Formula::operator()(double first, double second, double third) const {
  if (constant()) return finite(value_, "", 0, 0);
  return finite(tree_->value(std::array{first, second, third}), "", first, second, third);
}

double Formula::derivative(double first, double second) const {
  if (constant()) return 0;
  return finite((*tree_)(std::array{first, second}).first, "the derivative of ", first, second);
}

double Formula::second_derivative(double first, double second) const {
  if (constant()) return 0;
  return finite((*tree_)(std::array{first, second}).second, "the second derivative of ", first, second);
}

namespace {

class FunctionOfFormula final : public Function {
 public:
  explicit FunctionOfFormula(Formula formula) : formula_(std::move(formula)) {}
  Jet operator()(const Jet& x, std::vector<Jet>* switches) const override {
    return formula_.constant() ? Jet{formula_()} : (*formula_.expression())(x, switches);
  }
  bool has_switches() const override { return !formula_.constant() && formula_.expression()->has_switches(); }

 private:
  Formula formula_;
};

}  // namespace

std::shared_ptr<const Function> function_of(const Formula& formula) {
  return std::make_shared<FunctionOfFormula>(formula);
}

std::vector<std::string> formula_names() {
  std::vector<std::string> names{"pi", "e"};
  for (const auto& [name, function] : known_functions()) names.push_back(name);
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace floe::math
