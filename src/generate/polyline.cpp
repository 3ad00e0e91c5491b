#include <algorithm>

#include "floe/generate/generate.h"
#include "share.h"

namespace floe::generate {
namespace {

Polyline completed(Polyline lines) {
  if (lines.segments.empty())
    for (int i = 1; i < static_cast<int>(lines.points.size()); ++i) lines.segments.push_back({i - 1, i});
  if (lines.parts.empty()) lines.parts.assign(lines.segments.size(), "line");
  return lines;
}

void check(const Polyline& lines) {
  Checks checks("polyline");
  const std::size_t count = lines.segments.size();
  const int points = static_cast<int>(lines.points.size());
  checks.require(count > 0, "there is no segment");
  checks.require(lines.elements.size() == count && lines.parts.size() == count,
                 "there are " + std::to_string(count) + " segments, " + std::to_string(lines.elements.size()) +
                     " numbers of elements and " + std::to_string(lines.parts.size()) + " parts");
  for (int i = 0; i < points; ++i) checks.finite("point " + std::to_string(i + 1), lines.points[i]);
  checks.finish();
  std::vector<char> met(points, 0);
  for (std::size_t s = 0; s < count; ++s) {
    const auto [from, to] = lines.segments[s];
    const std::string name = "segment " + std::to_string(s + 1);
    checks.at_least(1, "elements of " + name, lines.elements[s]);
    const bool known = std::min(from, to) >= 0 && std::max(from, to) < points;
    checks.require(known, name + " joins points that do not exist");
    if (!known) continue;
    met[from] = met[to] = 1;
    checks.require(lines.points[from] != lines.points[to], name + " has no length");
  }
  checks.finish();
  for (int i = 0; i < points; ++i) checks.require(met[i], "no segment meets point " + std::to_string(i + 1));
  auto sorted = lines.segments;
  for (auto& pair : sorted) std::sort(pair.begin(), pair.end());
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end())
    checks.require(false, "two segments join points " + std::to_string((*twice)[0] + 1) + " and " +
                              std::to_string((*twice)[1] + 1));
  checks.finish();
}

// Consecutive nodes: a point, or what lies inside a segment.
struct Run {
  PetscInt first;
  int point, segment;  // one of them is -1
};

struct Numbering {
  std::vector<Run> runs;               // ascending, none empty
  std::vector<PetscInt> point, inner;  // node of each point, first node inside each segment
  std::vector<PetscInt> first_cell;    // of each segment
  PetscInt nodes = 0, cells = 0;
};

Numbering number(const Polyline& lines) {
  Numbering n;
  n.point.assign(lines.points.size(), -1);
  const auto meet = [&](int p) {
    if (n.point[p] >= 0) return;
    n.point[p] = n.nodes++;
    n.runs.push_back({n.point[p], p, -1});
  };
  for (std::size_t s = 0; s < lines.segments.size(); ++s) {
    meet(lines.segments[s][0]);
    n.inner.push_back(n.nodes);
    if (lines.elements[s] > 1) n.runs.push_back({n.nodes, -1, static_cast<int>(s)});
    n.nodes += lines.elements[s] - 1;
    meet(lines.segments[s][1]);
    n.first_cell.push_back(n.cells);
    n.cells += lines.elements[s];
  }
  return n;
}

Eigen::Vector3d position(const Polyline& lines, const Numbering& n, PetscInt node) {
  const auto after = std::upper_bound(n.runs.begin(), n.runs.end(), node,
                                      [](PetscInt value, const Run& run) { return value < run.first; });
  const Run& run = *std::prev(after);
  if (run.point >= 0) return lines.points[run.point];
  const auto [from, to] = lines.segments[run.segment];
  const double along = static_cast<double>(node - run.first + 1) / static_cast<double>(lines.elements[run.segment]);
  return lines.points[from] + (lines.points[to] - lines.points[from]) * along;
}

Cell cell(const Polyline& lines, const Numbering& n, const std::vector<int>& part, PetscInt number) {
  const auto s = std::upper_bound(n.first_cell.begin(), n.first_cell.end(), number) - n.first_cell.begin() - 1;
  const PetscInt i = number - n.first_cell[s];
  const auto node = [&](PetscInt k) {
    if (k == 0) return n.point[lines.segments[s][0]];
    return k == lines.elements[s] ? n.point[lines.segments[s][1]] : n.inner[s] + k - 1;
  };
  return {CellKind::line, {node(i), node(i + 1), -1, -1}, part[s]};
}

}  // namespace

RawMesh polyline(MPI_Comm comm, const Polyline& given) {
  const Polyline lines = completed(given);
  check(lines);
  double total = 0;
  for (const PetscInt elements : lines.elements) total += static_cast<double>(elements);
  require_countable("polyline", total + static_cast<double>(lines.points.size()), total);
  const Numbering n = number(lines);
  Recipe recipe{"polyline", n.nodes, n.cells, {}, {}};
  std::vector<int> part;
  for (const auto& name : lines.parts) {
    const auto found = std::find(recipe.parts.begin(), recipe.parts.end(), name);
    part.push_back(static_cast<int>(found - recipe.parts.begin()));
    if (found == recipe.parts.end()) recipe.parts.push_back(name);
  }
  for (std::size_t p = 0; p < lines.points.size(); ++p)
    recipe.places.push_back(single("p" + std::to_string(p + 1), n.point[p]));
  recipe.places.push_back(single("start", n.point.front()));
  recipe.places.push_back(single("end", n.point.back()));
  return generated(
      comm, recipe, [&](PetscInt i) { return position(lines, n, i); },
      [&](PetscInt i) { return cell(lines, n, part, i); });
}

}  // namespace floe::generate
