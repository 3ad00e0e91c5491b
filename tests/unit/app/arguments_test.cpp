#include "../../../src/app/arguments.h"

#include <CLI/CLI.hpp>

#include "command_tests.h"

namespace {

/// What a command line prints. @throws CLI::ParseError, InputError
std::string said(std::vector<std::string> words) {
  CLI::App app("floe");
  app.require_subcommand(1);
  app::Arguments given;
  std::function<void()> work;
  app::add_computing(app, given, work);
  std::reverse(words.begin(), words.end());
  app.parse(words);
  REQUIRE(work);
  return printed(work);
}

double last(const std::filesystem::path& table, const std::string& column) {
  return std::stod(columns_of(table).at(column).back());
}

/// A cantilever of length 2, EI = 10, rhoA = 3, under F at its end: F L^3 / 3 EI.
const std::string cantilever =
    "parameters: {F: 0.03}\nbodies:\n  beam:\n    mesh: {line: {from: [0, 0], to: [2, 0], elements: 8}}\n"
    "    section: {EA: 1e5, EI: 10, rhoA: 3}\n    reduction: {modes: 3, attachment: all}\n"
    "joints:\n  root: {type: fixed, between: [ground, beam.start]}\n"
    "loads:\n  tip: {type: force, at: beam.end, force: [0, F]}\n"
    "motion: {end: 0.1, step: 0.01}\nprobes:\n  tip: {at: beam.end, quantity: displacement}\n";

}  // namespace

TEST_CASE("command lines: equilibria, motions, sweeps, frequencies and reduced bodies of one scene") {
  const OwnFolder own;
  const std::string scene = own.write("scene.yaml", cantilever), out = own.path / "out";
  const double deflection = 0.03 * 8 / 30;
  for (const std::string formulation : {"lffr", "nlffr", "cfr", "vm+md"}) {
    said({"static", scene, "--formulation", formulation, "--steps", "2", "-o", out, "--force", "--no-estimate"});
    CHECK(last(own.path / "out/probes.csv", "tip.y [m]") == Approx(deflection).epsilon(1e-3));
  }
  CHECK_THROWS_AS(said({"static", scene, "-o", out}), InputError);  // is there
  said({"run", scene, "--formulation", "vm", "-o", out, "--force", "--no-estimate", "--checkpoint", "4"});
  CHECK(last(own.path / "out/probes.csv", "t [s]") == Approx(0.1));
  said({"run", "--restart", out, "--until", "0.15", "--no-estimate"});
  CHECK(last(own.path / "out/probes.csv", "t [s]") == Approx(0.15));
  said({"sweep", scene, "--vary", "F=0.03,0.06", "--vary", "motion.step=0.01,0.005", "--together", "-o", out,
        "--force"});
  CHECK(columns_of(own.path / "out/sweep.csv").at("member").size() == 2);
  CHECK_THAT(said({"modes", scene}), Contains("1.6048"));  // 3.516 sqrt(EI / rhoA) / L^2
  const std::string body = own.path / "beam.h5";
  CHECK_THAT(said({"reduce", scene, "--body", "beam", "-o", body}), Contains("Reduced body: " + body));
  CHECK_THAT(said({"info", body}), Contains("beam"));
  CHECK_THAT(said({"check", scene, "--formulation", "lffr"}), Contains("10 steps of 0.01 s"));
  CHECK_THAT(said({"schema"}), Contains("spectral_radius"));
  CHECK_THAT(said({"schema", "--markdown"}), Contains("|"));
}

TEST_CASE("command lines with missing or invalid arguments are refused") {
  const OwnFolder own;
  const std::string scene = own.write("scene.yaml", cantilever),
                    still = own.write("still.yaml", cantilever.substr(0, cantilever.find("motion:")));
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"run"},
                                             {"run", scene, "--until", "1"},
                                             {"run", "--restart", "out", "-o", "out"},
                                             {"run", "--restart", "out", "--accuracy", "1%"},
                                             {"run", scene, "--accuracy", "1%", "--formulation", "vm"}})
    CHECK_THROWS_AS(said(words), CLI::ParseError);
  CHECK_THROWS_WITH(said({"run", scene, "--accuracy", "1%", "--no-estimate", "-o", own.path / "out"}),
                    Contains("cannot be combined with an accuracy"));
  CHECK_THROWS_WITH(said({"tradeoff", scene, "--reference", "vm", "-o", own.path / "out"}),
                    Contains("expected nlffr or cfr"));
  CHECK_THROWS_AS(said({"static", scene, "--steps", "0"}), CLI::ParseError);
  CHECK_THROWS_AS(said({"static", scene, "--at", "-1"}), CLI::ParseError);
  CHECK_THROWS_AS(said({"campbell", scene}), CLI::ParseError);  // no speeds
  CHECK_THROWS_AS(said({"sweep", scene}), CLI::ParseError);
  CHECK_THROWS_AS(said({"swing", scene}), CLI::ParseError);
  CHECK_THROWS_WITH(said({"run", still, "-o", own.path / "out"}), Contains("motion: is missing"));
  CHECK_THROWS_AS(said({"run", scene, "--formulation", "fem", "-o", own.path / "out"}), InputError);
  CHECK_THROWS_AS(said({"run", own.path / "none.yaml", "-o", own.path / "out"}), InputError);
  CHECK_THROWS_AS(said({"run", scene, "--accuracy", "much", "-o", own.path / "out"}), InputError);
  CHECK_FALSE(std::filesystem::exists(own.path / "out"));
}
