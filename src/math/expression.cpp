#include "expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <numbers>

#include "function.h"
#include "functions.h"

namespace floe::math {

using NodePointer = std::shared_ptr<const Expression::Node>;

struct Expression::Node {
  Operation operation;     // none: a number, a variable or a function of the scene
  Switches switches = {};  // none: smooth wherever it is finite
  std::vector<NodePointer> children;
  double number = 0;
  int variable = -1;
  bool choice = false;  // children: condition, then, else; only the one that is taken is looked at
  std::shared_ptr<const Function> function = nullptr;  // of its child

  Jet evaluate(std::span<const Jet> variables, std::vector<Jet>* seen) const {
    if (choice) {
      const Jet condition = children[0]->evaluate(variables, seen);
      if (seen) seen->push_back(condition);
      return children[condition.value != 0 ? 1 : 2]->evaluate(variables, seen);
    }
    if (function) return (*function)(children[0]->evaluate(variables, seen), seen);
    if (!operation) return variable < 0 ? Jet{number} : variables[static_cast<std::size_t>(variable)];
    constexpr std::size_t few = 4;
    if (children.size() > few) {
      std::vector<Jet> arguments;
      for (const NodePointer& child : children) arguments.push_back(child->evaluate(variables, seen));
      return apply(arguments, seen);
    }
    std::array<Jet, few> arguments;
    for (std::size_t i = 0; i < children.size(); ++i) arguments[i] = children[i]->evaluate(variables, seen);
    return apply({arguments.data(), children.size()}, seen);
  }
  bool has_switches() const {
    return choice || switches || (function && function->has_switches()) ||
           std::any_of(children.begin(), children.end(),
                       [](const NodePointer& child) { return child->has_switches(); });
  }

 private:
  Jet apply(Arguments arguments, std::vector<Jet>* seen) const {
    if (seen && switches) switches(arguments, *seen);
    return operation(arguments);
  }
};

namespace {

NodePointer make(Operation operation, std::vector<NodePointer> children, Switches switches = {}) {
  auto node = std::make_shared<Expression::Node>();
  node->operation = std::move(operation), node->children = std::move(children), node->switches = std::move(switches);
  return node;
}

/// Of a comparison.
NodePointer comparing(std::function<bool(double, double)> holds, const NodePointer& left, const NodePointer& right) {
  return make([holds = std::move(holds)](Arguments a) { return Jet{holds(a[0].value, a[1].value) ? 1.0 : 0.0}; },
              {left, right}, [](Arguments a, std::vector<Jet>& switches) { switches.push_back(a[0] - a[1]); });
}

Operation compared(std::function<bool(double, double)> holds) {
  return [holds = std::move(holds)](Arguments a) { return Jet{holds(a[0].value, a[1].value) ? 1.0 : 0.0}; };
}

/// By recursive descent, a level for each precedence.
struct Reader {
  const std::string& text;
  std::vector<std::string>& variables;
  const Names& names;
  bool dotted = false;
  std::size_t at = 0;
  bool constant = true;

  [[noreturn]] void refuse(const std::string& why) const {
    throw FormulaError(fmt::format("\"{}\" does not parse: {}", text, why));
  }
  [[noreturn]] void refuse_rest() const {
    if (at >= text.size()) refuse("it ends where a number, a name or \"(\" is expected");
    if (text[at] == '=' && text.compare(at, 2, "==") != 0)
      throw FormulaError(fmt::format("\"{}\" assigns at character {}; compare with ==", text, at + 1));
    std::size_t end = at + 1;  // of the character, which may have several bytes
    while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
    refuse(fmt::format("unexpected \"{}\" at character {}", text.substr(at, end - at), at + 1));
  }
  void skip_blanks() {
    while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at]))) ++at;
  }
  bool take(const std::string& word) {
    skip_blanks();
    if (text.compare(at, word.size(), word) != 0) return false;
    at += word.size();
    return true;
  }
  void expect(const std::string& word, const std::string& what) {
    if (take(word)) return;
    if (at >= text.size()) refuse("missing " + what);
    refuse_rest();
  }
  NodePointer whole() {
    NodePointer root = choice();
    skip_blanks();
    if (at == text.size()) return root;
    if (text[at] == ',') throw FormulaError(fmt::format("\"{}\" is more than one formula", text));
    refuse_rest();
  }

  NodePointer choice() {
    NodePointer condition = alternative();
    if (!take("?")) return condition;
    auto node = std::make_shared<Expression::Node>();
    const NodePointer yes = choice();
    expect(":", "\":\" of the condition");
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
        left = make([](Arguments a) { return a[0] + a[1]; }, {left, product()});
      else if (take("-"))
        left = make([](Arguments a) { return a[0] - a[1]; }, {left, product()});
      else
        return left;
    }
  }
  NodePointer product() {
    NodePointer left = signed_power();
    for (;;) {
      if (take("*"))
        left = make([](Arguments a) { return a[0] * a[1]; }, {left, signed_power()});
      else if (take("/"))
        left = make([](Arguments a) { return a[0] / a[1]; }, {left, signed_power()});
      else
        return left;
    }
  }
  NodePointer signed_power() {
    if (take("-")) return make([](Arguments a) { return -a[0]; }, {signed_power()});
    if (take("+")) return signed_power();
    NodePointer base = primary();
    if (!take("^")) return base;
    return make([](Arguments a) { return power(a[0], a[1]); }, {base, signed_power()}, power_switches);
  }
  NodePointer primary() {
    skip_blanks();
    if (take("(")) {
      NodePointer inner = choice();
      expect(")", "parenthesis");
      return inner;
    }
    if (at >= text.size()) refuse_rest();
    const auto first = static_cast<unsigned char>(text[at]);
    if (std::isdigit(first) || first == '.') return number();
    if (std::isalpha(first) || first == '_') return named();
    refuse_rest();
  }
  NodePointer number() {
    auto node = std::make_shared<Expression::Node>();
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), node->number);
    if (error == std::errc::result_out_of_range)
      node->number = std::strtod(text.substr(at, static_cast<std::size_t>(end - text.data()) - at).c_str(), nullptr);
    else if (error != std::errc())
      refuse(fmt::format("no number at character {}", at + 1));
    at = static_cast<std::size_t>(end - text.data());
    return node;
  }
  bool continues_name(std::size_t i) const {
    return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) || text[i] == '_');
  }
  NodePointer named() {
    const std::size_t start = at;
    while (continues_name(at)) ++at;
    const bool has_dot = at < text.size() && text[at] == '.' && continues_name(at + 1);
    if (has_dot) ++at;
    while (has_dot && continues_name(at)) ++at;
    const std::string name = text.substr(start, at - start);
    auto node = std::make_shared<Expression::Node>();
    if (has_dot && dotted && std::find(variables.begin(), variables.end(), name) == variables.end())
      variables.push_back(name);
    if (const auto variable = std::find(variables.begin(), variables.end(), name); variable != variables.end()) {
      constant = false;
      return node->variable = static_cast<int>(variable - variables.begin()), node;
    }
    if (const auto known = names.numbers.find(name); known != names.numbers.end())
      return node->number = known->second, node;
    if (name == "pi") return node->number = std::numbers::pi, node;
    if (name == "e") return node->number = std::numbers::e, node;
    if (const auto own = names.functions.find(name); own != names.functions.end())
      return node->children = arguments(name, 1), node->function = own->second, node;
    const auto function = known_functions().find(name);
    if (function == known_functions().end())
      throw FormulaError(fmt::format("\"{}\" at character {} of \"{}\" is unknown", name, start + 1, text), name);
    return make(function->second.operation, arguments(name, function->second.arguments), function->second.switches);
  }
  std::vector<NodePointer> arguments(const std::string& function, int count) {
    std::vector<NodePointer> all;
    expect("(", fmt::format("\"(\" after {}", function));
    do all.push_back(choice());
    while (take(","));
    expect(")", "parenthesis");
    if (count > 0 && static_cast<int>(all.size()) != count)
      refuse(fmt::format("{} has {} arguments, not {}", function, count, all.size()));
    return all;
  }
};

/// The variables, of which the first varies; f(jets). Those that are not given are 1.
template <class F>
auto with_jets(std::span<const double> variables, std::size_t count, bool varies, const F& f) {
  constexpr std::size_t few = 3;
  std::array<Jet, few> some;
  std::vector<Jet> many;
  if (count > few) many.resize(count);
  const std::span<Jet> all = count > few ? std::span<Jet>(many) : std::span<Jet>(some);
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = {i < variables.size() ? variables[i] : 1, varies && i == 0 ? 1.0 : 0.0, 0};
  return f(all);
}

}  // namespace

Expression::Expression(const std::string& text, std::vector<std::string>& variables, const Names& names, bool dotted) {
  Reader reader{text, variables, names, dotted};
  root_ = reader.whole();
  constant_ = reader.constant, count_ = variables.size();
}

double Expression::value(std::span<const double> variables) const {
  return with_jets(variables, count_, false, [&](auto jets) { return root_->evaluate(jets, nullptr).value; });
}
Jet Expression::along(std::span<const Jet> variables) const { return root_->evaluate(variables, nullptr); }
Jet Expression::operator()(std::span<const double> variables) const {
  return with_jets(variables, count_, true, [&](auto jets) { return root_->evaluate(jets, nullptr); });
}
Jet Expression::operator()(std::span<const double> variables, std::vector<Jet>& switches) const {
  return with_jets(variables, count_, true, [&](auto jets) { return root_->evaluate(jets, &switches); });
}
Jet Expression::operator()(const Jet& variable, std::vector<Jet>* switches) const {
  return root_->evaluate({&variable, 1}, switches);
}
bool Expression::has_switches() const { return root_->has_switches(); }

}  // namespace floe::math
