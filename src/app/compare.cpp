#include "compare.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <optional>

#include "compare_table.h"
#include "drawing.h"
#include "floe/output/provenance.h"
#include "floe/output/table.h"
#include "floe/petsc/rank.h"
#include "interruption.h"
#include "refined.h"

namespace floe::app {

using nlohmann::ordered_json;
using scene::Formulation;

namespace {

ordered_json number_or_null(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json();
}

/// Characters in a line: of the terminal, or of COLUMNS; 100 where neither says.
int terminal_columns() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  const char* wish = std::getenv("COLUMNS");
  const int columns = wish ? std::atoi(wish) : 0;
  return columns > 0 ? columns : 100;
}

/// A folder for each formulation. The first results of any replace the older comparison.
std::vector<output::ResultFolder> folders_of(const output::ResultFolder& folder,
                                             const std::vector<Formulation>& formulations, MPI_Comm comm,
                                             bool overwrite) {
  std::vector<output::ResultFolder> subs;
  try {
    for (const Formulation formulation : formulations) {
      subs.push_back(output::prepare_folder(comm, folder.path / scene::name_of(formulation), overwrite));
      subs.back().replaces.insert(subs.back().replaces.end(), folder.replaces.begin(), folder.replaces.end());
    }
  } catch (const InputError&) {
    for (const output::ResultFolder& sub : subs) output::discard_if_empty(sub);
    output::discard_if_empty(folder);
    throw;
  }
  return subs;
}

bool any_of(const scene::Scene& scene, const std::function<bool(const scene::Body&)>& is) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), is);
}

std::vector<std::string> names_for(const scene::Scene& scene) {
  if (any_of(scene, [](const scene::Body& body) { return body.reduced.has_value(); })) return {"lffr", "vm", "vm+md"};
  std::vector<std::string> names = {"nlffr", "lffr", "vm", "vm+md"};
  if (scene.dimension == 2) names.insert(names.begin(), "cfr");
  return names;
}

}  // namespace

std::vector<Formulation> formulations_to_compare(const scene::Scene& scene, std::vector<std::string> names) {
  if (names.empty()) names = names_for(scene);
  std::vector<Formulation> formulations;
  for (const std::string& name : names) {
    const Formulation one = scene::formulation_of(name, "--formulations");
    if (std::find(formulations.begin(), formulations.end(), one) != formulations.end())
      throw InputError(fmt::format("--formulations: \"{}\" is given twice", name));
    formulations.push_back(one);
  }
  return formulations;
}

void compare(const scene::Scene& as_written, const std::vector<Formulation>& formulations, MPI_Comm comm,
             const std::string& path, bool overwrite, bool reference_error) {
  const scene::Scene scene = at_equal_times(as_written);
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const output::ResultFolder folder = output::prepare_folder(comm, path, overwrite);
  const std::vector<output::ResultFolder> subs = folders_of(folder, formulations, comm, overwrite);
  const auto discard = [&] {
    for (const output::ResultFolder& sub : subs) output::discard_if_empty(sub);
    output::discard_if_empty(folder);
  };
  std::vector<Compared> rows;
  std::vector<std::pair<std::string, std::string>> stopped;
  for (std::size_t f = 0; f < formulations.size(); ++f) {
    const output::ResultFolder& sub = subs[f];
    Compared row{scene::name_of(formulations[f]), {}};
    try {
      if (f > 0) output::remove_replaced(comm, sub);  // the scene is no input fault, and a failure is a result, too
      row.result = run(scene, formulations[f], comm, sub);
      rows.push_back(std::move(row));
    } catch (const InputError&) {
      discard();
      throw;
    } catch (const RunError& error) {  // one formulation that fails is a result, too
      output::discard_if_empty(sub);
      if (Interruption::happened(comm)) {
        discard();
        throw;
      }
      stopped.emplace_back(row.name, error.what());
      if (rank == 0) fmt::print(stderr, "floe: {}: {}\n", row.name, error.what());
    }
  }
  if (rows.empty()) {
    discard();
    throw RunError("no formulation reached the end of its simulation");
  }

  std::vector<const Compared*> references;
  for (const char* name : {"cfr", "nlffr"})
    for (const Compared& row : rows)
      if (row.name == name) references.push_back(&row);
  Compared own;
  if (reference_error && !references.empty()) {
    own.name = references.front()->name;
    own.refined = "mesh and step halved";
    try {
      own.result = run(refined(scene), scene::formulation_of(own.name), comm, std::nullopt);
    } catch (const RunError& error) {
      if (Interruption::happened(comm)) throw;
      stopped.emplace_back(own.name + ", " + own.refined, error.what());
      own.name.clear();
    }
  }
  const Compared* finer = own.name.empty() ? nullptr : &own;
  std::vector<std::string> failed;
  for (const Formulation formulation : formulations)
    if (const std::string name = scene::name_of(formulation);
        std::none_of(rows.begin(), rows.end(), [&](const Compared& row) { return row.name == name; }))
      failed.push_back(name);
  const output::Table table = comparison(rows, references, failed, finer, true);

  ordered_json j;
  j["title"] = scene.title.empty() ? scene.file : scene.title;
  j["time_unit"] = "s";
  j["reference"] = references.empty() ? rows.front().name : references.front()->name;
  for (const Compared& row : rows)
    j["runs"].push_back(
        {{"name", row.name},
         {"label", row.result.label},
         {"csv", row.name + "/probes.csv"},
         {"unknowns", row.result.coordinates},
         {"steps", row.result.steps},
         {"seconds", {{"offline", row.result.offline_seconds}, {"motion", row.result.motion_seconds}}}});
  for (const auto& [name, why] : stopped) j["stopped"].push_back({{"name", name}, {"reason", why}});
  for (const auto& column : rows.front().result.series.columns)
    j["probes"].push_back({{"column", column.name}, {"unit", column.unit}});
  for (const Compared* reference : references)
    for (const Compared& row : rows) {
      const auto errors = relative_errors(row.result.series, reference->result.series);
      for (std::size_t c = 0; c < errors.size(); ++c)
        j["errors"][reference->name][row.name][row.result.series.columns[c].name] = number_or_null(errors[c]);
    }
  if (!own.name.empty()) {
    const auto errors = relative_errors(own.result.series, references.front()->result.series);
    for (std::size_t c = 0; c < errors.size(); ++c)
      j["reference_error"][own.result.series.columns[c].name] = number_or_null(errors[c]);
  }
  j["provenance"] = output::provenance(comm);
  petsc::agree(comm, [&] {
    if (rank != 0) return;
    output::write_file_atomically(folder.path / "compare.json", j.dump(2));
    output::write_file_atomically(folder.path / "compare.csv", output::to_csv(table));
    output::write_file_atomically(folder.path / "compare.md", output::to_markdown(table));
    fmt::print("{}\n", comparison_text(rows, references, failed, finer, terminal_columns()));
    fmt::print("{}", references.empty() ? "No errors: there is no full-order model to compare with."
                                        : "Errors: relative L2 norm over the simulated time.");
    if (!own.name.empty())
      fmt::print(" The last row is the error of the reference itself, {} with {}.", own.name, own.refined);
    fmt::print("\n");
    for (const Compared& row : rows)
      for (const std::string& warning : row.result.warnings) fmt::print("Note ({}): {}\n", row.name, warning);
    for (const auto& [name, why] : stopped) fmt::print("Failed ({}): {}\n", name, why);
    fmt::print("Picture: {}\n", draw("compare", folder.path.string()));
  });
  if (!failed.empty())
    throw RunError(
        fmt::format("{} of {} formulations failed: {}", failed.size(), formulations.size(), fmt::join(failed, ", ")));
  if (!stopped.empty()) throw RunError(stopped[0].first + ": " + stopped[0].second);
}

}  // namespace floe::app
