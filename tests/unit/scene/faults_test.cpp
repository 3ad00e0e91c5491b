#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>

#include "floe/error.h"
#include "floe/scene/scene.h"

using namespace floe;
namespace fs = std::filesystem;
using Catch::Matchers::Contains;

namespace {

std::vector<std::string> faults_of(const std::string& path) {
  try {
    scene::read_scene(path);
  } catch (const InputError& error) {
    return error.faults();
  }
  return {};
}

std::vector<std::string> lines_of(const fs::path& path) {
  std::ifstream in(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

}  // namespace

// Beside each bad scene stands what a user must read, FILE.expected: a line for each fault that the scene was given.
TEST_CASE("each bad scene has all its faults reported, in the order of the file") {
  std::set<fs::path> scenes;
  for (const auto& entry : fs::directory_iterator("tests/failure/scenes")) {
    if (entry.path().extension() == ".yaml") scenes.insert(entry.path());
  }
  REQUIRE(scenes.size() >= 20);
  for (const auto& path : scenes) {
    INFO(path);
    std::vector<std::string> expected = lines_of(fs::path(path).replace_extension(".expected"));
    for (auto& line : expected) line = path.parent_path().string() + "/" + line;
    REQUIRE_FALSE(expected.empty());
    const auto faults = faults_of(path.string());
    for (std::size_t i = 0; i < std::min(faults.size(), expected.size()); ++i) CHECK(faults[i] == expected[i]);
    CHECK(faults.size() == expected.size());
  }
}

TEST_CASE("a file that is no text file is refused by name") {
  CHECK_THAT(faults_of("tests/failure/scenes/missing.yaml").at(0),
             Contains("missing.yaml: cannot be read: No such file"));
  CHECK_THAT(faults_of("tests/failure/scenes").at(0), Contains("is a folder"));
  CHECK_THAT(faults_of("/dev/zero").at(0), Contains("is larger than 16 MiB"));
  const std::string image = std::string("\x89PNG\r\n\x1a\n\0\0", 10);
  CHECK_THROWS_WITH(scene::parse_scene(image, "a.png"), "a.png: is not a text file; expected a scene in YAML (UTF-8)");
  CHECK_THROWS_WITH(scene::parse_scene(std::string("a: b\0c", 6), "a"), Contains("is not a text file"));
  CHECK_THROWS_WITH(scene::parse_scene("", "a"), "a: is empty; expected a scene");
}

TEST_CASE("a message is one line, whatever the file contains") {
  try {
    scene::parse_scene("title: a\n\"two\\nlines\\e[31m\": 1\n", "a");
    FAIL("the key is unknown");
  } catch (const InputError& error) {
    for (const auto& fault : error.faults()) {
      CHECK(std::none_of(fault.begin(), fault.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }));
    }
  }
}

TEST_CASE("deep nesting of every kind is refused without a crash") {
  for (const char* unit : {"[", "{", "- ", "? ", "{a: ", "[[", "!!a [", "&a [", "- - "}) {
    std::string text = "bodies: ";
    if (unit[1] == ' ') text.clear();
    for (int i = 0; i < 200000; ++i) text += unit;
    INFO(unit);
    CHECK_THROWS_AS(scene::parse_scene(text, "deep"), InputError);
  }
  std::string text;
  for (int i = 0; i < 2000; ++i) text += std::string(i, ' ') + "a:\n";
  CHECK_THROWS_AS(scene::parse_scene(text, "deep"), InputError);
}

TEST_CASE("aliases that multiply do not multiply the work") {
  std::string text = "a0: &a0 [1, 1]\n";
  for (int i = 1; i < 60; ++i) {
    const std::string before = std::to_string(i - 1), now = std::to_string(i);
    text += "a" + now + ": &a" + now + " [*a" + before + ", *a" + before + "]\n";
  }
  CHECK_THROWS_AS(scene::parse_scene(text + "bodies: *a59\nmotion: *a59\ngravity: *a59\n", "lol"), InputError);
}

TEST_CASE("numbers whose products are none in double precision are refused") {
  const auto told = [](const std::string& EI) {
    try {
      scene::parse_scene(
          "bodies:\n  b:\n    mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}\n    section: {EA: 1, EI: " + EI +
              ", rhoA: 1}\nmotion: {end: 1, step: 0.1}\n",
          "s.yaml");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  for (const char* EI : {"1e-310", "1e-200", "1e200", "10^(-200)"})
    CHECK(told(EI).find("bodies.b.section.EI: is ") != std::string::npos);
  CHECK(told("1e200").find("is 1e+200, whose products exceed the range of double precision; expected 0 or a size from "
                           "1e-120 to 1e+120") != std::string::npos);
  CHECK(told("1e-119") == "");
}
