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

double ModelVariant::worst() const { return stopped.empty() ? greatest_error(total) : infinite; }

std::vector<std::size_t> pareto_front(const std::vector<ModelVariant>& variants) {
  std::vector<std::size_t> order, front;
  for (std::size_t i = 0; i < variants.size(); ++i)
    if (std::isfinite(variants[i].worst())) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(variants[a].motion, variants[a].worst()) < std::pair(variants[b].motion, variants[b].worst());
  });
  for (const std::size_t i : order)
    if (front.empty() || variants[i].worst() < variants[front.back()].worst()) front.push_back(i);
  return front;
}

std::optional<std::size_t> choice(const std::vector<ModelVariant>& variants, double accuracy) {
  const std::vector<std::size_t> front = pareto_front(variants);
  const auto found =
      std::find_if(front.begin(), front.end(), [&](std::size_t i) { return variants[i].worst() <= accuracy; });
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
output::Cell estimated(const ModelVariant& variant) {
  const output::Cell cell = per_cent(variant.estimate);
  if (variant.lacks.empty() || !std::holds_alternative<double>(cell)) return cell;
  return math::rounded(std::get<double>(cell), 2) + " *";
}

double per_step(const ModelVariant& variant) {
  return 1e6 * variant.motion / std::max<double>(1, static_cast<double>(variant.steps));
}

std::vector<output::Cell> short_cells(const ModelVariant& variant, const output::Cell& place) {
  if (!variant.stopped.empty())
    return {variant.name + ": " + variant.stopped, nothing, nothing, nothing, nothing, nothing, nothing, nothing};
  return {variant.name,
          place,
          variant.coordinates,
          per_step(variant),
          variant.motion,
          per_cent(variant.reduction),
          per_cent(variant.total),
          estimated(variant)};
}

std::vector<output::Cell> all_cells(const ModelVariant& variant, const output::Cell& place, std::size_t probes) {
  const bool ended = variant.stopped.empty();
  std::vector<output::Cell> row = {variant.family, variant.name, variant.formulation, place};
  if (ended)
    row.insert(row.end(), {variant.coordinates, variant.offline, per_step(variant), variant.motion});
  else
    row.insert(row.end(), 4, nothing);
  for (std::size_t p = 0; p < probes; ++p)
    for (const auto* errors : {&variant.reduction, &variant.total, &variant.estimate, &variant.peak})
      row.push_back(ended ? per_cent(*errors, p) : nothing);
  row.push_back(ended ? per_cent(variant.energy) : nothing);
  row.push_back(variant.lacks);
  row.push_back(variant.stopped);
  return row;
}

}  // namespace

output::Table tradeoff_table(const std::vector<std::string>& probes, const std::vector<ModelVariant>& variants,
                             bool full) {
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
  const std::vector<std::size_t> front = pareto_front(variants);
  for (std::size_t i = 0; i < variants.size(); ++i) {
    const auto at = std::find(front.begin(), front.end(), i);
    const output::Cell place =
        at == front.end() ? nothing : output::Cell(static_cast<std::int64_t>(at - front.begin() + 1));
    table.rows.push_back(full ? all_cells(variants[i], place, probes.size()) : short_cells(variants[i], place));
  }
  return table;
}

output::Table selections_table(const std::vector<ModelVariant>& variants) {
  output::Table table;
  table.columns = {{"required", "%", 2},  {"true", "%", 2},      {"estimated", "%", 2},
                   {"model", ""},         {"per step", "us", 3}, {"simulation", "s", 3},
                   {"selection", "s", 2}, {"time ratio", "", 2}, {"to the fastest other model as accurate", ""}};
  for (const ModelVariant& variant : variants) {
    if (variant.required == 0) continue;
    std::vector<output::Cell> row = {100 * variant.required};
    if (!variant.stopped.empty()) {
      row.insert(row.end(), {nothing, nothing, variant.stopped, nothing, nothing, nothing, nothing, nothing});
      table.rows.push_back(row);
      continue;
    }
    const ModelVariant* fastest = nullptr;
    for (const ModelVariant& other : variants)
      if (other.required == 0 && other.worst() <= variant.required && (!fastest || other.motion < fastest->motion))
        fastest = &other;
    row.insert(row.end(), {per_cent(variant.worst()), estimated(variant), variant.selected, per_step(variant),
                           variant.motion, variant.offline,
                           fastest ? output::Cell(variant.motion / fastest->motion) : output::Cell(std::string("-")),
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

ordered_json to_json(const ModelVariant& variant) {
  ordered_json j = {{"family", variant.family},
                    {"name", variant.name},
                    {"formulation", variant.formulation},
                    {"stopped", variant.stopped},
                    {"unknowns", variant.coordinates},
                    {"offline", variant.offline},
                    {"motion", variant.motion},
                    {"steps", variant.steps},
                    {"total", numbers(variant.total)},
                    {"reduction", numbers(variant.reduction)},
                    {"peak", numbers(variant.peak)},
                    {"energy", numbers({variant.energy})},
                    {"estimate", numbers(variant.estimate)},
                    {"estimate_lacks", variant.lacks}};
  if (variant.required > 0) j["required"] = variant.required, j["selected"] = variant.selected;
  return j;
}

ModelVariant variant_of(const ordered_json& j) {
  ModelVariant variant;
  variant.family = j["family"], variant.name = j["name"], variant.formulation = j["formulation"],
  variant.stopped = j["stopped"];
  variant.coordinates = j["unknowns"], variant.steps = j["steps"];
  variant.offline = j["offline"], variant.motion = j["motion"];
  variant.total = numbers_of(j["total"]), variant.reduction = numbers_of(j["reduction"]),
  variant.peak = numbers_of(j["peak"]);
  variant.energy = numbers_of(j["energy"]).at(0), variant.estimate = numbers_of(j["estimate"]);
  variant.lacks = j["estimate_lacks"], variant.required = j.value("required", 0.0);
  variant.selected = j.value("selected", std::string());
  return variant;
}

ordered_json to_json(const TradeoffReference& reference) {
  ordered_json j = {{"name", scene::name_of(reference.formulation)}, {"words", reference.words}};
  if (!reference.why.empty()) j["not_cfr"] = reference.why;
  j["error"] = numbers({reference.error}).at(0);
  if (!reference.error_lacks.empty()) j["error_lacks"] = reference.error_lacks;
  return j;
}

}  // namespace floe::app
