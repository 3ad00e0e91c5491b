#pragma once
#include <mpi.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dataset.h"
#include "floe/output/reduced_file.h"
#include "floe/output/result_file.h"
#include "reduced_file_shares.h"

/// Rows of a mesh that lies anywhere on the ranks, written in the mesh's original order.
namespace floe::output {

using Integers = std::vector<std::int64_t>;

/// @throws RunError  `shapes: WHAT`
void need(bool condition, const std::string& what);
/// Over all ranks, and over those before this one. Collective.
std::int64_t sum(MPI_Comm comm, std::int64_t mine);
std::int64_t sum_before(MPI_Comm comm, std::int64_t mine);

/// One shared dataset to which every rank gives its rows, from row `first` on. Collective.
template <class Number>
void write_shared(MPI_Comm comm, hid_t file, const std::string& name, const Extent& shape, hsize_t first,
                  const std::vector<Number>& rows, const Label& label);

/// Nodes' rows as they came, put in their original order.
class NodeRows {
 public:
  /// @param nodes  original numbers of this rank's  @throws RunError  a node on several ranks or none. Collective.
  NodeRows(MPI_Comm comm, const Shares& shares, const Integers& nodes);
  /// Of the nodes of this rank's share. Collective.
  std::vector<double> in_order(std::span<const double> rows, int width) const;
  std::int64_t first() const { return first_; }  ///< of this rank's share

 private:
  Route route_;
  std::int64_t first_ = 0;
  Integers numbers_;
};

constexpr int cell_width = 6;  ///< four nodes (cells are sorted by them), part, kind
/// Nodes of a cell of this kind.
int corners(ReducedShapes::Kind kind);
/// Cells at the share of their first node, in ascending order there: an order that no partition changes. Collective.
Integers cells_in_order(MPI_Comm comm, const Shares& shares, const std::vector<ReducedShapes::Cell>& cells);
/// Rows of elements as they came, put in that order and spread over the ranks in equal shares.
class CellRows {
 public:
  /// @param nodes  of the mesh, of all ranks. Collective.
  CellRows(MPI_Comm comm, std::int64_t nodes, std::int64_t cells, const std::vector<ReducedShapes::Cell>& mine);
  /// Of this rank's share. Collective.
  std::vector<double> in_order(std::span<const double> rows, int width) const;
  std::int64_t first() const { return first_; }  ///< of this rank's share

 private:
  Route to_nodes_;
  std::vector<std::size_t> order_;  ///< of what came, ascending
  Route to_shares_;
  std::int64_t first_;
};

/// Some of the cell_width columns of such rows.
Integers columns_of(const Integers& rows, int from, int count);

}  // namespace floe::output
