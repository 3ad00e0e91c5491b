#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "differences.h"
#include "floe/fem/shell_samples.h"
#include "shell_plate.h"
#include "spatial_structures.h"

using namespace floe;
using Eigen::Vector3d;
using testing::Spread;

namespace {

fem::Mesh tube(int sides, generate::ShellCells cells, Spread spread) {
  generate::MappedGrid grid;
  grid.nu = sides, grid.nv = 3, grid.closed_u = true, grid.cells = cells;
  grid.position = [](double u, double v) {
    return Vector3d(2 * std::cos(2 * M_PI * u), 5 * v, -2 * std::sin(2 * M_PI * u));
  };
  const mesh::RawMesh raw = generate::shell_of(PETSC_COMM_WORLD, grid);
  return fem::mesh_of(raw, testing::ranks_of(raw, spread));
}

/// Mean distance of the corners of a cell from its middle.
double half_length(const fem::Mesh& mesh, const fem::Mesh::Cell& cell) {
  Vector3d middle = Vector3d::Zero();
  const auto n = static_cast<double>(cell.corners().size());
  for (const int node : cell.corners()) middle += mesh.positions[node] / n;
  double sum = 0;
  for (const int node : cell.corners()) sum += (mesh.positions[node] - middle).norm() / n;
  return sum;
}

}  // namespace

TEST_CASE("elements of a tube rise by the angle between them and the surface, those of a folded one do not", "[fem]") {
  const auto spread = GENERATE(Spread::metis, Spread::shuffled, Spread::reversed, Spread::last);
  const auto cells = GENERATE(generate::ShellCells::triangles, generate::ShellCells::quadrilaterals);
  for (const int sides : {8, 9, 30}) {  // normals of neighbours 45, 40, 12 degrees apart
    const fem::Mesh mesh = tube(sides, cells, spread);
    for (const auto& cell : mesh.cells) {
      const double slope = sides > 8 ? std::sin(M_PI / sides) : 0;
      CHECK(cell.rise == Approx(half_length(mesh, cell) * slope / 2).epsilon(1e-12));
      CHECK(cell.alone().rise == cell.rise);
    }
  }
}

TEST_CASE("flat plates in any position and boxes have no rise", "[fem]") {
  const Eigen::Matrix3d axes = Eigen::AngleAxisd(0.7, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  generate::Plate floor{{100, -30, 7}, 2 * axes.col(0), axes.col(1), 4, 3}, wall = floor;
  wall.b = 0.5 * axes.col(2);
  const mesh::RawMesh raw = generate::folded_plates(PETSC_COMM_WORLD, {{"floor", floor}, {"wall", wall}});
  for (const auto& cell : fem::mesh_of(raw, testing::ranks_of(raw, Spread::metis)).cells) CHECK(cell.rise == 0);
}

TEST_CASE("two flat plates are a curved surface at a fold of less than 42 degrees, not at a sharp edge", "[fem]") {
  const auto cells = GENERATE(generate::ShellCells::triangles, generate::ShellCells::quadrilaterals);
  const auto [degrees, curved] =
      GENERATE(std::pair(30, true), std::pair(45, false), std::pair(140, false), std::pair(165, false));
  const double angle = degrees * M_PI / 180;
  generate::Plate first{{0, 0, 0}, Vector3d(-1, 0, 0), Vector3d(0, 2, 0), 1, 3, cells}, second = first;
  second.a = Vector3d(std::cos(angle), 0, std::sin(angle));
  const mesh::RawMesh raw = generate::merged(generate::prefixed(generate::plate(PETSC_COMM_WORLD, first), "a."),
                                             generate::prefixed(generate::plate(PETSC_COMM_WORLD, second), "b."),
                                             {{"a.left", "b.left"}}, 1e-9);
  for (const auto& cell : fem::mesh_of(raw, testing::ranks_of(raw, Spread::metis)).cells) {
    CAPTURE(degrees);
    CHECK((cell.rise > 0) == curved);
  }
}

TEST_CASE("flat webs on flat skins are flat, at any angle of their corners and against the skin", "[fem]") {
  const Vector3d up = GENERATE(Vector3d(0, 0, 1), Vector3d(0, 1, 1), Vector3d(0, 1, 1.8));
  const double along = GENERATE(0., 1.);  // corners of 90 and of 35 to 45 degrees
  generate::Plate plate{{-1, -1, 0}, Vector3d(2, 0, 0), Vector3d(0, 2, 0), 2, 2};
  generate::Plate web{{0, 0, 0}, Vector3d(1, 0, 0), up + along * Vector3d(1, 0, 0), 1, 1};  // from the plate's middle
  const mesh::RawMesh raw = generate::merged(generate::prefixed(generate::plate(PETSC_COMM_WORLD, plate), "skin."),
                                             generate::prefixed(generate::plate(PETSC_COMM_WORLD, web), "web."),
                                             {{"skin.plate", "web.plate"}}, 1e-9);
  CHECK(raw.cell_count == 10);
  for (const auto& cell : fem::mesh_of(raw, testing::ranks_of(raw, Spread::metis)).cells) CHECK(cell.rise == 0);
}

// Otherwise the stress of a bent surface would be that of drilling rotations, which the element does not have.
TEST_CASE("stresses of elements on curved surfaces are those of their stiffness", "[fem]") {
  const auto cells = GENERATE(generate::ShellCells::triangles, generate::ShellCells::quadrilaterals);
  const fem::Structure structure(tube(12, cells, Spread::metis),
                                 {fem::shell_section({{fem::isotropic(500, 0.3, 4), 0.1, 0}})},
                                 fem::MembraneStrain::averaged);
  for (const auto& cell : structure.mesh.cells) {
    CHECK(cell.rise > 0.03);
    const fem::ElementMaps maps = structure.maps(cell);
    const std::vector<fem::ShellSample> samples = fem::shell_samples(structure, cell);
    Eigen::MatrixXd strain = Eigen::MatrixXd::Zero(3, 6 * static_cast<Eigen::Index>(cell.corners().size()));
    for (int d = 0; d < 6; ++d)
      for (std::size_t i = 0; i < samples[0].corners.size(); ++i)
        strain.col(6 * samples[0].corners[i] + d) = samples[0].L.topRows<3>().col(6 * static_cast<int>(i) + d);
    CHECK(testing::relative_error(strain, maps.membrane[0].L) < 1e-12);
  }
}

TEST_CASE("the section of an element on a curved surface keeps its bending and its membrane", "[fem]") {
  const fem::ShellSection flat = fem::shell_section({{fem::isotropic(500, 0.3, 4), 0.1, 0}}, 0.02);
  const fem::ShellSection curved = fem::on_curved_surface(flat, 0.03), same = fem::on_curved_surface(flat, 0);
  CHECK((curved.A == flat.A && curved.bending == flat.bending && curved.coupling == flat.coupling));
  CHECK(curved.higher_order == Approx(flat.higher_order / 10));  // 1 + (10 * 0.03 / 0.1)^2, at any offset
  CHECK(curved.drilling == Approx(1.5 * std::pow(0.1, 1. / 12)));
  CHECK((same.higher_order == flat.higher_order && same.drilling == 1.5));
}

// A force in its plane at the end of a cantilever of 10 by 1, of the deflection of a beam with shear. Elements are
// squares and twice as long as wide.
TEST_CASE("strips of elements as on a surface that rises by any number of thicknesses bend in their plane", "[fem]") {
  struct Strip {
    int across, aspect;
    double least, most, least_to_three;
  };
  const auto cells = GENERATE(testing::Cells::triangles, testing::Cells::quadrilaterals);
  const auto [across, aspect, least, most, least_to_three] =
      GENERATE(Strip{1, 1, 0.75, 1.46, 0.75}, Strip{2, 1, 0.79, 1.01, 0.87}, Strip{4, 1, 0.83, 1.01, 0.93},
               Strip{1, 2, 0.64, 1.17, 0.64}, Strip{2, 2, 0.685, 1.01, 0.805}, Strip{4, 2, 0.785, 1.01, 0.915});
  const fem::ShellSection flat = fem::shell_section({{fem::isotropic(1, 0.3, 1), 1, 0}});
  for (const double rise : {0.03, 0.1, 0.3, 1., 1.5, 2., 3., 6.7, 10., 30., 100., 1000.}) {
    testing::Plate strip = testing::plate(10, 1, 10 * across / aspect, across, cells);
    strip.hold([](const Vector3d& x) { return x.x() < 1e-9; }, {0, 1, 2, 3, 4, 5});
    Eigen::VectorXd load = Eigen::VectorXd::Zero(strip.dofs());
    for (std::size_t i = 0; i < strip.nodes.size(); ++i)
      if (const Vector3d& x = strip.nodes[i]; x.x() > 10 - 1e-9) {
        const bool end = x.y() < 1e-9 || x.y() > 1 - 1e-9;
        load[6 * static_cast<Eigen::Index>(i) + 1] = (end ? 0.5 : 1) / across;
      }
    const Eigen::VectorXd q = testing::solved(testing::stiffness(strip, fem::on_curved_surface(flat, rise)), load);
    const double deflection = load.dot(q) / (4000 + 10 * 2.6 * 1.2);
    CAPTURE(across, aspect, rise, deflection);
    CHECK(deflection > (rise <= 3 ? least_to_three : least));
    CHECK(deflection < (rise <= 3 ? std::min(most, 1.06) : most));
  }
}
