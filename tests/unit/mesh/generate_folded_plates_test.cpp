#include "generated.h"

using namespace floe;
using Catch::Matchers::Contains;
using generate::Diagonals;
using generate::NamedPlate;
using generate::Plate;
using generate::ShellCells;

namespace {

// A box of sides 1, 2, 3 with its normals outwards; nz cells along z.
std::vector<NamedPlate> box(PetscInt nx, PetscInt ny, PetscInt nz, Diagonals diagonals) {
  const Eigen::Vector3d x(1, 0, 0), y(0, 2, 0), z(0, 0, 3), o(0, 0, 0);
  const auto plate = [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& a, const Eigen::Vector3d& b, PetscInt na,
                         PetscInt nb) { return Plate{origin, a, b, na, nb, ShellCells::triangles, diagonals}; };
  return {{"bottom", plate(o, y, x, ny, nx)},    {"top", plate(z, x, y, nx, ny)},   {"front", plate(o, x, z, nx, nz)},
          {"back", plate(x + y, -x, z, nx, nz)}, {"left", plate(y, -y, z, ny, nz)}, {"right", plate(x, y, z, ny, nz)}};
}

std::string fault(const std::vector<NamedPlate>& plates) {
  return testing::fault_of([&] { generate::folded_plates(PETSC_COMM_WORLD, plates); });
}

}  // namespace

TEST_CASE("six plates make a closed box") {
  for (const auto diagonals : {Diagonals::right, Diagonals::alternating, Diagonals::crossed}) {
    for (const auto [nx, ny, nz] : {std::array<PetscInt, 3>{1, 1, 1}, {2, 3, 4}, {5, 1, 2}}) {
      const auto plates = box(nx, ny, nz, diagonals);
      const auto make = [&](MPI_Comm comm) { return generate::folded_plates(comm, plates); };
      const auto all = testing::sound(make);
      const auto topology = testing::topology_of(all);
      CHECK(topology.euler == 2);  // of a sphere
      CHECK(topology.boundary_edges == 0);
      const double areas[]{2, 2, 3, 3, 6, 6};
      for (int p = 0; p < 6; ++p) CHECK(testing::measure(make(PETSC_COMM_WORLD), p) == Approx(areas[p]));
      CHECK(all.places.at("bottom.left") == all.places.at("front.bottom"));
      CHECK(all.places.at("top.p3") == all.places.at("back.p4"));
      CHECK(all.places.at("right.left") == all.places.at("front.right"));
      CHECK(static_cast<PetscInt>(all.places.at("right.left").size()) == nz + 1);
      CHECK(all.places.at("top.left") ==
            testing::nodes_where(all, [](const auto& x) { return std::hypot(x[0], x[2] - 3); }));
    }
  }
}

TEST_CASE("three plates meet at an edge, graded the same way from either end") {
  Plate web{{0, 0, 0}, {4, 0, 0}, {0, 0, 1}, 6, 2};
  Plate half{{0, 0, 1}, {4, 0, 0}, {0, 1, 0}, 6, 3};
  Plate other{{4, 0, 1}, {-4, 0, 0}, {0, -1, 0}, 6, 1};
  web.grading_a = half.grading_a = 4;
  other.grading_a = 1 / 4.;
  const auto make = [&](MPI_Comm comm) {
    return generate::folded_plates(comm, {{"web", web}, {"half", half}, {"other", other}});
  };
  const auto all = testing::sound(make);
  CHECK(all.positions.size() == 7 * 7);  // a line of 7 nodes at the edge, 2 + 3 + 1 beside it
  CHECK(all.places.at("web.top") == all.places.at("half.bottom"));
  CHECK(all.places.at("web.top") == all.places.at("other.bottom"));
  for (int p = 0; p < 3; ++p) CHECK(testing::measure(make(PETSC_COMM_WORLD), p) == Approx(4));
}

TEST_CASE("one plate alone and plates with one corner in common") {
  const Plate one{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4, 3};
  const auto alone = testing::sound([&](MPI_Comm comm) { return generate::folded_plates(comm, {{"one", one}}); });
  CHECK(alone.positions.size() == 20);
  CHECK(testing::topology_of(alone).boundary_edges == 14);
  Plate two = one;
  two.origin = {1, 1, 0};
  const auto both = testing::sound([&](MPI_Comm comm) {
    return generate::folded_plates(comm, {{"one", one}, {"two", two}});
  });
  CHECK(both.positions.size() == 39);
  CHECK(both.places.at("one.p3") == both.places.at("two.p1"));
}

TEST_CASE("plates that do not fit are named") {
  const Plate web{{0, 0, 0}, {4, 0, 0}, {0, 0, 1}, 6, 2}, flange{{0, 0, 1}, {4, 0, 0}, {0, 1, 0}, 5, 3};
  CHECK(fault({{"web", web}, {"flange", flange}}) ==
        "folded plates: web and flange have an edge in common, with 6 and 5 elements along it");
  Plate graded = flange;
  graded.na = 6;
  graded.grading_a = 2;
  CHECK(fault({{"web", web}, {"flange", graded}}) ==
        "folded plates: web and flange have an edge in common, with another grading along it");
  Plate shorter = flange;
  shorter.a = {2, 0, 0};
  CHECK(fault({{"web", web}, {"flange", shorter}}) ==
        "folded plates: a corner of flange lies inside an edge of web: divide that plate there");
  CHECK(fault({{"flange", shorter}, {"web", web}}) ==
        "folded plates: a corner of flange lies inside an edge of web: divide that plate there");
  CHECK(fault({{"web", web}, {"again", web}}) == "folded plates: web and again have the same corners");
  CHECK(fault({}) == "folded plates: there is no plate");
  CHECK(fault({{"web", web}, {"web", flange}}) == "folded plates: two plates are called web");
  CHECK_THAT(fault({{"web", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0, 1}}}), Contains("web: na = 0"));
}
