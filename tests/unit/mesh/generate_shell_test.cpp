#include <cmath>

#include "generated.h"

using namespace floe;
using Catch::Matchers::Contains;
using generate::Diagonals;
using generate::MappedGrid;
using generate::ShellCells;

namespace {

constexpr double pi = 3.14159265358979323846;

Eigen::Vector3d tube(double u, double v) { return {2 * std::cos(2 * pi * u), 2 * std::sin(2 * pi * u), 5 * v}; }

// Colatitude from 0 at v = 0 to pi at v = 1: outside to the left of u then v, hence -u.
Eigen::Vector3d sphere(double u, double v) {
  return {std::sin(pi * v) * std::cos(2 * pi * u), -std::sin(pi * v) * std::sin(2 * pi * u), std::cos(pi * v)};
}

double area(const MappedGrid& grid) { return testing::measure(generate::shell_of(PETSC_COMM_WORLD, grid), 0); }

}  // namespace

TEST_CASE("tubes close, with the area of the inscribed prism") {
  for (const auto diagonals : {Diagonals::right, Diagonals::alternating, Diagonals::left}) {
    for (const auto cells : {ShellCells::triangles, ShellCells::quadrilaterals}) {
      for (const PetscInt nu : {3, 8}) {
        MappedGrid grid{nu, 4, tube, true};
        grid.cells = cells;
        grid.diagonals = diagonals;
        const auto all = testing::sound([&](MPI_Comm comm) { return generate::shell_of(comm, grid); });
        CHECK(static_cast<PetscInt>(all.positions.size()) == nu * 5);
        const auto topology = testing::topology_of(all);
        CHECK(topology.euler == 0);  // of an annulus
        CHECK(topology.boundary_edges == 2 * nu);
        CHECK(area(grid) == Approx(5 * nu * 4 * std::sin(pi / static_cast<double>(nu))).epsilon(1e-12));
        CHECK(all.places.size() == 2);
        CHECK(all.places.at("bottom") == testing::nodes_where(all, [](const auto& x) { return x[2]; }));
        CHECK(all.places.at("top") == testing::nodes_where(all, [](const auto& x) { return x[2] - 5; }));
      }
    }
  }
}

TEST_CASE("a sphere has two poles, no edge and the area 4 pi at order 2") {
  double errors[2];
  for (const auto cells : {ShellCells::triangles, ShellCells::quadrilaterals}) {
    for (int k = 0; k < 2; ++k) {
      MappedGrid grid{12 << k, 6 << k, sphere, true, true, true};
      grid.cells = cells;
      const auto all = testing::sound([&](MPI_Comm comm) { return generate::shell_of(comm, grid); });
      CHECK(static_cast<PetscInt>(all.positions.size()) == grid.nu * (grid.nv - 1) + 2);
      const auto topology = testing::topology_of(all);
      CHECK(topology.euler == 2);
      CHECK(topology.boundary_edges == 0);
      CHECK(all.places.at("bottom").size() == 1);
      CHECK(all.places.at("top").size() == 1);
      errors[k] = 4 * pi - area(grid);
    }
    CHECK(std::log2(errors[0] / errors[1]) == Approx(2).margin(0.1));
  }
}

TEST_CASE("crossed diagonals and poles go together") {
  for (const bool bottom : {false, true}) {
    for (const bool top : {false, true}) {
      MappedGrid grid{7, 5, nullptr, true, bottom, top};
      grid.diagonals = Diagonals::crossed;
      const double from = bottom ? 0 : 0.2, to = top ? 1 : 0.9;
      grid.position = [=](double u, double v) { return sphere(u, from + (to - from) * v); };
      const auto all = testing::sound([&](MPI_Comm comm) { return generate::shell_of(comm, grid); });
      const auto topology = testing::topology_of(all);
      CHECK(topology.euler == bottom + top);
      CHECK(topology.boundary_edges == 7 * (2 - bottom - top));
    }
  }
}

TEST_CASE("a twisted tapered blade keeps its edges and corners") {
  MappedGrid grid{6, 20, [](double u, double v) {
                    const double chord = 2 - v, angle = v * pi / 4;
                    return Eigen::Vector3d((u - 0.5) * chord * std::cos(angle), (u - 0.5) * chord * std::sin(angle),
                                           10 * v);
                  }};
  grid.part = "blade";
  const auto all = testing::sound([&](MPI_Comm comm) { return generate::shell_of(comm, grid); });
  CHECK(all.parts == std::vector<std::string>{"blade"});
  CHECK(testing::topology_of(all).euler == 1);
  CHECK(all.places.at("left").size() == 21);
  CHECK(all.places.at("bottom") == testing::nodes_where(all, [](const auto& x) { return x[2]; }));
  CHECK(all.at(*all.places.at("p3").begin()).isApprox(grid.position(1, 1)));
  CHECK(all.at(*all.places.at("p4").begin()).isApprox(grid.position(0, 1)));
}

TEST_CASE("maps that do not do what is said of them are refused on every rank") {
  const auto fault = [](const MappedGrid& grid) {
    return testing::fault_of([&] { generate::shell_of(PETSC_COMM_WORLD, grid); });
  };
  CHECK(fault({4, 4, nullptr}) == "shell: there is no position(u, v)");
  CHECK(fault({2, 0, tube, true}) == "shell: nu = 2, expected at least 3\nshell: nv = 0, expected at least 1");
  CHECK(fault({4, 1, sphere, true, true, true}) == "shell: nv = 1, expected at least 2");
  CHECK(fault({4, 4, [](double u, double v) { return tube(0.9 * u, v); }, true}) ==
        "shell: u = 0 and u = 1 do not coincide");
  CHECK(fault({4, 4, tube, true, true}) == "shell: v = 0 is not a pole");
  CHECK(fault({4, 4, tube, true, false, true}) == "shell: v = 1 is not a pole");
  CHECK_THAT(fault({4, 4, [](double u, double v) { return Eigen::Vector3d(u, v, std::sqrt(0.9 - v)); }}),
             Contains("not finite"));
}
