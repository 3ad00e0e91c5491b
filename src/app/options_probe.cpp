#include "options_probe.h"

#include <fmt/format.h>
#include <petscsys.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <regex>
#include <set>
#include <utility>

#include "floe/math/nearest.h"
#include "floe/petsc/error.h"
#include "options_solvers.h"

namespace floe::app {

using petsc::check;

namespace {

using Names = std::set<std::string>;

/// Read by SNES, TS, KSP, EPS, PEP and MatPartitioning only while they solve.
const Names in_solve = {"ts_view",
                        "ts_view_solution",
                        "snes_view",
                        "snes_view_pre",
                        "snes_view_solution",
                        "snes_converged_reason",
                        "snes_compare_explicit",
                        "snes_compare_operator",
                        "snes_compare_coloring",
                        "snes_compare_coloring_display",
                        "snes_compare_coloring_threshold_atol",
                        "snes_compare_coloring_threshold_rtol",
                        "snes_test_jacobian",
                        "snes_test_jacobian_view",
                        "snes_test_local_min",
                        "ksp_converged_reason",
                        "mat_factor_view",
                        "eps_view_pre",
                        "eps_view_mat0",
                        "eps_view_mat1",
                        "pep_view_pre",
                        "rg_view",
                        "mat_partitioning_view",
                        "mat_partitioning_view_imbalance"};
/// In names that are not judged: of matrices and solvers that others make when they solve, of windows, and of what
/// PCBDDC reads while it is set up.
const char* const not_judged[] = {"mat_mffd_", "mat_fd_", "mat_coloring_", "mat_coarsen_", "mat_product_", "npc_",
                                  "_lg",       "draw",    "_sp_",          "envelope",     "pc_bddc_"};

/// A solver within preconditioners, or linear solvers, of some types, by its part of an option's prefix.
struct Inner {
  const char* option;  // of the type
  Names types;
  std::regex part;
};

const std::vector<Inner>& inner_solvers() {
  const auto part = [](const std::string& words) {
    return std::regex("^(?:" + words + ")(?=(?:ksp|pc|mat|mg|sub|esteig|redundant|telescope|fieldsplit|galerkin)_)");
  };
  static const std::vector<Inner> all = {
      {"pc_type", {"mg", "gamg", "ml", "hmg"}, part("mg_(?:levels_(?:\\d+_)?|coarse_)")},
      {"pc_type", {"gamg"}, part("pc_gamg_esteig_")},
      {"pc_type", {"hmg"}, part("(?:hmg_)?inner_")},
      {"pc_type", {"bjacobi", "asm", "gasm"}, part("sub_")},
      {"pc_type", {"composite"}, part("sub_\\d+_")},
      {"pc_type", {"redundant"}, part("redundant_")},
      {"pc_type", {"telescope"}, part("telescope_")},
      {"pc_type", {"ksp"}, part("ksp_")},
      {"pc_type", {"galerkin"}, part("galerkin_")},
      {"pc_type", {"deflation"}, part("deflation_\\w*?")},
      {"pc_type", {"fieldsplit"}, part("fieldsplit_\\w+?_")},
      {"pc_type", {"bddc"}, part("pc_bddc_(?:dirichlet|neumann|coarse)_(?:l\\d+_)?")},
      {"ksp_type", {"chebyshev"}, part("esteig_")}};
  return all;
}

std::string value_of(const std::vector<Option>& options, const std::string& name) {
  const auto found = std::find_if(options.begin(), options.end(), [&](const Option& o) { return o.first == name; });
  return found == options.end() ? "" : found->second;
}

/// Prefixes of the linear solver of prefix `linear`, and of those within it, that may read `name`; the innermost is
/// last.
std::vector<std::string> prefixes_of(const std::vector<Option>& options, const std::string& linear,
                                     const std::string& name) {
  const auto may_have = [&](const std::string& prefix, const Inner& inner) {
    const std::string type = value_of(options, prefix + inner.option);
    return type.empty() ? prefix != linear : inner.types.count(type) > 0;  // defaults of inner solvers are left open
  };
  std::vector<std::string> all = {linear};
  for (std::size_t depth = 0; depth < all.size(); ++depth) {
    const std::string prefix = all[depth], rest = name.substr(prefix.size());
    std::smatch found;
    for (const Inner& inner : inner_solvers()) {
      if (!std::regex_search(rest, found, inner.part) || !may_have(prefix, inner)) continue;
      all.push_back(prefix + found.str());
      break;
    }
  }
  return all;
}

/// What a solver would open a file or write for here is done without.
std::string harmless(const Option& option) {
  static const std::regex viewer("view|monitor|_reason|_error_"), file("^(?:(?:ascii)?:.+|binary.*|hdf5.*|vtk.*)");
  static const std::regex output("mat_mumps_icntl_[1-4]$");
  if (std::regex_search(option.first, output)) return "0";
  if (std::regex_search(option.first, viewer) && std::regex_match(option.second, file)) return "ascii:/dev/null";
  return option.second;
}

/// A table of its own, which is PETSc's while this lives; `tag` is before each name.
class Table {
 public:
  Table(const std::vector<Option>& options, std::string tag) : tag_(std::move(tag)) {
    check(PetscOptionsCreate(&options_));
    for (const Option& option : options) {
      const std::string value = harmless(option);
      check(
          PetscOptionsSetValue(options_, ("-" + tag_ + option.first).c_str(), value.empty() ? nullptr : value.c_str()));
    }
    check(PetscOptionsPush(options_));
  }
  ~Table() {
    PetscOptionsPop();
    PetscOptionsDestroy(&options_);
  }
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  /// Lets every solver that the options concern read them. @throws InputError
  void read(const std::vector<Option>& options) const {
    Names inner;
    for (const OptionReader& solver : option_readers()) {
      bool concerned = false;
      for (const auto& [name, value] : options) {
        concerned |= name.starts_with(solver.prefix);
        if (solver.linear.empty() || !name.starts_with(solver.linear)) continue;
        const std::vector<std::string> prefixes = prefixes_of(options, solver.linear, name);
        inner.insert(prefixes.begin() + 1, prefixes.end());
      }
      if (concerned) solver.read(tag_);
    }
    for (const std::string& prefix : inner) read_inner(tag_ + prefix);
  }

  /// What reads is to list what it reads.
  void ask_for_help() const {
    char words[][16] = {"floe", "-skip_petscrc", "-help"};
    char* pointers[] = {words[0], words[1], words[2], nullptr};
    char** arguments = pointers;
    int count = 3;
    check(PetscOptionsInsert(options_, &count, &arguments, nullptr));
  }

  bool is_read(const Option& option) const {
    PetscBool used = PETSC_FALSE;
    check(PetscOptionsUsed(options_, (tag_ + option.first).c_str(), &used));
    return used;
  }

 private:
  PetscOptions options_ = nullptr;
  std::string tag_;
};

/// What is written to standard output while this lives, in a file; PETSc's help cannot be had otherwise.
class Output {
 public:
  Output() : file_(std::tmpfile()), terminal_(dup(STDOUT_FILENO)) {
    std::fflush(stdout);
    if (file_) dup2(fileno(file_), STDOUT_FILENO);
  }
  ~Output() {
    std::fflush(stdout);
    dup2(terminal_, STDOUT_FILENO);
    close(terminal_);
    if (file_) std::fclose(file_);
  }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  std::vector<std::string> words() const {
    std::vector<std::string> all;
    char word[256];
    std::fflush(stdout);
    if (!file_) return all;
    std::rewind(file_);
    while (std::fscanf(file_, "%255s", word) == 1) all.emplace_back(word);
    return all;
  }

 private:
  std::FILE* file_;
  int terminal_;
};

/// Names that the solvers of these options read, with the types that the options select.
std::vector<std::string> names_read(const std::vector<Option>& options) {
  static int calls = 0;  // help lists what has a prefix once
  const std::string tag = fmt::format("help{}_", ++calls), dash = "-" + tag;
  std::vector<std::string> names;
  {
    const Output output;
    const Table table(options, tag);
    table.ask_for_help();
    table.read(options);
    for (const std::string& word : output.words())
      if (word.starts_with(dash)) names.push_back(word.substr(dash.size(), word.find_first_of(":<") - dash.size()));
  }
  for (const OptionReader& solver : option_readers())
    for (const std::string& late : in_solve)
      if (!solver.linear.empty()) names.push_back(solver.prefix + late);
  return names;
}

bool judges(const std::vector<Option>& options, const Option& option) {
  const std::string& name = option.first;
  for (const char* part : not_judged)
    if (name.find(part) != std::string::npos) return false;
  const auto late = [&](const std::string& prefix) { return in_solve.count(name.substr(prefix.size())) > 0; };
  bool ours = false;
  for (const OptionReader& solver : option_readers()) {
    if (!name.starts_with(solver.prefix)) continue;
    if (late(solver.prefix)) return false;
    ours = true;
    if (solver.linear.empty() || !name.starts_with(solver.linear)) continue;
    const std::vector<std::string> prefixes = prefixes_of(options, solver.linear, name);
    if (std::any_of(prefixes.begin(), prefixes.end(), late)) return false;
  }
  return ours;
}

/// Empty, or why PETSc rejects options.
std::string rejection(const std::vector<Option>& options) {
  try {
    Table(options, "judged_").read(options);
  } catch (const InputError& error) {
    return std::regex_replace(error.what(), std::regex("-judged_"), "-");
  }
  return "";
}

/// The line of a rejected option: the one without which nothing is rejected, if there is one.
std::string rejected(const std::vector<Option>& options, const std::string& all) {
  for (std::size_t i = 0; i < options.size(); ++i) {
    std::vector<Option> others = options;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    if (!rejection(others).empty()) continue;
    const auto why = all.find("is rejected: ");
    if (why != std::string::npos) return fmt::format("option {}: {}", written(options[i]), all.substr(why));
  }
  return all;
}

}  // namespace

std::string written(const Option& option) {
  return fmt::format("-{}{}{}", option.first, option.second.empty() ? "" : " ", option.second);
}

std::vector<std::string> faults_of(const std::vector<Option>& options) {
  std::vector<Option> judged;
  std::copy_if(options.begin(), options.end(), std::back_inserter(judged),
               [&](const Option& option) { return judges(options, option); });
  if (judged.empty()) return {};
  if (const std::string why = rejection(judged); !why.empty()) return {rejected(judged, why)};
  const Table table(judged, "judged_");
  table.read(judged);
  std::vector<Option> unread;
  std::copy_if(judged.begin(), judged.end(), std::back_inserter(unread),
               [&](const Option& option) { return !table.is_read(option); });
  if (unread.empty()) return {};
  const std::vector<std::string> names = names_read(judged);
  std::vector<std::string> faults;
  for (const Option& option : unread) {
    const std::string near = math::nearest(option.first, names);
    faults.push_back(fmt::format("option {}: unknown, or of a type that is not selected; {}", written(option),
                                 near.empty() ? "floe <command> SCENE -help lists the solvers' options"
                                              : fmt::format("did you mean -{}?", near)));
  }
  return faults;
}

}  // namespace floe::app
