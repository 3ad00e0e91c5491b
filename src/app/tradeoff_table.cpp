#include "tradeoff_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace floe::app {

using nlohmann::ordered_json;

double Rung::worst() const {
  double most = stopped.empty() ? 0 : std::numeric_limits<double>::infinity();
  for (const double error : rms)
    if (!(error <= most)) most = std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
  return most;
}

std::vector<std::size_t> pareto_front(const std::vector<Rung>& rungs) {
  std::vector<std::size_t> order, front;
  for (std::size_t i = 0; i < rungs.size(); ++i)
    if (std::isfinite(rungs[i].worst())) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(rungs[a].motion, rungs[a].worst()) < std::pair(rungs[b].motion, rungs[b].worst());
  });
  for (const std::size_t i : order)
    if (front.empty() || rungs[i].worst() < rungs[front.back()].worst()) front.push_back(i);
  return front;
}

std::optional<std::size_t> choice(const std::vector<Rung>& rungs, double accuracy) {
  const std::vector<std::size_t> front = pareto_front(rungs);
  if (front.empty()) return {};
  const auto found =
      std::find_if(front.begin(), front.end(), [&](std::size_t i) { return rungs[i].worst() <= accuracy; });
  return found == front.end() ? std::nullopt : std::optional(*found);
}

namespace {

/// Errors of divergent models have no digits worth showing.
output::Cell per_cent(double share) {
  if (!std::isfinite(share)) return std::string("-");
  return 100 * share;
}

std::vector<output::Cell> cells(const Rung& rung, const Rung& reference, std::size_t probes, bool full) {
  const auto at = [&](const std::vector<double>& values, std::size_t p) {
    return p < values.size() ? per_cent(values[p]) : output::Cell(std::string());
  };
  const bool stands = rung.stopped.empty();
  std::vector<output::Cell> row = {stands ? rung.name : rung.name + ": " + rung.stopped};
  if (full) row.insert(row.begin(), rung.family), row.emplace_back(rung.formulation);
  row.emplace_back(stands ? output::Cell(rung.coordinates) : output::Cell(std::string()));
  if (full) row.push_back(stands ? output::Cell(rung.offline) : output::Cell(std::string()));
  row.push_back(stands ? output::Cell(1e6 * rung.motion / std::max<double>(1, static_cast<double>(rung.steps)))
                       : output::Cell(std::string()));
  if (full) row.push_back(stands ? output::Cell(rung.motion) : output::Cell(std::string()));
  row.push_back(stands && rung.motion > 0 ? output::Cell(reference.motion / rung.motion) : output::Cell(std::string()));
  for (std::size_t p = 0; p < probes; ++p) {
    row.push_back(at(rung.rms, p));
    row.push_back(at(rung.estimate, p));
    if (full) row.push_back(at(rung.peak, p));
  }
  if (full) row.push_back(stands && &rung != &reference ? per_cent(rung.energy) : output::Cell(std::string()));
  return row;
}

}  // namespace

output::Table tradeoff_table(const std::vector<std::string>& probes, const Rung& reference, const Rung* own,
                             const std::vector<Rung>& rungs, std::optional<std::size_t> chosen, bool full) {
  output::Table table;
  table.columns = {{"model", ""}};
  if (full) table.columns.insert(table.columns.begin(), {"family", ""}), table.columns.push_back({"formulation", ""});
  table.columns.push_back({"unknowns", ""});
  if (full) table.columns.push_back({"offline", "s", 3});
  table.columns.push_back({"per step", "us", 3});
  if (full) table.columns.push_back({"motion", "s", 3});
  table.columns.push_back({"speed-up", "", 3});
  for (const std::string& probe : probes) {
    table.columns.push_back({probe + " error", "%", 2});
    table.columns.push_back({probe + " estimate", "%", 2});
    if (full) table.columns.push_back({probe + " peak error", "%", 2});
  }
  if (full) table.columns.push_back({"energy error", "%", 2});
  table.rows.push_back(cells(reference, reference, probes.size(), full));
  if (own) table.rows.push_back(cells(*own, reference, probes.size(), full));
  for (std::size_t i = 0; i < rungs.size(); ++i) {
    Rung rung = rungs[i];
    if (chosen == i) rung.name += " <- selected";
    table.rows.push_back(cells(rung, reference, probes.size(), full));
  }
  return table;
}

namespace {

ordered_json numbers(const std::vector<double>& values) {
  ordered_json j = ordered_json::array();
  for (const double value : values) j.push_back(std::isfinite(value) ? ordered_json(value) : ordered_json());
  return j;
}

std::vector<double> numbers_of(const ordered_json& j) {
  std::vector<double> values;
  for (const ordered_json& value : j)
    values.push_back(value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>());
  return values;
}

}  // namespace

ordered_json to_json(const Rung& rung) {
  return {{"family", rung.family},
          {"name", rung.name},
          {"formulation", rung.formulation},
          {"stopped", rung.stopped},
          {"unknowns", rung.coordinates},
          {"offline", rung.offline},
          {"motion", rung.motion},
          {"steps", rung.steps},
          {"rms", numbers(rung.rms)},
          {"reduction", numbers(rung.reduction)},
          {"peak", numbers(rung.peak)},
          {"energy", numbers({rung.energy})},
          {"estimate", numbers(rung.estimate)}};
}

Rung rung_of(const ordered_json& j) {
  Rung rung;
  rung.family = j["family"], rung.name = j["name"], rung.formulation = j["formulation"], rung.stopped = j["stopped"];
  rung.coordinates = j["unknowns"], rung.steps = j["steps"];
  rung.offline = j["offline"], rung.motion = j["motion"];
  rung.rms = numbers_of(j["rms"]), rung.reduction = numbers_of(j["reduction"]), rung.peak = numbers_of(j["peak"]);
  rung.energy = numbers_of(j["energy"]).at(0), rung.estimate = numbers_of(j["estimate"]);
  return rung;
}

}  // namespace floe::app
