#pragma once
#include <initializer_list>
#include <map>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace floe::math {

class Expression;
class Function;

/// A formula does not parse, names something unknown, or yields NaN or infinity. what() says which and where in the
/// text.
class FormulaError : public std::runtime_error {
 public:
  explicit FormulaError(const std::string& text, const std::string& unknown_name = {})
      : std::runtime_error(text), unknown(unknown_name) {}
  std::string unknown;  ///< the name that is neither variable, constant nor function; empty for other faults
};

/// What formulas may call by name beside their variables, and beside pi, e and the functions of formula_names().
struct Names {
  std::map<std::string, double> numbers;                             ///< the scene's parameters
  std::map<std::string, std::shared_ptr<const Function>> functions;  ///< of one argument
  Names() = default;
  Names(std::initializer_list<std::pair<const std::string, double>> some) : numbers(some) {}
};

/// A real function of named variables, read from text as `2500*sin(9.5*t)`. Copies share the tree that it is.
///
/// Functions: sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp ln log (natural) log2 log10 sqrt
/// abs sign rint min max sum avg, and
///   triangle(t, rise, fall)  0 -> 1 over `rise`, 1 -> 0 over `fall`, else 0
///   ramp(t, from, to)        0 before `from`, linear, 1 after `to`
///   smooth(t, from, to)      the same by 6 x^5 - 15 x^4 + 10 x^3: with its first two derivatives 0 at both ends
///   pulse(t, from, to)       1 for from <= t < to, else 0
class Formula {
 public:
  /// The constant 0.
  Formula() : Formula(0.0) {}
  Formula(double constant);  // NOLINT: a number is a formula
  /// @param variables  in the order of the arguments of operator(), at most three
  /// @throws FormulaError
  Formula(const std::string& text, const std::vector<std::string>& variables, const Names& names);
  /// A formula of t and of what sensors measure: every name with a dot, as hinge.angle, is a variable behind t.
  /// @throws FormulaError
  static Formula of_sensors(const std::string& text, const Names& names);

  /// @throws FormulaError when the value is not finite (its text names the formula and the arguments)
  double operator()(double first = 0, double second = 0, double third = 0) const;
  /// d/dfirst, exact up to round-off (forward-mode differentiation of the text); at a kink or a jump that of the branch
  /// taken, as after the corner of a ramp.
  /// @throws FormulaError as operator()
  double derivative(double first, double second = 0) const;
  /// d2/dfirst2 likewise.
  double second_derivative(double first, double second = 0) const;

  /// Of any number of variables. @param arguments  as variables()  @throws FormulaError as operator()
  double value(std::span<const double> arguments) const;
  /// The same with the derivative by each (forward-mode differentiation, once for each variable).
  /// @param arguments    as variables();  @param derivatives  of the same length
  /// @throws FormulaError as operator()
  double gradient(std::span<const double> arguments, std::span<double> derivatives) const;

  /// Mentions none of its variables.
  bool constant() const { return !tree_; }
  /// In the order of the arguments.
  const std::vector<std::string>& variables() const { return variables_; }
  /// Whether it depends on more than the first variable, the time.
  bool has_sensors() const { return variables_.size() > 1; }
  const std::string& text() const { return text_; }
  /// The formula as a tree, for breaks(); null where it is constant.
  const Expression* expression() const { return tree_.get(); }

 private:
  Formula(const std::string& text, const std::vector<std::string>& variables, const Names& names, bool dotted);
  double finite(double value, const char* what, std::span<const double> arguments) const;
  std::string text_;
  std::vector<std::string> variables_;
  double value_ = 0;  // of a constant
  std::shared_ptr<const Expression> tree_;
};

/// The names that every formula knows: pi, e and the functions. Sorted.
std::vector<std::string> formula_names();

/// A formula of one variable as a function that other formulas may call.
std::shared_ptr<const Function> function_of(const Formula& formula);

/// A function given at points.
struct Table {
  std::vector<double> x, y;  ///< x ascending, at least two
  /// cubic: Fritsch and Carlson's, which is monotone where the points are and has a continuous first derivative
  /// (SIAM J. Numer. Anal. 17, 1980).
  enum class Interpolation { linear, cubic } interpolation = Interpolation::linear;
  /// Repeated beyond its ends, with the period x_last - x_first; else the first and the last value go on.
  bool periodic = false;
};
std::shared_ptr<const Function> function_of(Table table);

}  // namespace floe::math
