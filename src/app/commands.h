#pragma once
#include <optional>
#include <string>

#include "floe/assembly/model.h"
#include "floe/output/folder.h"
#include "run.h"

namespace floe::app {

/// `floe modes`: frequencies of each body with residuals; with a path their shapes into an XDMF file, with a folder
/// their matrices into it. Collective.
void modes(const scene::Scene& scene, MPI_Comm comm, const std::optional<std::string>& path,
           const std::optional<std::string>& matrices, bool overwrite);
/// `floe check`: what would be simulated, and the mass properties of its bodies; nothing is moved.
/// @param formulation  that the scene is built in; none: the first that it can be built in, of full order if possible
/// @param frequencies  how many of each body to compute, free and as its modes are constrained
/// Collective.
void check(const scene::Scene& scene, MPI_Comm comm, const std::optional<scene::Formulation>& formulation = {},
           int frequencies = 0);
/// `floe reduce`: one body of a scene into a file. Collective.
void reduce(const scene::Scene& scene, const std::string& body, MPI_Comm comm, const std::string& path, bool overwrite);
/// `floe info`: what such a file holds. Collective.
void info(const std::string& path, MPI_Comm comm);
/// `floe run`. @param estimate  of the error, where there can be one. Collective.
void run_one(const scene::Scene& scene, scene::Formulation formulation, MPI_Comm comm,
             const output::ResultFolder& folder, const RunPlan& plan = {});
/// `floe run` of a scene with an accuracy: chooses its reduced model, says why, and moves it. Collective.
/// @param explicit_scene  a file for the scene as it was chosen
void run_chosen(const scene::Scene& scene, const scene::Accuracy& accuracy, MPI_Comm comm,
                const output::ResultFolder& folder, const std::optional<std::string>& explicit_scene, bool overwrite);

}  // namespace floe::app
