#include "estimate_words.h"

#include <fmt/format.h>

#include <cmath>

#include "floe/math/rounded.h"

namespace floe::app {

std::string estimate_words(const assess::Estimate& estimate, bool has_total) {
  if (!estimate.none.empty())
    return fmt::format("No estimate of the {}error: {}\n", has_total ? "reduction " : "", estimate.none);
  std::string notes;
  for (const std::string& note : estimate.notes) notes += "Note (estimate): " + note + "\n";
  if (!estimate.by.empty())
    return fmt::format("reduction: {} (computed in {:.2g} s)\n{}", estimate.by, estimate.seconds, notes);
  const std::string error =
      std::isfinite(estimate.deformation)
          ? "estimated error " + math::percent(estimate.deformation)
          : "estimated error above 10000 %, which is no usable estimate; take smaller steps or more basis vectors";
  return fmt::format("{} (deformations, relative to the full-order model of the same mesh; {:.2g} s)\n{}", error,
                     estimate.seconds, notes);
}

std::string missed_words(double asked, double supported) {
  constexpr int most = 15;
  int digits = 2;
  while (digits < most && math::percent(asked, digits) == math::percent(supported, digits)) ++digits;
  return fmt::format("the best model found has an estimated error of {1} (limit {0}, the accuracy requested)",
                     math::percent(asked, digits), math::percent(supported, digits));
}

}  // namespace floe::app
