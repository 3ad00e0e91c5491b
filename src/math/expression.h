#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "jet.h"

namespace floe::math {

/// A formula as a tree that is evaluated with its derivatives (forward mode): exact up to round-off, whatever the scale
/// of time, and from inside where the formula ends, as t^2.5 does at 0. At kinks and jumps, that of the branch taken.
///
/// Its switches are the quantities whose sign decides on a branch (t - from of a ramp, a - b of a comparison or of
/// min(a, b), x of abs(x) and of sqrt(x)): the derivatives can jump or be infinite only where one of them changes its
/// sign.
///
/// Reads what muParser reads: numbers, names, + - * / ^ (to the right), comparisons, && ||, c ? a : b, functions.
class Expression {
 public:
  struct Node;
  /// @return  nothing where the text has something that this does not know
  static std::shared_ptr<const Expression> read(const std::string& text, const std::vector<std::string>& variables,
                                                const std::map<std::string, double>& constants);
  /// By the first of the variables.
  Jet operator()(const std::vector<double>& variables) const;
  /// Appends the switches, of the branches that are taken alone: their number may change where one of them does.
  Jet operator()(const std::vector<double>& variables, std::vector<Jet>& switches) const;
  /// Whether there is any.
  bool has_switches() const;

 private:
  std::shared_ptr<const Node> root_;
};

}  // namespace floe::math
