#pragma once
#include <functional>
#include <string>
#include <vector>

namespace floe::app {

/// The command line in two: floe's own words, and the options that PETSc reads (-modes_eps_nev 5 -log_view).
struct CommandLine {
  std::vector<std::string> own;
  std::vector<std::string> petsc;
};

/// PETSc's options have one dash and more than one letter, and take the next word along unless that is an option, a
/// scene or the command.
CommandLine split(int argc, char** argv);

/// Runs `work` of a command between SlepcInitialize and SlepcFinalize and converts what it throws into messages (rank
/// 0, stderr) and an exit code: 0, 1 RunError, 2 InputError. A fault of one rank alone, which the others do not learn
/// of, ends them all.
int in_session(const CommandLine& line, const std::string& command, const std::function<void()>& work);

}  // namespace floe::app
