#include "grid.h"

namespace floe::generate {
namespace {

PetscInt width(const Grid& grid) { return grid.closed ? grid.nu : grid.nu + 1; }
PetscInt inside(const Grid& grid) { return grid.crossed() ? grid.nu : 0; }
PetscInt poles(const Grid& grid) { return grid.pole_bottom + grid.pole_top; }
int triangles_of(const Grid& grid) {
  if (grid.cells == ShellCells::quadrilaterals) return 1;
  return grid.crossed() ? 4 : 2;
}

GridCell triangle(GridNode a, GridNode b, GridNode c) { return {CellKind::triangle, {a, b, c, {}}}; }

// The k-th cell in the square (i, j).
GridCell piece(const Grid& grid, PetscInt i, PetscInt j, int k) {
  const std::array<GridNode, 4> corner{{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
  if (grid.cells == ShellCells::quadrilaterals) return {CellKind::quadrilateral, corner};
  if (grid.crossed()) return triangle(corner[k], corner[(k + 1) % 4], {i, j, true});
  const bool right =
      grid.diagonals == Diagonals::right || (grid.diagonals == Diagonals::alternating && (i + j) % 2 == 0);
  const int first = right ? 0 : 1;  // the diagonal runs from this corner to the opposite one
  return k == 0 ? triangle(corner[first], corner[first + 1], corner[first + 2])
                : triangle(corner[first], corner[first + 2], corner[(first + 3) % 4]);
}

}  // namespace

double node_total(const Grid& grid) {
  const double row = grid.closed ? grid.nu : grid.nu + 1.0, centres = grid.crossed() ? grid.nu : 0;
  return row * (grid.nv + 1.0 - poles(grid)) + centres * (static_cast<double>(grid.nv) - poles(grid)) + poles(grid);
}

double cell_total(const Grid& grid) {
  const double rows = static_cast<double>(grid.nv) - poles(grid);
  return static_cast<double>(grid.nu) * (triangles_of(grid) * rows + poles(grid));
}

PetscInt number_of(const Grid& grid, GridNode node) {
  const PetscInt pitch = width(grid) + inside(grid), bottom = grid.pole_bottom;
  if (bottom && node.j == 0) return 0;
  const PetscInt row = bottom + (node.j - bottom) * pitch;
  if (grid.pole_top && node.j == grid.nv) return row - inside(grid);
  if (node.centre) return row + width(grid) + node.i;
  return row + (grid.closed ? node.i % grid.nu : node.i);
}

GridNode node_of(const Grid& grid, PetscInt number) {
  const PetscInt pitch = width(grid) + inside(grid), bottom = grid.pole_bottom;
  if (bottom && number == 0) return {0, 0};
  if (grid.pole_top && number + 1 == static_cast<PetscInt>(node_total(grid))) return {0, grid.nv};
  const PetscInt j = (number - bottom) / pitch + bottom, i = (number - bottom) % pitch;
  return i < width(grid) ? GridNode{i, j} : GridNode{i - width(grid), j, true};
}

GridCell cell_of(const Grid& grid, PetscInt number) {
  if (grid.pole_bottom && number < grid.nu) return triangle({0, 0}, {number + 1, 1}, {number, 1});
  const int pieces = triangles_of(grid);
  const PetscInt bottom = grid.pole_bottom, n = number - bottom * grid.nu, square = n / pieces;
  if (grid.pole_top && number >= static_cast<PetscInt>(cell_total(grid)) - grid.nu) {
    const PetscInt i = number - (static_cast<PetscInt>(cell_total(grid)) - grid.nu);
    return triangle({i, grid.nv - 1}, {i + 1, grid.nv - 1}, {0, grid.nv});
  }
  return piece(grid, square % grid.nu, bottom + square / grid.nu, static_cast<int>(n % pieces));
}

std::vector<PlaceRule> edge_places(const Grid& grid, const std::string& prefix,
                                   const std::function<PetscInt(GridNode)>& number) {
  const PetscInt nu = grid.nu, nv = grid.nv;
  const auto row = [&](const char* name, PetscInt j, bool pole) {
    return PlaceRule{prefix + name, pole ? 1 : width(grid), [=](PetscInt i) { return number({i, j}); }};
  };
  const auto column = [&](const char* name, PetscInt i) {
    return PlaceRule{prefix + name, nv + 1, [=](PetscInt j) { return number({i, j}); }};
  };
  std::vector<PlaceRule> places;
  if (!grid.closed) places = {column("left", 0), column("right", nu)};
  places.push_back(row("bottom", 0, grid.pole_bottom));
  places.push_back(row("top", nv, grid.pole_top));
  if (grid.closed || poles(grid) > 0) return places;
  const std::array<GridNode, 4> corners{{{0, 0}, {nu, 0}, {nu, nv}, {0, nv}}};
  for (int k = 0; k < 4; ++k) places.push_back(single(prefix + "p" + std::to_string(k + 1), number(corners[k])));
  return places;
}

std::optional<GridNode> centre_of(const Grid& grid) {
  if (grid.nu % 2 == 0 && grid.nv % 2 == 0) return GridNode{grid.nu / 2, grid.nv / 2};
  if (grid.nu % 2 == 1 && grid.nv % 2 == 1 && grid.crossed()) return GridNode{grid.nu / 2, grid.nv / 2, true};
  return std::nullopt;
}

void check_grid(Checks& checks, const Grid& grid, const std::string& along_u, const std::string& along_v) {
  checks.at_least(grid.closed ? 3 : 1, along_u, grid.nu);
  checks.at_least(poles(grid) == 2 ? 2 : 1, along_v, grid.nv);
  checks.require(grid.cells == ShellCells::triangles || grid.diagonals != Diagonals::crossed,
                 "quadrilaterals have no crossed diagonals");
}

}  // namespace floe::generate
