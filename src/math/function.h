#pragma once
#include <vector>

#include "jet.h"

namespace floe::math {

/// A function of one argument that formulas call by a name of the scene.
class Function {
 public:
  virtual ~Function() = default;
  /// @param switches  if given, its switches (Expression) are appended
  virtual Jet operator()(const Jet& x, std::vector<Jet>* switches) const = 0;
  virtual bool has_switches() const = 0;
};

}  // namespace floe::math
