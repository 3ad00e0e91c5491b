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

/// A strip of shells released from a bent shape that a force at its tip would hold. Its shortening u = -int w'^2/2
/// makes it inextensible to second order; what is left excites stretching at many times the frequencies that steps
/// resolve.
inline const char* released_strip = R"yaml(
bodies:
  strip:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.1, 0], elements: [12, 2], cells: quadrilaterals}}
    section: {thickness: 0.003}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    initial: {deformation: ["-1.125*0.06^2*(4*x^3/3 - x^4 + x^5/5)", 0, "0.06*x^2*(3-x)/2"]}
joints: {root: {type: fixed, between: [ground, strip.left]}}
motion: {end: 0.4, step: 2e-3}
probes: {tip: {at: strip.p3, quantity: position}, edge: {at: strip.right, quantity: displacement}}
)yaml";

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
