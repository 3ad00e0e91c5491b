#include "tradeoff_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "floe/math/rounded.h"

namespace floe::app {

using nlohmann::ordered_json;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// The greatest; infinity where one is no number.
double greatest_error(const std::vector<double>& errors) {
  double most = 0;
  for (const double error : errors)
    if (!(error <= most)) most = std::isfinite(error) ? error : infinite;
  return most;
}

}  // namespace

double Rung::worst() const { return stopped.empty() ? greatest_error(total) : infinite; }

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
  const auto found =
      std::find_if(front.begin(), front.end(), [&](std::size_t i) { return rungs[i].worst() <= accuracy; });
  return found == front.end() ? std::nullopt : std::optional(*found);
}

namespace {

const output::Cell nothing = std::string();

/// Errors of divergent models have no digits worth showing.
output::Cell per_cent(double share) {
  if (!std::isfinite(share)) return std::string("-");
  return 100 * share;
}
output::Cell per_cent(const std::vector<double>& errors) {
  return errors.empty() ? nothing : per_cent(greatest_error(errors));
}
output::Cell per_cent(const std::vector<double>& errors, std::size_t p) {
  return p < errors.size() ? per_cent(errors[p]) : nothing;
}

/// The estimate, with a mark where it lacks a part.
output::Cell estimated(const Rung& rung) {
  const output::Cell cell = per_cent(rung.estimate);
  if (rung.lacks.empty() || !std::holds_alternative<double>(cell)) return cell;
  return math::rounded(std::get<double>(cell), 2) + " *";
}

double per_step(const Rung& rung) { return 1e6 * rung.motion / std::max<double>(1, static_cast<double>(rung.steps)); }

std::vector<output::Cell> short_cells(const Rung& rung, const output::Cell& place) {
  if (!rung.stopped.empty())
    return {rung.name + ": " + rung.stopped, nothing, nothing, nothing, nothing, nothing, nothing, nothing};
  return {rung.name,
          place,
          rung.coordinates,
          per_step(rung),
          rung.motion,
          per_cent(rung.reduction),
          per_cent(rung.total),
          estimated(rung)};
}

std::vector<output::Cell> all_cells(const Rung& rung, const output::Cell& place, std::size_t probes) {
  const bool ended = rung.stopped.empty();
  std::vector<output::Cell> row = {rung.family, rung.name, rung.formulation, place};
  if (ended)
    row.insert(row.end(), {rung.coordinates, rung.offline, per_step(rung), rung.motion});
  else
    row.insert(row.end(), 4, nothing);
  for (std::size_t p = 0; p < probes; ++p)
    for (const auto* errors : {&rung.reduction, &rung.total, &rung.estimate, &rung.peak})
      row.push_back(ended ? per_cent(*errors, p) : nothing);
  row.push_back(ended ? per_cent(rung.energy) : nothing);
  row.push_back(rung.lacks);
  row.push_back(rung.stopped);
  return row;
}

}  // namespace

output::Table tradeoff_table(const std::vector<std::string>& probes, const std::vector<Rung>& rungs, bool full) {
  output::Table table;
  if (full) {
    table.columns = {{"family", ""},   {"model", ""},       {"formulation", ""},   {"front", ""},
                     {"unknowns", ""}, {"offline", "s", 3}, {"per step", "us", 3}, {"simulation", "s", 3}};
    for (const std::string& probe : probes)
      for (const char* what : {"reduction", "total", "estimate", "peak"})
        table.columns.push_back({probe + " " + what, "%", 2});
    table.columns.push_back({"energy", "%", 2});
    table.columns.push_back({"estimate lacks", ""});
    table.columns.push_back({"stopped", ""});
  } else {
    table.columns = {{"model", ""},          {"front", ""},         {"unknowns", ""},  {"per step", "us", 3},
                     {"simulation", "s", 3}, {"reduction", "%", 2}, {"total", "%", 2}, {"estimate", "%", 2}};
  }
  const std::vector<std::size_t> front = pareto_front(rungs);
  for (std::size_t i = 0; i < rungs.size(); ++i) {
    const auto at = std::find(front.begin(), front.end(), i);
    const output::Cell place =
        at == front.end() ? nothing : output::Cell(static_cast<std::int64_t>(at - front.begin() + 1));
    table.rows.push_back(full ? all_cells(rungs[i], place, probes.size()) : short_cells(rungs[i], place));
  }
  return table;
}

output::Table selections_table(const std::vector<Rung>& rungs) {
  output::Table table;
  table.columns = {{"required", "%", 2},  {"true", "%", 2},      {"estimated", "%", 2},
                   {"model", ""},         {"per step", "us", 3}, {"simulation", "s", 3},
                   {"selection", "s", 2}, {"time ratio", "", 2}, {"to the fastest other model as accurate", ""}};
  for (const Rung& rung : rungs) {
    if (rung.required == 0) continue;
    std::vector<output::Cell> row = {100 * rung.required};
    if (!rung.stopped.empty()) {
      row.insert(row.end(), {nothing, nothing, rung.stopped, nothing, nothing, nothing, nothing, nothing});
      table.rows.push_back(row);
      continue;
    }
    const Rung* fastest = nullptr;
    for (const Rung& other : rungs)
      if (other.required == 0 && other.worst() <= rung.required && (!fastest || other.motion < fastest->motion))
        fastest = &other;
    row.insert(row.end(),
               {per_cent(rung.worst()), estimated(rung), rung.selected, per_step(rung), rung.motion, rung.offline,
                fastest ? output::Cell(rung.motion / fastest->motion) : output::Cell(std::string("-")),
                fastest ? fastest->name : std::string("there is none")});
    table.rows.push_back(row);
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
  for (const ordered_json& value : j) values.push_back(value.is_null() ? infinite : value.get<double>());
  return values;
}

}  // namespace

ordered_json to_json(const Rung& rung) {
  ordered_json j = {{"family", rung.family},
                    {"name", rung.name},
                    {"formulation", rung.formulation},
                    {"stopped", rung.stopped},
                    {"unknowns", rung.coordinates},
                    {"offline", rung.offline},
                    {"motion", rung.motion},
                    {"steps", rung.steps},
                    {"total", numbers(rung.total)},
                    {"reduction", numbers(rung.reduction)},
                    {"peak", numbers(rung.peak)},
                    {"energy", numbers({rung.energy})},
                    {"estimate", numbers(rung.estimate)},
                    {"estimate_lacks", rung.lacks}};
  if (rung.required > 0) j["required"] = rung.required, j["selected"] = rung.selected;
  return j;
}

Rung rung_of(const ordered_json& j) {
  Rung rung;
  rung.family = j["family"], rung.name = j["name"], rung.formulation = j["formulation"], rung.stopped = j["stopped"];
  rung.coordinates = j["unknowns"], rung.steps = j["steps"];
  rung.offline = j["offline"], rung.motion = j["motion"];
  rung.total = numbers_of(j["total"]), rung.reduction = numbers_of(j["reduction"]), rung.peak = numbers_of(j["peak"]);
  rung.energy = numbers_of(j["energy"]).at(0), rung.estimate = numbers_of(j["estimate"]);
  rung.lacks = j["estimate_lacks"], rung.required = j.value("required", 0.0);
  rung.selected = j.value("selected", std::string());
  return rung;
}

ordered_json to_json(const TradeoffReference& reference) {
  ordered_json j = {{"name", scene::name_of(reference.formulation)}, {"words", reference.words}};
  if (!reference.why.empty()) j["not_cfr"] = reference.why;
  j["error"] = numbers({reference.error}).at(0);
  if (!reference.error_lacks.empty()) j["error_lacks"] = reference.error_lacks;
  return j;
}

}  // namespace floe::app
