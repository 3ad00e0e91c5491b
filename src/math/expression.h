#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "floe/math/formula.h"
#include "jet.h"

namespace floe::math {

/// A formula as a tree that is evaluated with its derivatives (forward mode): exact up to round-off, whatever the scale
/// of time, and from inside where the formula ends, as t^2.5 does at 0. At kinks and jumps, that of the branch taken.
///
/// Its switches are the quantities whose sign decides on a branch (t - from of a ramp, a - b of a comparison or of
/// min(a, b), x of abs(x) and of sqrt(x)): the derivatives can jump or be infinite only where one of them changes its
/// sign.
///
/// Numbers, names, + - * / ^ (to the right), comparisons, && ||, c ? a : b, functions.
class Expression {
 public:
  struct Node;
  /// @param variables  to which names with a dot (`hinge.angle`) are appended in the order in which they occur, if they
  ///                   are given by `dotted`; else they are unknown
  /// @throws FormulaError
  Expression(const std::string& text, std::vector<std::string>& variables, const Names& names, bool dotted = false);
  /// Here and below, variables that are not given are 1 (sensors, where only time counts).
  double value(std::span<const double> variables) const;
  /// With derivatives along a line through the space of the variables.
  Jet along(std::span<const Jet> variables) const;
  /// By the first of the variables.
  Jet operator()(std::span<const double> variables) const;
  /// Appends the switches, of the branches that are taken alone: their number may change where one of them does.
  Jet operator()(std::span<const double> variables, std::vector<Jet>& switches) const;
  /// The same at an argument that varies itself.
  Jet operator()(const Jet& variable, std::vector<Jet>* switches) const;
  /// Whether there is any.
  bool has_switches() const;
  /// Mentions none of its variables.
  bool constant() const { return constant_; }

 private:
  std::shared_ptr<const Node> root_;
  bool constant_ = true;
  std::size_t count_ = 0;  // of variables
};

}  // namespace floe::math
