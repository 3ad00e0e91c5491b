#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "floe/assembly/model.h"
#include "floe/error.h"

namespace floe::testing {

/// A scene of one body in space, its keys as they stand in the file; the mesh begins at line 3, what follows at line 4.
inline std::string one_body(const std::string& mesh, const std::string& keys, const std::string& rest = "") {
  return "bodies:\n  b:\n    mesh: {" + mesh + "}\n" + keys + "    reduction: {modes: 2}\n" + rest;
}
inline const std::string plate = "plate: {along: [2, 0, 0], across: [0, 1, 0], elements: [4, 2]}";
inline const std::string line = "line: {from: [0, 0, 0], to: [2, 0, 0], elements: 4}";
inline const std::string thickness = "    section: {thickness: 0.01}\n";
inline const std::string tube = "    section: {shape: tube, radius: 0.02, wall: 0.005, orientation: [0, 1, 0]}\n";
inline const std::string metal = "    material: {E: 7e10, nu: 0.3, rho: 2700}\n";

inline scene::Body body_of(const std::string& text) { return scene::parse_scene(text, "s.yaml").bodies.at(0); }

/// All faults of a scene, of its reading or else of its preparation up to the modes.
inline std::vector<std::string> faults_of(const std::string& text, const std::string& name = "s.yaml") {
  try {
    assembly::body_modes(scene::parse_scene(text, name), PETSC_COMM_WORLD);
  } catch (const InputError& error) {
    return error.faults();
  }
  return {};
}

/// A folder of this run that goes with it.
struct Folder {
  int rank = 0;
  std::filesystem::path path;
  Folder() {
    int number = static_cast<int>(getpid());  // of the first rank, for all
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    MPI_Bcast(&number, 1, MPI_INT, 0, PETSC_COMM_WORLD);
    path = std::filesystem::temp_directory_path() / ("floe_scene_test_" + std::to_string(number));
    if (rank == 0) std::filesystem::create_directories(path);
    MPI_Barrier(PETSC_COMM_WORLD);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    MPI_Barrier(PETSC_COMM_WORLD);
    if (rank == 0) std::filesystem::remove_all(path);
  }
  std::string write(const std::string& name, const std::string& text) const {
    if (rank == 0) std::ofstream(path / name, std::ios::binary) << text;
    MPI_Barrier(PETSC_COMM_WORLD);
    return (path / name).string();
  }
};

}  // namespace floe::testing
