#include "compare.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>

#include "floe/output/provenance.h"
#include "floe/output/table.h"
#include "floe/version.h"
#include "interruption.h"

namespace floe::app {

using nlohmann::ordered_json;
using scene::Formulation;

namespace {

std::string shell_quoted(const std::string& word) {
  std::string safe = "'";
  for (const char c : word) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return safe + "'";
}

bool readable(const std::string& path) { return access(path.c_str(), R_OK) == 0; }

/// Draws with the script that is shipped. Returns the picture's path, or says why there is none.
std::string draw(const std::string& folder) {
  std::string script = std::string(FLOE_SCRIPTS_INSTALLED) + "/compare.py";
  if (!readable(script)) script = std::string(FLOE_SCRIPTS_SOURCE) + "/compare.py";
  const std::string python = readable("/usr/bin/python3") ? "/usr/bin/python3" : "python3";
  if (std::system(
          (shell_quoted(python) + " " + shell_quoted(script) + " " + shell_quoted(folder) + " >/dev/null").c_str()) !=
      0)
    return "no picture: " + script + " failed (it needs python3 and matplotlib)";
  return folder + "/compare.png";
}

scene::Scene refined(const scene::Scene& scene) {
  scene::Scene fine = scene;
  for (scene::Body& body : fine.bodies)
    for (int& elements : body.mesh.elements) elements *= 2;
  fine.motion.step /= 2;
  fine.motion.every *= 2;
  if (fine.motion.tolerance) *fine.motion.tolerance /= 4;
  return fine;
}

struct Row {
  std::string name;
  RunResult result;
};

/// `tip` of the column `tip.x`.
std::string probe_of(const scene::ProbeColumn& column) { return column.name.substr(0, column.name.rfind('.')); }

ordered_json number_or_null(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json();
}

output::Table table_of(const std::vector<Row>& rows, const std::vector<const Row*>& references, const Row* own) {
  output::Table table;
  table.columns = {{"formulation", ""}, {"model", ""}, {"unknowns", ""}};
  std::vector<std::string> names;
  for (const auto& column : rows.front().result.series.columns) names.push_back(column.name);
  for (const Row* reference : references)
    for (const std::string& name : names) table.columns.push_back({name + " vs " + reference->name, "%", 3});
  table.columns.push_back({"offline", "s", 3});
  table.columns.push_back({"motion", "s", 3});
  table.columns.push_back({"per step", "us", 3});
  auto add = [&](const Row& row, const std::string& label) {
    const RunResult& r = row.result;
    std::vector<output::Cell> cells = {row.name, label, static_cast<std::int64_t>(r.coordinates)};
    for (const Row* reference : references) {
      if (reference == &row) {
        cells.insert(cells.end(), names.size(), std::string());
        continue;
      }
      for (const auto& error : relative_errors(r.series, reference->result.series))
        cells.push_back(error ? output::Cell(100 * *error) : output::Cell(std::string()));
    }
    cells.push_back(r.offline_seconds);
    cells.push_back(r.motion_seconds);
    cells.push_back(1e6 * r.motion_seconds / std::max<double>(1, static_cast<double>(r.steps)));
    table.rows.push_back(std::move(cells));
  };
  for (const Row& row : rows) add(row, row.result.label);
  if (own) add(*own, own->result.label + ", mesh and step halved");
  return table;
}

}  // namespace

std::vector<std::optional<double>> relative_errors(const Series& series, const Series& reference) {
  const std::size_t columns = series.columns.size();
  std::vector<double> difference(columns, 0), size(columns, 0);
  std::size_t k = 0;
  for (std::size_t i = 0; i < series.t.size(); ++i) {
    const double t = series.t[i];
    if (t > reference.t.back() * (1 + 1e-12)) break;
    while (k + 2 < reference.t.size() && reference.t[k + 1] < t) ++k;
    const double s =
        reference.t.size() < 2 ? 0 : std::clamp((t - reference.t[k]) / (reference.t[k + 1] - reference.t[k]), 0.0, 1.0);
    for (std::size_t c = 0; c < columns; ++c) {
      const double r = reference.t.size() < 2 ? reference.values[0][c]
                                              : (1 - s) * reference.values[k][c] + s * reference.values[k + 1][c];
      difference[c] += std::pow(series.values[i][c] - r, 2);
      size[c] += r * r;
    }
  }
  std::map<std::string, double> of_probe;  // the greatest of its components
  for (std::size_t c = 0; c < columns; ++c) {
    double& greatest = of_probe[probe_of(series.columns[c])];
    greatest = std::max(greatest, size[c]);
  }
  std::vector<std::optional<double>> errors(columns);
  for (std::size_t c = 0; c < columns; ++c)
    if (size[c] > 0 && std::sqrt(size[c]) >= 1e-9 * std::sqrt(of_probe[probe_of(series.columns[c])]))
      errors[c] = std::sqrt(difference[c] / size[c]);
  return errors;
}

void compare(const scene::Scene& scene, const std::vector<Formulation>& formulations, MPI_Comm comm,
             const std::string& path, bool overwrite, bool reference_error) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const output::ResultFolder folder = output::prepare_folder(comm, path, overwrite);
  std::vector<Row> rows;
  std::vector<std::pair<std::string, std::string>> stopped;
  for (const Formulation formulation : formulations) {
    Row row{scene::name_of(formulation), {}};
    const output::ResultFolder sub = output::prepare_folder(comm, folder.path / row.name, overwrite);
    try {
      row.result = run(scene, formulation, comm, sub);
      rows.push_back(std::move(row));
    } catch (const InputError&) {
      throw;
    } catch (const RunError& error) {  // one formulation that fails is a result, too
      if (Interruption::happened(comm)) throw;
      stopped.emplace_back(row.name, error.what());
      if (rank == 0) fmt::print(stderr, "floe: {}: {}\n", row.name, error.what());
    }
  }
  if (rows.empty()) throw RunError("no formulation came to the end of its motion");

  std::vector<const Row*> references;
  for (const char* name : {"cfr", "nlffr"})
    for (const Row& row : rows)
      if (row.name == name) references.push_back(&row);
  Row own;
  if (reference_error && !references.empty()) {
    own.name = references.front()->name;
    try {
      own.result = run(refined(scene), scene::formulation_of(own.name), comm, std::nullopt);
    } catch (const RunError& error) {
      if (Interruption::happened(comm)) throw;
      stopped.emplace_back(own.name + ", mesh and step halved", error.what());
      own.name.clear();
    }
  }
  const output::Table table = table_of(rows, references, own.name.empty() ? nullptr : &own);

  ordered_json j;
  j["title"] = scene.title.empty() ? scene.file : scene.title;
  j["time_unit"] = "s";
  j["reference"] = references.empty() ? rows.front().name : references.front()->name;
  for (const Row& row : rows)
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
  for (const Row* reference : references)
    for (const Row& row : rows) {
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
    fmt::print("{}\n", output::to_text(table));
    fmt::print("Errors: relative L2 over the horizon.");
    if (!own.name.empty())
      fmt::print(" The last row is the error of the reference itself, {} against a mesh and step twice as fine.",
                 own.name);
    fmt::print("\n");
    for (const Row& row : rows)
      for (const std::string& warning : row.result.warnings) fmt::print("Note ({}): {}\n", row.name, warning);
    for (const auto& [name, why] : stopped) fmt::print("Not in the table ({}): {}\n", name, why);
    fmt::print("Picture: {}\n", draw(folder.path.string()));
  });
}

}  // namespace floe::app
