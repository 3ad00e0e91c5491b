#pragma once
#include <string>

namespace floe::app {

/// What is wrong with a PETSc option, as far as its name and value show before any solver is made: it begins with no
/// prefix of floe's solvers and is none of PETSc's own, gives a time that is not positive, or is not taken (refusal).
/// Empty if nothing is.
///
/// @param name   without the dash
/// @param value  empty if the option has none
std::string option_fault(const std::string& name, const std::string& value);

/// Before any work is done: option_fault of every option that PETSc has not read itself when it began, those of solvers
/// that the command does not have, those that no solver reads, and values that an option cannot have.
/// @throws InputError  a line for each
void check_options(const std::string& command);
/// A fault with the options that the user gave to solvers, which may be its cause; unchanged where it names one of
/// these solvers.
std::string with_options(const std::string& text);
/// What check_options could not know: options of solvers that this run did not need, or that PETSc looks up late.
/// @throws InputError  options that nothing has read
void check_unused();
/// Lets PETSc be silent at its end about options that nothing has read, unless the user asked it for options.
void silence_options_left();

}  // namespace floe::app
