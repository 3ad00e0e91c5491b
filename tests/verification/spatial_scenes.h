#pragma once
#include <unistd.h>

#include <filesystem>

#include "scene_motion.h"

namespace floe::test {

/// Angular frequencies of the one body of a scene in space. [rad/s]
inline std::vector<double> omega_of(const std::string& text, const std::string& name = "scene") {
  return scene::body_modes(scene::parse_scene(text, name), PETSC_COMM_WORLD).at(0).omega;
}

/// A folder that goes with the test.
struct Scratch {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("floe_verification_" + std::to_string(getpid()));
  Scratch() { std::filesystem::create_directories(path); }
  ~Scratch() { std::filesystem::remove_all(path); }
};

}  // namespace floe::test
