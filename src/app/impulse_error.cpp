#include "impulse_error.h"

#include <fmt/format.h>

#include <algorithm>

#include "compare_table.h"
#include "discretisation.h"
#include "exact_motion.h"
#include "interruption.h"

namespace floe::app {

double ImpulseError::of(const Series& reduced) {
  if (full_order_.t.empty() && unknown_.empty()) simulate();
  if (!unknown_.empty()) return 0;
  const double error = worst_error(reduced, full_order_);
  if (error <= 1 && worst_error(full_order_, reduced) <= 1) return error;  // of the size of either motion
  unknown_ = "after an impulse the motion in formulation nlffr differs by more than 100 %";
  return 0;
}

void ImpulseError::simulate() {
  constexpr double greatest_work = 1e6;  // elements times steps: some 100 s
  if (element_count(scene_, discretisation_of(scene_)) * scene_.motion.end > greatest_work * scene_.motion.step) {
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
