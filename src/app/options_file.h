#pragma once
#include <string>
#include <vector>

namespace floe::app {

/// Of the words for PETSc takes out what would end the program before floe can say why: files of options that cannot be
/// read or have a line that PETSc does not understand (-options_file, and .petscrc, petscrc, ~/.petscrc, which PETSc
/// reads by itself), and options in YAML.
/// @return  a line for each fault
std::vector<std::string> take_bad_option_files(std::vector<std::string>& words);

}  // namespace floe::app
