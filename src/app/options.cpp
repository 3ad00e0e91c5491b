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
/// Of what PETSc itself, its objects without prefix and its viewers read while floe runs, or at the end.
const Words objects = {"options_left",
                       "options_view",
                       "options_suppress_deprecated_warnings",
                       "memory_view",
                       "get_total_flops",
                       "log_threshold",
                       "citations",
                       "mpidump",
                       "build_twosided",
                       "splitreduction_async",
                       "psubcomm_type",
                       "mat_view",
                       "mat_factor_view",
                       "mat_no_inode",
                       "mat_inode_limit",
                       "mat_no_unroll",
                       "mat_ignore_lower_triangular",
                       "mat_getrow_uppertriangular",
                       "mat_seqaij_type",
                       "mat_use_hash_table",
                       "vec_view",
                       "vec_view_stash",
                       "vecscatter_merge",
                       "is_view",
                       "sf_type",
                       "sf_rank_order",
                       "sf_window_flavor",
                       "sf_window_sync",
                       "viewer_type",
                       "viewer_view",
                       "viewer_hdf5_collective",
                       "viewer_hdf5_base_dimension2",
                       "viewer_hdf5_sp_output",
                       "viewer_hdf5_default_timestepping",
                       "viewer_binary_filename",
                       "viewer_binary_mpiio",
                       "viewer_binary_skip_header",
                       "viewer_binary_skip_info",
                       "viewer_binary_skip_options"};
/// Of these, what PETSc reads at its end.
const Words at_end = {"options_left", "options_view",    "options_suppress_deprecated_warnings",
                      "memory_view",  "get_total_flops", "log_threshold",
                      "citations",    "mpidump"};
/// Whose solver reads what a user of PETSc knows without prefix.
const std::vector<std::pair<std::string, std::string>> homes = {{"ts_", "motion_"},  {"snes_", "motion_"},
                                                                {"ksp_", "motion_"}, {"pc_", "derivatives_"},
                                                                {"eps_", "modes_"},  {"st_", "modes_"}};

bool begins_with_one_of(const std::string& name, const Words& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(), [&](const std::string& word) { return name.starts_with(word); });
}
bool is_one_of(const std::string& name, const Words& words) {
  return std::find(words.begin(), words.end(), name) != words.end();
}

/// Of solvers, bases (BV) and factors, whose options are judged by objects that take them.
bool is_judged(const std::string& name) {
  return begins_with_one_of(name, solvers) || begins_with_one_of(name, {"bv_", "mat_mumps_"});
}

/// The option that was probably meant, or empty.
std::string meant(const std::string& name) {
  for (const auto& [family, prefix] : homes)
    if (name.starts_with(family)) return prefix + name;
  Words known = objects;
  known.insert(known.end(), {"options_file", "log_view", "log_view_memory", "log_trace", "info", "malloc_debug",
                             "malloc_dump", "malloc_view", "on_error_abort", "fp_trap", "help", "version"});
  if (const std::string global = math::nearest(name, known); !global.empty()) return global;
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
  if (is_one_of(name, objects)) return "";
  if (!is_judged(name) && !name.starts_with("draw_")) {
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

/// Commands that have a solver of this prefix; none: any may have.
Words commands_with(const std::string& name) {
  if (name.starts_with("campbell_")) return {"campbell"};
  Words commands = {"run", "compare", "tradeoff", "sweep", "static", "campbell"};
  if (begins_with_one_of(name, {"modes_", "derivatives_", "ranking_", "mesh_"}))
    commands.insert(commands.end(), {"modes", "reduce", "check"});
  return begins_with_one_of(name, solvers) ? commands : Words();
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
    if (is_judged(name)) given.emplace_back(name, value);
    const std::string fault = option_fault(name, value);
    const Words commands = commands_with(name);
    if (!fault.empty())
      faults.push_back(fault);
    else if (!commands.empty() && !is_one_of(command, commands))
      faults.push_back(fmt::format("option {}: floe {} has no solver with this prefix; expected it with {}",
                                   written({name, value}), command, fmt::join(commands, ", ")));
  });
  if (faults.empty()) faults = faults_of(given);
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
    if (is_one_of(name, at_end) || (ranks == 1 && name.starts_with(partitioning))) return;
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
