#include "floe/plan/place_weights.h"

#include <catch2/catch.hpp>

#include "floe/generate/generate.h"
#include "floe/mesh/partition.h"
#include "floe/petsc/error.h"

using namespace floe;

namespace {

/// 4 by 2 elements of 0.25 x 0.5 and their nodes by number, i along, j across.
struct Grid {
  fem::Structure structure;
  explicit Grid(generate::ShellCells cells)
      : structure(mesh_of(cells), {fem::shell_section({{fem::isotropic(7e10, 0.3, 2700), 0.01}})},
                  fem::MembraneStrain::averaged) {}
  static fem::Mesh mesh_of(generate::ShellCells cells) {
    generate::Plate plate;
    plate.a = Eigen::Vector3d(1, 0, 0), plate.b = Eigen::Vector3d(0, 1, 0), plate.na = 4, plate.nb = 2;
    plate.cells = cells;
    const mesh::RawMesh raw = generate::plate(PETSC_COMM_WORLD, plate);
    return fem::mesh_of(raw, mesh::partition(raw));
  }
  /// Weights of nodes by their places; the sum of x by weight has to be `centre`.
  std::vector<double> weights(const std::vector<std::array<double, 2>>& points, const Eigen::Vector3d& centre) const {
    std::vector<PetscInt> nodes;
    for (const auto& [x, y] : points) nodes.push_back(fem::nearest_node(structure.mesh, Eigen::Vector3d(x, y, 0)).node);
    std::vector<double> found;
    Eigen::Vector3d sum = -centre;
    Eigen::Matrix3d arms = Eigen::Matrix3d::Zero();
    for (const auto& [node, weight, arm, turn, twist] : plan::place_weights(structure, nodes)) {
      const auto& [x, y] = points[found.size()];
      sum += weight * Eigen::Vector3d(x, y, 0);
      arms += arm;
      found.push_back(weight);
    }
    CHECK(sum.norm() < 1e-14);
    CHECK(arms.norm() < 1e-14);  // a rigid rotation about the middle moves it nowhere
    return found;
  }
};

void check_equal(const std::vector<double>& found, const std::vector<double>& expected) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) CHECK(found[i] == Approx(expected[i]).epsilon(1e-14));
}

}  // namespace

TEST_CASE("weights of places: edges by lengths, areas by areas, points alike") {
  for (const generate::ShellCells cells : {generate::ShellCells::triangles, generate::ShellCells::quadrilaterals}) {
    const Grid grid(cells);
    const bool quads = cells == generate::ShellCells::quadrilaterals;
    check_equal(grid.weights({{1, 0.5}, {1, 0}, {1, 1}}, {1, 0.5, 0}), {0.5, 0.25, 0.25});                // an edge
    check_equal(grid.weights({{0.25, 0.5}, {0.5, 0.5}, {0.75, 0.5}}, {0.5, 0.5, 0}), {0.25, 0.5, 0.25});  // inside
    // around a corner, half of each side: 0.5 along and 0.5 across; of triangles one may belong to it as a whole
    check_equal(grid.weights({{0.5, 0}, {0.25, 0}, {0, 0}, {0, 0.5}}, {0.125, 0.125, 0}), {0.125, 0.25, 0.375, 0.25});
    check_equal(grid.weights({{0.5, 1}, {0.75, 1}, {1, 1}, {1, 0.5}}, {0.875, 0.875, 0}), {0.125, 0.25, 0.375, 0.25});
    check_equal(grid.weights({{0.5, 0}, {0.75, 0}, {1, 0}, {1, 0.5}}, {0.875, 0.125, 0}), {0.125, 0.25, 0.375, 0.25});
    if (quads)
      check_equal(grid.weights({{0, 0}, {0.25, 0}, {0.25, 0.5}, {0, 0.5}, {0.5, 0}, {0.5, 0.5}}, {0.25, 0.25, 0}),
                  {0.125, 0.25, 0.25, 0.125, 0.125, 0.125});  // two elements
    check_equal(grid.weights({{0, 0}, {0.5, 0.5}, {1, 1}, {1, 0}}, {0.625, 0.375, 0}), {0.25, 0.25, 0.25, 0.25});
    check_equal(grid.weights({{0.5, 0.5}}, {0.5, 0.5, 0}), {1});
    std::vector<std::array<double, 2>> all;
    for (int j = 0; j <= 2; ++j)
      for (int i = 0; i <= 4; ++i) all.push_back({0.25 * i, 0.5 * j});
    const std::vector<double> area = grid.weights(all, {0.5, 0.5, 0});
    if (quads) CHECK(area[0] == Approx(1.0 / 32));
    if (quads) CHECK(area[6] == Approx(1.0 / 8));
  }
}

// A rigid rotation rotates the place by itself; drilling rotations of nodes by themselves do not rotate it, of curved
// shells by what of them is bending at the mean normal.
TEST_CASE("weights of places: edges of flat and curved shells rotate as the nearest rigid motion") {
  const double camber = GENERATE(0., 0.05, 1.);
  Grid grid(generate::ShellCells::quadrilaterals);
  for (Eigen::Vector3d& x : grid.structure.mesh.positions) x.z() = camber * x.y() * x.y();
  const bool apart = GENERATE(false, true);  // nodes of one edge, or none of one element
  std::vector<PetscInt> nodes;
  std::vector<Eigen::Vector3d> places;
  for (const double y : {0., 0.5, 1.}) {
    places.emplace_back(apart && y != 0.5 ? 0 : 1, y, camber * y * y);
    nodes.push_back(fem::nearest_node(grid.structure.mesh, places.back()).node);
  }
  const auto weights = plan::place_weights(grid.structure, nodes);
  const auto rotation = [&](auto&& u, auto&& theta) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < weights.size(); ++i)
      sum +=
          weights[i].weight * theta(places[i]) + weights[i].twist * theta(places[i]) + weights[i].turn * u(places[i]);
    return sum;
  };
  for (int c = 0; c < 3; ++c) {
    const Eigen::Vector3d w = Eigen::Vector3d::Unit(c), translation(0.3, -0.2, 0.7);
    const auto rigid = [&](const Eigen::Vector3d& x) { return Eigen::Vector3d(translation + w.cross(x)); };
    const auto constant = [&](const Eigen::Vector3d&) { return w; };
    CHECK((rotation(rigid, constant) - w).norm() < 1e-13);
  }
  const auto none = [](const Eigen::Vector3d&) { return Eigen::Vector3d(Eigen::Vector3d::Zero()); };
  const auto drilling = [](const Eigen::Vector3d&) { return Eigen::Vector3d(Eigen::Vector3d::UnitZ()); };
  CHECK(rotation(none, drilling).norm() <
        (camber == 0 ? 1e-14 : 0.02));  // h^2 / 12 over the inertia of the nodes; their mean: 1
}

// Else even tension at the edge would bend the elements in their planes.
TEST_CASE("weights of places: edges of curved shells have the alpha of their elements", "[plan]") {
  const double thickness = GENERATE(0.005, 0.05, 50.);
  generate::MappedGrid grid;
  grid.nu = 6, grid.nv = 2, grid.cells = generate::ShellCells::quadrilaterals;
  grid.position = [](double u, double v) { return Eigen::Vector3d(std::cos(M_PI / 2 * u), std::sin(M_PI / 2 * u), v); };
  const mesh::RawMesh raw = generate::shell_of(PETSC_COMM_WORLD, grid);
  const fem::Structure structure(fem::mesh_of(raw, mesh::partition(raw)),
                                 {fem::shell_section({{fem::isotropic(7e10, 0.3, 2700), thickness}})},
                                 fem::MembraneStrain::averaged);
  std::vector<PetscInt> nodes;
  for (int i = 0; i <= 6; ++i) nodes.push_back(fem::nearest_node(structure.mesh, grid.position(i / 6., 0)).node);
  const Eigen::Matrix3d arm = plan::place_weights(structure, nodes)[0].arm;  // of one edge
  const Eigen::Vector3d s = grid.position(1 / 6., 0) - grid.position(0, 0), t(0, 0, 1), n = s.cross(t).normalized();
  const double rise = std::sin(M_PI / 24) / 4 * std::hypot(s.norm(), 0.5) / 2;  // no other side: half the corners
  const double alpha = fem::on_curved_surface(std::get<fem::ShellSection>(structure.sections[0]), rise).drilling;
  CHECK(-t.dot(arm * n) / n.dot(arm * t) == Approx(alpha).epsilon(1e-10));
  CHECK((thickness < 1 ? alpha < 1.4 : alpha > 1.499));
}
