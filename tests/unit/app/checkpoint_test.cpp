#include "../../../src/app/checkpoint.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "floe/error.h"

using namespace floe;

namespace {

/// A folder that goes with its owner.
struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("floe-checkpoint-" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path / name) << text; }
};

const char* scene_text = R"yaml(
functions:
  gust: {file: gust.csv}
bodies:
  beam:
    mesh: {file: {path: beam.inp}}
    section: {A: 0.01, Iy: 1e-5, Iz: 1e-5, J: 2e-5, orientation: [0, 0, 1]}
    material: {E: 1e9, nu: 0.3, rho: 1000}
loads: {gust: {type: force, at: {body: beam, node: [1, 0, 0]}, force: [0, 0, gust(t)]}}
motion: {end: 1, step: 0.1}
)yaml";

}  // namespace

TEST_CASE("a restart is refused where any file of the scene has changed: tables, meshes, what meshes include") {
  const Folder folder;
  folder.write("scene.yaml", scene_text);
  folder.write("gust.csv", "0, 0\n1, 2\n");
  folder.write("beam.inp", "*INCLUDE, INPUT=nodes.inp\n*ELEMENT, TYPE=B31, ELSET=line\n1, 1, 2\n");
  folder.write("nodes.inp", "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n");
  const auto identity = [&] {
    return app::identity_of(scene::read_scene((folder.path / "scene.yaml").string()), scene::Formulation::vm_md,
                            PETSC_COMM_SELF);
  };
  const auto before = identity();
  CHECK(before.at("files").size() == 4);
  CHECK_NOTHROW(app::check_identity(before, identity(), "out"));
  const auto complaint = [&](const std::string& file, const std::string& text) {
    const std::string was = [&] {
      std::ifstream in(folder.path / file);
      return std::string(std::istreambuf_iterator<char>(in), {});
    }();
    folder.write(file, text);
    std::string words;
    try {
      app::check_identity(before, identity(), "out");
    } catch (const InputError& error) {
      words = error.what();
    }
    folder.write(file, was);
    return words;
  };
  CHECK_THAT(complaint("gust.csv", "0, 0\n1, 3\n"), Catch::Contains("gust.csv has changed since"));
  CHECK_THAT(complaint("nodes.inp", "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 2, 0, 0\n"),
             Catch::Contains("nodes.inp has changed since"));
  CHECK_NOTHROW(app::check_identity(before, identity(), "out"));
}
