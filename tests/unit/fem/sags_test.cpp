#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "floe/fem/field_rows.h"
#include "spatial_structures.h"

using namespace floe;
using Eigen::Vector3d;
using testing::Spread;

namespace {

/// Of a plate whose nodes lie on w = c s^2 / 2, s along its side a, rotated into the place of `axes`.
double sag_of_cylinder(generate::ShellCells cells, Spread spread, const Eigen::Matrix3d& axes, double c, int along,
                       int across) {
  generate::Plate plate{{1, 2, 3}, 2 * axes.col(0), 5 * axes.col(1), along, across};
  plate.cells = cells;
  const fem::Structure s = testing::structure_of(generate::plate(PETSC_COMM_WORLD, plate),
                                                 {fem::shell_section({{fem::isotropic(500, 0.3, 4), 0.1, 0}})}, spread);
  std::vector<petsc::VecHandle> fields;
  for (int i = 0; i < 2; ++i) fields.push_back(fem::field(s));
  petsc::Values own(fields[1]);
  for (PetscInt i = 0; i < s.mesh.owned_nodes; ++i) {
    const double at = axes.col(0).dot(s.mesh.positions[i] - plate.origin);
    Eigen::Map<Vector3d>(own.begin() + 6 * i) = c * at * at / 2 * axes.col(2);
    Eigen::Map<Vector3d>(own.begin() + 6 * i + 3) = -c * at * axes.col(1);  // theta x a = c s n
  }
  const Eigen::VectorXd both = fem::intra_deflections(s, fem::gather(s, fields));
  CHECK(both[0] == 0);  // nothing moves
  return both[1];
}

}  // namespace

TEST_CASE("a shell sags within its cells by what the cubic of an edge does below its chord", "[fem]") {
  const auto cells = GENERATE(generate::ShellCells::triangles, generate::ShellCells::quadrilaterals);
  const auto spread = GENERATE(Spread::metis, Spread::last);
  const Eigen::Matrix3d axes = Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  for (const int along : {1, 4, 9}) {
    const double intra_deflection = 0.3 * std::pow(2.0 / along, 2) / 8, size = 0.3 * 4 / 2;
    CHECK(sag_of_cylinder(cells, spread, axes, 0.3, along, 3) ==
          Approx(intra_deflection / (intra_deflection + size)).epsilon(1e-12));
    CHECK(sag_of_cylinder(cells, spread, axes, -1e-20, along, 3) ==
          Approx(intra_deflection / (intra_deflection + size)).epsilon(1e-12));
  }
}
