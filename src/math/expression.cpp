#include "expression.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <optional>

namespace floe::math {

using Arguments = std::vector<Jet>;
using Operation = std::function<Jet(const Arguments&)>;
using Switches = std::function<void(const Arguments&, std::vector<Jet>&)>;
using NodePointer = std::shared_ptr<const Expression::Node>;

struct Expression::Node {
  Operation operation;     // none: a number or a variable
  Switches switches = {};  // none: smooth wherever it is finite
  std::vector<NodePointer> children;
  double number = 0;
  int variable = -1;
  bool choice = false;  // children: condition, then, else; only the one that is taken is looked at

  Jet evaluate(const std::vector<double>& variables, std::vector<Jet>* seen) const {
    if (choice) {
      const Jet condition = children[0]->evaluate(variables, seen);
      if (seen) seen->push_back(condition);
      return children[condition.value != 0 ? 1 : 2]->evaluate(variables, seen);
    }
    if (!operation) return variable < 0 ? Jet{number} : Jet{variables[variable], variable == 0 ? 1.0 : 0.0, 0};
    Arguments arguments;
    for (const NodePointer& child : children) arguments.push_back(child->evaluate(variables, seen));
    if (seen && switches) switches(arguments, *seen);
    return operation(arguments);
  }
  bool has_switches() const {
    return choice || switches || std::any_of(children.begin(), children.end(), [](const NodePointer& child) {
             return child->has_switches();
           });
  }
};

namespace {

struct Unknown {};

/// A function of one argument with its derivatives.
Operation of_one(double (*f)(double), double (*df)(double), double (*ddf)(double)) {
  return [=](const Arguments& a) {
    const double x = a.at(0).value;
    return a[0].constant() ? Jet{f(x)} : chain(a[0], f(x), df(x), ddf(x));
  };
}

double zero(double) { return 0; }

/// A function that is constant in pieces.
Operation steps(double (*f)(double)) { return of_one(f, zero, zero); }

Jet extreme(const Arguments& a, bool greatest) {
  const auto less = [](const Jet& one, const Jet& two) { return one.value < two.value; };
  return greatest ? *std::max_element(a.begin(), a.end(), less) : *std::min_element(a.begin(), a.end(), less);
}

Jet sum(const Arguments& a) {
  Jet s;
  for (const Jet& term : a) s = s + term;
  return s;
}

struct Function {
  Operation operation;
  int arguments = 1;  // 0: one or more
  Switches switches = {};
};

/// Of functions with a kink or a jump at 0.
void by_value(const Arguments& a, std::vector<Jet>& switches) { switches.push_back(a[0]); }

/// Of those with an end at 0: also where the argument touches 0.
void by_sign(const Arguments& a, std::vector<Jet>& switches) {
  switches.push_back(a[0]);
  switches.push_back({a[0].first, a[0].second, 0});
}

/// Of ramp and pulse.
void between_two(const Arguments& a, std::vector<Jet>& switches) {
  switches.insert(switches.end(), {a[0] - a[1], a[0] - a[2]});
}

/// Of min and max: each pair.
void by_order(const Arguments& a, std::vector<Jet>& switches) {
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = i + 1; j < a.size(); ++j) switches.push_back(a[i] - a[j]);
}

/// Of a power: none of a whole exponent >= 0.
void by_base(const Arguments& a, std::vector<Jet>& switches) {
  if (!a[1].constant() || a[1].value < 0 || a[1].value != std::floor(a[1].value)) by_sign(a, switches);
}

/// Of asin and the like, which end at -1 and 1.
void by_ends(const Arguments& a, std::vector<Jet>& switches) {
  switches.push_back(Jet{1} - a[0] * a[0]);
  switches.push_back({a[0].first, a[0].second, 0});
}

const std::map<std::string, Function>& functions() {
  using D = double;
  static const std::map<std::string, Function> all{
      {"sin", {of_one(std::sin, std::cos, [](D x) { return -std::sin(x); })}},
      {"cos",
       {of_one(
           std::cos, [](D x) { return -std::sin(x); }, [](D x) { return -std::cos(x); })}},
      {"tan",
       {of_one(
           std::tan, [](D x) { return 1 + std::pow(std::tan(x), 2); },
           [](D x) { return 2 * std::tan(x) * (1 + std::pow(std::tan(x), 2)); })}},
      {"asin",
       {of_one(
            std::asin, [](D x) { return 1 / std::sqrt(1 - x * x); }, [](D x) { return x / std::pow(1 - x * x, 1.5); }),
        1, by_ends}},
      {"acos",
       {of_one(
            std::acos, [](D x) { return -1 / std::sqrt(1 - x * x); },
            [](D x) { return -x / std::pow(1 - x * x, 1.5); }),
        1, by_ends}},
      {"atan",
       {of_one(
           std::atan, [](D x) { return 1 / (1 + x * x); }, [](D x) { return -2 * x / std::pow(1 + x * x, 2); })}},
      {"sinh", {of_one(std::sinh, std::cosh, std::sinh)}},
      {"cosh", {of_one(std::cosh, std::sinh, std::cosh)}},
      {"tanh",
       {of_one(
           std::tanh, [](D x) { return 1 - std::pow(std::tanh(x), 2); },
           [](D x) { return -2 * std::tanh(x) * (1 - std::pow(std::tanh(x), 2)); })}},
      {"asinh",
       {of_one(
           std::asinh, [](D x) { return 1 / std::sqrt(1 + x * x); },
           [](D x) { return -x / std::pow(1 + x * x, 1.5); })}},
      {"acosh",
       {of_one(
           std::acosh, [](D x) { return 1 / std::sqrt(x * x - 1); },
           [](D x) { return -x / std::pow(x * x - 1, 1.5); })}},
      {"atanh",
       {of_one(
           std::atanh, [](D x) { return 1 / (1 - x * x); }, [](D x) { return 2 * x / std::pow(1 - x * x, 2); })}},
      {"exp", {of_one(std::exp, std::exp, std::exp)}},
      {"ln",
       {of_one(
           std::log, [](D x) { return 1 / x; }, [](D x) { return -1 / (x * x); })}},
      {"log",
       {of_one(
           std::log, [](D x) { return 1 / x; }, [](D x) { return -1 / (x * x); })}},
      {"log2",
       {of_one(
           std::log2, [](D x) { return std::numbers::log2e / x; },
           [](D x) { return -std::numbers::log2e / (x * x); })}},
      {"log10",
       {of_one(
           std::log10, [](D x) { return std::numbers::log10e / x; },
           [](D x) { return -std::numbers::log10e / (x * x); })}},
      {"sqrt",
       {of_one(
            std::sqrt, [](D x) { return 0.5 / std::sqrt(x); }, [](D x) { return -0.25 / (x * std::sqrt(x)); }),
        1, by_sign}},
      {"abs",
       {of_one(
            std::fabs, [](D x) { return x < 0   ? -1.0
                                        : x > 0 ? 1.0
                                                : 0.0; }, zero),
        1, by_value}},
      {"sign", {steps([](D x) { return x < 0   ? -1.0
                                       : x > 0 ? 1.0
                                               : 0.0; }), 1, by_value}},
      {"rint",
       {steps([](D x) { return std::floor(x + 0.5); }), 1,
        [](const Arguments& a, std::vector<Jet>& switches) {  // x = k + 1/2
          const double y = std::numbers::pi * a[0].value;
          switches.push_back(chain(a[0], std::cos(y), -std::numbers::pi * std::sin(y), 0));
        }}},
      {"atan2",
       {[](const Arguments& a) {
          Jet angle = Jet{std::atan2(a[0].value, a[1].value)};
          const Jet square = a[0] * a[0] + a[1] * a[1];
          const Jet &y = a[0], &x = a[1];
          // (x y' - y x') / (x^2 + y^2), and its derivative
          const double top = x.value * y.first - y.value * x.first, change = x.value * y.second - y.value * x.second;
          if (y.constant() && x.constant()) return angle;
          angle.first = top / square.value;
          angle.second = (change - angle.first * square.first) / square.value;
          return angle;
        },
        2,
        [](const Arguments& a, std::vector<Jet>& switches) {  // the cut along the negative axis
          switches.push_back(a[1]);
          if (a[1].value < 0) switches.push_back(a[0]);
        }}},
      {"min", {[](const Arguments& a) { return extreme(a, false); }, 0, by_order}},
      {"max", {[](const Arguments& a) { return extreme(a, true); }, 0, by_order}},
      {"sum", {sum, 0}},
      {"avg", {[](const Arguments& a) { return sum(a) / Jet{static_cast<double>(a.size())}; }, 0}},
      {"triangle",
       {[](const Arguments& a) {
          const Jet &t = a[0], &rise = a[1], &fall = a[2];
          if (t.value < 0 || t.value >= rise.value + fall.value) return Jet{};
          return t.value < rise.value ? t / rise : (rise + fall - t) / fall;
        },
        3,
        [](const Arguments& a, std::vector<Jet>& switches) {
          switches.insert(switches.end(), {a[0], a[0] - a[1], a[0] - a[1] - a[2]});
        }}},
      {"ramp",
       {[](const Arguments& a) {
          if (a[0].value < a[1].value) return Jet{0};
          if (a[0].value >= a[2].value) return Jet{1};
          return (a[0] - a[1]) / (a[2] - a[1]);
        },
        3, between_two}},
      {"pulse",
       {[](const Arguments& a) { return Jet{a[1].value <= a[0].value && a[0].value < a[2].value ? 1.0 : 0.0}; }, 3,
        between_two}},
  };
  return all;
}  // NOLINT(clang-analyzer-cplusplus.NewDeleteLeaks): they are static

NodePointer make(Operation operation, std::vector<NodePointer> children, Switches switches = {}) {
  auto node = std::make_shared<Expression::Node>();
  node->operation = std::move(operation), node->children = std::move(children), node->switches = std::move(switches);
  return node;
}

/// Of a comparison.
NodePointer comparing(std::function<bool(double, double)> holds, const NodePointer& left, const NodePointer& right) {
  return make([holds = std::move(holds)](const Arguments& a) { return Jet{holds(a[0].value, a[1].value) ? 1.0 : 0.0}; },
              {left, right}, [](const Arguments& a, std::vector<Jet>& switches) { switches.push_back(a[0] - a[1]); });
}

Operation compared(std::function<bool(double, double)> holds) {
  return [holds = std::move(holds)](const Arguments& a) { return Jet{holds(a[0].value, a[1].value) ? 1.0 : 0.0}; };
}

/// By recursive descent, a level for each precedence.
struct Reader {
  const std::string& text;
  const std::vector<std::string>& variables;
  const std::map<std::string, double>& constants;
  std::size_t at = 0;

  void skip_blanks() {
    while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at]))) ++at;
  }
  bool take(const std::string& word) {
    skip_blanks();
    if (text.compare(at, word.size(), word) != 0) return false;
    at += word.size();
    return true;
  }
  void expect(const std::string& word) {
    if (!take(word)) throw Unknown{};
  }

  NodePointer choice() {
    NodePointer condition = alternative();
    if (!take("?")) return condition;
    auto node = std::make_shared<Expression::Node>();
    const NodePointer yes = choice();
    expect(":");
    node->choice = true, node->children = {condition, yes, choice()};
    return node;
  }
  NodePointer alternative() {
    NodePointer left = conjunction();
    while (take("||"))
      left = make(compared([](double a, double b) { return a != 0 || b != 0; }), {left, conjunction()});
    return left;
  }
  NodePointer conjunction() {
    NodePointer left = comparison();
    while (take("&&")) left = make(compared([](double a, double b) { return a != 0 && b != 0; }), {left, comparison()});
    return left;
  }
  NodePointer comparison() {
    NodePointer left = addition();
    for (;;) {
      if (take("<="))
        left = comparing(std::less_equal<>(), left, addition());
      else if (take(">="))
        left = comparing(std::greater_equal<>(), left, addition());
      else if (take("!="))
        left = comparing(std::not_equal_to<>(), left, addition());
      else if (take("=="))
        left = comparing(std::equal_to<>(), left, addition());
      else if (take("<"))
        left = comparing(std::less<>(), left, addition());
      else if (take(">"))
        left = comparing(std::greater<>(), left, addition());
      else
        return left;
    }
  }
  NodePointer addition() {
    NodePointer left = product();
    for (;;) {
      if (take("+"))
        left = make([](const Arguments& a) { return a[0] + a[1]; }, {left, product()});
      else if (take("-"))
        left = make([](const Arguments& a) { return a[0] - a[1]; }, {left, product()});
      else
        return left;
    }
  }
  NodePointer product() {
    NodePointer left = signed_power();
    for (;;) {
      if (take("*"))
        left = make([](const Arguments& a) { return a[0] * a[1]; }, {left, signed_power()});
      else if (take("/"))
        left = make([](const Arguments& a) { return a[0] / a[1]; }, {left, signed_power()});
      else
        return left;
    }
  }
  NodePointer signed_power() {
    if (take("-")) return make([](const Arguments& a) { return -a[0]; }, {signed_power()});
    if (take("+")) return signed_power();
    NodePointer base = primary();
    if (!take("^")) return base;
    return make([](const Arguments& a) { return power(a[0], a[1]); }, {base, signed_power()}, by_base);
  }
  NodePointer primary() {
    skip_blanks();
    if (at >= text.size()) throw Unknown{};
    if (take("(")) {
      NodePointer inner = choice();
      expect(")");
      return inner;
    }
    if (std::isdigit(static_cast<unsigned char>(text[at])) || text[at] == '.') return number();
    return named();
  }
  NodePointer number() {
    char* end = nullptr;
    auto node = std::make_shared<Expression::Node>();
    node->number = std::strtod(text.c_str() + at, &end);
    if (end == text.c_str() + at) throw Unknown{};
    at = static_cast<std::size_t>(end - text.c_str());
    return node;
  }
  NodePointer named() {
    const std::size_t start = at;
    while (at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) || text[at] == '_')) ++at;
    const std::string name = text.substr(start, at - start);
    auto node = std::make_shared<Expression::Node>();
    const auto variable = std::find(variables.begin(), variables.end(), name);
    if (variable != variables.end()) return node->variable = static_cast<int>(variable - variables.begin()), node;
    if (const auto known = constants.find(name); known != constants.end()) return node->number = known->second, node;
    if (name == "pi") return node->number = std::numbers::pi, node;
    if (name == "e") return node->number = std::numbers::e, node;
    const auto function = functions().find(name);
    if (function == functions().end()) throw Unknown{};
    return make(function->second.operation, arguments(function->second.arguments), function->second.switches);
  }
  std::vector<NodePointer> arguments(int count) {
    std::vector<NodePointer> all;
    expect("(");
    do all.push_back(choice());
    while (take(","));
    expect(")");
    if (count > 0 && static_cast<int>(all.size()) != count) throw Unknown{};
    return all;
  }
};

}  // namespace

std::shared_ptr<const Expression> Expression::read(const std::string& text, const std::vector<std::string>& variables,
                                                   const std::map<std::string, double>& constants) {
  try {
    Reader reader{text, variables, constants};
    auto expression = std::make_shared<Expression>();
    expression->root_ = reader.choice();
    reader.skip_blanks();
    if (reader.at != text.size()) return nullptr;
    return expression;
  } catch (const Unknown&) {
    return nullptr;
  }
}

Jet Expression::operator()(const std::vector<double>& variables) const { return root_->evaluate(variables, nullptr); }
Jet Expression::operator()(const std::vector<double>& variables, std::vector<Jet>& switches) const {
  return root_->evaluate(variables, &switches);
}
bool Expression::has_switches() const { return root_->has_switches(); }

}  // namespace floe::math
