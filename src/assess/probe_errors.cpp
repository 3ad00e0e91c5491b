#include "floe/assess/probe_errors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace floe::assess {

namespace {

/// The number of each column's probe.
std::vector<std::size_t> numbers_of(const std::vector<ProbeColumn>& columns) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < columns.size(); ++i)
    numbers.push_back(i == 0                                             ? 0
                      : probe_of(columns[i]) == probe_of(columns[i - 1]) ? numbers.back()
                                                                         : numbers.back() + 1);
  return numbers;
}

}  // namespace

std::string probe_of(const ProbeColumn& column) { return column.name.substr(0, column.name.rfind('.')); }

std::vector<double> reference_sizes(const std::vector<ProbeColumn>& columns, const std::vector<double>& sizes,
                                    double duration) {
  const std::vector<std::size_t> probe = numbers_of(columns);
  using Kind = ProbeColumn::Kind;
  using Group = std::pair<Kind, std::string>;
  const auto group = [&](const ProbeColumn& column) -> Group {  // formulas of unlike quantities have nothing in common
    if (column.kind != Kind::formula) return {column.kind, ""};
    return {column.kind, column.unit.empty() ? column.name : column.unit};
  };
  std::map<Group, double> most;  // of each kind, relative to the scales
  for (std::size_t i = 0; i < columns.size(); ++i) {
    double& one = most[group(columns[i])];
    one = std::max(one, sizes[probe[i]] / columns[i].scale);
  }
  const double part = std::max(1e-10, 1e-7 * std::min(most[Group{Kind::place, ""}], 1.0));
  std::vector<double> references = sizes;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Kind kind = columns[i].kind;
    double least = kind == Kind::place ? part : 1e-7 * most[group(columns[i])];
    if (kind == Kind::load) least = std::max(least, 1e-7);
    const double time = duration > 0 ? duration : 1;
    if (kind == Kind::rate) least = std::max(least, part / time);
    if (kind == Kind::acceleration) least = std::max(least, part / (time * time));
    references[probe[i]] = std::max(references[probe[i]], least * columns[i].scale);
  }
  return references;
}

ProbeErrors::ProbeErrors(std::vector<ProbeColumn> columns)
    : columns_(std::move(columns)),
      probe_(numbers_of(columns_)),
      error_(columns_.empty() ? 0 : probe_.back() + 1),
      size_(error_.size()) {}

void ProbeErrors::add(const std::vector<double>& error, const std::vector<double>& value) {
  ++count_;
  for (std::size_t i = 0; i < columns_.size(); ++i)
    error_[probe_[i]] += error[i] * error[i], size_[probe_[i]] += value[i] * value[i];
}

std::vector<double> ProbeErrors::relative(double duration) const {
  std::vector<double> sizes, all;
  for (const double size : size_) sizes.push_back(std::sqrt(size / std::max(1.0, count_)));
  const std::vector<double> references = reference_sizes(columns_, sizes, duration);
  for (std::size_t p = 0; p < error_.size(); ++p)
    all.push_back(error_[p] == 0 ? 0 : std::sqrt(error_[p] / count_) / references[p]);
  return all;
}

}  // namespace floe::assess
