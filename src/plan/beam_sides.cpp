#include "floe/plan/beam_sides.h"

#include <algorithm>
#include <array>
#include <map>

#include "floe/fem/quadratic_beam.h"
#include "floe/mesh/exchange.h"

namespace floe::plan {
namespace {

/// A cell of any rank: the nodes that move it; of beams where it is, and of these nodes the one that each follows but
/// for rotations of its own, or -1.
struct Seen {
  int rank, cell;
  std::vector<PetscInt> moved, ends, followed;
};

/// Numbers of all ranks, rank by rank. Collective.
mesh::Received<PetscInt> of_all_ranks(MPI_Comm comm, const std::vector<PetscInt>& mine) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  std::vector<PetscInt> copies;
  for (int r = 0; r < ranks; ++r) copies.insert(copies.end(), mine.begin(), mine.end());
  return mesh::exchange(comm, copies, std::vector<int>(ranks, static_cast<int>(mine.size())));
}

std::vector<Seen> all_cells(const fem::Mesh& mesh) {
  std::vector<PetscInt> mine;
  for (const fem::Mesh::Cell& cell : mesh.cells) {
    const bool beam = mesh::is_line(cell.kind);
    mine.push_back(static_cast<PetscInt>(cell.nodes().size()));
    mine.push_back(beam ? static_cast<PetscInt>(cell.places().size()) : 0);
    for (const int node : cell.nodes()) mine.push_back(mesh.global_node(node));
    if (!beam) continue;
    for (const int node : cell.places()) mine.push_back(mesh.global_node(node));
    for (std::size_t i = 0; i < cell.places().size(); ++i)
      mine.push_back(cell.line[i] < 0 ? -1 : mesh.global_node(cell.moved[cell.line[i]]));
  }
  const mesh::Received<PetscInt> all = of_all_ranks(mesh.comm, mine);
  std::vector<Seen> cells;
  for (std::size_t rank = 0; rank + 1 < all.starts.size(); ++rank)
    for (int at = all.starts[rank], number = 0; at < all.starts[rank + 1]; ++number) {
      const auto moved = all.values.begin() + at + 2, ends = moved + all.values[at],
                 followed = ends + all.values[at + 1];
      at += 2 + static_cast<int>(all.values[at] + 2 * all.values[at + 1]);
      cells.push_back(
          {static_cast<int>(rank), number, {moved, ends}, {ends, followed}, {followed, all.values.begin() + at}});
    }
  return cells;
}

/// Axes of the section at the i-th node of a beam, and the way from there along the element.
void see_element(const fem::Structure& structure, const fem::Mesh::Cell& cell, std::size_t i, BeamSide& side) {
  const auto x = [&](int node) -> const Eigen::Vector3d& { return structure.mesh.positions[cell.place[node]]; };
  side.away = i == 0 ? x(1) - x(0) : x(0) - x(1);
  if (const auto* beam = std::get_if<fem::SpatialBeam>(&structure.sections[cell.part])) {
    side.axes = cell.kind == fem::CellKind::line
                    ? fem::element_axes({x(0), x(1), beam->orientation})
                    : fem::quadratic_beam_shares({x(0), x(1), x(2), beam->orientation})[i].axes;
    return;
  }
  const Eigen::Vector3d along = (x(1) - x(0)).normalized();
  side.axes << along, Eigen::Vector3d(-along.y(), along.x(), 0), Eigen::Vector3d::UnitZ();
}

/// Marks what hangs on a cell without the nodes `by`.
std::vector<char> hanging(const std::vector<Seen>& cells, const std::map<PetscInt, std::vector<std::size_t>>& at,
                          std::size_t first, const std::array<PetscInt, 2>& by, std::vector<char>& nodes) {
  std::vector<char> marked(cells.size(), 0);
  std::vector<std::size_t> next{first};
  marked[first] = 1;
  while (!next.empty()) {
    const Seen& cell = cells[next.back()];
    next.pop_back();
    for (const PetscInt node : cell.moved) {
      if (std::find(by.begin(), by.end(), node) != by.end() || nodes[static_cast<std::size_t>(node)]) continue;
      nodes[static_cast<std::size_t>(node)] = 1;
      for (const std::size_t other : at.at(node))
        if (!std::exchange(marked[other], 1)) next.push_back(other);
    }
  }
  return marked;
}

}  // namespace

std::vector<BeamSide> beam_sides(const fem::Structure& structure, PetscInt node) {
  const fem::Mesh& mesh = structure.mesh;
  int rank = 0;
  MPI_Comm_rank(mesh.comm, &rank);
  const std::vector<Seen> cells = all_cells(mesh);
  std::map<PetscInt, std::vector<std::size_t>> at;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (const PetscInt moved : cells[c].moved) at[moved].push_back(c);
  std::vector<BeamSide> sides;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto found = std::find(cells[c].ends.begin(), cells[c].ends.end(), node);
    if (found == cells[c].ends.end()) continue;
    const auto i = static_cast<std::size_t>(found - cells[c].ends.begin());
    BeamSide& side = sides.emplace_back();
    side.after = i == 0, side.middle = i == 2, side.by = cells[c].moved[i];
    side.nodes.assign(static_cast<std::size_t>(mesh.node_count), 0);
    const std::array<PetscInt, 2> by{side.by, cells[c].followed[i]};
    const std::vector<char> marked = hanging(cells, at, c, by, side.nodes);
    side.cells.assign(mesh.cells.size(), 0);
    for (std::size_t other = 0; other < cells.size(); ++other) {
      if (!marked[other]) continue;
      if (cells[other].rank == rank) side.cells[static_cast<std::size_t>(cells[other].cell)] = 1;
      const auto& moved = cells[other].moved;
      if (other != c && std::find_first_of(moved.begin(), moved.end(), by.begin(), by.end()) != moved.end())
        side.separates = false;
    }
    if (cells[c].rank == rank) {
      side.cell = cells[c].cell;
      see_element(structure, mesh.cells[static_cast<std::size_t>(side.cell)], i, side);
    }
    MPI_Allreduce(MPI_IN_PLACE, side.axes.data(), 9, MPI_DOUBLE, MPI_SUM, mesh.comm);
    MPI_Allreduce(MPI_IN_PLACE, side.away.data(), 3, MPI_DOUBLE, MPI_SUM, mesh.comm);
  }
  return sides;
}

}  // namespace floe::plan
