#include "floe/scene/file_places.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "floe/math/nearest.h"

namespace floe::scene {

Eigen::Vector3d in_mesh(const output::ReducedBodyFile& file, const Eigen::VectorXd& x) {
  Eigen::Vector3d all = Eigen::Vector3d::Zero();
  all.head(file.dimension) = file.frame.origin + file.frame.axes * x;
  return all;
}

const output::ReducedPlace& named_place(const Body& body, const Place& place) {
  const output::ReducedBodyFile& file = *body.reduced->file;
  std::vector<std::string> names;
  for (const output::ReducedPlace& each : file.places) {
    if (!place.point && each.name == place.name) return each;
    names.push_back(each.name);
  }
  const std::string expected = names.empty() ? "another body" : fmt::format("one of {}", fmt::join(names, ", "));
  if (place.point)
    throw InputError(
        fmt::format("{}: refers to a node by coordinates, and \"{}\" has no shapes with coordinates; expected {}",
                    place.where.text(), body.reduced->path, expected));
  const std::string near = math::nearest(place.name, names);
  throw InputError(fmt::format("{}: {} has no place \"{}\"; expected {}{}{}", place.where.text(), body.name, place.name,
                               expected, file.has_shapes ? ", or coordinates" : "",
                               near.empty() ? "" : "; did you mean \"" + near + "\"?"));
}

double extent_of(const output::ReducedBodyFile& file) {
  const body::Inertia& inertia = file.body.inertia;
  double extent = 2 * std::sqrt(std::max(0.0, inertia.C0.trace() / inertia.m - (inertia.s0 / inertia.m).squaredNorm()));
  for (const output::ReducedPlace& a : file.places)
    for (const output::ReducedPlace& b : file.places) extent = std::max(extent, (a.map.x - b.map.x).norm());
  return extent;
}

}  // namespace floe::scene
