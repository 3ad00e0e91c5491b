#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace floe::app {

/// A name without its dash and a value, empty if there is none.
using Option = std::pair<std::string, std::string>;

/// Which of the options none of floe's solvers reads, found before any of them is made for a scene: each prefix has a
/// solver of its kind made with two unknowns, which takes the options from a copy of PETSc's table. What PETSc reads
/// only while it solves (inner solvers, factors of MUMPS, viewers and monitors) is not judged.
/// @throws InputError  an option has a value that it cannot have. Rank-local.
std::vector<Option> unread(const std::vector<Option>& options);

}  // namespace floe::app
