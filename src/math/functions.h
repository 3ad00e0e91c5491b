#pragma once
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "jet.h"

namespace floe::math {

using Arguments = std::span<const Jet>;
using Operation = std::function<Jet(Arguments)>;
/// Appends the quantities whose sign decides on a branch (Expression).
using Switches = std::function<void(Arguments, std::vector<Jet>&)>;

/// Of a power: none of a whole exponent >= 0.
void power_switches(Arguments a, std::vector<Jet>& switches);

/// A function that every formula knows.
struct KnownFunction {
  Operation operation;
  int arguments = 1;       ///< 0: one or more
  Switches switches = {};  ///< none: smooth wherever it is finite
};

/// By name.
const std::map<std::string, KnownFunction>& known_functions();

}  // namespace floe::math
