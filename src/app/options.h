#pragma once
#include <string>

namespace floe::app {

/// What is wrong with a PETSc option, as far as its name and value tell before any solver is made: it begins with no
/// prefix of floe's solvers and is none of PETSc's own, or gives a time that is not positive. Empty if nothing is.
///
/// @param name   without the dash
/// @param value  empty if the option has none
std::string option_fault(const std::string& name, const std::string& value);

/// @throws InputError  with option_fault of every option that PETSc has not read itself when it began
void check_options();
/// @throws InputError  options that nothing has read
void check_unused();
/// Lets PETSc be silent at its end about options that nothing has read, unless the user asked it for options.
void silence_options_left();

}  // namespace floe::app
