#pragma once
#include <string>

namespace floe::app {

/// Why floe does not take an option of PETSc's that one of its solvers would read: it would change what is solved and
/// not how, or end in PETSc itself (a crash, an endless loop, a window without a display). Empty: it is taken.
/// Collective.
///
/// @param name   without the dash, with the solver's prefix: motion_ts_init_time
/// @param value  empty if the option has none
std::string refusal(const std::string& name, const std::string& value);

}  // namespace floe::app
