#include "options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petscsys.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <vector>

#include "floe/math/nearest.h"
#include "floe/petsc/error.h"
#include "options_probe.h"
#include "options_refused.h"

namespace floe::app {

using petsc::check;

namespace {

using Words = std::vector<std::string>;

/// Of floe's solvers: EPS of the modes; KSP of the static solutions; TS of the motion (and, below it, start_: the KSP
/// of the first accelerations); SNES of the start in equilibrium; TS of the motion that ranks derivatives;
/// MatPartitioning of a mesh; PEP of vibrations about a rotation; KSP of the estimate of the error.
const Words solvers = {"modes_", "derivatives_", "motion_", "static_", "ranking_", "mesh_", "campbell_", "estimate_"};
const std::string partitioning = "mesh_mat_partitioning_";
/// Of PETSc's objects that have no prefix of their own, and of its viewers.
const Words objects = {"mat_", "vec_", "bv_", "is_", "sf_", "vecscatter_", "viewer_", "draw_"};
/// What PETSc itself reads, at its start or its end.
const Words globals = {
    "options_",          "log_",         "info",  "malloc",  "memory_view",       "objects_dump",
    "get_total_flops",   "on_error_",    "help",  "version", "fp_trap",           "mpidump",
    "citations",         "petsc_sleep",  "debug", "python",  "start_in_debugger", "stop_for_debugger",
    "no_signal_handler", "error_output", "nox"};
/// Whose solver reads what a user of PETSc knows without prefix.
const std::vector<std::pair<std::string, std::string>> homes = {{"ts_", "motion_"},  {"snes_", "motion_"},
                                                                {"ksp_", "motion_"}, {"pc_", "derivatives_"},
                                                                {"eps_", "modes_"},  {"st_", "modes_"}};

bool begins(const std::string& name, const std::string& with) { return name.rfind(with, 0) == 0; }
bool begins(const std::string& name, const Words& with) {
  for (const std::string& word : with)
    if (begins(name, word)) return true;
  return false;
}

/// The option that was probably meant, or empty.
std::string meant(const std::string& name) {
  for (const auto& [family, prefix] : homes)
    if (begins(name, family)) return prefix + name;
  std::string global = math::nearest(name, {"options_left", "options_view", "options_file", "log_view", "info",
                                            "malloc_dump", "malloc_view", "memory_view", "help"});
  if (!global.empty()) return global;
  const auto end = name.find('_');
  if (end == std::string::npos) return "";
  const std::string prefix = math::nearest(name.substr(0, end + 1), solvers);
  return prefix.empty() ? "" : prefix + name.substr(end + 1);
}

/// Whether PETSc would take `value` for a number that is no positive, finite one.
bool not_positive(const std::string& value) {
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  return end != value.c_str() && *end == '\0' && !(number > 0 && std::isfinite(number));
}

void for_each_left(const std::function<void(const std::string& name, const std::string& value)>& visit) {
  PetscInt count = 0;
  char **names = nullptr, **values = nullptr;
  check(PetscOptionsLeftGet(nullptr, &count, &names, &values));
  for (PetscInt i = 0; i < count; ++i) visit(names[i], values[i] ? values[i] : "");
  check(PetscOptionsLeftRestore(nullptr, &count, &names, &values));
}

}  // namespace

std::string option_fault(const std::string& name, const std::string& value) {
  if (begins(name, objects) || begins(name, globals)) return "";
  if (!begins(name, solvers)) {
    const std::string near = meant(name);
    return fmt::format("option -{}: unknown prefix; {}", name,
                       near.empty() ? fmt::format("expected -{}..., or an option of PETSc as a whole (-log_view)",
                                                  fmt::join(solvers, "..., -"))
                                    : fmt::format("did you mean -{}?", near));
  }
  for (const char* time : {"motion_ts_dt", "motion_ts_max_time", "ranking_ts_dt", "ranking_ts_max_time"})
    if (name == time && not_positive(value)) return fmt::format("option -{} {}: is not a positive number", name, value);
  return refusal(name, value);
}

namespace {

std::string written(const Option& option) {
  return fmt::format("-{}{}{}", option.first, option.second.empty() ? "" : " ", option.second);
}

/// Commands that have a solver of this prefix; none: any may have.
Words commands_with(const std::string& name) {
  if (begins(name, "campbell_")) return {"campbell"};
  if (begins(name, "motion_")) return {"run", "compare", "tradeoff", "sweep", "static", "campbell"};
  return {};
}

/// Of the solvers' options; they are kept, for what goes wrong may be their fault.
std::vector<Option>& solver_options() {
  static std::vector<Option> all;
  return all;
}

}  // namespace

void check_options(const std::string& command) {
  Words faults;
  std::vector<Option>& given = solver_options();
  given.clear();
  for_each_left([&](const std::string& name, const std::string& value) {
    if (begins(name, solvers)) given.emplace_back(name, value);
    const std::string fault = option_fault(name, value);
    const Words commands = commands_with(name);
    if (!fault.empty())
      faults.push_back(fault);
    else if (!commands.empty() && std::find(commands.begin(), commands.end(), command) == commands.end())
      faults.push_back(fmt::format("option {}: floe {} has no solver with this prefix; expected it with {}",
                                   written({name, value}), command, fmt::join(commands, ", ")));
  });
  if (faults.empty())
    for (const Option& option : unread(given))
      faults.push_back(
          fmt::format("option {}: unknown; floe <command> SCENE -help lists the solvers' options", written(option)));
  if (!faults.empty()) throw InputError(faults);
}

std::string with_options(const std::string& text) {
  constexpr std::size_t most = 8;
  const std::vector<Option>& given = solver_options();
  const auto named = [&](const Option& option) {
    return text.find("-" + option.first.substr(0, option.first.find('_') + 1)) != std::string::npos;
  };
  if (given.empty() || std::any_of(given.begin(), given.end(), named)) return text;
  Words words;
  for (const Option& option : given)
    if (words.size() < most) words.push_back(written(option));
  return fmt::format("{} (option{} given: {}{})", text, given.size() > 1 ? "s" : "", fmt::join(words, ", "),
                     given.size() > most ? ", ..." : "");
}

void check_unused() {
  Words faults;
  int ranks = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  for_each_left([&](const std::string& name, const std::string& value) {
    if (begins(name, globals) || (ranks == 1 && begins(name, partitioning))) return;
    faults.push_back(fmt::format("option {}: not used in this run; its results are complete", written({name, value})));
  });
  if (!faults.empty()) throw InputError(faults);
}

void silence_options_left() {
  PetscBool left = PETSC_FALSE, view = PETSC_FALSE;
  PetscOptionsHasName(nullptr, nullptr, "-options_left", &left);
  PetscOptionsHasName(nullptr, nullptr, "-options_view", &view);
  if (!left && !view) PetscOptionsSetValue(nullptr, "-options_left", "no");
}

}  // namespace floe::app
