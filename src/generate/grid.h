#pragma once
#include <optional>

#include "floe/generate/generate.h"
#include "share.h"

namespace floe::generate {

/// nu by nv cells, perhaps closed to a ring along u, perhaps with a row v = 0 or v = 1 that is one node.
struct Grid {
  PetscInt nu, nv;
  ShellCells cells;
  Diagonals diagonals;
  bool closed = false, pole_bottom = false, pole_top = false;
  bool crossed() const { return cells == ShellCells::triangles && diagonals == Diagonals::crossed; }
};

/// The node of column i in row j, or the one inside cell (i, j).
struct GridNode {
  PetscInt i, j;
  bool centre = false;
};

struct GridCell {
  CellKind kind;
  std::array<GridNode, 4> nodes;
};

/// Exact below 2^53, and no overflow before require_countable.
double node_total(const Grid& grid);
double cell_total(const Grid& grid);

/// Rows j = 0, 1, ... of nodes, after each the nodes inside the cells above it.
PetscInt number_of(const Grid& grid, GridNode node);
GridNode node_of(const Grid& grid, PetscInt number);

/// Cell by its number, row by row, counter-clockwise in the u-v plane.
GridCell cell_of(const Grid& grid, PetscInt number);

/// A cell with the numbers that `number(GridNode)` gives.
template <class Number>
Cell numbered(const GridCell& from, int part, Number&& number) {
  Cell cell{from.kind, {-1, -1, -1, -1}, part};
  for (int k = 0; k < node_count(from.kind); ++k) cell.nodes[k] = number(from.nodes[k]);
  return cell;
}

/// Edges and corners that the grid has, numbered by `number`.
std::vector<PlaceRule> edge_places(const Grid& grid, const std::string& prefix,
                                   const std::function<PetscInt(GridNode)>& number);

/// The node in the middle.
std::optional<GridNode> centre_of(const Grid& grid);

/// What makes no grid.
void check_grid(Checks& checks, const Grid& grid, const std::string& along_u, const std::string& along_v);

}  // namespace floe::generate
