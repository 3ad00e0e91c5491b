#include "estimate_words.h"

#include <fmt/format.h>

namespace floe::app {

std::string estimate_words(const scene::Estimate& estimate) {
  if (!estimate.none.empty()) return fmt::format("No estimate of the error: {}\n", estimate.none);
  std::string words =
      fmt::format("estimated error {:.2g} % (deformations, against the full order of the same mesh; {:.2g} s)\n",
                  100 * estimate.deformation, estimate.seconds);
  for (const std::string& note : estimate.notes) words += "Note (estimate): " + note + "\n";
  return words;
}

}  // namespace floe::app
