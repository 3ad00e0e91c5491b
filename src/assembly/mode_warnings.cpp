#include "floe/assembly/mode_warnings.h"

#include <fmt/format.h>

namespace floe::assembly {

std::string sag_text(const std::string& name, const std::string& what, double sag, double limit) {
  return fmt::format(
      "body {}, {}: {:.2g} % of the deflection is within single cells (limit {:.2g} %), which are wrong in "
      "that: refine the mesh",
      name, what, 100 * sag, 100 * limit);
}

std::string left_out_text(const std::string& body, const BodyReport& report) {
  const bool one = report.left_out == 1;
  return fmt::format("body {}: {} more {} the frequency of mode {}, the last one, and {} left out: ask for {}", body,
                     report.left_out, one ? "mode has" : "modes have", report.omega.size(), one ? "is" : "are",
                     report.omega.size() + report.left_out);
}

}  // namespace floe::assembly
