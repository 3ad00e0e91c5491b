#pragma once
#include <string>
#include <utility>
#include <vector>

namespace floe::app {

/// A name without its dash and a value, empty if there is none.
using Option = std::pair<std::string, std::string>;

/// What is wrong with options of floe's solvers, a line for each, found before any of these is made for a scene: each
/// prefix has a solver of its kind made with two unknowns, which takes the options from a copy of PETSc's table. So
/// have the solvers within a preconditioner that the options select. An option that none of them reads is unknown, or
/// of a type that is not selected; a value that PETSc rejects is named. Rank-local.
std::vector<std::string> faults_of(const std::vector<Option>& options);

/// -NAME VALUE
std::string written(const Option& option);

}  // namespace floe::app
