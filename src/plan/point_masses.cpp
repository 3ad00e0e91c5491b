#include "point_masses.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>

#include "floe/error.h"
#include "floe/fem/point_mass.h"
#include "floe/math/nearest.h"
#include "floe/scene/places.h"

namespace floe::plan {
namespace {

using scene::MassSpec;

/// The node at a point, to 1e-6 of the mesh. Collective.
PetscInt node_at(const mesh::RawMesh& raw, const MassSpec& mass, const scene::Point& at) {
  const Eigen::Vector3d point = Eigen::Vector3d::Map(at.data());
  struct {
    double distance = std::numeric_limits<double>::infinity();
    int rank = 0;
  } nearest;
  MPI_Comm_rank(raw.comm, &nearest.rank);
  PetscInt node = -1;
  double size = 0;
  for (std::size_t i = 0; i < raw.positions.size(); ++i) {
    size = std::max(size, (raw.positions[i] - point).norm());
    if (const double distance = (raw.positions[i] - point).norm(); distance < nearest.distance)
      nearest.distance = distance, node = raw.first_node + static_cast<PetscInt>(i);
  }
  MPI_Allreduce(MPI_IN_PLACE, &nearest, 1, MPI_DOUBLE_INT, MPI_MINLOC, raw.comm);
  MPI_Allreduce(MPI_IN_PLACE, &size, 1, MPI_DOUBLE, MPI_MAX, raw.comm);
  MPI_Bcast(&node, 1, MPIU_INT, nearest.rank, raw.comm);
  if (!(nearest.distance <= 1e-6 * size))
    throw InputError(fmt::format("{}: the nearest node of the mesh is {:.6g} from ({}, {}, {}); expected a node",
                                 mass.at.where.text(), nearest.distance, point.x(), point.y(), point.z()));
  return node;
}

PetscInt node_of(const mesh::RawMesh& raw, const scene::Body& body, const mesh::NodeSets& places,
                 const MassSpec& mass) {
  if (mass.at.point) return node_at(raw, mass, *mass.at.point);
  if (mass.at.name == "middle" && scene::unbranched(body.mesh))
    return node_at(raw, mass, scene::place_point(body.mesh, mass.at));
  const auto place = places.find(mass.at.name);
  if (place != places.end() && place->second.nodes.size() == 1) return place->second.nodes.front();
  std::vector<std::string> names;
  for (const auto& [name, set] : places)
    if (set.nodes.size() == 1) names.push_back(name);
  const std::string near = math::nearest(mass.at.name, names);
  throw InputError(fmt::format(
      "{}: {}; expected {}the coordinates of a node{}", mass.at.where.text(),
      place == places.end() ? fmt::format("the mesh has no place \"{}\"", mass.at.name)
                            : fmt::format("the place \"{}\" has {} nodes", mass.at.name, place->second.nodes.size()),
      names.empty() ? "" : fmt::format("a place of one node ({}) or ", fmt::join(names, ", ")),
      near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
}

}  // namespace

void add_masses(const scene::Body& body, const mesh::NodeSets& places, mesh::RawMesh& raw,
                std::map<int, fem::Section>& parts) {
  if (body.masses.empty()) return;
  int rank = 0;
  MPI_Comm_rank(raw.comm, &rank);
  for (const MassSpec& mass : body.masses) {
    const PetscInt node = node_of(raw, body, places, mass);
    fem::PointMass point{mass.mass};
    const auto& J = mass.inertia;
    point.inertia << J[0], J[3], J[4], J[3], J[1], J[5], J[4], J[5], J[2];
    point.offset = Eigen::Vector3d::Map(mass.offset.data());
    const int part = static_cast<int>(raw.parts.size());
    parts[part] = point;
    raw.parts.push_back("mass " + mass.name);
    if (rank > 0) continue;
    mesh::Cell cell{mesh::CellKind::point, mesh::no_nodes<PetscInt>(), part};
    cell.nodes[0] = node;
    raw.cells.push_back(cell);
    raw.cell_labels.push_back(0);
  }
  const std::vector<PetscInt> cells = mesh::starts_of(raw.comm, static_cast<PetscInt>(raw.cells.size()));
  raw.first_cell = cells[rank];
  raw.cell_count = cells.back();
}

}  // namespace floe::plan
