#pragma once
#include <functional>
#include <string>
#include <vector>

namespace floe::app {

/// A solver of floe that takes options, made with two unknowns and without a scene.
struct OptionReader {
  std::string prefix;  ///< of its options: motion_
  std::string linear;  ///< of its linear solver; empty if it has none
  /// Makes it and lets it take its options, whose names have `tag` before them. PETSc's help lists options of a prefix
  /// once, and is left to those that solve. @throws InputError  a value that an option cannot have. Rank-local.
  std::function<void(const std::string& tag)> read;
};

/// All of them.
const std::vector<OptionReader>& option_readers();

/// As OptionReader::read, of a linear solver within a preconditioner: derivatives_mg_levels_. Its types are not known,
/// so options of each usual one are read.
void read_inner(const std::string& prefix);

}  // namespace floe::app
