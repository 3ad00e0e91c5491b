#include "floe/app/app.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "campbell.h"
#include "commands.h"
#include "compare.h"
#include "drawing.h"
#include "equilibrium.h"
#include "floe/petsc/rank.h"
#include "floe/scene/schema.h"
#include "floe/version.h"
#include "restart.h"
#include "session.h"
#include "showing.h"
#include "sweep.h"
#include "tradeoff.h"

namespace floe::app {

namespace {

struct Choices {
  std::string scene, formulation = "vm+md", body;
  std::optional<std::string> out, matrices;
  std::vector<std::string> formulations = {"cfr", "nlffr", "lffr", "vm", "vm+md"};
  std::optional<double> at;
  int steps = 10;
  CampbellRequest campbell;
  std::string reference = "nlffr";
  TradeoffRequest tradeoff;
  std::optional<std::string> restart, checkpoint, accuracy, explicit_scene;
  std::optional<double> until;
  std::vector<std::string> varied;
  bool together = false;
  bool force = false, no_reference_error = false, no_estimate = false, markdown = false;
};

std::string stem(const std::string& path) {
  const auto slash = path.find_last_of('/');
  const std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
  std::string file = name.substr(0, name.find_last_of('.'));
  if (file != "scene" || slash == std::string::npos) return file;
  const std::string folder = path.substr(0, slash);  // examples/cantilever/scene.yaml: cantilever
  const auto before = folder.find_last_of('/');
  return before == std::string::npos ? folder : folder.substr(before + 1);
}

scene::Scene read(const std::string& path) {
  scene::Scene scene;
  petsc::agree(PETSC_COMM_WORLD, [&] { scene = scene::read_scene(path); });
  return scene;
}

/// The scene of a command that moves it.
scene::Scene read_moving(const std::string& path) {
  scene::Scene scene = read(path);
  if (scene.motion.end <= 0)
    throw InputError(path +
                     ": motion: is missing; expected how long and how finely, as `motion: {end: 3, step: 1e-3}`");
  return scene;
}

std::string folder_of(const Choices& choices, const std::string& what) {
  return choices.out ? *choices.out : "results/" + stem(choices.scene) + "-" + what;
}

void add_scene(CLI::App* command, Choices& choices) {
  command->add_option("SCENE", choices.scene, "the scene, a YAML file (floe schema prints its grammar)")->required();
}
/// Empty for a positive, finite number, else what is wrong with it.
std::string positive(const std::string& word) {
  char* end = nullptr;
  const double number = std::strtod(word.c_str(), &end);
  const bool whole = end != word.c_str() && *end == '\0';
  return whole && number > 0 && std::isfinite(number) ? "" : "is " + word + "; expected a positive number";
}
void add_folder(CLI::App* command, Choices& choices) {
  command->add_option("-o,--out", choices.out, "folder for the results (default: results/NAME-...)");
  command->add_flag("--force", choices.force, "replace floe's results in a folder that has some");
}

}  // namespace

int main(int argc, char** argv) {
  const CommandLine line = split(argc, argv);
  Choices choices;
  const auto on_first_rank = [](const auto& show) {
    int rank = 0;
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    if (rank == 0) show();
  };
  std::function<void()> work;
  CLI::App app("floe " FLOE_VERSION
               ": flexible multibody dynamics, reduced with modal derivatives in the floating frame of reference",
               "floe");
  app.set_version_flag("--version", std::string("floe " FLOE_VERSION " (" FLOE_COMMIT ")"));
  app.require_subcommand(1);
  app.footer(
      "PETSc's and SLEPc's options follow with one dash: -modes_eps_..., -derivatives_ksp_..., -motion_ts_..., "
      "-static_snes_..., -campbell_pep_..., -log_view; -help lists those of a command's solvers. Under mpirun -n N the "
      "answer is the "
      "same.");

  CLI::App* run_command = app.add_subcommand("run", "simulate a scene in one formulation");
  run_command->add_option("SCENE", choices.scene,
                          "the scene, a YAML file (floe schema prints its grammar); with --restart that of the run");
  run_command->add_option("--formulation", choices.formulation, "cfr | nlffr | lffr | vm | vm+md")
      ->capture_default_str();
  run_command->add_flag("--no-estimate", choices.no_estimate,
                        "spare the estimate of the error against full order (vm, vm+md)");
  run_command->add_option(
      "--accuracy", choices.accuracy,
      "choose columns, elastic force and step for this error of the probes, 1% or 0.01 (default: the "
      "scene's accuracy, if it has one)");
  run_command->add_option("--write-scene", choices.explicit_scene,
                          "with an accuracy: write the scene with what was chosen into this file");
  add_folder(run_command, choices);
  run_command->add_option("--checkpoint", choices.checkpoint,
                          "write a checkpoint each so many steps (1000) or seconds (60s), and at the end");
  run_command->add_option("--restart", choices.restart,
                          "go on from the checkpoint in this folder: the same motion, bit for bit");
  run_command
      ->add_option("--until", choices.until, "with --restart: to this time (default: the scene's motion.end) [s]")
      ->check(CLI::Validator(positive, "POSITIVE"));
  run_command->callback([&, formulation_given = run_command->get_option("--formulation")] {
    if (choices.scene.empty() && !choices.restart) throw CLI::RequiredError("SCENE");
    if (choices.until && !choices.restart) throw CLI::RequiresError("--until", "--restart");
    if (choices.restart && choices.out) throw CLI::ExcludesError("--restart", "--out");
    if (choices.restart && choices.force) throw CLI::ExcludesError("--restart", "--force");
    if (choices.accuracy && choices.restart) throw CLI::ExcludesError("--accuracy", "--restart");
    if (choices.accuracy && choices.formulation != "vm+md") throw CLI::ExcludesError("--accuracy", "--formulation");
    work = [&, formulation_given] {
      RunPlan plan;
      plan.estimate = !choices.no_estimate && scene::is_reduced(scene::formulation_of(choices.formulation));
      if (choices.checkpoint) plan.checkpoints = checkpoint_every(*choices.checkpoint);
      if (choices.restart)
        return restart_one(*choices.restart, choices.scene,
                           formulation_given->count() > 0 ? std::optional(choices.formulation) : std::nullopt,
                           choices.until, plan, PETSC_COMM_WORLD);
      const scene::Formulation formulation = scene::formulation_of(choices.formulation);
      const scene::Scene scene = read_moving(choices.scene);
      const bool chooses = formulation == scene::Formulation::vm_md && (choices.accuracy || scene.accuracy);
      if (choices.explicit_scene && !chooses)
        throw InputError("--write-scene: goes with an accuracy, of the scene or --accuracy, in formulation vm+md");
      if (chooses) {
        const double accuracy = choices.accuracy ? scene::accuracy_of(*choices.accuracy) : *scene.accuracy;
        if (choices.no_estimate)
          throw InputError("--no-estimate: does not go with an accuracy, which is judged by the estimate");
        if (choices.checkpoint)
          throw InputError("--checkpoint: does not go with an accuracy; expected the scene of --write-scene");
        if (scene.motion.tolerance)
          throw InputError(scene.motion.where.text() +
                           ".tolerance: does not go with an accuracy, which chooses the step");
        return run_chosen(scene, accuracy, PETSC_COMM_WORLD,
                          output::prepare_folder(PETSC_COMM_WORLD, folder_of(choices, "accuracy"), choices.force),
                          choices.explicit_scene, choices.force);
      }
      run_one(scene, formulation, PETSC_COMM_WORLD,
              output::prepare_folder(PETSC_COMM_WORLD, folder_of(choices, choices.formulation), choices.force), plan);
      if (scene.accuracy && petsc::first_rank(PETSC_COMM_WORLD))
        fmt::print("Note: accuracy goes with formulation vm+md, and was not used\n");
    };
  });

  CLI::App* compare_command = app.add_subcommand("compare", "simulate in several formulations: one table, one picture");
  add_scene(compare_command, choices);
  compare_command
      ->add_option(
          "--formulations", choices.formulations,
          "which, separated by commas (modal damping: vm,vm+md; bodies from files: lffr,vm,vm+md; in space cfr is "
          "left to be named, in the plane with shear it is not known)")
      ->delimiter(',')
      ->capture_default_str();
  compare_command->add_flag("--no-reference-error", choices.no_reference_error,
                            "spare the run that shows the reference's own error");
  add_folder(compare_command, choices);
  compare_command->callback([&, given = compare_command->get_option("--formulations")] {
    work = [&, given] {
      const scene::Scene scene = read_moving(choices.scene);
      const bool files = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                     [](const scene::Body& body) { return body.reduced.has_value(); });
      const bool shears = std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const scene::Body& body) {
        return !body.rigid && body.section.GA.has_value();
      });
      const bool modal = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                     [](const scene::Body& body) { return !body.damping.modal.empty(); });
      if (modal && given->count() == 0) {
        choices.formulations = {"vm", "vm+md"};  // those with modes to damp
        on_first_rank([] { fmt::print("Note: modal damping is that of modes; compared are vm and vm+md\n"); });
      } else if (files && given->count() == 0)
        choices.formulations = {"lffr", "vm", "vm+md"};  // those without a mesh
      else if (given->count() == 0 && (scene.dimension == 3 || shears))
        choices.formulations = {"nlffr", "lffr", "vm", "vm+md"};
      std::vector<scene::Formulation> formulations;
      for (const std::string& name : choices.formulations) {
        const scene::Formulation one = scene::formulation_of(name);
        if (std::find(formulations.begin(), formulations.end(), one) != formulations.end())
          throw InputError(fmt::format("--formulations: \"{}\" is named twice", name));
        formulations.push_back(one);
      }
      compare(scene, formulations, PETSC_COMM_WORLD, folder_of(choices, "compare"), choices.force,
              !choices.no_reference_error);
    };
  });

  CLI::App* tradeoff_command =
      app.add_subcommand("tradeoff", "a ladder of cheaper models against full order: error against time, one picture");
  add_scene(tradeoff_command, choices);
  tradeoff_command->add_option("--reference", choices.reference, "nlffr | cfr")->capture_default_str();
  tradeoff_command
      ->add_option("--accuracy", choices.tradeoff.accuracy, "the cheapest model within this error is named the choice")
      ->check(CLI::Range(1e-9, 1.0))
      ->capture_default_str();
  add_folder(tradeoff_command, choices);
  tradeoff_command->callback([&] {
    work = [&] {
      choices.tradeoff.reference = scene::formulation_of(choices.reference);
      if (choices.reference != "nlffr" && choices.reference != "cfr")
        throw InputError("--reference: is " + choices.reference + "; expected nlffr or cfr, of full order");
      tradeoff(read_moving(choices.scene), PETSC_COMM_WORLD, choices.tradeoff, folder_of(choices, "tradeoff"),
               choices.force);
    };
  });

  CLI::App* static_command = app.add_subcommand("static", "equilibria of a scene under loads that grow with t");
  add_scene(static_command, choices);
  static_command->add_option("--formulation", choices.formulation, "cfr | nlffr | lffr | vm | vm+md")
      ->capture_default_str();
  static_command
      ->add_option("--at", choices.at, "t of the last equilibrium, from 0 (default: the end of the motion, or 1)")
      ->check(CLI::Validator(positive, "POSITIVE"));
  static_command->add_option("--steps", choices.steps, "equilibria on the way, at equal distances in t")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  static_command->add_flag("--no-estimate", choices.no_estimate,
                           "spare the estimate of the error against full order (vm, vm+md)");
  add_folder(static_command, choices);
  static_command->callback([&] {
    work = [&] {
      const scene::Formulation formulation = scene::formulation_of(choices.formulation);
      const scene::Scene scene = read(choices.scene);
      const double at = choices.at.value_or(scene.motion.end > 0 ? scene.motion.end : 1);
      rest_one(scene, formulation, PETSC_COMM_WORLD, {at, choices.steps},
               output::prepare_folder(PETSC_COMM_WORLD, folder_of(choices, "static"), choices.force),
               !choices.no_estimate && scene::is_reduced(formulation));
    };
  });

  CLI::App* campbell_command =
      app.add_subcommand("campbell", "steady rotation of a scene at several speeds, and its vibrations there");
  add_scene(campbell_command, choices);
  campbell_command->add_option("--formulation", choices.formulation, "nlffr | lffr | vm | vm+md")
      ->capture_default_str();
  campbell_command->add_option("--speeds", choices.campbell.speeds, "FROM:TO:STEP or a list A,B,C [rad/s]")->required();
  campbell_command->add_option(
      "--about", choices.campbell.about,
      "direction of the axis X,Y,Z (default: of the one driven or revolute joint to the ground)");
  campbell_command->add_option("--through", choices.campbell.through,
                               "a point of the axis X,Y,Z (default: that joint's, or 0,0,0 with --about)");
  campbell_command->add_option("--modes", choices.campbell.modes, "how many vibrations at each speed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  add_folder(campbell_command, choices);
  campbell_command->callback([&] {
    work = [&] {
      const scene::Formulation formulation = scene::formulation_of(choices.formulation);
      const scene::Scene scene = read(choices.scene);
      campbell_one(scene, formulation, PETSC_COMM_WORLD, choices.campbell,
                   output::prepare_folder(PETSC_COMM_WORLD, folder_of(choices, "campbell"), choices.force));
    };
  });

  CLI::App* sweep_command = app.add_subcommand(
      "sweep", "simulate a reduced scene with some of its numbers varied, members spread over ranks");
  add_scene(sweep_command, choices);
  sweep_command->add_option("--formulation", choices.formulation, "vm+md | vm")->capture_default_str();
  sweep_command
      ->add_option("--vary", choices.varied,
                   "PATH=FROM:TO:STEP or PATH=A,B,C: a number of the scene by its path (loads.tip.force[2], "
                   "parameters by their name); several: every combination")
      ->required()
      ->allow_extra_args(false);
  sweep_command->add_flag("--together", choices.together, "the i-th values of all together, not every combination");
  add_folder(sweep_command, choices);
  sweep_command->callback([&] {
    work = [&] {
      const scene::Formulation formulation = scene::formulation_of(choices.formulation);
      std::vector<Varied> varied;
      for (const std::string& text : choices.varied) varied.push_back(parse_varied(text));
      sweep(choices.scene, formulation, varied, choices.together, PETSC_COMM_WORLD,
            output::prepare_folder(PETSC_COMM_WORLD, folder_of(choices, "sweep"), choices.force));
    };
  });

  CLI::App* modes_command = app.add_subcommand("modes", "frequencies of each body, with residuals");
  add_scene(modes_command, choices);
  modes_command->add_option("--write", choices.out,
                            "shapes of modes and derivatives for ParaView: FILE.xdmf, and FILE.h5 beside it");
  modes_command->add_option("--write-matrices", choices.matrices,
                            "a folder: K and M of each body under the conditions of its modes, in Matrix Market, and "
                            "what their rows are");
  modes_command->add_flag("--force", choices.force, "replace these files if they are there");
  modes_command->callback([&] {
    work = [&] { modes(read(choices.scene), PETSC_COMM_WORLD, choices.out, choices.matrices, choices.force); };
  });

  CLI::App* reduce_command =
      app.add_subcommand("reduce", "reduce one body, offline and in parallel, into a file that needs no mesh");
  add_scene(reduce_command, choices);
  reduce_command->add_option("--body", choices.body, "which one (default: the only one)");
  reduce_command->add_option("-o,--out", choices.out, "the file (default: NAME.h5)");
  reduce_command->add_flag("--force", choices.force, "replace the file if it is there");
  reduce_command->callback([&] {
    work = [&] {
      const std::string path = choices.out ? *choices.out : stem(choices.scene) + ".h5";
      reduce(read(choices.scene), choices.body, PETSC_COMM_WORLD, path, choices.force);
    };
  });

  CLI::App* info_command = app.add_subcommand("info", "what a reduced body's file holds");
  info_command->add_option("FILE", choices.scene, "made by floe reduce")->required();
  info_command->callback([&] { work = [&] { info(choices.scene, PETSC_COMM_WORLD); }; });

  Showing showing;
  add_showing(app, showing, work);

  CLI::App* check_command = app.add_subcommand("check", "validate a scene and say what would be simulated");
  add_scene(check_command, choices);
  check_command->add_option("--formulation", choices.formulation,
                            "build the scene in this one, as run would (default: at full order, if it can be)");
  check_command->callback([&, given = check_command->get_option("--formulation")] {
    work = [&, given] {
      const std::optional<scene::Formulation> formulation =
          given->count() > 0 ? std::optional(scene::formulation_of(choices.formulation)) : std::nullopt;
      check(read(choices.scene), PETSC_COMM_WORLD, formulation);
    };
  });

  CLI::App* schema_command = app.add_subcommand("schema", "print the grammar of scenes");
  schema_command->add_flag("--markdown", choices.markdown, "as Markdown, for the manual");
  schema_command->callback([&] {
    work = [&] {
      on_first_rank([&] { fmt::print("{}", choices.markdown ? scene::schema_markdown() : scene::schema_reference()); });
    };
  });

  try {
    std::vector<std::string> words(line.own.rbegin(), line.own.rend());
    if (words.empty() && !line.petsc.empty()) words = {"--help"};
    app.parse(words);
  } catch (const CLI::Success& help) {
    work = [&on_first_rank, &app, shown = help] { on_first_rank([&] { app.exit(shown); }); };
  } catch (const CLI::ParseError& error) {
    std::string what = error.what();
    if (app.get_subcommands().empty() && !line.own.empty() && line.own.front()[0] != '-')
      what = fmt::format(
          "\"{}\" is no command; expected run, compare, tradeoff, sweep, static, campbell, modes, reduce, info, "
          "motion, "
          "plot, report, export, check or schema",
          line.own.front());
    work = [text = what + " (floe --help)"] { throw InputError(text); };
  }
  if (showing.script && !work) {
    if (line.petsc.empty()) return become_script(showing.script->name, showing.script->words);
    work = [&] {
      throw InputError(fmt::format("{}: {} has no options of PETSc", line.petsc.front(), showing.script->name));
    };
  }
  const std::vector<CLI::App*> commands = app.get_subcommands();
  return in_session(line, commands.empty() ? "" : commands.front()->get_name(), work);
}

}  // namespace floe::app
