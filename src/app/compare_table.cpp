#include "compare_table.h"

#include <algorithm>
#include <cmath>

namespace floe::app {

namespace {

using assess::probe_of;

double duration(const Series& series) { return series.t.empty() ? 0 : series.t.back() - series.t.front(); }

/// Visits the instants of `series` that the reference has reached, with the reference's place there: instants k, k + 1
/// and the share of the second.
template <class Visit>
void for_each_instant(const Series& series, const Series& reference, Visit&& visit) {
  std::size_t k = 0;
  for (std::size_t i = 0; i < series.t.size(); ++i) {
    const double t = series.t[i];
    if (t > reference.t.back() * (1 + 1e-12)) break;
    while (k + 2 < reference.t.size() && reference.t[k + 1] < t) ++k;
    const double s =
        reference.t.size() < 2 ? 0 : std::clamp((t - reference.t[k]) / (reference.t[k + 1] - reference.t[k]), 0.0, 1.0);
    visit(i, k, s);
  }
}

double between(const Series& reference, std::size_t k, double s, std::size_t c) {
  return reference.t.size() < 2 ? reference.values[0][c]
                                : (1 - s) * reference.values[k][c] + s * reference.values[k + 1][c];
}

/// Root mean squares over the instants, of each column.
struct Sizes {
  std::vector<double> difference, size;
};

Sizes sizes(const Series& series, const Series& reference) {
  const std::size_t columns = series.columns.size();
  Sizes of{std::vector<double>(columns, 0), std::vector<double>(columns, 0)};
  double count = 0;
  for_each_instant(series, reference, [&](std::size_t i, std::size_t k, double s) {
    for (std::size_t c = 0; c < columns; ++c) {
      const double r = between(reference, k, s, c);
      of.difference[c] += std::pow(series.values[i][c] - r, 2);
      of.size[c] += r * r;
    }
    ++count;
  });
  for (auto* values : {&of.difference, &of.size})
    for (double& value : *values) value = std::sqrt(value / std::max(1.0, count));
  return of;
}

}  // namespace

std::vector<std::string> probes(const std::vector<assembly::ProbeColumn>& columns) {
  std::vector<std::string> names;
  for (const auto& column : columns)
    if (std::find(names.begin(), names.end(), probe_of(column)) == names.end()) names.push_back(probe_of(column));
  return names;
}

std::vector<std::optional<double>> relative_errors(const Series& series, const Series& reference) {
  const Sizes of = sizes(series, reference);
  const std::vector<std::string> names = probes(series.columns);
  std::vector<double> whole(names.size(), 0);  // of each probe
  const auto probe = [&](std::size_t c) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), probe_of(series.columns[c])) - names.begin());
  };
  for (std::size_t c = 0; c < of.size.size(); ++c) whole[probe(c)] = std::hypot(whole[probe(c)], of.size[c]);
  const std::vector<double> least = assess::reference_sizes(series.columns, whole, duration(series));
  std::vector<std::optional<double>> errors(of.size.size());
  for (std::size_t c = 0; c < errors.size(); ++c)
    if (whole[probe(c)] >= least[probe(c)] && of.size[c] > 0 && of.size[c] >= 1e-9 * whole[probe(c)])
      errors[c] = of.difference[c] / of.size[c];
  return errors;
}

std::vector<double> vector_errors(const Series& series, const Series& reference) {
  assess::ProbeErrors errors(series.columns);
  std::vector<double> error(series.columns.size()), value(series.columns.size());
  for_each_instant(series, reference, [&](std::size_t i, std::size_t k, double s) {
    for (std::size_t c = 0; c < value.size(); ++c) {
      value[c] = between(reference, k, s, c);
      error[c] = series.values[i][c] - value[c];
    }
    errors.add(error, value);
  });
  return errors.relative(duration(series));
}

double worst_error(const Series& series, const Series& reference) {
  double worst = 0;
  for (const double error : vector_errors(series, reference))
    worst = std::isnan(error) ? error : std::max(worst, error);
  return worst;
}

std::vector<double> peak_errors(const Series& series, const Series& reference) {
  const std::vector<std::string> names = probes(series.columns);
  std::vector<double> error(names.size()), size(names.size());
  for_each_instant(series, reference, [&](std::size_t i, std::size_t k, double s) {
    for (std::size_t p = 0; p < names.size(); ++p) {
      double difference = 0, whole = 0;
      for (std::size_t c = 0; c < series.columns.size(); ++c) {
        if (probe_of(series.columns[c]) != names[p]) continue;
        const double r = between(reference, k, s, c);
        difference += std::pow(series.values[i][c] - r, 2), whole += r * r;
      }
      error[p] = std::max(error[p], std::sqrt(difference)), size[p] = std::max(size[p], std::sqrt(whole));
    }
  });
  size = assess::reference_sizes(series.columns, size, duration(series));
  for (std::size_t p = 0; p < names.size(); ++p) error[p] = error[p] == 0 ? 0 : error[p] / size[p];
  return error;
}

std::optional<double> relative_energy_error(const Series& series, const Series& reference) {
  const auto of = [](const dynamics::Energy& e) { return e.kinetic + e.elastic; };
  double difference = 0, size = 0;
  for_each_instant(series, reference, [&](std::size_t i, std::size_t k, double s) {
    const std::size_t next = std::min(k + 1, reference.energy.size() - 1);
    const double r = (1 - s) * of(reference.energy[k]) + s * of(reference.energy[next]);
    difference += std::pow(of(series.energy[i]) - r, 2), size += r * r;
  });
  return size > 0 ? std::optional(std::sqrt(difference / size)) : std::nullopt;
}

output::Table comparison(const std::vector<Compared>& rows, const std::vector<const Compared*>& references,
                         const std::vector<std::string>& failed, const Compared* own, bool components) {
  output::Table table;
  table.columns = {{"formulation", ""}, {"model", ""}, {"unknowns", ""}};
  const auto& columns = rows.front().result.series.columns;
  std::vector<std::string> names;
  for (const auto& column : columns) names.push_back(column.name);
  if (!components) names = probes(columns);
  for (const Compared* reference : references)
    for (const std::string& name : names) table.columns.push_back({name + " vs " + reference->name, "%", 3});
  table.columns.push_back({"offline", "s", 3});
  table.columns.push_back({"motion", "s", 3});
  table.columns.push_back({"per step", "us", 3});
  const auto add = [&](const Compared& row, const std::string& label) {
    const RunResult& r = row.result;
    std::vector<output::Cell> cells = {row.name, label, static_cast<std::int64_t>(r.coordinates)};
    for (const Compared* reference : references) {
      if (reference == &row) {
        cells.insert(cells.end(), names.size(), std::string());
        continue;
      }
      if (components) {
        for (const auto& error : relative_errors(r.series, reference->result.series))
          cells.push_back(error ? output::Cell(100 * *error) : output::Cell(std::string()));
      } else {
        for (const double error : vector_errors(r.series, reference->result.series)) cells.emplace_back(100 * error);
      }
    }
    cells.emplace_back(r.offline_seconds);
    cells.emplace_back(r.motion_seconds);
    cells.emplace_back(1e6 * r.motion_seconds / std::max<double>(1, static_cast<double>(r.steps)));
    table.rows.push_back(std::move(cells));
  };
  for (const Compared& row : rows) add(row, row.result.label);
  for (const std::string& name : failed) {
    std::vector<output::Cell> cells(table.columns.size(), std::string());
    cells[0] = name, cells[1] = "failed";
    table.rows.push_back(std::move(cells));
  }
  if (own) add(*own, own->result.label + ", " + own->refined);
  return table;
}

std::string comparison_text(const std::vector<Compared>& rows, const std::vector<const Compared*>& references,
                            const std::vector<std::string>& failed, const Compared* own, int columns) {
  const auto narrow = [&](const std::vector<const Compared*>& against, bool components) {
    output::Table table = comparison(rows, against, failed, own, components);
    for (auto& column : table.columns)  // `tip vs cfr [%]`: tip above [% cfr]
      if (const auto at = column.name.find(" vs "); at != std::string::npos)
        column = {column.name.substr(0, at), "% " + column.name.substr(at + 4), column.digits};
    return table;
  };
  const std::vector<const Compared*> first(references.begin(),
                                           references.begin() + std::min<std::size_t>(1, references.size()));
  const output::Table whole = narrow(references, true), vectors = narrow(references, false);
  if (output::text_width(whole) <= columns) return output::to_text(whole);
  const bool both = output::text_width(vectors) <= columns;
  return output::to_text(both ? vectors : narrow(first, false)) + "Each probe as a vector; its components" +
         (both ? "" : " and every reference") + " are in compare.csv.\n";
}

}  // namespace floe::app
