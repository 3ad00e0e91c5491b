#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "readers.h"

namespace floe::scene {
namespace {

constexpr double most_elements = 1e8;

std::vector<Point> read_points(Document& document, Reading& reading) {
  std::vector<Point> points;
  const auto value = reading.value("points");
  if (!value) return points;
  const Key& key = reading.key("points");
  Key point = key;
  point.type = Type::point;
  const std::size_t before = document.fault_count();
  for (const auto& item : read_list(document, *value, key)) points.push_back(read_point(document, item, point));
  if (document.fault_count() == before && points.size() < 2) {
    document.fault(value->where, fmt::format("has length {}", points.size()), "at least 2 points");
  }
  return points;
}

std::vector<int> read_elements(Document& document, Reading& reading, std::size_t segments) {
  const auto value = reading.value("elements");
  if (!value) return {};
  const Key& key = reading.key("elements");
  if (!value->node.IsSequence()) return std::vector<int>(segments, read_integer(document, *value, key));
  std::vector<int> elements;
  for (const auto& item : read_list(document, *value, key)) elements.push_back(read_integer(document, item, key));
  if (elements.size() != segments) {
    document.fault(value->where, fmt::format("has length {} for {} segments", elements.size(), segments),
                   "one for each segment, or one number for all");
  }
  return elements;
}

void chain(MeshSpec& mesh) {
  for (int i = 0; i + 1 < static_cast<int>(mesh.points.size()); ++i) mesh.segments.push_back({i, i + 1});
}

void read_line(Document& document, const Value& value, MeshSpec& mesh) {
  Reading reading(document, value, "line");
  mesh.points = {reading.point("from"), reading.point("to")};
  chain(mesh);
  mesh.elements = {reading.integer("elements")};
}

void read_polyline(Document& document, const Value& value, MeshSpec& mesh) {
  Reading reading(document, value, "polyline");
  mesh.points = read_points(document, reading);
  chain(mesh);
  mesh.elements = read_elements(document, reading, mesh.segments.size());
}

void read_segments(Document& document, const Value& value, MeshSpec& mesh) {
  Reading reading(document, value, "segments");
  mesh.points = read_points(document, reading);
  const auto join = reading.value("join");
  if (!join) return;
  for (const auto& [i, j] : read_pairs(document, *join, reading.key("join"))) {
    if (std::max(i, j) > static_cast<int>(mesh.points.size())) {
      document.fault(join->where, fmt::format("refers to point {} of {}", std::max(i, j), mesh.points.size()));
    } else if (i == j) {
      document.fault(join->where, fmt::format("[{}, {}] connects a point with itself", i, j));
    } else if (std::count(mesh.segments.begin(), mesh.segments.end(), std::array{i - 1, j - 1}) +
                   std::count(mesh.segments.begin(), mesh.segments.end(), std::array{j - 1, i - 1}) >
               0) {
      document.fault(join->where, fmt::format("[{}, {}] is given twice", i, j));
    }
    mesh.segments.push_back({i - 1, j - 1});
  }
  if (mesh.segments.empty() && join->node.IsSequence() && join->node.size() == 0) {
    document.fault(join->where, "is empty", describe(reading.key("join")));
  }
  mesh.elements = read_elements(document, reading, mesh.segments.size());
}

void read_plate(Document& document, const Value& value, MeshSpec& mesh) {
  Reading reading(document, value, "plate");
  PlateSpec plate;
  plate.origin = reading.point("origin");
  plate.along = reading.point("along");
  plate.across = reading.point("across");
  const auto elements = reading.value("elements");
  const auto counts = elements ? read_list(document, *elements, reading.key("elements"), 2) : std::vector<Value>{};
  for (std::size_t i = 0; i < counts.size(); ++i)
    plate.elements[i] = read_integer(document, counts[i], reading.key("elements"));
  using Cells = PlateSpec::Cells;
  plate.cells =
      reading.choice<Cells>("cells", {{"triangles", Cells::triangles}, {"quadrilaterals", Cells::quadrilaterals}});
  mesh.plate = plate;
}

void read_file(Document& document, const Value& value, MeshSpec& mesh) {
  Reading reading(document, value, "file");
  mesh.file = MeshFileSpec{
      reading.text("path"), {}, reading.text("instance"), reading.number("scale"), reading.integer("refine")};
  if (const auto ignore = reading.value("ignore"))
    mesh.file->ignore = read_texts(document, *ignore, reading.key("ignore"));
  mesh.file->path = document.beside(mesh.file->path);
}

// Two points at one place would give two nodes that nothing holds together, and a segment between them no direction.
void refuse_coincident_points(Document& document, const MeshSpec& mesh) {
  const auto projection = [&](int i) {
    return mesh.points[i][0] + 0.6180339887 * mesh.points[i][1] + 0.3819660113 * mesh.points[i][2];
  };
  double size = 0;
  for (const Point& p : mesh.points)
    size = std::max(size, std::hypot(p[0] - mesh.points[0][0], p[1] - mesh.points[0][1], p[2] - mesh.points[0][2]));
  std::vector<int> order(mesh.points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return projection(a) < projection(b); });
  for (std::size_t a = 0; a < order.size(); ++a) {
    for (std::size_t b = a + 1; b < order.size(); ++b) {
      if (projection(order[b]) - projection(order[a]) > 2e-9 * size) break;
      const auto &p = mesh.points[order[a]], &q = mesh.points[order[b]];
      if (std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) > 1e-9 * size) continue;
      const auto [first, second] = std::minmax(order[a], order[b]);
      document.fault(mesh.where,
                     fmt::format("points {} and {} coincide at ({}, {})", first + 1, second + 1, p[0], p[1]),
                     "different points (where segments meet, use the same point in `segments: {join: ...}`)");
      return;
    }
  }
}

void refuse_loose_points(Document& document, const MeshSpec& mesh) {
  std::vector<int> root(mesh.points.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const auto& [i, j] : mesh.segments) root[find(i)] = find(j);
  for (int i = 1; i < static_cast<int>(root.size()); ++i) {
    if (find(i) == find(0)) continue;
    document.fault(mesh.where, fmt::format("no segments lead from point 1 to point {}", i + 1), "a connected mesh");
    return;
  }
}

}  // namespace

MeshSpec read_mesh(Document& document, const Value& value) {
  const std::size_t before = document.fault_count();
  MeshSpec mesh;
  mesh.where = value.where;
  Reading reading(document, value, "mesh");
  const bool line = reading.given("line"), polyline = reading.given("polyline"), segments = reading.given("segments");
  const bool plate = reading.given("plate"), file = reading.given("file");
  const int shapes = line + polyline + segments + plate + file;
  if (value.node.IsMap() && shapes != 1) {
    document.fault(value.where, fmt::format("has {} shapes", shapes),
                   "exactly one of line, polyline, segments, plate, file");
  }
  if (plate && shapes == 1) read_plate(document, *reading.value("plate"), mesh);
  if (file && shapes == 1) read_file(document, *reading.value("file"), mesh);
  if (plate || file) return mesh;
  if (line)
    read_line(document, *reading.value("line"), mesh);
  else if (polyline)
    read_polyline(document, *reading.value("polyline"), mesh);
  else if (segments)
    read_segments(document, *reading.value("segments"), mesh);
  if (document.fault_count() == before) refuse_coincident_points(document, mesh);
  if (document.fault_count() == before) refuse_loose_points(document, mesh);
  const double elements = std::accumulate(mesh.elements.begin(), mesh.elements.end(), 0.0);
  if (document.fault_count() == before && elements > most_elements) {
    document.fault(mesh.where, fmt::format("has {} elements", elements), fmt::format("at most {}", most_elements));
  }
  if (document.fault_count() != before) mesh.points.clear();  // unsound: nothing more is checked against it
  return mesh;
}

}  // namespace floe::scene
