#include "ordered_rows.h"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>

#include "floe/petsc/error.h"
#include "reduced_file_hdf5.h"

namespace floe::output {

void need(bool condition, const std::string& what) {
  if (!condition) throw RunError("shapes: " + what);
}

std::int64_t sum(MPI_Comm comm, std::int64_t mine) {
  MPI_Allreduce(MPI_IN_PLACE, &mine, 1, MPI_INT64_T, MPI_SUM, comm);
  return mine;
}

std::int64_t sum_before(MPI_Comm comm, std::int64_t mine) {
  std::int64_t before = 0;
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  MPI_Exscan(&mine, &before, 1, MPI_INT64_T, MPI_SUM, comm);
  return rank == 0 ? 0 : before;
}

template <class Number>
void write_shared(MPI_Comm comm, hid_t file, const std::string& name, const Extent& shape, hsize_t first,
                  const std::vector<Number>& rows, const Label& label) {
  petsc::agree(comm, [&] {
    Hid dataset = create_dataset<Number>(file, name, shape, label);
    Extent start(shape.size(), 0), count = shape;
    start[0] = first;
    const hsize_t width = std::accumulate(shape.begin() + 1, shape.end(), hsize_t{1}, std::multiplies<>());
    count[0] = rows.size() / width;
    write_rows<Number>(dataset, start, count, rows, true);
    dataset.close();
  });
}
template void write_shared(MPI_Comm, hid_t, const std::string&, const Extent&, hsize_t, const std::vector<double>&,
                           const Label&);
template void write_shared(MPI_Comm, hid_t, const std::string&, const Extent&, hsize_t, const Integers&, const Label&);

NodeRows::NodeRows(MPI_Comm comm, const Shares& shares, const Integers& nodes) : route_(comm, shares, nodes) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  first_ = shares.first(rank);
  numbers_ = route_.send<std::int64_t>(nodes, 1);
  petsc::agree(comm, [&] {
    Integers sorted = numbers_, all(shares.size(rank));
    std::sort(sorted.begin(), sorted.end());
    std::iota(all.begin(), all.end(), first_);
    need(sorted == all, "each node must be on exactly one rank");
  });
}

std::vector<double> NodeRows::in_order(std::span<const double> rows, int width) const {
  const auto came = route_.send<double>(rows, width);
  std::vector<double> sorted(came.size());
  for (std::size_t i = 0; i < numbers_.size(); ++i)
    std::copy_n(came.begin() + i * width, width, sorted.begin() + (numbers_[i] - first_) * width);
  return sorted;
}

int corners(ReducedShapes::Kind kind) {
  using Kind = ReducedShapes::Kind;
  return kind == Kind::vertex ? 1 : kind == Kind::line ? 2 : kind == Kind::triangle ? 3 : 4;
}

Integers cells_in_order(MPI_Comm comm, const Shares& shares, const std::vector<ReducedShapes::Cell>& cells) {
  Integers firsts, rows;
  for (const auto& cell : cells) {
    firsts.push_back(cell.nodes[0]);
    rows.insert(rows.end(), cell.nodes.begin(), cell.nodes.end());
    rows.insert(rows.end(), {cell.part, static_cast<std::int64_t>(cell.kind)});
  }
  const Integers came = Route(comm, shares, firsts).send<std::int64_t>(rows, cell_width);
  std::vector<std::array<std::int64_t, cell_width>> sorted(came.size() / cell_width);
  for (std::size_t i = 0; i < sorted.size(); ++i) std::copy_n(&came[i * cell_width], cell_width, sorted[i].begin());
  std::sort(sorted.begin(), sorted.end());
  Integers all;
  for (const auto& cell : sorted) all.insert(all.end(), cell.begin(), cell.end());
  return all;
}

namespace {

Integers first_nodes(const std::vector<ReducedShapes::Cell>& cells) {
  Integers firsts;
  for (const auto& cell : cells) firsts.push_back(cell.nodes[0]);
  return firsts;
}

/// Of the cells that come to this rank, by (nodes, part, kind). Collective.
std::vector<std::size_t> cell_order(const Route& route, const std::vector<ReducedShapes::Cell>& cells) {
  Integers rows;
  for (const auto& cell : cells) {
    rows.insert(rows.end(), cell.nodes.begin(), cell.nodes.end());
    rows.insert(rows.end(), {cell.part, static_cast<std::int64_t>(cell.kind)});
  }
  const Integers came = route.send<std::int64_t>(rows, cell_width);
  std::vector<std::size_t> order(came.size() / cell_width);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto at = came.begin();
    return std::lexicographical_compare(at + cell_width * a, at + cell_width * (a + 1), at + cell_width * b,
                                        at + cell_width * (b + 1));
  });
  return order;
}

Integers numbers_from(std::int64_t first, std::size_t count) {
  Integers all(count);
  std::iota(all.begin(), all.end(), first);
  return all;
}

}  // namespace

CellRows::CellRows(MPI_Comm comm, std::int64_t nodes, std::int64_t cells, const std::vector<ReducedShapes::Cell>& mine)
    : to_nodes_(comm, Shares(comm, nodes), first_nodes(mine)),
      order_(cell_order(to_nodes_, mine)),
      to_shares_(comm, Shares(comm, cells), numbers_from(sum_before(comm, std::ssize(order_)), order_.size())) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  first_ = Shares(comm, cells).first(rank);
}

std::vector<double> CellRows::in_order(std::span<const double> rows, int width) const {
  const auto came = to_nodes_.send<double>(rows, width);
  std::vector<double> sorted;
  sorted.reserve(came.size());
  for (const std::size_t i : order_)
    sorted.insert(sorted.end(), came.begin() + static_cast<std::ptrdiff_t>(i * width),
                  came.begin() + static_cast<std::ptrdiff_t>((i + 1) * width));
  return to_shares_.send<double>(sorted, width);
}

Integers columns_of(const Integers& rows, int from, int count) {
  Integers part;
  for (auto row = rows.begin(); row != rows.end(); row += cell_width)
    part.insert(part.end(), row + from, row + from + count);
  return part;
}

}  // namespace floe::output
