#include "floe/scene/places.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "floe/error.h"
#include "floe/math/nearest.h"

namespace floe::scene {
namespace {

double distance(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

double segment_length(const MeshSpec& mesh, std::size_t i) {
  return distance(mesh.points[mesh.segments[i][0]], mesh.points[mesh.segments[i][1]]);
}

// The node after `steps` of the segment's elements.
Point node_of(const MeshSpec& mesh, std::size_t segment, double steps) {
  const Point& a = mesh.points[mesh.segments[segment][0]];
  const Point& b = mesh.points[mesh.segments[segment][1]];
  if (steps >= mesh.elements[segment]) return b;
  const double s = steps / mesh.elements[segment];
  return {a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2])};
}

struct Nearest {
  Point node;
  double distance, element_length;
};

Nearest find_nearest(const MeshSpec& mesh, const Point& p) {
  Nearest best{{}, INFINITY, 0};
  for (std::size_t i = 0; i < mesh.segments.size(); ++i) {
    const Point& a = mesh.points[mesh.segments[i][0]];
    const Point& b = mesh.points[mesh.segments[i][1]];
    const double length = distance(a, b);
    double along = 0;
    for (int k = 0; k < 3; ++k) along += (p[k] - a[k]) / length * ((b[k] - a[k]) / length);
    const double steps = std::clamp(std::round(along * mesh.elements[i]), 0.0, double(mesh.elements[i]));
    const Point node = node_of(mesh, i, steps);
    if (distance(node, p) < best.distance) best = {node, distance(node, p), length / mesh.elements[i]};
  }
  return best;
}

/// Half the total length, as a segment and elements of it.
struct Half {
  std::size_t segment;
  double steps;
};

Half half_of(const MeshSpec& mesh) {
  double left = total_length(mesh) / 2;
  for (std::size_t i = 0; i < mesh.segments.size(); ++i) {
    const double steps = left / segment_length(mesh, i) * mesh.elements[i] * (1 + 1e-12);  // rounding loses no node
    if (steps <= mesh.elements[i]) return {i, steps};
    left -= segment_length(mesh, i);
  }
  return {mesh.segments.size() - 1, static_cast<double>(mesh.elements.back())};
}

/// The node there, or the last one before it.
double steps_to_node(const Half& half) { return std::floor(half.steps + 1e-9); }

}  // namespace

bool has_middle(const MeshSpec& mesh) {
  if (!unbranched(mesh)) return false;
  const Half half = half_of(mesh);
  return half.segment > 0 || steps_to_node(half) > 0;
}

namespace {

Point middle(const MeshSpec& mesh, const Place& place) {
  const Half half = half_of(mesh);
  if (!has_middle(mesh))
    throw InputError(
        fmt::format("{}: {} has no node between its start and half of its length; expected a mesh of an even "
                    "number of elements, start, end or coordinates",
                    place.where.text(), place.body));
  return node_of(mesh, half.segment, steps_to_node(half));
}

}  // namespace

int node_count(const MeshSpec& mesh) {
  int count = static_cast<int>(mesh.points.size());
  for (const int elements : mesh.elements) count += elements - 1;
  return count;
}

double total_length(const MeshSpec& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.segments.size(); ++i) sum += segment_length(mesh, i);
  return sum;
}

bool unbranched(const MeshSpec& mesh) {
  if (mesh.segments.size() + 1 != mesh.points.size()) return false;
  for (std::size_t i = 0; i < mesh.segments.size(); ++i) {
    if (mesh.segments[i] != std::array<int, 2>{static_cast<int>(i), static_cast<int>(i) + 1}) return false;
  }
  return true;
}

std::vector<std::string> place_names(const MeshSpec& mesh) {
  std::vector<std::string> names{"start", "end"};
  if (has_middle(mesh)) names.push_back("middle");
  return names;
}

Point nearest_node(const MeshSpec& mesh, const Point& point) { return find_nearest(mesh, point).node; }

Point place_point(const MeshSpec& mesh, const Place& place) {
  if (place.point) {
    const auto [node, away, element_length] = find_nearest(mesh, *place.point);
    const Point& p = *place.point;
    const double rounding = 1e-12 * std::hypot(node[0], node[1], node[2]);
    if (away <= 1e-6 * element_length + rounding) return node;
    throw InputError(fmt::format("{}: no node of {} at ({}, {}); the nearest node is at ({}, {})", place.where.text(),
                                 place.body, p[0], p[1], node[0], node[1]));
  }
  if (place.name == "start") return mesh.points.front();
  if (place.name == "end") return mesh.points.back();
  if (place.name == "middle" && unbranched(mesh)) return middle(mesh, place);
  std::size_t number = 0;
  const char* last = place.name.data() + place.name.size();
  if (place.name.starts_with("p") && std::from_chars(place.name.data() + 1, last, number).ptr == last && number > 0 &&
      number <= mesh.points.size() && place.name[1] != '0') {
    return mesh.points[number - 1];
  }
  const std::string near = math::nearest(place.name, place_names(mesh));
  throw InputError(fmt::format("{}: {} has no place \"{}\"; expected start, end{}, p1 to p{} or coordinates{}",
                               place.where.text(), place.body, place.name, unbranched(mesh) ? ", middle" : "",
                               mesh.points.size(), near.empty() ? "" : "; did you mean \"" + near + "\"?"));
}

Point place_point(const Body& body, const Place& place) {
  if (body.rigid && place.point) return *place.point;
  if (body.mass && place.name == "centre") return body.mass->centre;
  if (body.mass && !body.mass->has_mesh)
    throw InputError(fmt::format("{}: {} has no mesh and no place \"{}\"; expected centre or coordinates",
                                 place.where.text(), place.body, place.name));
  if (body.rigid && place.name == "middle" && unbranched(body.mesh)) {
    const Half half = half_of(body.mesh);
    const double node = std::round(half.steps);
    return node_of(body.mesh, half.segment, std::abs(half.steps - node) < 1e-9 ? node : half.steps);
  }
  return place_point(body.mesh, place);
}

double short_of_middle(const MeshSpec& mesh) {
  const Half half = half_of(mesh);
  return std::max(0.0, half.steps - steps_to_node(half)) * segment_length(mesh, half.segment) /
         mesh.elements[half.segment];
}

std::string never_deflects(const Probe& probe, const Body& body) {
  return fmt::format("probe {}: its deflection is 0 throughout, because {}; use quantity displacement with relative_to",
                     probe.name,
                     body.rigid ? fmt::format("body {} is rigid", body.name)
                                : fmt::format("the floating frame of body {} is attached to that place", body.name));
}

std::vector<std::string> middles_beside_nodes(const Scene& scene) {
  std::vector<std::string> words;
  const auto look = [&](const Place& place) {
    for (const Body& body : scene.bodies) {
      if (place.name != "middle" || place.point || body.name != place.body || !unbranched(body.mesh)) continue;
      if (body.reduced || (body.rigid && scene.dimension == 2) || body.mesh.points.empty()) continue;
      const double away = short_of_middle(body.mesh), length = total_length(body.mesh);
      if (!(away > 1e-6 * length)) continue;
      std::string text = fmt::format(
          "place {}.middle: no node at half of the length; the nearest node before it is used, at a distance of {:.3g} "
          "m, {:.2g} % of the length (limit 0.0001 %); use an even number of elements",
          body.name, away, 100 * away / length);
      if (std::find(words.begin(), words.end(), text) == words.end()) words.push_back(std::move(text));
    }
  };
  for (const Joint& joint : scene.joints) look(joint.first), look(joint.second);
  for (const Load& load : scene.loads) look(load.at);
  for (const Body& body : scene.bodies)
    for (const MassSpec& mass : body.masses) look(mass.at);
  for (const Probe& probe : scene.probes) {
    look(probe.at);
    if (probe.relative_to) look(*probe.relative_to);
    if (probe.toward) look(*probe.toward);
  }
  return words;
}

}  // namespace floe::scene
