#include "floe/generate/halved.h"
#include "generated.h"

using namespace floe;
using Eigen::Vector3d;
using mesh::RawMesh;

namespace {

constexpr auto both = {generate::ShellCells::triangles, generate::ShellCells::quadrilaterals};

RawMesh halved(const RawMesh& raw, int times = 1) {
  std::vector<mesh::DependentNode> links;
  RawMesh fine = raw;
  for (int i = 0; i < times; ++i) fine = generate::halved(fine, links);
  return fine;
}

RawMesh shell(generate::ShellCells cells, PetscInt nu, PetscInt nv, std::function<Vector3d(double u, double v)> at,
              bool closed = false, generate::Diagonals diagonals = generate::Diagonals::right) {
  generate::MappedGrid grid;
  grid.diagonals = diagonals;
  grid.nu = nu, grid.nv = nv, grid.position = std::move(at), grid.closed_u = closed, grid.cells = cells;
  return generate::shell_of(PETSC_COMM_SELF, grid);
}

Vector3d on_cylinder(double angle, double z) { return {std::cos(angle), std::sin(angle), z}; }

/// Of the nodes' distance from the surface that `off` measures.
template <class Off>
double worst(const RawMesh& raw, Off off) {
  double most = 0;
  for (const Vector3d& x : raw.positions) most = std::max(most, std::abs(off(x)));
  return most;
}

double off_cylinder(const Vector3d& x) { return x.head<2>().norm() - 1; }

}  // namespace

TEST_CASE("quarter cylinders and tubes of quadrilaterals that are halved are those of twice as many") {
  for (const PetscInt n : {3, 8})
    for (const double turn : {M_PI / 2, 2 * M_PI}) {
      const bool closed = turn > 6;
      const PetscInt nu = closed ? 4 * n : n;
      const auto at = [&](double u, double v) { return on_cylinder(turn * u, 2 * v * (1 + 0.3 * v)); };
      const RawMesh fine = halved(shell(generate::ShellCells::quadrilaterals, nu, 2, at, closed), 2);
      const RawMesh expected = shell(generate::ShellCells::quadrilaterals, 4 * nu, 8, at, closed);
      CHECK(fine.node_count == expected.node_count);
      CHECK(worst(fine, off_cylinder) < 1e-13);
      std::set<long> angles;
      for (const Vector3d& x : fine.positions) angles.insert(std::lround(1e9 * std::atan2(x[1], x[0])));
      std::set<long> wanted;
      for (const Vector3d& x : expected.positions) wanted.insert(std::lround(1e9 * std::atan2(x[1], x[0])));
      CHECK(angles == wanted);
    }
}

// `rise`: of an edge along u over its chord, where halved edges would be without arcs; `remains` of it.
TEST_CASE("curved shells that are halved lie on their surfaces, with rims and corners") {
  struct Surface {
    const char* name;
    std::function<Vector3d(double, double)> at;
    std::function<double(const Vector3d&)> off;
    double rise, remains;
  };
  const double arc = M_PI / 16;
  const Surface surface = GENERATE_COPY(
      Surface{"cylinder", [](double u, double v) { return on_cylinder(M_PI / 2 * u, 2 * v); }, off_cylinder,
              1 - std::cos(arc / 2), 0.002},
      Surface{"sphere",
              [](double u, double v) {
                const double b = 0.4 * M_PI * v;
                return Vector3d(std::cos(b) * on_cylinder(M_PI / 2 * u, 0) + Vector3d(0, 0, std::sin(b)));
              },
              [](const Vector3d& x) { return x.norm() - 1; }, 1 - std::cos(arc / 2), 0.11},
      Surface{"sphere, nodes out of line",
              [](double u, double v) {
                const double shift = 0.5 * u * (1 - u) * v * (1 - v);
                const double a = M_PI / 2 * (u + shift * std::sin(97 * u + 31 * v)),
                             b = 0.4 * M_PI * (v + shift * std::sin(57 * u - 83 * v));
                return Vector3d(std::cos(b) * on_cylinder(a, 0) + Vector3d(0, 0, std::sin(b)));
              },
              [](const Vector3d& x) { return x.norm() - 1; }, 1 - std::cos(arc / 2), 0.3},
      Surface{"paraboloid, straight lines across",
              [](double u, double v) { return Vector3d(u, v, (u - v) * (u + v - 1)); },
              [](const Vector3d& x) { return x[2] - (x[0] - x[1]) * (x[0] + x[1] - 1); }, 1. / 256, 0.21});
  CAPTURE(surface.name);
  for (const auto cells : both) {
    const RawMesh coarse = shell(cells, 8, 8, surface.at);
    for (const int times : {1, 2}) CHECK(worst(halved(coarse, times), surface.off) < surface.remains * surface.rise);
  }
}

TEST_CASE("a can that is halved is round with a flat bottom, and a web in it is flat") {
  for (const auto cells : both) {
    const auto wall = shell(
        cells, 16, 4, [](double u, double v) { return on_cylinder(2 * M_PI * u, 2 * v); }, true);
    const auto bottom = shell(
        cells, 16, 2, [](double u, double v) { return Vector3d((1 + v) / 2 * on_cylinder(2 * M_PI * u, 0)); }, true);
    const auto web = shell(cells, 4, 4, [](double u, double v) { return Vector3d(2 * u - 1, 0, 2 * v); });
    RawMesh can = generate::merged(generate::prefixed(wall, "wall."), generate::prefixed(bottom, "bottom."),
                                   {{"wall.bottom", "bottom.top"}}, 1e-9);
    can = generate::merged(can, generate::prefixed(web, "web."), {{"wall.shell", "web.shell"}}, 1e-9);
    const RawMesh fine = halved(can, 2);
    for (const mesh::Cell& cell : fine.cells)
      for (int i = 0; i < mesh::corner_count(cell.kind); ++i) {
        const Vector3d& x = fine.positions[cell.nodes[i]];
        const std::string& part = fine.parts[cell.part];
        INFO(part << x.transpose());
        if (part.starts_with("wall"))
          CHECK(std::abs(off_cylinder(x)) < (cells == generate::ShellCells::triangles ? 1e-3 : 1e-12));
        if (part.starts_with("bottom")) CHECK(std::abs(x[2]) < 1e-12);
        if (part.starts_with("web")) CHECK(std::abs(x[1]) < 1e-12);
      }
  }
}

TEST_CASE("beams along edges of a curved shell that is halved follow it, across its elements they remain straight") {
  for (const auto cells : both) {
    RawMesh skin = shell(cells, 4, 2, [](double u, double v) { return on_cylinder(M_PI / 2 * u, v); });
    const PetscInt row = 5;  // nodes 5 to 9: v = 1/2
    for (const auto& [a, b] : {std::pair<PetscInt, PetscInt>{row, row + 1}, {0, row + 2}}) {
      mesh::Cell beam{mesh::CellKind::line, mesh::no_nodes<PetscInt>(), 0};
      beam.nodes[0] = a, beam.nodes[1] = b;
      skin.cells.push_back(beam), skin.cell_labels.push_back(100 + a);
    }
    skin.cell_count += 2;
    const RawMesh fine = halved(skin);
    const auto middle = [&](long long label) {
      const auto at = std::find(fine.cell_labels.begin(), fine.cell_labels.end(), label) - fine.cell_labels.begin();
      return fine.positions[fine.cells[at].nodes[1]];
    };
    CHECK((middle(100 + row) - on_cylinder(M_PI / 16, 0.5)).norm() < 1e-3);
    CHECK((middle(100) - (skin.positions[0] + skin.positions[row + 2]) / 2).norm() < 1e-14);
  }
}

TEST_CASE("folds of less than 42 degrees remain between flat walls of two elements") {
  using generate::Diagonals;
  const auto diagonals = GENERATE(Diagonals::right, Diagonals::left, Diagonals::alternating, Diagonals::crossed);
  const auto wall = [](double x) {  // at 0, 35, 0, -35 degrees
    return std::tan(35 * M_PI / 180) * (std::clamp(x - 1, 0., 1.) - std::clamp(x - 3, 0., 1.));
  };
  const auto polygon = [](double u) {  // of 12 sides
    const double side = std::floor(12 * u + 1e-9), share = 12 * u - side;
    return Vector3d((1 - share) * on_cylinder(M_PI / 6 * side, 0) + share * on_cylinder(M_PI / 6 * (side + 1), 0));
  };
  const auto inside = [](const Vector3d& x) {
    const double angle = std::remainder(std::atan2(x[1], x[0]) - M_PI / 12, M_PI / 6);
    return x.head<2>().norm() * std::cos(angle) - std::cos(M_PI / 12);
  };
  for (const auto cells : both)
    for (const PetscInt rows : {1, 4}) {
      if (diagonals == Diagonals::crossed && cells == generate::ShellCells::quadrilaterals) continue;
      CAPTURE(static_cast<int>(diagonals), rows);
      const auto sheet = [&](double u, double v) { return Vector3d(4 * u, rows * v, wall(4 * u)); };
      CHECK(worst(halved(shell(cells, 8, rows, sheet, false, diagonals), 2),
                  [&](const Vector3d& x) { return wall(x[0]) - x[2]; }) < 1e-13);
      const auto tube = [&](double u, double v) { return Vector3d(polygon(u) + Vector3d(0, 0, v)); };
      CHECK(worst(halved(shell(cells, 24, rows, tube, true, diagonals), 2), inside) < 1e-13);
    }
}

TEST_CASE("walls of a wedge of 15 degrees remain flat, with a sharp edge") {
  for (const auto cells : both) {
    const double slope = std::tan(M_PI / 24);
    const auto wedge = [&](double u, double v) { return Vector3d(-std::abs(u - 0.5), v, slope * (u - 0.5)); };
    const RawMesh fine = halved(shell(cells, 2, 4, wedge));
    CHECK(worst(fine, [&](const Vector3d& x) { return std::abs(x[2]) + slope * x[0]; }) < 1e-13);
  }
}

TEST_CASE("rims of plates are arcs that fold no element") {
  for (const auto cells : both)
    for (const double width : {1., 0.1, 0.02}) {
      const auto ring = [&](double u, double v) { return Vector3d((1 + width * v) * on_cylinder(2 * M_PI * u, 0)); };
      const RawMesh fine = halved(shell(cells, 12, 2, ring, true), 2);
      if (width == 1)
        CHECK(testing::measure(fine, 0) == Approx(testing::measure(shell(cells, 48, 8, ring, true), 0)).epsilon(1e-3));
      for (const mesh::Cell& cell : fine.cells)
        for (int n = mesh::corner_count(cell.kind), i = 0; i < n; ++i) {
          const Vector3d &x = fine.positions[cell.nodes[i]], to = fine.positions[cell.nodes[(i + 1) % n]] - x,
                         back = fine.positions[cell.nodes[(i + n - 1) % n]] - x;
          CHECK(to.cross(back)[2] < 0);
        }
    }
}
