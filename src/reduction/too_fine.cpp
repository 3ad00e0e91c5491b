#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "floe/fem/element_count.h"
#include "floe/math/disjoint_sets.h"
#include "floe/petsc/all_ranks.h"
#include "floe/reduction/statics.h"

namespace floe::reduction {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Root of bending over membrane stiffness, of a beam the lesser one. [m] Infinite where there is no such ratio.
struct RadiusOfGyration {
  static double of(double bending, double membrane) {
    return bending > 0 && membrane > 0 ? std::sqrt(bending / membrane) : std::numeric_limits<double>::infinity();
  }
  double operator()(const fem::BeamSection& section) const { return of(section.EI, section.EA); }
  double operator()(const fem::SpatialBeam& beam) const {
    if (beam.releases.any()) return std::numeric_limits<double>::infinity();
    return std::min(of(beam.section.EIy, beam.section.EA), of(beam.section.EIz, beam.section.EA));
  }
  double operator()(const fem::ShellSection& shell) const { return of(shell.D()(0, 0), shell.A(0, 0)); }
  double operator()(const fem::PointMass&) const { return std::numeric_limits<double>::infinity(); }
  double operator()(const fem::NodeSpring&) const { return std::numeric_limits<double>::infinity(); }
};

/// h, r of the cell with the greatest h/r, and whether the body bends without stretching its cells in any direction of
/// space: lines along one direction, shells with one normal.
struct Cells {
  double h = 0, r = 0;
  bool plain = true;
};

Vector3d direction(const fem::Mesh& mesh, const fem::Mesh::Cell& cell) {
  const auto at = [&](int corner) { return mesh.positions[cell.place[corner]]; };
  const Vector3d along = at(1) - at(0);
  return cell.corners().size() < 3 ? along : Vector3d(along.cross(at(2) - at(0)));
}

Cells cells_of(const fem::Structure& structure) {
  const fem::Mesh& mesh = structure.mesh;
  double least[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};  // r/h; r
  Matrix3d directions = Matrix3d::Zero();
  for (const fem::Mesh::Cell& cell : mesh.cells) {
    if (!mesh::has_extent(cell.kind)) continue;
    const double h = (mesh.positions[cell.place[1]] - mesh.positions[cell.place[0]]).norm(),
                 r = std::visit(RadiusOfGyration(), structure.sections[cell.part]);
    if (r / h < least[0]) least[0] = r / h, least[1] = r;
    const Vector3d d = direction(mesh, cell).normalized();
    directions += d * d.transpose();
  }
  double all[2] = {least[0], std::numeric_limits<double>::infinity()};
  MPI_Allreduce(least, all, 1, MPI_DOUBLE, MPI_MIN, mesh.comm);
  if (least[0] > all[0]) least[1] = std::numeric_limits<double>::infinity();
  MPI_Allreduce(least + 1, all + 1, 1, MPI_DOUBLE, MPI_MIN, mesh.comm);
  MPI_Allreduce(MPI_IN_PLACE, directions.data(), 9, MPI_DOUBLE, MPI_SUM, mesh.comm);
  const Vector3d values = Eigen::SelfAdjointEigenSolver<Matrix3d>(directions, Eigen::EigenvaluesOnly).eigenvalues();
  return {all[1] / all[0], all[1], values[1] <= 1e-12 * values[2]};
}

/// Quadrilaterals of second order that share no edge with another shell. Collective.
PetscInt lone_quadrilaterals(const fem::Structure& structure) {
  const fem::Mesh& mesh = structure.mesh;
  const Eigen::Index n = structure.dofs_per_node;
  const auto each_middle = [&](const auto& visit) {
    for (const fem::Mesh::Cell& cell : mesh.cells)
      if (mesh::is_quadratic(cell.kind) && !mesh::is_line(cell.kind)) {
        const auto places = cell.places();
        for (std::size_t i = places.size() / 2; i < places.size(); ++i) visit(cell, n * places[i]);
      }
  };
  Eigen::VectorXd here = Eigen::VectorXd::Zero(n * std::ssize(mesh.positions));
  each_middle([&](const fem::Mesh::Cell&, Eigen::Index at) { here[at] += 1; });
  const petsc::VecHandle count = fem::field(structure);
  structure.exchange.add(here, count);
  const Eigen::VectorXd all = structure.exchange.gather(count);
  std::map<const fem::Mesh::Cell*, bool> lone;
  each_middle([&](const fem::Mesh::Cell& cell, Eigen::Index at) {
    bool& one = lone.try_emplace(&cell, cell.places().size() == 8).first->second;
    one = one && all[at] < 1.5;
  });
  PetscInt sum = std::count_if(lone.begin(), lone.end(), [](const auto& one) { return one.second; });
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPIU_INT, MPI_SUM, mesh.comm);
  return sum;
}

/// Pairs of the global numbers of nodes that cells connect: a, b, a, b, ...
std::vector<PetscInt> connections(const fem::Mesh& mesh, bool of_springs) {
  std::vector<PetscInt> pairs;
  for (const fem::Mesh::Cell& cell : mesh.cells)
    for (const int node : cell.nodes())
      if ((cell.kind == fem::CellKind::spring) == of_springs)
        pairs.insert(pairs.end(), {mesh.global_node(cell.nodes().front()), mesh.global_node(node)});
  return pairs;
}

/// Whether a spring connects nodes that no other elements do; not those of a straight edge. Collective.
bool springs_connect(const fem::Mesh& mesh) {
  const std::vector<PetscInt> springs = petsc::of_all_ranks(mesh.comm, connections(mesh, true));
  if (springs.empty()) return false;
  math::DisjointSets<PetscInt> components(static_cast<std::size_t>(mesh.node_count));
  const std::vector<PetscInt> others = petsc::of_all_ranks(mesh.comm, connections(mesh, false));
  for (std::size_t i = 0; i < others.size(); i += 2) components.join(others[i], others[i + 1]);
  for (std::size_t i = 0; i < springs.size(); i += 2)
    if (components.root(springs[i]) != components.root(springs[i + 1])) return true;
  return false;
}

/// Whether parts of the body may move relative to each other without stiffness. Collective.
bool may_be_loose(const fem::Structure& structure) {
  const bool released = std::any_of(structure.sections.begin(), structure.sections.end(), [](const auto& section) {
    const auto* beam = std::get_if<fem::SpatialBeam>(&section);
    return beam && beam->releases.any();
  });
  const fem::Mesh& mesh = structure.mesh;
  bool hinged = std::any_of(mesh.dependent_nodes.begin(), mesh.dependent_nodes.end(), [&](const auto& f) {
    const fem::Mesh::Spin* spin = fem::spin_of(mesh, f.node);  // line hinges have arms along their axes
    const Vector3d arm = mesh.positions[f.node] - mesh.positions[f.independent_node];
    return spin && (spin->others || !(arm.dot(spin->axis) * arm.dot(spin->axis) > (1 - 1e-6) * arm.squaredNorm()));
  });
  MPI_Allreduce(MPI_IN_PLACE, &hinged, 1, MPI_C_BOOL, MPI_LOR, mesh.comm);
  return released || hinged || springs_connect(mesh);
}

}  // namespace

RunError too_fine(const fem::Structure& structure, const std::string& what) {
  if (const PetscInt lone = structure.dimension() == 3 ? lone_quadrilaterals(structure) : 0; lone > 0)
    return RunError(fmt::format(
        "{}: {} of {} elements {} of second order (S8R) without an edge in common with another shell; by reduced "
        "integration two motions of such an element cost no energy, which is the cause if the joints leave them free; "
        "take two or more of them side by side, elements of first order, or joints that constrain one of its edges",
        what, lone, fem::element_count(structure.mesh), lone == 1 ? "is a quadrilateral" : "are quadrilaterals"));
  const Cells cells = cells_of(structure);
  const double length = fem::extent(structure);
  if (may_be_loose(structure))
    return RunError(fmt::format(
        "{}: springs, released ends of beams or links that leave rotations free may leave a motion without stiffness "
        "within the body (a hinge needs two bodies and a joint), or the mesh of {} elements is finer than double "
        "precision resolves",
        what, fem::element_count(structure.mesh)));
  if (cells.plain || !(cells.h > 10 * cells.r))  // (L/h)^4, the bending of a cell against that of the body
    return RunError(
        fmt::format("the mesh of {} elements is finer than double precision resolves: {}; take fewer elements",
                    fem::element_count(structure.mesh), what));
  return RunError(fmt::format(
      "the body is thinner than double precision resolves: {}; where it is bent or folded, an element of {:.2g} m with "
      "the radius of gyration {:.2g} m stretches (L/h)^2 (L/r)^2 = {:.1g} times as stiffly as the whole of {:.2g} m "
      "bends; take a thicker section (twice as thick: a quarter), or fewer elements (half as many along it: a quarter)",
      what, cells.h, cells.r, std::pow(length / cells.h * length / cells.r, 2), length));
}

}  // namespace floe::reduction
