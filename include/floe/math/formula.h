#pragma once
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace floe::math {

class Expression;

/// A formula does not parse, names something unknown, or yields NaN or infinity. what() says which and where in the
/// text.
class FormulaError : public std::runtime_error {
 public:
  explicit FormulaError(const std::string& text, const std::string& unknown_name = {})
      : std::runtime_error(text), unknown(unknown_name) {}
  std::string unknown;  ///< the name that is neither variable, constant nor function; empty for other faults
};

/// A real function of named variables, read from text as `2500*sin(9.5*t)`; evaluated by muParser. Copies share the
/// parser.
///
/// Beyond muParser's functions (sin, exp, sqrt, min, ..., and `condition ? a : b`) it knows
///   triangle(t, rise, fall)  0 -> 1 over `rise`, 1 -> 0 over `fall`, else 0
///   ramp(t, from, to)        0 before `from`, linear, 1 after `to`
///   pulse(t, from, to)       1 for from <= t < to, else 0
/// Not thread-safe. Source: https://beltoforion.de/en/muparser
class Formula {
 public:
  /// The constant 0.
  Formula() : Formula(0.0) {}
  Formula(double constant);  // NOLINT: a number is a formula
  /// @param variables  in the order of the arguments of operator(), at most three
  /// @param constants  named numbers (the scene's parameters); pi and e are always known
  /// @throws FormulaError
  Formula(const std::string& text, const std::vector<std::string>& variables,
          const std::map<std::string, double>& constants);

  /// @throws FormulaError when the value is not finite (its text names the formula and the arguments)
  double operator()(double first = 0, double second = 0, double third = 0) const;
  /// d/dfirst, exact up to round-off (forward-mode differentiation of the text); at a kink or a jump that of the branch
  /// taken, as after the corner of a ramp.
  /// @throws FormulaError as operator()
  double derivative(double first, double second = 0) const;
  /// d2/dfirst2 likewise.
  double second_derivative(double first, double second = 0) const;

  /// Mentions none of its variables.
  bool constant() const;
  const std::string& text() const;
  /// The formula as a tree, for breaks(); null where it has no derivatives, and of a number.
  const Expression* expression() const;

 private:
  double finite(double value, const char* what, double first, double second, double third = 0) const;
  const Expression& tree() const;
  struct Parser;
  std::shared_ptr<Parser> parser_;
};

/// The names that every formula knows: pi, e and the functions. Sorted.
std::vector<std::string> formula_names();

}  // namespace floe::math
