#include "impulse_error.h"

#include <fmt/format.h>

#include <algorithm>

#include "compare_table.h"
#include "exact_motion.h"
#include "interruption.h"

namespace floe::app {

double ImpulseError::of(const Series& reduced) {
  constexpr double absurd = 10;  // of the reduced motion: the full-order one diverges
  if (full_order_.t.empty() && unknown_.empty()) simulate();
  if (full_order_.t.empty()) return 0;
  unknown_.clear();
  if (worst_error(full_order_, reduced) <= absurd) return worst_error(reduced, full_order_);
  unknown_ = "impulses change the velocities, and formulation nlffr, which shows it, diverges";
  return 0;
}

void ImpulseError::simulate() {
  constexpr double greatest_work = 1e6;  // elements times steps: 4 s of lines, 40 s of plates
  if (elements_of(scene_) * scene_.motion.end > greatest_work * scene_.motion.step) {
    unknown_ = "impulses change the velocities, and formulation nlffr, which shows it, would take too long";
    return;
  }
  try {
    full_order_ = quiet_motion(scene_, scene::Formulation::nlffr, accuracy_, comm_);
  } catch (const std::runtime_error& fault) {  // on all ranks
    if (Interruption::happened(comm_)) throw;
    const std::string text = fault.what();
    unknown_ = fmt::format("impulses change the velocities, and formulation nlffr, which shows it, fails ({})",
                           text.substr(0, std::min({text.find(';'), text.find('\n'), text.find(" ("), text.size()})));
  }
}

}  // namespace floe::app
