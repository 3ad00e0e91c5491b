// src/plot/compare.py, run as `floe compare` runs it.
#include <fmt/format.h>
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "floe/version.h"
#include "scratch.h"

namespace {

namespace fs = std::filesystem;

void sample(const fs::path& folder, const std::string& name, double error, int rows) {
  fs::create_directories(folder / name);
  std::ofstream file(folder / name / "probes.csv");
  file << "t [s],tip.x [m],tip.y [m]\n";
  for (int i = 0; i < rows; ++i) {
    const double t = 3.0 * i / (rows - 1), y = std::sin(9.5 * t) + error * std::sin(23 * t);
    file << fmt::format("{},{},{}\n", t, -0.3 * y * y, y);
  }
}

void describe(const fs::path& folder, const std::string& reference, const std::string& column) {
  std::ofstream(folder / "compare.json") << fmt::format(
      R"({{"title": "Cantilever", "time_unit": "s", "reference": "{}", "runs": [
           {{"name": "cfr", "label": "corotational", "csv": "cfr/probes.csv"}},
           {{"name": "vm+md", "label": "12 VMs + 5 MDs", "csv": "vm+md/probes.csv"}}],
          "probes": [{{"column": "tip.x", "unit": "m"}}, {{"column": "{}", "unit": "m"}}], "errors": {{}}}})",
      reference, column);
}

struct Outcome {
  int code;
  std::string message;
};

Outcome draw(const fs::path& folder, const std::string& options = "") {
  const fs::path said = folder / "said";
  const std::string command = fmt::format("/usr/bin/python3 '{}/plot/compare.py' '{}' {} >'{}' 2>&1",
                                          FLOE_SCRIPTS_SOURCE, folder.string(), options, said.string());
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(said)};
}

/// Width and height in the IHDR chunk of a PNG.
std::pair<unsigned, unsigned> dimensions(const std::string& png) {
  const auto number = [&](std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | static_cast<unsigned char>(png.at(i));
    return value;
  };
  REQUIRE(png.substr(0, 8) == "\x89PNG\r\n\x1a\n");
  return {number(16), number(20)};
}

}  // namespace

TEST_CASE("compare.py draws the formulations of a comparison") {
  Scratch scratch;
  if (scratch.rank() != 0) return;
  const fs::path folder = scratch;
  sample(folder, "cfr", 0, 400);
  sample(folder, "vm+md", 0.01, 300);
  describe(folder, "cfr", "tip.y");
  const Outcome drawn = draw(folder);
  INFO(drawn.message);
  REQUIRE(drawn.code == 0);
  CHECK(drawn.message.empty());
  const std::string png = text_of(folder / "compare.png");
  CHECK(png.size() > 20000);
  const auto [width, height] = dimensions(png);
  CHECK((width >= 1500 && height >= 450));  // its size, its error

  const fs::path svg = folder / "picture.svg";
  REQUIRE(draw(folder, "-o '" + svg.string() + "'").code == 0);
  const std::string text = text_of(svg);
  CHECK(text.find("<svg") != std::string::npos);
  CHECK(text.find("|tip| [m]") != std::string::npos);  // matplotlib names each text in a comment
  REQUIRE(draw(folder, "--components --output '" + svg.string() + "'").code == 0);
  CHECK(text_of(svg).find("tip.y [m]") != std::string::npos);
}

TEST_CASE("compare.py tells bad input in one line and exits with 2") {
  Scratch scratch;
  if (scratch.rank() != 0) return;
  const fs::path folder = scratch;
  const auto refuses = [&](const std::string& what, const std::string& options = "") {
    const Outcome refused = draw(folder, options);
    INFO(refused.message);
    CHECK(refused.code == 2);
    CHECK(refused.message.find(what) != std::string::npos);
    CHECK(std::count(refused.message.begin(), refused.message.end(), '\n') == 1);
  };
  refuses("compare.json: No such file");
  std::ofstream(folder / "compare.json") << "{";
  refuses("not JSON");
  std::ofstream(folder / "compare.json") << "{}";
  refuses("has no 'runs'");
  describe(folder, "cfr", "tip.y");
  refuses("cfr/probes.csv: No such file");
  sample(folder, "cfr", 0, 50);
  sample(folder, "vm+md", 0, 50);
  describe(folder, "cfr", "tip.z");
  refuses("no column 'tip.z'");
  describe(folder, "full", "tip.y");
  refuses("reference 'full'");
  describe(folder, "cfr", "tip.y");
  refuses("ends in .png, .svg or .pdf", "-o picture.gif");
  std::ofstream(folder / "cfr/probes.csv", std::ios::app) << "3.1,0.1\n";
  refuses("cfr/probes.csv:52: 2 cells for 3 columns");
  CHECK_FALSE(fs::exists(folder / "compare.png"));
}
