#include "generated.h"

using namespace floe;
using Catch::Matchers::Contains;
using generate::Lattice;
using generate::LatticeDiagonals;

TEST_CASE("a branching polyline has the lengths and places of its segments") {
  const generate::Polyline lines{
      {{0, 0, 0}, {3, 0, 0}, {3, 4, 0}, {3, 0, 2}}, {{0, 1}, {2, 1}, {1, 3}}, {3, 5, 1}, {"shaft", "arm", "shaft"}};
  const auto make = [&](MPI_Comm comm) { return generate::polyline(comm, lines); };
  const auto all = testing::sound(make);
  CHECK(all.parts == std::vector<std::string>{"shaft", "arm"});
  CHECK(all.positions.size() == 10);  // a tree: one node more than lines
  CHECK(all.cells.size() == 9);
  CHECK(testing::measure(make(PETSC_COMM_WORLD), 0) == Approx(5));
  CHECK(testing::measure(make(PETSC_COMM_WORLD), 1) == Approx(4));
  for (int p = 0; p < 4; ++p) {
    const auto& place = all.places.at("p" + std::to_string(p + 1));
    REQUIRE(place.size() == 1);
    CHECK(all.at(*place.begin()) == lines.points[p]);
  }
  CHECK(all.places.at("start") == all.places.at("p1"));
  CHECK(all.places.at("end") == all.places.at("p4"));
}

TEST_CASE("a polyline without segments joins its points in turn") {
  const auto all = testing::sound([](MPI_Comm comm) {
    return generate::polyline(comm, {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {}, {2, 3}, {}});
  });
  CHECK(all.parts == std::vector<std::string>{"line"});
  CHECK(all.positions.size() == 6);
  CHECK(all.at(4)[1] == Approx(2 / 3.));
}

TEST_CASE("bad polylines are refused") {
  const auto fault = [](const generate::Polyline& lines) {
    return testing::fault_of([&] { generate::polyline(PETSC_COMM_WORLD, lines); });
  };
  const std::vector<Eigen::Vector3d> points{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}};
  CHECK(fault({}) == "polyline: there is no segment");
  CHECK(fault({points, {{0, 1}, {1, 2}}, {0, 1}, {}}) ==
        "polyline: elements of segment 1 = 0, expected at least 1\npolyline: segment 2 has no length");
  CHECK_THAT(fault({points, {{0, 3}}, {1}, {}}), Contains("do not exist"));
  CHECK_THAT(fault({points, {{0, 1}}, {1}, {}}), Contains("no segment meets point 3"));
  CHECK_THAT(fault({points, {{0, 1}}, {1, 2}, {}}), Contains("1 segments, 2 numbers"));
  CHECK_THAT(fault({{{0, 0, 0}, {1, 0, 0}}, {{0, 1}, {1, 0}}, {1, 1}, {}}),
             Contains("two segments join points 1 and 2"));
  CHECK_THAT(fault({{{0, 0, 0}, {1, std::nan(""), 0}}, {}, {1}, {}}), Contains("point 2") && Contains("not finite"));
  if (sizeof(PetscInt) == 4)
    CHECK_THAT(fault({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {}, {PETSC_MAX_INT, PETSC_MAX_INT}, {}}), Contains("petsc64"));
}

TEST_CASE("lattices have the beams of their boxes") {
  const double x = 1, y = 2, z = 3;
  const PetscInt nx = 3, ny = 2, nz = 4;
  const double xs = nx * (ny + 1) * (nz + 1), ys = (nx + 1) * ny * (nz + 1), zs = (nx + 1) * (ny + 1) * nz;
  const double xy = 2 * nx * ny * (nz + 1), xz = 2 * nx * (ny + 1) * nz, yz = 2 * (nx + 1) * ny * nz;
  const double through = 4 * nx * ny * nz;
  for (const auto diagonals : {LatticeDiagonals::none, LatticeDiagonals::faces, LatticeDiagonals::all}) {
    const auto make = [&](MPI_Comm comm) { return generate::lattice(comm, Lattice{nx, ny, nz, {x, y, z}, diagonals}); };
    const auto all = testing::sound(make);
    const bool faces = diagonals != LatticeDiagonals::none, inside = diagonals == LatticeDiagonals::all;
    CHECK(all.positions.size() == 4 * 3 * 5);
    CHECK(static_cast<double>(all.cells.size()) == xs + ys + zs + (faces ? xy + xz + yz : 0) + (inside ? through : 0));
    const auto raw = make(PETSC_COMM_WORLD);
    CHECK(testing::measure(raw, 0) == Approx(xs * x + ys * y + zs * z));
    CHECK(all.parts.size() == (faces ? 2 : 1));
    if (faces)
      CHECK(testing::measure(raw, 1) == Approx(xy * std::hypot(x, y) + xz * std::hypot(x, z) + yz * std::hypot(y, z) +
                                               (inside ? through * std::hypot(x, y, z) : 0)));
  }
}

TEST_CASE("the places of a lattice are its faces and corners") {
  const auto all = testing::sound([&](MPI_Comm comm) { return generate::lattice(comm, {3, 2, 4, {1, 2, 3}}); });
  const Eigen::Vector3d size(3, 4, 12);
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    CHECK(all.places.at(name + "min") == testing::nodes_where(all, [&](const auto& p) { return p[axis]; }));
    CHECK(all.places.at(name + "max") ==
          testing::nodes_where(all, [&](const auto& p) { return p[axis] - size[axis]; }));
  }
  const std::vector<Eigen::Vector3d> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                             {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (int k = 0; k < 8; ++k) {
    const auto& place = all.places.at("p" + std::to_string(k + 1));
    REQUIRE(place.size() == 1);
    CHECK(all.at(*place.begin()) == corners[k].cwiseProduct(size));
  }
}

TEST_CASE("bad lattices are refused") {
  const auto fault = [](const Lattice& lattice) {
    return testing::fault_of([&] { generate::lattice(PETSC_COMM_WORLD, lattice); });
  };
  CHECK(fault({1, 0, 1, {1, 1, -1}}) ==
        "lattice: ny = 0, expected at least 1\nlattice: unit cell size along z = -1, expected a number above 0");
  CHECK_THAT(fault({1, 1, 1, {1, std::nan(""), 1}}), Contains("along y = nan"));
  if (sizeof(PetscInt) == 4) CHECK_THAT(fault({1000, 1000, 1000, {1, 1, 1}}), Contains("petsc64"));
}
