#include "reduced_file_shapes.h"

#include <fmt/format.h>

#include <algorithm>

#include "floe/petsc/error.h"
#include "reduced_file_hdf5.h"
#include "reserve.h"
#include "shape_rows.h"

namespace floe::output {
namespace {

/// Everything that can be seen without other ranks.
void check_mine(const ReducedBodyFile& file, const ReducedShapes& shapes) {
  const auto known = [&](std::int64_t node) { return node >= 0 && node < file.nodes; };
  need(shapes.dofs_per_node > 0 && shapes.dofs_per_node * file.nodes == file.dofs,
       fmt::format("{} dofs are not {} for each of {} nodes", file.dofs, shapes.dofs_per_node, file.nodes));
  need(shapes.positions.size() == shapes.nodes.size(), "each node needs a position");
  need(std::all_of(shapes.nodes.begin(), shapes.nodes.end(), known), "a node without position in the body");
  for (const auto& cell : shapes.cells) {
    const auto end = cell.nodes.begin() + corners(cell.kind);
    need(std::all_of(cell.nodes.begin(), end, known), "an element with a node that the body does not have");
    need(std::all_of(end, cell.nodes.end(), [](auto node) { return node == -1; }), "an element with too many nodes");
    need(cell.part >= 0 && cell.part < std::ssize(shapes.parts), "an element of a part without name");
  }
  for (const auto& [name, nodes] : shapes.sets)
    need(std::all_of(nodes.begin(), nodes.end(), known),
         fmt::format("set '{}': a node that the body does not have", name));
}

/// Each set ascending, each node once.
std::vector<Integers> sets_in_order(MPI_Comm comm, const Shares& shares, const ReducedShapes& shapes) {
  std::vector<Integers> all;
  for (const auto& [name, nodes] : shapes.sets) {
    Integers came = Route(comm, shares, nodes).send<std::int64_t>(nodes, 1);
    std::sort(came.begin(), came.end());
    came.erase(std::unique(came.begin(), came.end()), came.end());
    all.push_back(std::move(came));
  }
  return all;
}

Integers starts_of_sets(MPI_Comm comm, const std::vector<Integers>& sets) {
  Integers starts{0};
  for (const Integers& nodes : sets) starts.push_back(starts.back() + sum(comm, std::ssize(nodes)));
  return starts;
}

void write_sets(MPI_Comm comm, hid_t file, const std::vector<Integers>& sets, const Integers& starts) {
  Hid dataset;
  petsc::agree(comm, [&] {
    dataset = create_dataset<std::int64_t>(file, "shapes/sets/nodes", {hsize_t(starts.back())},
                                           {"", "original numbers; of set i from start[i] up to start[i+1]"});
  });
  for (std::size_t i = 0; i < sets.size(); ++i) {
    const hsize_t first = starts[i] + sum_before(comm, std::ssize(sets[i]));
    petsc::agree(comm, [&] { write_rows<std::int64_t>(dataset, {first}, {sets[i].size()}, sets[i], true); });
  }
  petsc::agree(comm, [&] { dataset.close(); });
}

/// Of texts that are filled up to the longest.
std::uint64_t bytes_of(const std::vector<std::string>& texts) {
  std::size_t longest = 1;
  for (const auto& text : texts) longest = std::max(longest, text.size());
  return longest * texts.size();
}

/// Names and starts: what rank 0 writes by itself, before the file is opened by all.
void write_lists(const std::filesystem::path& draft, const ReducedShapes& shapes, const Integers& starts) {
  std::vector<std::string> names;
  for (const auto& [name, nodes] : shapes.sets) names.push_back(name);
  reserve(draft, starts.size() * sizeof(std::int64_t) + bytes_of(names) + bytes_of(shapes.parts));
  Hid file = open_file(draft, Open::change, MPI_COMM_NULL);
  write_texts(file, "shapes/parts", shapes.parts, {});
  write_texts(file, "shapes/sets/names", names, {});
  write_whole<std::int64_t>(file, "shapes/sets/start", {starts.size()}, starts, {});
  file.close();
}

}  // namespace

void add_shapes(MPI_Comm comm, const std::filesystem::path& draft, const ReducedBodyFile& body,
                const ReducedShapes& shapes) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  petsc::agree(comm, [&] { check_mine(body, shapes); });
  const std::int64_t cells = sum(comm, std::ssize(shapes.cells));
  petsc::agree(comm,
               [&] { need(cells >= body.cells, fmt::format("{} elements, the body has {}", cells, body.cells)); });
  const Shares shares(comm, body.nodes);
  const NodeRows rows(comm, shares, shapes.nodes);
  const auto sets = sets_in_order(comm, shares, shapes);
  const Integers starts = starts_of_sets(comm, sets);
  petsc::agree(comm, [&] {
    if (rank != 0) return;
    write_lists(draft, shapes, starts);
    reserve(draft, sizeof(double) *
                       (body.nodes * 3 + body.dofs * body.body.coordinates() + cells * cell_width + starts.back()));
  });
  Hid file;
  petsc::agree(comm, [&] { file = open_file(draft, Open::change, comm); });
  write_positions(comm, file, "shapes", body.nodes, rows, shapes);
  write_cells(comm, file, "shapes/cells", cells, cells_in_order(comm, shares, shapes.cells));
  write_sets(comm, file, sets, starts);
  write_columns(comm, file, "shapes/basis", body.body.coordinates(), body.nodes, rows, shapes,
                {"kg^-1/2; rotations: rad m^-1 kg^-1/2", "in the axes of the floating frame"});
  petsc::agree(comm, [&] { file.close(); });
}

}  // namespace floe::output
