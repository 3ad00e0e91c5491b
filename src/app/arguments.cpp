#include "arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "commands.h"
#include "compare.h"
#include "equilibrium.h"
#include "floe/petsc/rank.h"
#include "floe/scene/schema.h"
#include "restart.h"
#include "sweep.h"

namespace floe::app {

namespace {

using Work = std::function<void()>;

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

/// A scene, or for a mesh file or deck one of it as a free body.
scene::Scene read_bodies(const std::string& path) {
  const auto ends = [&](const char* with) { return path.ends_with(with); };
  const char* const meshes[] = {".inp", ".bdf", ".nas", ".dat", ".msh"};
  if (std::none_of(std::begin(meshes), std::end(meshes), ends) || !std::filesystem::exists(path)) return read(path);
  const std::string file = nlohmann::json(std::filesystem::absolute(path).string()).dump();
  scene::Scene scene;
  petsc::agree(PETSC_COMM_WORLD, [&] {
    scene = scene::parse_scene("bodies: {body: {frame: mean-axis, mesh: {file: {path: " + file + "}}}}\n", path);
  });
  return scene;
}

/// The scene of a command that moves it.
scene::Scene read_moving(const std::string& path) {
  scene::Scene scene = read(path);
  if (scene.motion.end <= 0)
    throw InputError(path + ": motion: is missing; expected end time and time step, as `motion: {end: 3, step: 1e-3}`");
  return scene;
}

std::string folder_of(const Arguments& given, const std::string& what) {
  return given.out ? *given.out : "results/" + stem(given.scene) + "-" + what;
}

output::ResultFolder new_folder(const Arguments& given, const std::string& what) {
  return output::prepare_folder(PETSC_COMM_WORLD, folder_of(given, what), given.force);
}

/// Empty for a positive, finite number, else what is wrong with it.
std::string positive(const std::string& word) {
  char* end = nullptr;
  const double number = std::strtod(word.c_str(), &end);
  const bool whole = end != word.c_str() && *end == '\0';
  return whole && number > 0 && std::isfinite(number) ? "" : "is " + word + "; expected a positive number";
}

void add_scene(CLI::App* command, Arguments& given) {
  command->add_option("SCENE", given.scene, "the scene, a YAML file (floe schema prints its grammar)")->required();
}

void add_scene_or_mesh(CLI::App* command, Arguments& given) {
  command
      ->add_option("SCENE", given.scene,
                   "the scene, a YAML file (floe schema prints its grammar); or a deck or mesh file, as a free body")
      ->required();
}

void add_folder(CLI::App* command, Arguments& given) {
  command->add_option("-o,--out", given.out, "folder for the results (default: results/NAME-...)");
  command->add_flag("--force", given.force, "replace existing floe results in the folder");
}

CLI::Option* add_formulation(CLI::App* command, Arguments& given, const std::string& kinds) {
  return command->add_option("--formulation", given.formulation, kinds)->capture_default_str();
}

void add_no_estimate(CLI::App* command, Arguments& given) {
  command->add_flag("--no-estimate", given.no_estimate,
                    "skip the estimate of the error relative to the full-order model (vm, vm+md)");
}

// run ---------------------------------------------------------------------------------------------------------------

void check_run(const Arguments& given) {
  if (given.scene.empty() && !given.restart) throw CLI::RequiredError("SCENE");
  if (given.until && !given.restart) throw CLI::RequiresError("--until", "--restart");
  if (given.restart && given.out) throw CLI::ExcludesError("--restart", "--out");
  if (given.restart && given.force) throw CLI::ExcludesError("--restart", "--force");
  if (given.accuracy && given.restart) throw CLI::ExcludesError("--accuracy", "--restart");
  if (given.accuracy && given.formulation != "vm+md") throw CLI::ExcludesError("--accuracy", "--formulation");
}

/// With the model that an accuracy asks for.
void run_by_accuracy(const Arguments& given, const scene::Scene& scene) {
  const scene::Accuracy accuracy = given.accuracy ? scene::accuracy_of(*given.accuracy) : *scene.accuracy;
  if (given.no_estimate)
    throw InputError("--no-estimate: cannot be combined with an accuracy, which needs the estimate");
  if (given.checkpoint)
    throw InputError("--checkpoint: cannot be combined with an accuracy; expected the scene of --write-scene");
  if (scene.motion.tolerance)
    throw InputError(scene.motion.where.text() +
                     ".tolerance: cannot be combined with an accuracy, which selects the step");
  run_chosen(scene, accuracy, PETSC_COMM_WORLD, new_folder(given, "accuracy"), given.explicit_scene, given.force);
}

void run(const Arguments& given) {
  RunPlan plan;
  plan.estimate = !given.no_estimate && scene::is_reduced(scene::formulation_of(given.formulation));
  if (given.checkpoint) plan.checkpoints = checkpoint_every(*given.checkpoint);
  if (given.restart)
    return restart_one(*given.restart, given.scene,
                       given.formulation_given ? std::optional(given.formulation) : std::nullopt, given.until, plan,
                       PETSC_COMM_WORLD);
  const scene::Formulation formulation = scene::formulation_of(given.formulation);
  const scene::Scene scene = read_moving(given.scene);
  if (formulation == scene::Formulation::vm_md && (given.accuracy || scene.accuracy))
    return run_by_accuracy(given, scene);
  if (given.explicit_scene)
    throw InputError("--write-scene: needs an accuracy, of the scene or --accuracy, and formulation vm+md");
  run_one(scene, formulation, PETSC_COMM_WORLD, new_folder(given, given.formulation), plan);
  if (scene.accuracy && petsc::first_rank(PETSC_COMM_WORLD))
    fmt::print("Note: accuracy applies to formulation vm+md only, and was ignored\n");
}

void add_run(CLI::App& app, Arguments& given, Work& work) {
  CLI::App* command = app.add_subcommand("run", "simulate a scene in one formulation");
  command->add_option("SCENE", given.scene,
                      "the scene, a YAML file (floe schema prints its grammar); with --restart that of the run");
  const CLI::Option* formulation = add_formulation(command, given, "cfr | nlffr | lffr | vm | vm+md");
  add_no_estimate(command, given);
  command->add_option(
      "--accuracy", given.accuracy,
      "select frames, elements, strains, basis vectors, elastic force and step for this total error of "
      "the probes, 1% or 0.01; reduction:1% selects basis vectors, elastic force and step for the error "
      "relative to the full-order model of the same mesh (default: the scene's accuracy, if given)");
  command->add_option("--write-scene", given.explicit_scene,
                      "with an accuracy: write the scene with the selected model to this file");
  add_folder(command, given);
  command->add_option("--checkpoint", given.checkpoint,
                      "write a checkpoint every N steps (1000) or every N seconds (60s), and at the end");
  command->add_option(
      "--restart", given.restart,
      "continue from the checkpoint in this folder; results are bitwise identical to an uninterrupted run");
  command->add_option("--until", given.until, "with --restart: end time (default: the scene's motion.end) [s]")
      ->check(CLI::Validator(positive, "POSITIVE"));
  command->callback([&given, &work, formulation] {
    given.formulation_given = formulation->count() > 0;
    check_run(given);
    work = [&given] { run(given); };
  });
}

// compare, tradeoff, sweep ------------------------------------------------------------------------------------------

void add_compare(CLI::App& app, Arguments& given, Work& work) {
  CLI::App* command = app.add_subcommand(
      "compare", "simulate a scene in several formulations and compare them: one table, one picture");
  add_scene(command, given);
  command
      ->add_option("--formulations", given.formulations,
                   "the formulations, separated by commas (default: cfr,nlffr,lffr,vm,vm+md; bodies from files: "
                   "lffr,vm,vm+md; cfr in space only where it is named)")
      ->delimiter(',');
  command->add_flag("--no-reference-error", given.no_reference_error,
                    "skip the run that determines the reference's own error");
  add_folder(command, given);
  command->callback([&given, &work] {
    work = [&given] {
      const scene::Scene scene = read_moving(given.scene);
      compare(scene, formulations_to_compare(scene, given.formulations), PETSC_COMM_WORLD, folder_of(given, "compare"),
              given.force, !given.no_reference_error);
    };
  });
}

void add_tradeoff(CLI::App& app, Arguments& given, Work& work) {
  CLI::App* command = app.add_subcommand("tradeoff",
                                         "simulate a hierarchy of models and compare them with a converged reference: "
                                         "total error versus computing time, one picture");
  add_scene(command, given);
  command->add_option("--reference", given.reference,
                      "nlffr | cfr; absent: cfr where it can simulate the scene within the time budget, else nlffr");
  command
      ->add_option("--time-budget", given.tradeoff.most_seconds,
                   "seconds of processor time that one simulation of the reference in formulation cfr, or of a "
                   "full-order model, may take")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--accuracy", given.tradeoff.accuracy, "point out the fastest model with at most this error")
      ->check(CLI::Range(1e-9, 1.0))
      ->capture_default_str();
  add_folder(command, given);
  command->callback([&given, &work] {
    work = [&given] {
      if (!given.reference.empty()) given.tradeoff.reference = scene::formulation_of(given.reference, "--reference");
      if (!given.reference.empty() && given.reference != "nlffr" && given.reference != "cfr")
        throw InputError("--reference: is " + given.reference + "; expected nlffr or cfr, the full-order models");
      tradeoff(read_moving(given.scene), PETSC_COMM_WORLD, given.tradeoff, folder_of(given, "tradeoff"), given.force);
    };
  });
}

void add_sweep(CLI::App& app, Arguments& given, Work& work) {
  CLI::App* command = app.add_subcommand(
      "sweep", "simulate a reduced scene for several values of its parameters, distributed over the ranks");
  add_scene(command, given);
  add_formulation(command, given, "vm+md | vm");
  command
      ->add_option("--vary", given.varied,
                   "PATH=FROM:TO:STEP or PATH=A,B,C: a number of the scene by its path (loads.tip.force[2], "
                   "parameters by their name); several: every combination")
      ->required()
      ->allow_extra_args(false);
  command->add_flag("--together", given.together,
                    "vary all together, the i-th value of each, instead of every combination");
  command->add_flag("--estimate", given.estimate,
                    "estimate the total error of each member, as run does; each takes the time of several");
  command->add_option("--ranks-per-member", given.ranks_per_member,
                      "ranks that reduce and simulate a member together (default 1), for large meshes");
  add_folder(command, given);
  command->callback([&given, &work] {
    work = [&given] {
      SweepRequest request{
          given.scene,           scene::formulation_of(given.formulation), {}, given.together, given.estimate,
          given.ranks_per_member};
      for (const std::string& text : given.varied) request.varied.push_back(parse_varied(text));
      sweep(request, PETSC_COMM_WORLD, new_folder(given, "sweep"));
    };
  });
}

// static, campbell --------------------------------------------------------------------------------------------------

void add_static(CLI::App& app, Arguments& given, Work& work) {
  CLI::App* command = app.add_subcommand("static", "compute equilibria of a scene under loads that grow with t");
  add_scene(command, given);
  add_formulation(command, given, "cfr | nlffr | lffr | vm | vm+md");
  command->add_option("--at", given.at, "t of the last equilibrium, from 0 (default: motion.end, or 1)")
      ->check(CLI::Validator(positive, "POSITIVE"));
  command->add_option("--steps", given.steps, "number of equilibria, at equal increments of t")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  CLI::Option* path = command->add_flag(
      "--path", given.path,
      "follow the path of equilibria by arc length, past limit points (snap-through, snap-back), to t = T; increments "
      "of t are at most T / steps");
  command->add_option("--points", given.points, "with --path: maximum number of points")
      ->check(CLI::Range(1, 1000000))
      ->needs(path)
      ->capture_default_str();
  add_no_estimate(command, given);
  add_folder(command, given);
  command->callback([&given, &work] {
    work = [&given] {
      const scene::Formulation formulation = scene::formulation_of(given.formulation);
      const scene::Scene scene = read(given.scene);
      const double at = given.at.value_or(scene.motion.end > 0 ? scene.motion.end : 1);
      solve_static(scene, formulation, PETSC_COMM_WORLD, {at, given.steps, given.path, given.points},
                   new_folder(given, "static"), !given.no_estimate && scene::is_reduced(formulation));
    };
  });
}

void add_campbell(CLI::App& app, Arguments& given, Work& work) {
  CLI::App* command = app.add_subcommand(
      "campbell", "compute the steady rotation of a scene at several speeds, and its vibrations about it");
  add_scene(command, given);
  add_formulation(command, given, "cfr | nlffr | lffr | vm | vm+md");
  command->add_option("--speeds", given.campbell.speeds, "FROM:TO:STEP or a list A,B,C [rad/s]")->required();
  command->add_option("--about", given.campbell.about,
                      "direction of the axis X,Y,Z (default: of the one driven or revolute joint to the ground)");
  command->add_option("--through", given.campbell.through,
                      "a point of the axis X,Y,Z (default: that joint's, or 0,0,0 with --about)");
  command->add_option("--modes", given.campbell.modes, "number of vibrations at each speed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  add_no_estimate(command, given);
  add_folder(command, given);
  command->callback([&given, &work] {
    work = [&given] {
      const scene::Formulation formulation = scene::formulation_of(given.formulation);
      const scene::Scene scene = read(given.scene);
      given.campbell.estimate = !given.no_estimate;
      campbell_one(scene, formulation, PETSC_COMM_WORLD, given.campbell, new_folder(given, "campbell"));
    };
  });
}

// modes, reduce, info, check, schema --------------------------------------------------------------------------------

void add_modes(CLI::App& app, Arguments& given, Work& work) {
  CLI::App* command = app.add_subcommand("modes", "compute the natural frequencies of each body, with residuals");
  add_scene_or_mesh(command, given);
  command->add_option("--write", given.out,
                      "shapes of modes and derivatives for ParaView: FILE.xdmf, and FILE.h5 beside it");
  command->add_option("--write-matrices", given.matrices,
                      "folder for K and M of each body under the conditions of its modes, in Matrix Market "
                      "format, with the meaning of their rows");
  command->add_flag("--force", given.force, "replace these files if they exist");
  command->callback([&given, &work] {
    work = [&given] { modes(read_bodies(given.scene), PETSC_COMM_WORLD, given.out, given.matrices, given.force); };
  });
}

void add_reduce(CLI::App& app, Arguments& given, Work& work) {
  CLI::App* command = app.add_subcommand(
      "reduce", "reduce one body, offline and in parallel, and write it to a file that needs no mesh");
  add_scene(command, given);
  command->add_option("--body", given.body, "name of the body (default: the only one)");
  command->add_option("-o,--out", given.out, "the file (default: NAME.h5)");
  command->add_flag("--force", given.force, "replace the file if it exists");
  command->callback([&given, &work] {
    work = [&given] {
      const std::string path = given.out ? *given.out : stem(given.scene) + ".h5";
      reduce(read(given.scene), given.body, PETSC_COMM_WORLD, path, given.force);
    };
  });
}

void add_info(CLI::App& app, Arguments& given, Work& work) {
  CLI::App* command = app.add_subcommand("info", "describe the contents of a reduced body's file");
  command->add_option("FILE", given.scene, "file written by floe reduce")->required();
  command->callback([&given, &work] { work = [&given] { info(given.scene, PETSC_COMM_WORLD); }; });
}

void add_check(CLI::App& app, Arguments& given, Work& work) {
  CLI::App* command = app.add_subcommand("check", "check the input; list bodies, unknowns and steps");
  add_scene_or_mesh(command, given);
  const CLI::Option* formulation =
      command->add_option("--formulation", given.formulation,
                          "build the scene in this formulation, as run would (default: nlffr, if possible)");
  command
      ->add_option("--frequencies", given.frequencies,
                   "number of natural frequencies of each body to compute, free of supports and as its modes are held")
      ->check(CLI::Range(1, 1000));
  command->callback([&given, &work, formulation] {
    given.formulation_given = formulation->count() > 0;
    work = [&given] {
      std::optional<scene::Formulation> wanted;
      if (given.formulation_given) wanted = scene::formulation_of(given.formulation);
      check(read_bodies(given.scene), PETSC_COMM_WORLD, wanted, given.frequencies);
    };
  });
}

void add_schema(CLI::App& app, Arguments& given, Work& work) {
  CLI::App* command = app.add_subcommand("schema", "print the grammar of scenes");
  command->add_flag("--markdown", given.markdown, "as Markdown, for the manual");
  command->callback([&given, &work] {
    work = [&given] {
      if (!petsc::first_rank(PETSC_COMM_WORLD)) return;
      fmt::print("{}", given.markdown ? scene::schema_markdown() : scene::schema_reference());
    };
  });
}

}  // namespace

void add_computing(CLI::App& app, Arguments& arguments, std::function<void()>& work) {
  for (const auto add : {add_run, add_compare, add_tradeoff, add_sweep, add_static, add_campbell, add_modes, add_reduce,
                         add_info, add_check, add_schema})
    add(app, arguments, work);
}

}  // namespace floe::app
