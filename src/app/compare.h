#pragma once
#include <optional>
#include <string>
#include <vector>

#include "run.h"

namespace floe::app {

/// Runs a scene in several formulations and writes a folder each, one table (compare.csv, compare.md, compare.json) and
/// one picture (compare.png). Errors are relative L2 over the horizon against cfr and against nlffr, where these are
/// among them; the first of them is also run with mesh and step halved, to show its own error. Collective.
void compare(const scene::Scene& scene, const std::vector<scene::Formulation>& formulations, MPI_Comm comm,
             const std::string& folder, bool overwrite, bool reference_error);

/// sqrt(sum (p - r)^2 / sum r^2) for each column; the reference is taken at the times of `series` by linear
/// interpolation. None where the reference's root mean square is below 1e-9 of that of its probe's other component:
/// there it is round-off.
std::vector<std::optional<double>> relative_errors(const Series& series, const Series& reference);

}  // namespace floe::app
