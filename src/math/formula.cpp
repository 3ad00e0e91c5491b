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
    : Formula(text, variables, names, false) {}

Formula::Formula(const std::string& text, const std::vector<std::string>& variables, const Names& names, bool dotted)
    : text_(text), variables_(variables), tree_(std::make_shared<Expression>(text, variables_, names, dotted)) {
  if (!tree_->constant()) return;
  value_ = tree_->value({});
  tree_ = nullptr;
  finite(value_, "", {});
}

Formula Formula::of_sensors(const std::string& text, const Names& names) { return {text, {"t"}, names, true}; }

double Formula::finite(double value, const char* what, std::span<const double> arguments) const {
  if (std::isfinite(value)) return value;
  std::string where;
  if (!constant())
    for (std::size_t i = 0; i < std::min(variables_.size(), arguments.size()); ++i)
      where += fmt::format("{}{} = {}", i == 0 ? " at " : ", ", variables_[i], arguments[i]);
  throw FormulaError(
      fmt::format("{}\"{}\" is {}{}", what, text(), std::isnan(value) ? "not a number" : "infinite", where));
}

double Formula::operator()(double first, double second, double third) const {
  if (constant()) return finite(value_, "", {});
  const std::array arguments{first, second, third};
  return finite(tree_->value(arguments), "", arguments);
}

double Formula::derivative(double first, double second) const {
  if (constant()) return 0;
  const std::array arguments{first, second};
  return finite((*tree_)(arguments).first, "the derivative of ", arguments);
}

double Formula::second_derivative(double first, double second) const {
  if (constant()) return 0;
  const std::array arguments{first, second};
  return finite((*tree_)(arguments).second, "the second derivative of ", arguments);
}

double Formula::value(std::span<const double> arguments) const {
  return finite(constant() ? value_ : tree_->value(arguments), "", arguments);
}

double Formula::gradient(std::span<const double> arguments, std::span<double> derivatives) const {
  if (constant()) {
    std::fill(derivatives.begin(), derivatives.end(), 0.);
    return finite(value_, "", {});
  }
  std::vector<Jet> jets;
  for (const double argument : arguments) jets.push_back({argument});
  double value = 0;
  for (std::size_t i = 0; i < jets.size(); ++i) {
    jets[i].first = 1;
    const Jet jet = tree_->along(jets);
    jets[i].first = 0;
    value = finite(jet.value, "", arguments);
    derivatives[i] = finite(jet.first, "the derivative of ", arguments);
  }
  return value;
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
