#pragma once
#include <string>
#include <vector>

namespace floe::app {

/// Draws FOLDER/NAME.png with the script NAME.py that is shipped. Returns the picture's path, or says why there is
/// none.
std::string draw(const std::string& name, const std::string& folder);

/// Becomes the script NAME.py that is shipped, with these words; under mpirun the first rank alone, the others are
/// done. To be called outside of a session: MPI has not begun.
///
/// @return  exit code, where there was nothing to do, or nothing that could be started
int become_script(const std::string& name, const std::vector<std::string>& words);

}  // namespace floe::app
