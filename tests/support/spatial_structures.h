#pragma once
#include <functional>
#include <map>
#include <numeric>

#include "floe/generate/generate.h"
#include "floe/mesh/exchange.h"
#include "floe/mesh/partition.h"
#include "floe/mesh/pieces.h"
#include "random.h"
#include "structures.h"

/// Bodies in space with all kinds of cells, on any partition of their nodes over the ranks.
namespace floe::testing {

enum class Spread { metis, shuffled, reversed, last };  ///< reversed: the first nodes on the last rank; last: all

inline int size_of(MPI_Comm comm) {
  int size = 1;
  MPI_Comm_size(comm, &size);
  return size;
}

/// Ranks of the nodes of this rank's share; on one rank all are its own.
inline std::vector<int> ranks_of(const mesh::RawMesh& raw, Spread spread) {
  const int size = size_of(raw.comm);
  if (spread == Spread::metis && size > 1) return mesh::partition(raw);
  Random random(5);
  std::vector<int> all(static_cast<std::size_t>(raw.node_count), size - 1);
  if (spread == Spread::shuffled)
    for (int& rank : all) rank = std::min(size - 1, static_cast<int>(size * (random.number() + 1) / 2));
  if (spread == Spread::reversed)
    for (PetscInt i = 0; i < raw.node_count; ++i) all[i] = size - 1 - static_cast<int>(i * size / raw.node_count);
  return {all.begin() + raw.first_node, all.begin() + raw.first_node + static_cast<long>(raw.positions.size())};
}

inline fem::Structure structure_of(const mesh::RawMesh& raw, std::vector<fem::Section> sections, Spread spread) {
  return {fem::mesh_of(raw, ranks_of(raw, spread)), std::move(sections), fem::MembraneStrain::averaged};
}

/// A cell of one node, in a part of its own. Collective.
inline void add_point(mesh::RawMesh& raw, PetscInt node) {
  int rank = 0;
  MPI_Comm_rank(raw.comm, &rank);
  raw.parts.push_back("point");
  const int part = static_cast<int>(raw.parts.size()) - 1;
  if (node >= raw.first_node && node < raw.first_node + static_cast<PetscInt>(raw.positions.size())) {
    raw.cells.push_back({mesh::CellKind::point, {node, -1, -1, -1}, part});
    raw.cell_labels.push_back(0);
  }
  const std::vector<PetscInt> starts = mesh::starts_of(raw.comm, static_cast<PetscInt>(raw.cells.size()));
  raw.first_cell = starts[rank], raw.cell_count = starts.back();
}

/// Triangles on [0, 1] x [0, 1], quadrilaterals that go on from x = 1 upwards to (1.8, y, 0.6), a mast of beams from
/// (1.8, 0, 0.6) to (1.8, -0.5, 1.4), and a point mass on its top. Collective.
inline mesh::RawMesh mixed_mesh(MPI_Comm comm) {
  generate::Plate floor{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3, 2}, ramp{{1, 0, 0}, {0.8, 0, 0.6}, {0, 1, 0}, 2, 2};
  ramp.cells = generate::ShellCells::quadrilaterals;
  const auto shells =
      generate::merged(generate::prefixed(generate::plate(comm, floor), "floor."),
                       generate::prefixed(generate::plate(comm, ramp), "ramp."), {{"floor.right", "ramp.left"}}, 1e-9);
  const auto mast = generate::polyline(comm, {{{1.8, 0, 0.6}, {1.8, -0.5, 1.4}}, {}, {3}, {"mast"}});
  mesh::RawMesh raw = generate::merged(shells, mast, {{"ramp.p2", "start"}}, 1e-9);
  add_point(raw, raw.node_count - 1);
  return raw;
}

/// The same mesh with elements of second order: nodes in the middles of edges follow the others, and lie off the chords
/// where `curved` says so of the chord's middle. Collective.
inline mesh::RawMesh second_order(const mesh::RawMesh& raw,
                                  const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& curved) {
  const auto of_all = [&](const auto& mine) {
    std::decay_t<decltype(mine)> copies;
    for (int r = 0; r < size_of(raw.comm); ++r) copies.insert(copies.end(), mine.begin(), mine.end());
    return mesh::exchange(raw.comm, copies, std::vector<int>(size_of(raw.comm), static_cast<int>(mine.size()))).values;
  };
  std::vector<std::array<double, 3>> mine;
  for (const Eigen::Vector3d& x : raw.positions) mine.push_back({x[0], x[1], x[2]});
  std::vector<Eigen::Vector3d> positions;
  for (const auto& x : of_all(mine)) positions.emplace_back(x[0], x[1], x[2]);
  std::vector<mesh::Cell> cells = of_all(raw.cells);
  std::map<std::pair<PetscInt, PetscInt>, PetscInt> middles;
  for (mesh::Cell& cell : cells) {
    const int n = mesh::corner_count(cell.kind);
    if (n < 2) continue;
    for (int i = 0; i < (n == 2 ? 1 : n); ++i) {
      const PetscInt a = cell.nodes[i], b = cell.nodes[(i + 1) % n];
      const auto [at, made] = middles.try_emplace(std::minmax(a, b), static_cast<PetscInt>(positions.size()));
      if (made) positions.push_back(curved((positions[a] + positions[b]) / 2));
      cell.nodes[n + i] = at->second;
    }
    cell.kind = static_cast<mesh::CellKind>(static_cast<int>(cell.kind) + 3);
  }
  int rank = 0;
  MPI_Comm_rank(raw.comm, &rank);
  mesh::RawMesh out = raw;
  out.node_count = static_cast<PetscInt>(positions.size());
  const mesh::Share nodes = mesh::share_of(out.node_count, rank, size_of(raw.comm)),
                    elements = mesh::share_of(out.cell_count, rank, size_of(raw.comm));
  out.first_node = nodes.first, out.first_cell = elements.first;
  out.positions.assign(positions.begin() + nodes.first, positions.begin() + nodes.first + nodes.count);
  out.cells.assign(cells.begin() + elements.first, cells.begin() + elements.first + elements.count);
  out.node_labels.assign(out.positions.size(), 0), out.cell_labels.assign(out.cells.size(), 0);
  return out;
}

enum class Order { first, second };

/// The mixed mesh; of second order with edges off their chords but where its hinge lines are.
inline mesh::RawMesh mixed_mesh(MPI_Comm comm, Order order) {
  if (order == Order::first) return mixed_mesh(comm);
  return second_order(mixed_mesh(comm), [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    if (std::hypot(x[0] - 1.8, x[2] - 0.6) < 1e-9 || std::hypot(x[0] + x[1] / 1.5 - 1, x[2]) < 1e-9) return x;
    return x + 0.02 * Eigen::Vector3d(std::sin(9 * x.y() + x.x()), std::cos(7 * x.x()), std::sin(8 * x.x() + x.y()));
  });
}

/// Sections of the mixed mesh: a soft shell, a layered one with coupling, an unsymmetric beam with strains of
/// second order, a mass with an offset.
/// @param strains  of the shells
inline std::vector<fem::Section> mixed_sections(fem::Strains strains = fem::Strains::von_karman) {
  const fem::ShellMaterial ply{900, 300, 0.25, 150, 2};
  fem::SpatialBeam beam{{400, 3, 5, 1, 2, 3, 0.02, 0.03, 0.005, {0.02, -0.01}, {0.01, 0.03}}, {1, 0, 0}, {}};
  beam.strain.strains = fem::Strains::second_order;
  fem::ShellSection floor = fem::shell_section({{fem::isotropic(500, 0.3, 4), 0.1, 0}}),
                    ramp = fem::shell_section({{ply, 0.06, 0}, {ply, 0.04, 0.9}}, 0.02, {0, 1, 0});
  floor.strains = ramp.strains = strains;
  return {floor, ramp, beam, fem::PointMass{0.7, Eigen::Vector3d(0.03, 0.04, 0.05).asDiagonal(), {0.1, 0, 0.2}}};
}

inline fem::Structure mixed_structure(MPI_Comm comm, Spread spread, fem::Strains strains = fem::Strains::von_karman,
                                      Order order = Order::first) {
  return structure_of(mixed_mesh(comm, order), mixed_sections(strains), spread);
}

/// Nodes of the mixed mesh that follow others rigidly: two of the shells', and the one where the mast stands.
inline std::vector<mesh::DependentNode> mixed_links() { return {{2, 5}, {9, 0}, {13, 5}}; }

/// The mixed mesh with dependent nodes.
inline fem::Structure structure_with(MPI_Comm comm, Spread spread,
                                     const std::vector<mesh::DependentNode>& dependent_nodes,
                                     fem::Strains strains = fem::Strains::von_karman, Order order = Order::first) {
  const mesh::RawMesh raw = mixed_mesh(comm, order);
  return {fem::mesh_of(raw, ranks_of(raw, spread), dependent_nodes), mixed_sections(strains),
          fem::MembraneStrain::averaged};
}

inline fem::Structure linked_structure(MPI_Comm comm, Spread spread, fem::Strains strains = fem::Strains::von_karman,
                                       Order order = Order::first) {
  return structure_with(comm, spread, mixed_links(), strains, order);
}

/// Hinge lines of the mixed mesh: the edge where the ramp ends and the mast stands, and an oblique one across the
/// floor; with links, each has a node in common with a piece.
inline std::vector<mesh::DependentNode> mixed_lines(bool links, Order order = Order::first) {
  const mesh::RawMesh raw = mixed_mesh(PETSC_COMM_SELF, order);
  const auto on = [&](auto&& where) {
    std::vector<PetscInt> nodes;
    for (PetscInt i = 0; i < raw.node_count; ++i)
      if (where(raw.positions[i])) nodes.push_back(i);
    return nodes;
  };
  const double length = std::hypot(2, 3);
  return mesh::with_lines(links ? mixed_links() : std::vector<mesh::DependentNode>{},
                          {{on([](const auto& x) { return std::hypot(x[0] - 1.8, x[2] - 0.6) < 1e-9; }), {0, 1, 0}},
                           {on([](const auto& x) { return std::hypot(x[0] + x[1] / 1.5 - 1, x[2]) < 1e-9; }),
                            {-2 / length, 3 / length, 0}}});
}
inline fem::Structure hinged_structure(MPI_Comm comm, Spread spread, bool links,
                                       fem::Strains strains = fem::Strains::von_karman, Order order = Order::first) {
  return structure_with(comm, spread, mixed_lines(links, order), strains, order);
}

/// Nodes of the mixed mesh with rotations of their own: all, about an axis, and about all others; and one without.
inline std::vector<mesh::DependentNode> mixed_loose() {
  return {{1, 0}, {2, 5, {}, true}, {9, 0, {0.6, 0, 0.8}}, {13, 5, {0.48, 0.6, 0.64}, true}};
}

/// Values by original dofs, the same on every rank, of a field; and the way back. Collective.
inline Eigen::VectorXd in_original_order(const fem::Structure& s, Vec field) {
  petsc::Values own(field);
  Eigen::VectorXd all = Eigen::VectorXd::Zero(s.dofs());
  for (PetscInt i = 0; i < s.owned_dofs(); ++i) all[s.original_dof(static_cast<int>(i))] = own[own.first + i];
  MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), MPI_DOUBLE, MPI_SUM, s.mesh.comm);
  return all;
}
inline petsc::VecHandle field_of_originals(const fem::Structure& s, const Eigen::VectorXd& values) {
  petsc::VecHandle field = fem::field(s);
  petsc::Values own(field);
  for (PetscInt i = 0; i < s.owned_dofs(); ++i) own[own.first + i] = values[s.original_dof(static_cast<int>(i))];
  return field;
}

/// A x for x by original dofs, which y is too. Collective.
inline Eigen::VectorXd product_in_originals(const fem::Structure& s, Mat A, const Eigen::VectorXd& x) {
  const petsc::VecHandle from = field_of_originals(s, x), to = fem::field(s);
  petsc::check(MatMult(A, from, to));
  return in_original_order(s, to);
}

/// Global dofs, ascending, of nodes given by original numbers. Collective.
inline fem::Conditions dofs_of(const fem::Structure& s, const std::vector<PetscInt>& originals,
                               const std::vector<int>& directions) {
  fem::Conditions dofs;
  for (PetscInt node : fem::global_nodes(s.mesh, originals))
    for (int d : directions) dofs.push_back(s.dofs_per_node * node + d);
  std::sort(dofs.begin(), dofs.end());
  return dofs;
}

/// Original numbers of nodes where a function of the position holds, ascending, on every rank. Collective.
template <class Where>
std::vector<PetscInt> nodes_where(const fem::Structure& s, Where&& where) {
  std::vector<int> found(static_cast<std::size_t>(s.mesh.node_count), 0);
  for (PetscInt i = 0; i < s.mesh.owned_nodes; ++i)
    if (where(s.mesh.positions[i])) found[s.mesh.original_node(static_cast<int>(i))] = 1;
  MPI_Allreduce(MPI_IN_PLACE, found.data(), static_cast<int>(found.size()), MPI_INT, MPI_SUM, s.mesh.comm);
  std::vector<PetscInt> nodes;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (found[i] > 0) nodes.push_back(static_cast<PetscInt>(i));
  return nodes;
}

}  // namespace floe::testing
