#pragma once
#include <filesystem>

#include "floe/assembly/model.h"
#include "floe/output/reduced_file.h"

namespace floe::assembly {

/// Reduces one body of a scene and writes it, with its basis at every node, so that no later motion needs its mesh.
///
/// Places in the file: all that the mesh names, and those that joints, loads and probes of the scene name by
/// coordinates (as `at(x, y, z)`, mesh axes). Derivatives that are chosen by count are those of maximum modal
/// interaction under equal generalised forces, |eta_i eta_j| = 1 / (omega_i omega_j)^2 of two modes: no motion is known
/// here.
/// @param body       its name; empty: the only body of the scene
/// @param warnings   receives what the user should know of the choice of basis vectors and of the mesh
/// @return what was written, but for the shapes
/// @throws InputError  no such body, a rigid one, several bodies and no name. Collective.
output::ReducedBodyFile reduce_body(const Scene& scene, const std::string& body, MPI_Comm comm,
                                    const std::filesystem::path& path, bool overwrite,
                                    std::vector<std::string>& warnings);

}  // namespace floe::assembly
