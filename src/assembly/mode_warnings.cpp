#include "floe/assembly/mode_warnings.h"

#include <fmt/format.h>

namespace floe::assembly {

std::string intra_deflection_text(const std::string& name, const std::string& what, double intra_deflection,
                                  double limit) {
  return fmt::format(
      "body {}, {}: {:.2g} % of the deflection is intra-element deflection (limit {:.2g} %), which the mesh does not "
      "resolve; refine the mesh",
      name, what, 100 * intra_deflection, 100 * limit);
}

std::string left_out_text(const std::string& body, const BodyReport& report) {
  const bool one = report.left_out == 1;
  return fmt::format("body {}: {} more {} the frequency of mode {}, the last one, and {} omitted; ask for {} modes",
                     body, report.left_out, one ? "mode has" : "modes have", report.omega.size(), one ? "is" : "are",
                     report.omega.size() + report.left_out);
}

}  // namespace floe::assembly
