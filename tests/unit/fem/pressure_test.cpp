#include "floe/fem/pressure.h"

#include <catch2/catch.hpp>

#include "shell_states.h"
#include "spatial_structures.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// int n dA over an element of these nodes: half the integral of x ~ dx along its rim, whose edges are straight or
/// parabolas through their middles (Simpson's rule is exact).
Vector3d vector_area(const std::vector<Vector3d>& x, int corners) {
  const bool curved = static_cast<int>(x.size()) > corners;
  Vector3d twice = Vector3d::Zero();
  for (int i = 0; i < corners; ++i) {
    const Vector3d &a = x[i], &b = x[(i + 1) % corners], m = curved ? x[corners + i] : Vector3d((a + b) / 2);
    twice += (a.cross(-1.5 * a + 2 * m - 0.5 * b) + 4 * m.cross((b - a) / 2) + b.cross(0.5 * a - 2 * m + 1.5 * b)) / 3;
  }
  return twice / 2;
}

/// Triangles, and quadrilaterals that are not plane; of second order with curved edges.
fem::Structure warped(testing::Order order) {
  mesh::RawMesh raw = testing::mixed_mesh(PETSC_COMM_WORLD, order);
  for (Vector3d& x : raw.positions)
    x += 0.05 * Vector3d(std::sin(3 * x.y()), x.x() * x.z(), std::cos(5 * x.x() + 4 * x.y()));
  return testing::structure_of(raw, testing::mixed_sections(), testing::Spread::metis);
}

}  // namespace

// The resultant and its change with the nodes depend on the rim alone; both are exact to first order in q.
TEST_CASE("unit pressure on an element: resultant and its change by the nodes are those of the vector area") {
  const fem::Structure s = warped(GENERATE(testing::Order::first, testing::Order::second));
  for (const fem::Mesh::Cell& cell : s.mesh.cells) {
    if (!fem::is_shell(cell)) continue;
    const int corners = mesh::corner_count(cell.kind);
    std::vector<Vector3d> x;
    for (const int node : cell.places()) x.push_back(s.mesh.positions[node]);
    const body::Pressure unit = fem::pressure(s, cell);
    CHECK((unit.force - vector_area(x, corners)).norm() < 1e-12);
    MatrixXd change = MatrixXd::Zero(3, 6 * static_cast<Eigen::Index>(x.size()));
    for (std::size_t i = 0; i < x.size(); ++i)
      for (int d = 0; d < 3; ++d) {  // of a quadratic function: exact
        auto more = x, less = x;
        more[i][d] += 0.5, less[i][d] -= 0.5;
        change.col(6 * static_cast<Eigen::Index>(i) + d) = vector_area(more, corners) - vector_area(less, corners);
      }
    CHECK((unit.force_by - change).norm() < 1e-12);
  }
}

TEST_CASE("unit pressure on an element: rigid motions move its resultant, its moment and its loads") {
  const fem::Structure s = warped(GENERATE(testing::Order::first, testing::Order::second));
  const Vector3d c(0.3, -0.7, 0.2), w(0.5, 0.4, -0.6);
  for (const fem::Mesh::Cell& cell : s.mesh.cells) {
    if (!fem::is_shell(cell)) continue;
    std::vector<Vector3d> x;
    for (const int node : cell.places()) x.push_back(s.mesh.positions[node]);
    const body::Pressure unit = fem::pressure(s, cell);
    const MatrixXd rigid = testing::rigid_motions(x);
    const VectorXd shift = rigid.leftCols<3>() * c, turn = rigid.rightCols<3>() * w;
    CHECK(unit.load.dot(shift) == Approx(unit.force.dot(c)).margin(1e-12));
    CHECK(unit.load.dot(turn) == Approx(unit.moment.dot(w)).margin(1e-12));
    CHECK((unit.force_by * shift).norm() < 1e-12);
    CHECK((unit.force_by * turn - w.cross(unit.force)).norm() < 1e-12);
    CHECK((unit.moment_by * shift - c.cross(unit.force)).norm() < 1e-12);
    CHECK((unit.moment_by * turn - w.cross(unit.moment)).norm() < 1e-12);
    // the virtual work of forces that rotate with the element, on a translation
    CHECK(shift.dot(unit.load_by * turn) == Approx(c.dot(w.cross(unit.force))).margin(1e-12));
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (Eigen::Index i = 0; i < shift.size(); ++i) spread += shift[i] * unit.spread_by[i];
    CHECK((spread - c * unit.force.transpose()).norm() < 1e-12);
    // int x ~ n is the skew part of int x n'
    const Eigen::Matrix3d& X = unit.spread;
    CHECK((unit.moment - Vector3d(X(1, 2) - X(2, 1), X(2, 0) - X(0, 2), X(0, 1) - X(1, 0))).norm() < 1e-12);
  }
}
