#include "fold.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "floe/error.h"

namespace floe::generate {
namespace {

constexpr int sides = 4;  // bottom, right, top, left
constexpr std::array<std::array<int, 2>, sides> ends{{{0, 1}, {1, 2}, {3, 2}, {0, 3}}};

PetscInt elements_of(const Plate& plate, int side) { return side % 2 == 0 ? plate.na : plate.nb; }
double grading_of(const Plate& plate, int side) { return side % 2 == 0 ? plate.grading_a : plate.grading_b; }

GridNode corner_of(const Plate& plate, int corner) {
  return {corner == 1 || corner == 2 ? plate.na : 0, corner >= 2 ? plate.nb : 0};
}

GridNode on_side(const Plate& plate, int side, PetscInt k) {
  if (side % 2 == 0) return {k, side == 2 ? plate.nb : 0};
  return {side == 1 ? plate.na : 0, k};
}

// Nodes inside a plate: rows of nodes inside cells and of inner grid nodes in turn, from the bottom.
struct Inside {
  PetscInt centres, grid, rows;
  explicit Inside(const Plate& plate)
      : centres(grid_of(plate).crossed() ? plate.na : 0), grid(plate.na - 1), rows(plate.nb) {}
  PetscInt pitch() const { return centres + grid; }
  PetscInt count() const { return centres + (rows - 1) * pitch(); }
  PetscInt number(GridNode node) const {
    return node.centre ? node.j * pitch() + node.i : centres + (node.j - 1) * pitch() + node.i - 1;
  }
  GridNode node(PetscInt number) const {
    if (number < centres) return {number, 0, true};
    const PetscInt j = 1 + (number - centres) / pitch(), i = (number - centres) % pitch();
    return i < grid ? GridNode{i + 1, j} : GridNode{i - grid, j, true};
  }
};

double longest_edge(const std::vector<NamedPlate>& plates) {
  double longest = 0;
  for (const auto& [name, plate] : plates) longest = std::max({longest, plate.a.norm(), plate.b.norm()});
  return longest;
}

}  // namespace

Fold::Fold(const std::vector<NamedPlate>& plates) : plates_(plates), first_cell_{0} {
  constexpr double same = 1e-9;  // of the longest edge
  const double tolerance = same * longest_edge(plates);
  double node_sum = 0, cell_sum = 0;
  for (const auto& [name, plate] : plates) {
    node_sum += node_total(grid_of(plate));
    cell_sum += cell_total(grid_of(plate));
  }
  require_countable("folded plates", node_sum, cell_sum);
  for (int p = 0; p < static_cast<int>(plates.size()); ++p) {
    Fitted fitted;
    for (int k = 0; k < sides; ++k) fitted.corners[k] = point_of(p, k, tolerance);
    for (int k = 0; k < sides; ++k) fitted.sides[k] = side_of(p, k, fitted.corners);
    fitted.first = nodes_;
    add({nodes_, p, -1, -1}, Inside(plates[p].plate).count());
    fitted_.push_back(fitted);
    first_cell_.push_back(first_cell_.back() + static_cast<PetscInt>(cell_total(grid_of(plates[p].plate))));
  }
  refuse_repeated();
  refuse_corners_inside_edges(tolerance);
}

void Fold::add(Run run, PetscInt count) {
  if (count > 0) runs_.push_back(run);
  nodes_ += count;
}

int Fold::point_of(int plate, int corner, double tolerance) {
  const auto& shape = plates_[plate].plate;
  const Eigen::Vector3d at = position_of(shape, corner_of(shape, corner));
  const auto found = std::find_if(points_.begin(), points_.end(),
                                  [&](const Point& point) { return (point.at - at).norm() <= tolerance; });
  if (found != points_.end()) return static_cast<int>(found - points_.begin());
  points_.push_back({at, plate, nodes_});
  add({nodes_, plate, corner, -1}, 1);
  return static_cast<int>(points_.size()) - 1;
}

Fold::Side Fold::side_of(int plate, int side, const std::array<int, 4>& corners) {
  const auto& shape = plates_[plate].plate;
  const Edge edge{corners[ends[side][0]], corners[ends[side][1]], plate, elements_of(shape, side), nodes_,
                  grading_of(shape, side)};
  const auto [found, fresh] =
      edge_of_.try_emplace({std::min(edge.from, edge.to), std::max(edge.from, edge.to)}, edges_.size());
  if (fresh) {
    edges_.push_back(edge);
    add({nodes_, plate, -1, side}, edge.elements - 1);
  } else {
    refuse_unequal(edges_[found->second], edge);
  }
  return {found->second, edges_[found->second].from != edge.from};
}

void Fold::refuse_unequal(const Edge& edge, const Edge& other) const {
  constexpr double same = 1e-12;
  const std::string text =
      "folded plates: " + plates_[edge.plate].name + " and " + plates_[other.plate].name + " have an edge in common, ";
  if (edge.elements != other.elements)
    throw InputError(text + "with " + std::to_string(edge.elements) + " and " + std::to_string(other.elements) +
                     " elements along it");
  const double grading = edge.from == other.from ? other.grading : 1 / other.grading;
  if (edge.elements > 1 && std::abs(grading - edge.grading) > same * edge.grading)
    throw InputError(text + "with another grading along it");
}

void Fold::refuse_repeated() const {
  std::map<std::array<int, 4>, int> seen;
  for (std::size_t p = 0; p < fitted_.size(); ++p) {
    auto corners = fitted_[p].corners;
    std::sort(corners.begin(), corners.end());
    const auto [found, fresh] = seen.try_emplace(corners, static_cast<int>(p));
    if (!fresh)
      throw InputError("folded plates: " + plates_[found->second].name + " and " + plates_[p].name +
                       " have the same corners");
  }
}

void Fold::refuse_corners_inside_edges(double tolerance) const {
  for (const Edge& edge : edges_) {
    const Eigen::Vector3d &from = points_[edge.from].at, along = points_[edge.to].at - from;
    for (const Point& point : points_) {
      const Eigen::Vector3d x = point.at - from;
      const double s = x.dot(along) / along.squaredNorm();
      if (s <= 0 || s >= 1 || (x - s * along).norm() > tolerance) continue;
      if (&point == &points_[edge.from] || &point == &points_[edge.to]) continue;
      throw InputError("folded plates: a corner of " + plates_[point.plate].name + " lies inside an edge of " +
                       plates_[edge.plate].name + ": divide that plate there");
    }
  }
}

PetscInt Fold::number(int plate, GridNode node) const {
  const auto& shape = plates_[plate].plate;
  const auto& fitted = fitted_[plate];
  for (int side = 0; side < sides && !node.centre; ++side) {
    const PetscInt k = side % 2 == 0 ? node.i : node.j;
    const GridNode there = on_side(shape, side, k);
    if (there.i != node.i || there.j != node.j) continue;
    const auto [id, reversed] = fitted.sides[side];
    const Edge& edge = edges_[id];
    const PetscInt along = reversed ? edge.elements - k : k;
    if (along == 0) return points_[edge.from].number;
    return along == edge.elements ? points_[edge.to].number : edge.first + along - 1;
  }
  return fitted.first + Inside(shape).number(node);
}

Eigen::Vector3d Fold::position(PetscInt number) const {
  const auto after = std::upper_bound(runs_.begin(), runs_.end(), number,
                                      [](PetscInt value, const Run& run) { return value < run.first; });
  const Run& run = *std::prev(after);
  const auto& shape = plates_[run.plate].plate;
  const PetscInt i = number - run.first;
  if (run.corner >= 0) return position_of(shape, corner_of(shape, run.corner));
  return position_of(shape, run.side >= 0 ? on_side(shape, run.side, i + 1) : Inside(shape).node(i));
}

Cell Fold::cell(PetscInt number) const {
  const int plate =
      static_cast<int>(std::upper_bound(first_cell_.begin(), first_cell_.end(), number) - first_cell_.begin()) - 1;
  return numbered(cell_of(grid_of(plates_[plate].plate), number - first_cell_[plate]), plate,
                  [&](GridNode node) { return this->number(plate, node); });
}

}  // namespace floe::generate
