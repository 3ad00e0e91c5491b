#include <algorithm>
#include <numeric>

#include "floe/generate/generate.h"
#include "floe/mesh/exchange.h"
#include "join.h"
#include "share.h"

namespace floe::generate {
namespace {

// Positions of names in a list that grows by those it does not have.
std::vector<int> united(std::vector<std::string>& names, const std::vector<std::string>& more) {
  std::vector<int> positions;
  for (const auto& name : more) {
    const auto found = std::find(names.begin(), names.end(), name);
    positions.push_back(static_cast<int>(found - names.begin()));
    if (found == names.end()) names.push_back(name);
  }
  return positions;
}

struct PlacedNode {
  PetscInt number;
  double x[3];
};

struct PlacedCell {
  PetscInt number;
  Cell cell;
};

// One mesh on its way into the union.
struct Source {
  const RawMesh& mesh;
  const std::vector<PetscInt>&
      numbers;  // in the union, of the share's nodes; those below `first_new` are there already
  PetscInt first_new, first_cell;
  std::vector<int> parts;
};

// Numbers in the union of any nodes. Collective.
std::vector<PetscInt> numbers_of(const Source& source, const std::vector<PetscInt>& nodes) {
  const auto starts = starts_of(source.mesh.comm, static_cast<PetscInt>(source.mesh.positions.size()));
  return ask<PetscInt>(
      source.mesh.comm, nodes, [&](PetscInt node) { return owner_of(starts, node); },
      [&](PetscInt node) { return source.numbers[node - source.mesh.first_node]; });
}

std::vector<PlacedNode> placed_nodes(const Source& source) {
  std::vector<PlacedNode> nodes;
  for (std::size_t i = 0; i < source.numbers.size(); ++i) {
    const auto& x = source.mesh.positions[i];
    if (source.numbers[i] >= source.first_new) nodes.push_back({source.numbers[i], {x[0], x[1], x[2]}});
  }
  return nodes;
}

std::vector<PlacedCell> placed_cells(const Source& source) {
  std::vector<PetscInt> nodes;
  for (const auto& cell : source.mesh.cells)
    nodes.insert(nodes.end(), cell.nodes.begin(), cell.nodes.begin() + node_count(cell.kind));
  const auto numbers = numbers_of(source, nodes);
  std::vector<PlacedCell> cells;
  std::size_t next = 0;
  PetscInt number = source.first_cell + source.mesh.first_cell;
  for (Cell cell : source.mesh.cells) {
    for (int k = 0; k < node_count(cell.kind); ++k) cell.nodes[k] = numbers[next++];
    cell.part = source.parts[cell.part];
    cells.push_back({number++, cell});
  }
  return cells;
}

void add_places(const Source& source, RawMesh& mesh) {
  const auto positions = united(mesh.places, source.mesh.places);
  mesh.place_nodes.resize(mesh.places.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto numbers = numbers_of(source, source.mesh.place_nodes[i]);
    auto& nodes = mesh.place_nodes[positions[i]];
    nodes.insert(nodes.end(), numbers.begin(), numbers.end());
  }
}

// Sends each to the rank in whose share its number lies.
template <class Placed>
std::vector<Placed> shared_out(MPI_Comm comm, const std::vector<Placed>& placed, PetscInt total) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  std::vector<PetscInt> starts;
  for (int r = 0; r < ranks; ++r) starts.push_back(share_of(total, r, ranks).first);
  auto mine = scatter(comm, placed, [&](const Placed& p) { return owner_of(starts, p.number); }).values;
  std::sort(mine.begin(), mine.end(), [](const Placed& a, const Placed& b) { return a.number < b.number; });
  return mine;
}

RawMesh united(const std::vector<Source>& sources, PetscInt nodes, PetscInt cells) {
  RawMesh mesh;
  mesh.comm = sources.front().mesh.comm;
  mesh.node_count = nodes;
  mesh.cell_count = cells;
  std::vector<PlacedNode> all_nodes;
  std::vector<PlacedCell> all_cells;
  for (const Source& source : sources) {
    const auto more_nodes = placed_nodes(source);
    const auto more_cells = placed_cells(source);
    all_nodes.insert(all_nodes.end(), more_nodes.begin(), more_nodes.end());
    all_cells.insert(all_cells.end(), more_cells.begin(), more_cells.end());
    add_places(source, mesh);
    mesh.source += (mesh.source.empty() ? "" : " + ") + source.mesh.source;
  }
  int rank = 0, ranks = 1;
  MPI_Comm_rank(mesh.comm, &rank);
  MPI_Comm_size(mesh.comm, &ranks);
  mesh.first_node = share_of(nodes, rank, ranks).first;
  mesh.first_cell = share_of(cells, rank, ranks).first;
  for (const auto& [number, x] : shared_out(mesh.comm, all_nodes, nodes)) {
    mesh.positions.emplace_back(x[0], x[1], x[2]);
    mesh.node_labels.push_back(number + 1LL);
  }
  for (const auto& [number, cell] : shared_out(mesh.comm, all_cells, cells)) {
    mesh.cells.push_back(cell);
    mesh.cell_labels.push_back(number + 1LL);
  }
  return mesh;
}

}  // namespace

RawMesh merged(const RawMesh& first, const RawMesh& second, const std::vector<Seam>& seams, double tolerance) {
  Checks checks("merged");
  int same = MPI_UNEQUAL;
  MPI_Comm_compare(first.comm, second.comm, &same);
  checks.require(same == MPI_IDENT || same == MPI_CONGRUENT, "the meshes are on different communicators");
  checks.positive("tolerance", tolerance);
  checks.finish();
  std::vector<PetscInt> of_first(first.positions.size());
  std::iota(of_first.begin(), of_first.end(), first.first_node);
  auto of_second = joined_to(first, second, seams, tolerance);
  const auto fresh = static_cast<PetscInt>(std::count(of_second.begin(), of_second.end(), PetscInt{-1}));
  const auto starts = starts_of(first.comm, fresh);
  require_countable("merged", static_cast<double>(first.node_count) + static_cast<double>(starts.back()),
                    static_cast<double>(first.cell_count) + static_cast<double>(second.cell_count));
  int rank = 0;
  MPI_Comm_rank(first.comm, &rank);
  PetscInt next = first.node_count + starts[rank];
  for (PetscInt& number : of_second)
    if (number < 0) number = next++;
  std::vector<std::string> parts;
  const auto parts_of_first = united(parts, first.parts), parts_of_second = united(parts, second.parts);
  RawMesh mesh = united({{first, of_first, 0, 0, parts_of_first},
                         {second, of_second, first.node_count, first.cell_count, parts_of_second}},
                        first.node_count + starts.back(), first.cell_count + second.cell_count);
  mesh.parts = parts;
  return mesh;
}

}  // namespace floe::generate
