#include "floe/fem/mesh.h"

#include <algorithm>
#include <limits>
#include <map>

namespace floe::fem {
namespace {

/// Global node numbers of a segment: first end, inner nodes (consecutive), last end.
struct Run {
  PetscInt from, inner, to;
  PetscInt node(PetscInt i, PetscInt elements) const { return i == 0 ? from : i == elements ? to : inner + i - 1; }
};

std::vector<Run> number(const Segments& segments, PetscInt& count) {
  std::vector<PetscInt> of_point(segments.points.size(), -1);
  std::vector<Run> runs;
  count = 0;
  auto point = [&](int p) {
    if (of_point[p] < 0) of_point[p] = count++;
    return of_point[p];
  };
  for (std::size_t s = 0; s < segments.join.size(); ++s) {
    Run run;
    run.from = point(segments.join[s][0]);
    run.inner = count;
    count += segments.elements[s] - 1;
    run.to = point(segments.join[s][1]);
    runs.push_back(run);
  }
  return runs;
}

}  // namespace

Mesh mesh_of(MPI_Comm comm, const Segments& segments) {
  Mesh mesh;
  mesh.comm = comm;
  const std::vector<Run> runs = number(segments, mesh.node_count);
  PetscInt owned = PETSC_DECIDE;
  petsc::check(PetscSplitOwnership(comm, &owned, &mesh.node_count));
  mesh.owned_nodes = owned;
  PetscInt end = 0;
  MPI_Scan(&owned, &end, 1, MPIU_INT, MPI_SUM, comm);
  mesh.first_node = end - owned;

  // The first end of an element decides whose it is.
  struct Element {
    PetscInt nodes[2];
    int part;
  };
  std::vector<Element> mine;
  std::map<PetscInt, Eigen::Vector3d> position;
  for (std::size_t s = 0; s < runs.size(); ++s) {
    const PetscInt elements = segments.elements[s];
    const Eigen::Vector3d &from = segments.points[segments.join[s][0]], &to = segments.points[segments.join[s][1]];
    auto at = [&](PetscInt i) { return Eigen::Vector3d(from + (to - from) * (double(i) / double(elements))); };
    mesh.cell_count += elements;
    for (PetscInt i = 0; i < elements; ++i) {
      const Element element{{runs[s].node(i, elements), runs[s].node(i + 1, elements)}, static_cast<int>(s)};
      const bool own[2] = {element.nodes[0] >= mesh.first_node && element.nodes[0] < end,
                           element.nodes[1] >= mesh.first_node && element.nodes[1] < end};
      if (own[0]) mine.push_back(element);
      if (own[0] || own[1]) position.emplace(element.nodes[0], at(i)), position.emplace(element.nodes[1], at(i + 1));
    }
  }
  for (const Element& element : mine)
    for (PetscInt node : element.nodes)
      if (node < mesh.first_node || node >= end) mesh.foreign.push_back(node);
  std::sort(mesh.foreign.begin(), mesh.foreign.end());
  mesh.foreign.erase(std::unique(mesh.foreign.begin(), mesh.foreign.end()), mesh.foreign.end());

  auto local = [&](PetscInt node) {
    if (node >= mesh.first_node && node < end) return static_cast<int>(node - mesh.first_node);
    const auto found = std::lower_bound(mesh.foreign.begin(), mesh.foreign.end(), node);
    return static_cast<int>(owned + (found - mesh.foreign.begin()));
  };
  mesh.positions.resize(owned + mesh.foreign.size());
  for (const auto& [node, x] : position)
    if ((node >= mesh.first_node && node < end) || std::binary_search(mesh.foreign.begin(), mesh.foreign.end(), node))
      mesh.positions[local(node)] = x;
  for (const Element& element : mine)
    mesh.cells.emplace_back(CellKind::line, element.part,
                            Mesh::Cell::Nodes{local(element.nodes[0]), local(element.nodes[1])});
  return mesh;
}

void express_in_frame(Mesh& mesh, const Eigen::Vector3d& origin, const Eigen::Matrix3d& rotation) {
  for (Eigen::Vector3d& x : mesh.positions) x = rotation.transpose() * (x - origin);
  for (Mesh::Spin& spin : mesh.spins) spin.axis = rotation.transpose() * spin.axis;
}

const Mesh::Spin* spin_of(const Mesh& mesh, int local) {
  const auto found = std::lower_bound(mesh.spins.begin(), mesh.spins.end(), local,
                                      [](const Mesh::Spin& spin, int node) { return spin.node < node; });
  return found != mesh.spins.end() && found->node == local ? &*found : nullptr;
}

int spin_slot(const Eigen::Vector3d& axis) {
  int slot = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(axis[i]) > std::abs(axis[slot]) + 1e-6) slot = i;  // ties by the order of the axes
  return slot;
}

Eigen::Matrix3d Mesh::Spin::own() const {
  Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
  if (!others) {
    S.col(spin_slot(axis)) = axis;
  } else if (axis.isZero(0)) {
    S.setIdentity();
  } else {
    const int slot = spin_slot(axis), next = (slot + 1) % 3;
    S.col(next) = (Eigen::Vector3d::Unit(next) - axis[next] * axis).normalized();
    S.col((slot + 2) % 3) = axis[slot] < 0 ? Eigen::Vector3d(S.col(next).cross(axis)) : axis.cross(S.col(next));
  }
  return S;
}

std::vector<Eigen::Vector3d> positions_of(const Mesh& mesh, const std::vector<PetscInt>& nodes) {
  std::vector<Eigen::Vector3d> all(nodes.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (const PetscInt local = nodes[i] - mesh.first_node; local >= 0 && local < mesh.owned_nodes)
      all[i] = mesh.positions[local];
  MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(3 * all.size()), MPI_DOUBLE, MPI_SUM, mesh.comm);
  return all;
}

NearestNode nearest_node(const Mesh& mesh, const Eigen::Vector3d& point) {
  struct Candidate {
    double distance = std::numeric_limits<double>::infinity();
    PetscInt original = PETSC_MAX_INT, local = -1;
  } best;
  auto dependent_node = mesh.dependent_nodes.begin();
  for (PetscInt i = 0; i < mesh.owned_nodes; ++i) {
    const double distance = (mesh.positions[i] - point).norm();
    const bool follows = dependent_node != mesh.dependent_nodes.end() && dependent_node->node == i;
    if (follows) ++dependent_node;
    const PetscInt original = mesh.original_node(static_cast<int>(i)) + (follows ? mesh.node_count : 0);
    if (distance < best.distance || (distance == best.distance && original < best.original))
      best = {distance, original, i};
  }
  double least = best.distance;
  MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_DOUBLE, MPI_MIN, mesh.comm);
  PetscInt first = best.distance == least ? best.original : PETSC_MAX_INT;
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPIU_INT, MPI_MIN, mesh.comm);
  NearestNode found{0, least, Eigen::Vector3d::Zero()};
  if (best.local >= 0 && best.distance == least && best.original == first) {
    found.node = mesh.first_node + best.local;
    found.position = mesh.positions[best.local];
  }
  MPI_Allreduce(MPI_IN_PLACE, &found.node, 1, MPIU_INT, MPI_SUM, mesh.comm);
  MPI_Allreduce(MPI_IN_PLACE, found.position.data(), 3, MPI_DOUBLE, MPI_SUM, mesh.comm);
  return found;
}

Eigen::Vector3d near_origin(const Mesh& mesh) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
  for (const Eigen::Vector3d& x : mesh.positions) low = low.cwiseMin(x), high = high.cwiseMax(x);
  MPI_Allreduce(MPI_IN_PLACE, low.data(), 3, MPI_DOUBLE, MPI_MIN, mesh.comm);
  MPI_Allreduce(MPI_IN_PLACE, high.data(), 3, MPI_DOUBLE, MPI_MAX, mesh.comm);
  Eigen::Vector3d middle = (low + high) / 2;
  if (middle.norm() > 10 * (high - low).norm()) return middle;
  return Eigen::Vector3d::Zero();
}

}  // namespace floe::fem
