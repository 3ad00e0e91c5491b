#include <catch2/catch.hpp>
#include <fstream>
#include <random>
#include <sstream>

#include "floe/error.h"
#include "floe/scene/scene.h"

using namespace floe;

namespace {

std::string text_of(const std::string& name) {
  std::ifstream in("examples/" + name + "/scene.yaml");
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

// Cuts, changes, doubles or deletes a piece; the pieces put in are those that mean something to YAML and formulas.
std::string mutated(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  static const std::vector<std::string> pieces{
      "[",    "]",      "{",      "}",     ":",    ": ",    ",",     "\n",     "  ",          "- ", "? ", "&a ",
      "*a",   "<<: *a", "!!int ", "|\n",   ">",    "'",     "\"",    "#",      "%",           "@",  "\t", "\xc3\xa9",
      "\xff", "0",      "-1",     "1e999", ".nan", "~",     "null",  "true",   "(",           ")",  "^",  "?",
      "=",    "ground", "start",  "beam",  "type", "---\n", "...\n", "1e-400", "99999999999", "t",  "pi"};
  const std::size_t changes = 1 + below(4);
  for (std::size_t change = 0; change < changes && !text.empty(); ++change) {
    const std::size_t at = below(text.size()), length = std::min<std::size_t>(1 + below(12), text.size() - at);
    switch (below(5)) {
      case 0:
        text.resize(at);
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, pieces[below(pieces.size())]);
        break;
      case 3:
        text[at] = static_cast<char>(below(256));
        break;
      default:
        text.insert(below(text.size()), text.substr(at, length * 4));
        break;
    }
  }
  return text;
}

}  // namespace

TEST_CASE("a damaged scene is read or refused, and nothing else happens") {
  std::mt19937 random(20240229);
  int refused = 0, count = 0;
  for (const char* name : {"cantilever", "robot_arm", "pendulum", "slider_crank", "spin_up"}) {
    const std::string text = text_of(name);
    REQUIRE_FALSE(text.empty());
    for (int i = 0; i < 400; ++i, ++count) {
      const std::string damaged = mutated(text, random);
      INFO(damaged);
      try {
        scene::parse_scene(damaged, "fuzz");
      } catch (const InputError& error) {
        ++refused;
        if (error.faults().empty() || error.faults()[0].rfind("fuzz", 0) != 0) FAIL(error.what());
      } catch (const std::exception& error) {
        FAIL("not an InputError: " << error.what());
      }
    }
  }
  CHECK(refused > count / 4);
  CHECK(refused < count);
}
