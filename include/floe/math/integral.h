#pragma once
#include <functional>
#include <memory>
#include <vector>

namespace floe::math {

/// t -> int_0^t f, to round-off of f's scale where f has at most some hundred periods in a panel: a function of t
/// alone, whatever was asked before.
///
/// Time is divided into panels of one width; their integrals are kept as they are needed, each by adaptive
/// Gauss-Kronrod quadrature, which also takes the rest of the last panel, from one break to the next: a jump that no
/// point of the rule sees would have no error. Copies share what is kept. Not thread-safe.
class Integral {
 public:
  /// @param panel  > 0: about the time in which f varies
  /// @param breaks  where f may have corners and jumps, ascending
  Integral(std::function<double(double)> f, double panel, std::vector<double> breaks = {});
  /// @throws what f throws
  double operator()(double t) const;

 private:
  struct Kept;
  std::shared_ptr<Kept> kept_;
};

}  // namespace floe::math
