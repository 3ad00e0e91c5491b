#include "showing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petscsys.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>

#include "floe/error.h"
#include "floe/output/motion_file.h"
#include "floe/output/progress.h"

namespace floe::app {
namespace {

/// Empty for a finite number, else what is wrong with it.
std::string finite(const std::string& word) {
  char* end = nullptr;
  const double number = std::strtod(word.c_str(), &end);
  return end != word.c_str() && *end == '\0' && std::isfinite(number) ? "" : "is " + word + "; expected a number";
}

void add_amplify(CLI::App* command, Showing& showing) {
  command->add_option("--amplify", showing.amplify, "scale factor of the deformations (default: 1)")
      ->check(CLI::Validator(finite, "NUMBER"));
}

void write_motion(const Showing& showing) {
  output::MotionRequest request;
  request.results = showing.folder;
  request.xdmf = showing.out ? *showing.out : (request.results / "motion.xdmf").string();
  request.amplify = std::strtod(showing.amplify.c_str(), nullptr);
  request.frames = showing.frames;
  request.overwrite = showing.force;
  const output::MotionWritten written = [&] {
    const output::Waiting waiting(PETSC_COMM_WORLD, "writing the simulation");
    return output::write_motion(PETSC_COMM_WORLD, request);
  }();
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank != 0) return;
  fmt::print("{} instants from t = {} to {} s, {} nodes and {} elements of {}\n", written.t.size(), written.t.front(),
             written.t.back(), written.nodes, written.cells, fmt::join(written.bodies, ", "));
  for (const std::string& name : written.without)
    fmt::print("Note: {} has no mesh in the results and is omitted\n", name);
  fmt::print("For ParaView: {}\n", request.xdmf.string());
}

void add_motion(CLI::App& app, Showing& showing, std::function<void()>& work) {
  CLI::App* command =
      app.add_subcommand("motion", "write the motion of a run's mechanism for ParaView, with all nodes of its meshes");
  command->add_option("DIR", showing.folder, "folder with the results of floe run")->required();
  command->add_option("-o,--out", showing.out, "FILE.xdmf, and FILE.h5 beside it (default: DIR/motion.xdmf)");
  add_amplify(command, showing);
  command->add_option("--frames", showing.frames, "maximum number of instants; 0: all stored ones")
      ->check(CLI::Range(0, 1000000000))
      ->capture_default_str();
  command->add_flag("--force", showing.force, "replace these files if they exist");
  command->callback([&] { work = [&] { write_motion(showing); }; });
}

void add_stress(CLI::App& app, Showing& showing, std::function<void()>& work) {
  CLI::App* command = app.add_subcommand(
      "stress", "recover stresses of a run's flexible bodies: extremes, fields for ParaView, histories as CSV");
  StressRequest& request = showing.stress;
  command->add_option("DIR", request.folder, "folder with the results of floe run or static")->required();
  command->add_option("-o,--out", request.out,
                      "FILE.xdmf, with FILE.h5 and FILE.csv beside it (default: DIR/stress.xdmf)");
  command
      ->add_option("--at", request.at,
                   "instants of the fields, T1,T2,... [s] (default: those of the maximum stress of each body)")
      ->delimiter(',');
  command->add_option("--frames", request.frames, "fields at this number of equally spaced instants")
      ->check(CLI::Range(1, 1000000));
  command->add_option(
      "--history", request.histories,
      "element with a history in FILE.csv: BODY:X,Y,Z in the axes of its mesh, the nearest (repeatable; "
      "default: where each body has its maximum)");
  command->add_option("--source", request.sources,
                      "BODY:SCENE.yaml: the scene from which the file of a reduced body was made, with its elements "
                      "(repeatable)");
  command->add_option("--scene", request.scene,
                      "the scene, where the run's own has been moved or was selected by --accuracy");
  command->add_flag("--uncorrected", request.uncorrected,
                    "the stresses of the reduced model alone, without the correction by its error estimate");
  add_amplify(command, showing);
  command->add_flag("--force", request.force, "replace these files if they exist");
  command->callback([&] {
    request.amplify = std::strtod(showing.amplify.c_str(), nullptr);
    work = [&] { stress(request, PETSC_COMM_WORLD); };
  });
}

std::vector<std::string> plot_words(const Showing& showing) {
  std::vector<std::string> words = showing.paths;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) words.push_back(fmt::format("{}={}", name, value));
  };
  add("--kind", fmt::format("{}", fmt::join(showing.kinds, ",")));
  if (showing.out) words.push_back("--out=" + *showing.out);
  add("--format", showing.format);
  add("--probes", fmt::format("{}", fmt::join(showing.probes, ",")));
  add("--times", showing.times);
  add("--amplify", showing.amplify);
  add("--view", showing.view);
  add("--body", showing.body);
  add("--shapes", fmt::format("{}", showing.shapes));
  add("--frames", fmt::format("{}", showing.pictures));
  add("--fps", fmt::format("{}", showing.fps));
  add("--dpi", fmt::format("{}", showing.dpi));
  if (showing.components) words.push_back("--components");
  return words;
}

void add_plot(CLI::App& app, Showing& showing) {
  CLI::App* command =
      app.add_subcommand("plot", "draw results: histories, energy, shapes, comparisons, diagrams, animations");
  command
      ->add_option("PATH", showing.paths,
                   "result folders of floe run, static, compare, tradeoff, sweep or campbell; shapes (modes.xdmf), "
                   "reduced bodies (NAME.h5)")
      ->required();
  command
      ->add_option("--kind", showing.kinds,
                   "kinds of pictures, separated by commas: probes, energy, deformed, animation, shapes, campbell, "
                   "compare, tradeoff, sweep (default: all that PATH has, except animation)")
      ->delimiter(',');
  command->add_option(
      "-o,--out", showing.out,
      "a picture (.png .svg .pdf, an animation .gif .mp4) or a folder (default: in the folder of the results)");
  command->add_option("--format", showing.format, "png | svg | pdf (default: png)")
      ->check(CLI::IsMember({"png", "svg", "pdf"}));
  command->add_option("--probes", showing.probes, "columns of probes.csv, separated by commas: tip.x (default: all)")
      ->delimiter(',');
  command->add_flag("--components", showing.components,
                    "compare: a panel for each component of the probes (default: one for each probe, with its error)");
  command->add_option("--times", showing.times, "instants of deformed shapes, A,B,C [s] (default: six)");
  add_amplify(command, showing);
  command->add_option("--view", showing.view,
                      "view direction of spatial mechanisms: AZIMUTH,ELEVATION [degrees] (default: -60,25)");
  command->add_option("--body", showing.body, "body whose shapes are drawn (default: all bodies)");
  command->add_option("--shapes", showing.shapes, "number of shapes, in their order")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_option("--frames", showing.pictures, "of an animation")
      ->check(CLI::Range(2, 10000))
      ->capture_default_str();
  command->add_option("--fps", showing.fps, "frames per second of an animation")
      ->check(CLI::Range(0.1, 120.0))
      ->capture_default_str();
  command->add_option("--dpi", showing.dpi, "resolution of a PNG [dots per inch]")
      ->check(CLI::Range(20, 1200))
      ->capture_default_str();
  command->callback([&] { showing.script = {"plot", plot_words(showing)}; });
}

void add_report(CLI::App& app, Showing& showing) {
  CLI::App* command =
      app.add_subcommand("report", "write one HTML page on a run: scene, model, tables, pictures, animated mechanism");
  command->add_option("DIR", showing.folder, "result folder of floe run, static, compare, tradeoff, sweep or campbell")
      ->required();
  command->add_option("-o,--out", showing.out,
                      "the page (default: DIR/report.html); needs no network and no other file");
  command->callback([&] {
    showing.script = {"report", {showing.folder}};
    if (showing.out) showing.script->words.push_back("--out=" + *showing.out);
  });
}

std::vector<std::string> export_words(const Showing& showing) {
  std::vector<std::string> words = {"--out=" + showing.out.value_or("")};
  if (!showing.format.empty()) words.push_back("--format=" + showing.format);
  if (!showing.columns.empty()) words.push_back("--columns=" + showing.columns);
  if (!showing.gyroscopic_columns.empty()) words.push_back("--gyroscopic-columns=" + showing.gyroscopic_columns);
  if (showing.with_shapes) words.push_back("--shapes");
  if (showing.no_geometric_stiffness) words.push_back("--no-geometric-stiffness");
  if (showing.force) words.push_back("--force");
  words.insert(words.end(), {"--", showing.folder});  // whatever the body's name begins with
  return words;
}

void add_export(CLI::App& app, Showing& showing) {
  CLI::App* command = app.add_subcommand(
      "export",
      "export a reduced body to other programs: NumPy, Standard Input Data (SID), MBSim, Exudyn, Matrix "
      "Market");
  command->add_option("BODY", showing.folder, "file written by floe reduce")->required();
  command
      ->add_option("-o,--out", showing.out,
                   "the file; its extension selects the format: .npz, .sid .SID_FEM, .xml (MBSim, nonlinear), .h5mbs "
                   "(MBSim, linear), .mtx (NAME-K.mtx, NAME-M.mtx, NAME-C.mtx)")
      ->required();
  command
      ->add_option("--format", showing.format,
                   "npz | sid | mbsim | mbsim-hdf5 | mtx | exudyn (an .npz; default: by the extension)")
      ->check(CLI::IsMember({"npz", "sid", "mbsim", "mbsim-hdf5", "mtx", "exudyn"}));
  command->add_flag("--shapes", showing.with_shapes, "npz: include the mesh and the basis at all nodes");
  command
      ->add_option("--columns", showing.columns,
                   "sid, exudyn: modes (with attachment modes; in sid derivatives act by geometric stiffness) | all "
                   "(default: modes)")
      ->check(CLI::IsMember({"modes", "all"}));
  command
      ->add_option(
          "--gyroscopic-columns", showing.gyroscopic_columns,
          "sid, columns of Gr and Ge: axis (all coordinates of an axis together, as FEMBS has them) | coordinate "
          "(default: axis)")
      ->check(CLI::IsMember({"axis", "coordinate"}));
  command->add_flag("--no-geometric-stiffness", showing.no_geometric_stiffness,
                    "sid: omit the geometric stiffness terms");
  command->add_flag("--force", showing.force, "replace the file if it exists");
  command->callback([&] { showing.script = {"export", export_words(showing)}; });
}

}  // namespace

void add_showing(CLI::App& app, Showing& showing, std::function<void()>& work) {
  add_motion(app, showing, work);
  add_stress(app, showing, work);
  add_plot(app, showing);
  add_report(app, showing);
  add_export(app, showing);
}

}  // namespace floe::app
