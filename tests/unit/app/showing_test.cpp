#include "../../../src/app/showing.h"

#include <CLI/CLI.hpp>

#include "../../../src/app/commands.h"
#include "command_tests.h"
#include "floe/error.h"
#include "floe/scene/scene.h"

namespace {

/// Reads a command line of what shows results. @throws CLI::ParseError
struct Line {
  app::Showing showing;
  std::function<void()> work;

  explicit Line(std::vector<std::string> words) {
    CLI::App app("floe");
    app.require_subcommand(1);
    app::add_showing(app, showing, work);
    std::reverse(words.begin(), words.end());
    app.parse(words);
  }
  std::string script() const {
    REQUIRE(showing.script);
    return fmt::format("{}: {}", showing.script->name, fmt::join(showing.script->words, " "));
  }
};

std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> all;
  std::istringstream in(text);
  for (std::string word; in >> word;) all.push_back(word);
  return all;
}

}  // namespace

TEST_CASE("plot: its script gets paths and what was asked for, and nothing else that is empty") {
  CHECK(Line(words("plot out")).script() == "plot: out --amplify=1 --shapes=6 --frames=100 --fps=20 --dpi=150");
  const std::string all =
      Line(words("plot a b --kind probes,energy -o x.svg --format svg --probes tip.x,tip.y --times 0,1 --amplify 5 "
                 "--view 10,20 --body beam --shapes 3 --frames 7 --fps 2 --dpi 90 --components"))
          .script();
  CHECK(all ==
        "plot: a b --kind=probes,energy --out=x.svg --format=svg --probes=tip.x,tip.y --times=0,1 --amplify=5 "
        "--view=10,20 --body=beam --shapes=3 --frames=7 --fps=2 --dpi=90 --components");
  for (const char* bad : {"plot", "plot out --format bmp", "plot out --amplify nan", "plot out --amplify x",
                          "plot out --shapes 0", "plot out --frames 1", "plot out --fps 0", "plot out --dpi 10000"})
    CHECK_THROWS_AS(Line(words(bad)), CLI::ParseError);
}

TEST_CASE("report and export: the words of their scripts") {
  CHECK(Line(words("report out")).script() == "report: out");
  CHECK(Line(words("report out -o page.html")).script() == "report: out --out=page.html");
  CHECK(Line(words("export beam.h5 -o beam.npz")).script() == "export: --out=beam.npz -- beam.h5");
  CHECK(Line(words("export beam.h5 -o b.sid --format sid --shapes --columns all --gyroscopic-columns coordinate "
                   "--no-geometric-stiffness --force"))
            .script() ==
        "export: --out=b.sid --format=sid --columns=all --gyroscopic-columns=coordinate --shapes "
        "--no-geometric-stiffness --force -- beam.h5");
  for (const char* bad : {"report", "export beam.h5", "export -o x.npz", "export b.h5 -o x --format stl",
                          "export b.h5 -o x --columns none", "export b.h5 -o x --gyroscopic-columns row"})
    CHECK_THROWS_AS(Line(words(bad)), CLI::ParseError);
}

TEST_CASE("motion and stress: requests, and files of a run") {
  const OwnFolder own;
  const std::string scene = own.write("scene.yaml",
                                      "bodies:\n  beam:\n    mesh: {line: {from: [0, 0], to: [2, 0], elements: 4}}\n"
                                      "    section: {EA: 1e5, EI: 10, rhoA: 3}\n    reduction: {modes: 2}\n"
                                      "joints:\n  root: {type: fixed, between: [ground, beam.start]}\n"
                                      "loads:\n  tip: {type: force, at: beam.end, force: [0, 0.03]}\n"
                                      "motion: {end: 0.1, step: 0.01}\n");
  const Line stress(
      words("stress out --at 0.1,0.2 --frames 3 --history beam:1,0 --source beam:s.yaml --scene t.yaml "
            "--uncorrected --amplify 4 --force -o s.xdmf"));
  const app::StressRequest& request = stress.showing.stress;
  CHECK(request.at == std::vector<double>{0.1, 0.2});
  CHECK(request.histories == std::vector<std::string>{"beam:1,0"});
  CHECK(request.sources == std::vector<std::string>{"beam:s.yaml"});
  CHECK(request.amplify == 4);
  CHECK((request.uncorrected && request.force && stress.work));
  CHECK_THROWS_AS(Line(words("motion")), CLI::ParseError);
  CHECK_THROWS_AS(Line(words("motion out --frames -1")), CLI::ParseError);
  CHECK_THROWS_AS(Line(words("motion out --amplify inf")), CLI::ParseError);
  CHECK_THROWS(Line({"motion", own.path / "none"}).work());

  const auto folder = own.results("out");
  app::RunPlan plan;
  plan.quiet = true;
  printed([&] { app::run_one(scene::read_scene(scene), Formulation::vm_md, PETSC_COMM_WORLD, folder, plan); });
  const Line motion({"motion", own.path / "out", "--frames", "3", "--amplify", "2"});
  const std::string text = printed(motion.work);
  CHECK_THAT(text, Contains("3 instants from t = 0 to 0.1 s, 5 nodes and 4 elements of beam"));
  CHECK(std::filesystem::exists(own.path / "out/motion.xdmf"));
  CHECK_THROWS_AS(printed(motion.work), InputError);  // is there
  CHECK_NOTHROW(printed(Line({"motion", own.path / "out", "--frames", "2", "--force"}).work));
}
