#include "options_refused.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petscsys.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <initializer_list>
#include <string_view>
#include <vector>

namespace floe::app {
namespace {

using Words = std::initializer_list<std::string_view>;

/// An option by the end of its name, what it may be, or what it may not be, and why.
struct Rule {
  std::string_view tail;
  std::vector<std::string_view> allowed, refused;
  std::string_view why;
};

const std::vector<std::string_view> off = {"false", "no", "0"};

const std::vector<Rule>& rules() {
  static const std::vector<Rule> all = {
      {"ts_exact_final_time",
       {"matchstep"},
       {},
       "a simulation ends, and is interrupted by events, at the end of a step"},
      {"ts_init_time", {"0"}, {}, "a simulation begins at t = 0"},
      {"ts_time_span", {}, {}, "motion.output of the scene sets the output times"},
      {"ts_view_pre", {}, {}, "PETSc 3.18 aborts in it"},
      {"ts_monitor_cancel", off, {}, "results are written by a monitor"},
      {"ts_rhs_jacobian_test_mult", off, {}, "the equations of motion have no right-hand side function"},
      {"ts_rhs_jacobian_test_mult_transpose", off, {}, "the equations of motion have no right-hand side function"},
      {"ts_adjoint_solve", off, {}, "there is no adjoint problem"},
      {"ts_dmswarm_monitor_moments", {}, {}, "there are no particles"},
      {"ts_monitor_sp_swarm", {}, {}, "there are no particles"},
      {"ts_adapt_type", {"none", "basic", "dsp"}, {}, "it needs quantities that generalized-alpha does not estimate"},
      {"ts_convergence_estimate", {}, {}, "there is no sequence of meshes"},
      {"snes_convergence_estimate", {}, {}, "there is no sequence of meshes"},
      {"snes_convergence_test", {}, {}, "floe's own convergence test measures updates, or round-off"},
      {"snes_grid_sequence", {"0"}, {}, "there is no sequence of meshes"},
      {"snes_monitor_fields", {}, {}, "there are no fields of a DM"},
      {"snes_monitor_python", {}, {}, "there is no Python in floe"},
      {"ts_monitor_python", {}, {}, "there is no Python in floe"},
      {"static_snes_type",
       {"newtonls", "newtontr"},
       {},
       "the convergence test for equilibria uses the size of Newton's updates"},
      {"snes_type",
       {"simplified-newton", "newtonls"},
       {},
       "the convergence test for steps uses the size of Newton's updates"},
      {"snes_linesearch_type", {}, {"shell"}, "there is no such function"},
      {"snes_linesearch_damping",
       {"1", "1."},
       {},
       "a damped update does not measure the convergence of Newton's method"},
      {"motion_ksp_type",
       {},
       {"symmlq", "pipelcg"},
       "it is for symmetric matrices; here its error reaches 4e-4, or it does not terminate"},
      {"ksp_type", {}, {"pipelcg"}, "it may not terminate (PETSc 3.18)"},
      {"ksp_convergence_test", {}, {"skip"}, "an iteration would end with any residual"},
      {"ksp_norm_type", {}, {"none"}, "an iteration would end with any residual"},
      {"ksp_view_diagonal_scale", off, {}, "PETSc 3.18 aborts in it where nothing is scaled"},
      {"pc_type", {}, {"redistribute"}, "PETSc 3.18 aborts in it for a matrix with symmetric storage"},
      {"pc_factor_mat_ordering_type", {}, {"wbm"}, "its library is not free software, and aborts the program"},
      {"eps_hermitian", {}, {}, "modes solve a generalized eigenproblem with K and M"},
      {"eps_non_hermitian", {}, {}, "modes solve a generalized eigenproblem with K and M"},
      {"pep_type", {}, {"jd"}, "SLEPc 3.18 aborts in it for dense matrices"},
      {"mat_partitioning_nparts", {}, {}, "each rank has one part of a mesh"},
      {"eps_conv_user", {}, {}, "there is no such function"},
      {"eps_stop_user", {}, {}, "there is no such function"},
  };
  return all;
}

/// Whether the option is a solver's, however many prefixes it has: motion_ts_type for ts_type.
bool ends_in(std::string_view name, std::string_view tail) {
  return name == tail || (name.ends_with(tail) && name[name.size() - tail.size() - 1] == '_');
}

/// Whether rank 0, which opens windows, has a display. The first call is collective.
bool has_display() {
  static const bool found = [] {
    int set = std::getenv("DISPLAY") ? 1 : 0;
    MPI_Bcast(&set, 1, MPI_INT, 0, PETSC_COMM_WORLD);
    return set != 0;
  }();
  return found;
}

/// Viewers that need what is not there: of a window a display, of a socket or SAWs somebody at its other end.
std::string refused_viewer(const std::string& name, const std::string& value) {
  const bool views = name.find("_view") != std::string::npos || name.find("_monitor") != std::string::npos ||
                     name.find("_converged_reason") != std::string::npos;
  if (!views && !name.starts_with("draw_")) return "";
  for (const char* kind : {"socket", "saws", "matlab"})
    if (value.starts_with(kind)) return fmt::format("option -{} {}: is not supported", name, value);
  const Words windows = {"_monitor_lg", "_monitor_draw", "_monitor_sp", "_monitor_envelope", "_draw", "draw_"};
  const bool draws = value.starts_with("draw") || std::any_of(windows.begin(), windows.end(), [&](std::string_view w) {
                       return name.find(w) != std::string::npos;
                     });
  if (!draws || has_display()) return "";
  return fmt::format("option -{}: needs a window, and there is no display (DISPLAY is not set)", name);
}

}  // namespace

std::string refusal(const std::string& name, const std::string& value) {
  std::string word = value;
  std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto has = [&](const std::vector<std::string_view>& words) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  for (const Rule& rule : rules()) {
    if (!ends_in(name, rule.tail)) continue;
    if (has(rule.allowed) || (!rule.refused.empty() && !has(rule.refused))) return "";
    const bool choice = !rule.allowed.empty() && rule.allowed != off;
    return fmt::format("option -{}{}{}: is rejected: {}{}", name, value.empty() ? "" : " ", value, rule.why,
                       choice ? fmt::format("; expected {}", fmt::join(rule.allowed, " or ")) : "");
  }
  return refused_viewer(name, value);
}

}  // namespace floe::app
