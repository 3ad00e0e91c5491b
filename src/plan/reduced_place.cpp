#include "floe/plan/reduced_place.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "floe/plan/planar_start.h"
#include "floe/scene/file_places.h"

namespace floe::plan {
namespace {

fem::ReferenceFrame::Kind kind_of(const std::string& name) {
  using Kind = fem::ReferenceFrame::Kind;
  return name == "pinned" ? Kind::pinned : name == "clamped" ? Kind::clamped : Kind::mean_axis;
}

fem::Structure without_elements(MPI_Comm comm, int dimension) {
  fem::Mesh mesh;
  mesh.comm = comm;
  mesh.dimension = dimension;
  return fem::Structure(std::move(mesh), {}, fem::MembraneStrain::averaged);
}

Eigen::Vector3d filled(const Eigen::VectorXd& x) {
  Eigen::Vector3d all = Eigen::Vector3d::Zero();
  all.head(x.size()) = x;
  return all;
}

}  // namespace

PetscInt number_in_file(const output::ReducedBodyFile& file, const Eigen::VectorXd& x, PetscInt other) {
  for (std::size_t i = 0; i < file.places.size(); ++i)
    if ((file.places[i].map.x - x).norm() <= 1e-9 * extent_of(file)) return static_cast<PetscInt>(i);
  return static_cast<PetscInt>(file.places.size()) + other;
}

PlannedBody prepare_reduced(const Body& spec, MPI_Comm comm) {
  const output::ReducedBodyFile& file = *spec.reduced->file;
  PlannedBody body{spec, without_elements(comm, file.dimension), {}, {}, 0, {}, {}, {}, {}, {}, {}};
  body.frame.kind = kind_of(file.frame.kind);
  if (file.dimension == 3) {
    body.origin = file.frame.origin, body.axes = file.frame.axes;
    return body;
  }
  body.frame_origin = file.frame.origin;
  body.frame_angle = std::atan2(file.frame.axes(1, 0), file.frame.axes(0, 0));
  start_body(body);
  return body;
}

Anchor reduced_place(const Body& body, const Place& place, MPI_Comm comm) {
  const output::ReducedBodyFile& file = *body.reduced->file;
  Anchor found;
  if (!place.point || !file.has_shapes) {
    found.map = std::make_shared<const body::PlaceMap>(named_place(body, place).map);
    found.node = number_in_file(file, found.map->x);
  } else {
    const Point& p = *place.point;
    const Eigen::VectorXd in_plane = Eigen::Vector3d(p[0], p[1], p[2]).head(file.dimension);
    const output::ReducedNode node = output::nearest_node(comm, body.reduced->path, file,
                                                          file.frame.axes.transpose() * (in_plane - file.frame.origin));
    if (node.distance > 1e-6 * node.extent) {
      const Eigen::Vector3d at = in_mesh(file, node.map.x);
      throw InputError(fmt::format("{}: no node of {} at ({}); the nearest node is at ({:.9g})", place.where.text(),
                                   body.name, fmt::join(p.begin(), p.begin() + file.dimension, ", "),
                                   fmt::join(at.begin(), at.begin() + file.dimension, ", ")));
    }
    found.map = std::make_shared<const body::PlaceMap>(node.map);
    found.node = number_in_file(file, node.map.x, static_cast<PetscInt>(node.number));
  }
  found.nodes = {found.node};
  found.x = filled(found.map->x);
  return found;
}

}  // namespace floe::plan
