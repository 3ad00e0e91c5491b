#include "floe/app/app.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "arguments.h"
#include "drawing.h"
#include "floe/petsc/blas_kernel.h"
#include "floe/petsc/rank.h"
#include "floe/version.h"
#include "session.h"
#include "showing.h"

namespace floe::app {

namespace {

std::string names_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  const std::string last = names.back();
  names.pop_back();
  return fmt::format("{} or {}", fmt::join(names, ", "), last);
}

/// Reads the words; help and mistakes become the work.
void parse(CLI::App& app, const CommandLine& line, std::function<void()>& work) {
  try {
    std::vector<std::string> words(line.own.rbegin(), line.own.rend());
    if (words.empty() && !line.petsc.empty()) words = {"--help"};
    app.parse(words);
  } catch (const CLI::Success& help) {
    work = [&app, shown = help] {
      if (petsc::first_rank(PETSC_COMM_WORLD)) app.exit(shown);
    };
  } catch (const CLI::ParseError& error) {
    std::string what = error.what();
    if (app.get_subcommands().empty() && !line.own.empty() && line.own.front()[0] != '-')
      what = fmt::format("\"{}\" is not a command; expected {}", line.own.front(), names_of(app));
    work = [text = what + " (floe --help)"] { throw InputError(text); };
  }
}

}  // namespace

int main(int argc, char** argv) {
  petsc::use_better_blas_kernel(argv);
  const CommandLine line = split(argc, argv);
  CLI::App app("floe " FLOE_VERSION
               ": nonlinear model reduction for flexible multibody dynamics in the floating frame of reference",
               "floe");
  app.set_version_flag("--version", std::string("floe " FLOE_VERSION " (" FLOE_COMMIT ")"));
  app.require_subcommand(1);
  app.footer(
      "PETSc's and SLEPc's options follow with one dash: -modes_eps_..., -derivatives_ksp_..., -motion_ts_..., "
      "-static_snes_..., -campbell_pep_..., -log_view; -help lists those of a command's solvers. Under mpirun -n N the "
      "results are the same.");

  std::function<void()> work;
  Arguments arguments;
  Showing showing;
  add_computing(app, arguments, work);
  add_showing(app, showing, work);
  parse(app, line, work);

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
