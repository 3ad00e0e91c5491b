#include "plate.h"

#include <Eigen/Geometry>
#include <cmath>

namespace floe::generate {
namespace {

// Node i of 0..n at (r^i - 1) / (r^n - 1), r^(n - 1) = grading.
double station(PetscInt i, PetscInt n, double grading) {
  if (grading == 1 || n == 1) return static_cast<double>(i) / static_cast<double>(n);
  const double rate = std::log(grading) / static_cast<double>(n - 1);
  return std::expm1(rate * static_cast<double>(i)) / std::expm1(rate * static_cast<double>(n));
}

double place_along(PetscInt i, bool centre, PetscInt n, double grading) {
  const double here = station(i, n, grading);
  return centre ? (here + station(i + 1, n, grading)) / 2 : here;
}

}  // namespace

Grid grid_of(const Plate& plate) { return {plate.na, plate.nb, plate.cells, plate.diagonals}; }

Eigen::Vector3d position_of(const Plate& plate, GridNode node) {
  return plate.origin + plate.a * place_along(node.i, node.centre, plate.na, plate.grading_a) +
         plate.b * place_along(node.j, node.centre, plate.nb, plate.grading_b);
}

void check_plate(const std::string& source, const Plate& plate) {
  constexpr double parallel = 1e-9;  // sine of the angle between a and b
  Checks checks(source);
  const Grid grid = grid_of(plate);
  check_grid(checks, grid, "na", "nb");
  checks.finite("origin", plate.origin);
  checks.finite("a", plate.a);
  checks.finite("b", plate.b);
  checks.positive("grading_a", plate.grading_a);
  checks.positive("grading_b", plate.grading_b);
  const double lengths = plate.a.norm() * plate.b.norm();
  if (std::isfinite(lengths)) {
    checks.require(lengths > 0, "an edge has no length");
    checks.require(lengths == 0 || plate.a.cross(plate.b).norm() > parallel * lengths, "edges a and b are parallel");
  }
  checks.finish();
  require_countable(source, node_total(grid), cell_total(grid));
}

std::vector<PlaceRule> plate_places(const Plate& plate, const std::string& prefix,
                                    const std::function<PetscInt(GridNode)>& number) {
  auto places = edge_places(grid_of(plate), prefix, number);
  const auto centre = centre_of(grid_of(plate));
  if (centre && plate.grading_a == 1 && plate.grading_b == 1)
    places.push_back(single(prefix + "centre", number(*centre)));
  return places;
}

RawMesh plate(MPI_Comm comm, const Plate& plate) {
  check_plate("plate", plate);
  const Grid grid = grid_of(plate);
  const auto number = [grid](GridNode node) { return number_of(grid, node); };
  const Recipe recipe{"plate",
                      static_cast<PetscInt>(node_total(grid)),
                      static_cast<PetscInt>(cell_total(grid)),
                      {"plate"},
                      plate_places(plate, "", number)};
  return generated(
      comm, recipe, [&](PetscInt i) { return position_of(plate, node_of(grid, i)); },
      [&](PetscInt i) { return numbered(cell_of(grid, i), 0, number); });
}

}  // namespace floe::generate
