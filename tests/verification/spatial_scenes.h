#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "floe/petsc/error.h"
#include "scene_motion.h"

namespace floe::test {

/// Angular frequencies of the one body of a scene in space. [rad/s]
inline std::vector<double> omega_of(const std::string& text, const std::string& name = "scene") {
  return assembly::body_modes(scene::parse_scene(text, name), PETSC_COMM_WORLD).at(0).omega;
}

/// What rank 0 alone does; the others wait for it.
template <class Work>
void on_first_rank(Work&& work) {
  petsc::agree(PETSC_COMM_WORLD, [&] {
    int rank = 0;
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    if (rank == 0) work();
  });
}

/// A folder that goes with the test, the same on all ranks.
struct Scratch {
  std::filesystem::path path;
  Scratch() {
    int number = getpid();
    MPI_Bcast(&number, 1, MPI_INT, 0, PETSC_COMM_WORLD);
    path = std::filesystem::temp_directory_path() / ("floe_verification_" + std::to_string(number));
    on_first_rank([&] { std::filesystem::create_directories(path); });
  }
  Scratch(const Scratch&) = delete;
  ~Scratch() {
    int rank = 0;
    std::error_code ignored;
    MPI_Barrier(PETSC_COMM_WORLD);
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    if (rank == 0) std::filesystem::remove_all(path, ignored);
  }
};

inline void write_text(const std::string& path, const std::string& text) {
  on_first_rank([&] { std::ofstream(path) << text; });
}

}  // namespace floe::test
