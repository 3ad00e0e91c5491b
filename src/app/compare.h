#pragma once
#include <string>
#include <vector>

#include "run.h"

namespace floe::app {

/// The formulations of these names, each once; without names all that the scene supports: with
/// bodies from files and in space fewer than cfr, nlffr, lffr, vm, vm+md.
/// @throws InputError  a name is unknown, or given twice
std::vector<scene::Formulation> formulations_to_compare(const scene::Scene& scene, std::vector<std::string> names);

/// Runs a scene in several formulations and writes a folder each, one table (compare.csv, compare.md, compare.json) and
/// one picture (compare.png). Errors are relative L2 over the horizon against cfr and against nlffr, where these are
/// among them; the first of them is also run with mesh and step halved, to show its own error. The terminal shows
/// errors of components where that fits its width, else of each probe as a vector. A formulation that fails is
/// reported, marked in the table, and does not keep the others from being finished.
/// @throws InputError, RunError  after all is written: some formulations, or the finer run, failed. Collective.
void compare(const scene::Scene& scene, const std::vector<scene::Formulation>& formulations, MPI_Comm comm,
             const std::string& folder, bool overwrite, bool reference_error);

}  // namespace floe::app
