#include "generated.h"

using namespace floe;
using Catch::Matchers::Contains;
using generate::Diagonals;
using generate::Plate;
using generate::ShellCells;

namespace {

Plate skew(PetscInt na, PetscInt nb, ShellCells cells, Diagonals diagonals) {
  return {{1, 2, 3}, {4, 0, 0}, {1, 2, 0.5}, na, nb, cells, diagonals};
}

}  // namespace

TEST_CASE("plates of every pattern have the counts, area and edges of a parallelogram") {
  for (const auto [na, nb] : {std::array<PetscInt, 2>{1, 1}, {5, 3}, {4, 6}, {1, 7}, {9, 1}}) {
    for (const auto diagonals : {Diagonals::left, Diagonals::right, Diagonals::alternating, Diagonals::crossed}) {
      for (const auto cells : {ShellCells::triangles, ShellCells::quadrilaterals}) {
        const bool crossed = diagonals == Diagonals::crossed, triangles = cells == ShellCells::triangles;
        if (crossed && !triangles) continue;
        const Plate given = skew(na, nb, cells, diagonals);
        const auto all = testing::sound([&](MPI_Comm comm) { return generate::plate(comm, given); });
        CHECK(static_cast<PetscInt>(all.positions.size()) == (na + 1) * (nb + 1) + (crossed ? na * nb : 0));
        CHECK(static_cast<PetscInt>(all.cells.size()) == na * nb * (triangles ? (crossed ? 4 : 2) : 1));
        const auto topology = testing::topology_of(all);
        CHECK(topology.euler == 1);  // of a disc
        CHECK(topology.boundary_edges == 2 * (na + nb));
        CHECK(testing::measure(generate::plate(PETSC_COMM_WORLD, given), 0) ==
              Approx(given.a.cross(given.b).norm()).epsilon(1e-13));
        for (const auto& cell : all.cells) {  // normals along a x b
          const Eigen::Vector3d normal = (all.at(cell[3]) - all.at(cell[2])).cross(all.at(cell[4]) - all.at(cell[2]));
          CHECK(normal.dot(given.a.cross(given.b)) > 0);
        }
      }
    }
  }
}

TEST_CASE("the places of a plate are its edges, corners and centre") {
  const Plate given{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 6, 4};
  const auto all = testing::sound([&](MPI_Comm comm) { return generate::plate(comm, given); });
  CHECK(all.parts == std::vector<std::string>{"plate"});
  CHECK(all.places.size() == 9);
  const auto where = [&](auto zero) { return testing::nodes_where(all, zero); };
  CHECK(all.places.at("left") == where([](const Eigen::Vector3d& x) { return x[0]; }));
  CHECK(all.places.at("right") == where([](const Eigen::Vector3d& x) { return x[0] - 2; }));
  CHECK(all.places.at("bottom") == where([](const Eigen::Vector3d& x) { return x[1]; }));
  CHECK(all.places.at("top") == where([](const Eigen::Vector3d& x) { return x[1] - 1; }));
  const std::vector<std::pair<std::string, Eigen::Vector3d>> single{
      {"p1", {0, 0, 0}}, {"p2", {2, 0, 0}}, {"p3", {2, 1, 0}}, {"p4", {0, 1, 0}}, {"centre", {1, 0.5, 0}}};
  for (const auto& [name, at] : single)
    CHECK(all.places.at(name) == where([&](const Eigen::Vector3d& x) { return (x - at).norm(); }));
  const auto centre = [](PetscInt na, PetscInt nb, Diagonals diagonals, double grading = 1) {
    const auto whole = testing::whole(generate::plate(
        PETSC_COMM_SELF, {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, na, nb, ShellCells::triangles, diagonals, grading}));
    const auto found = whole.places.find("centre");
    return found == whole.places.end() ? -1. : (whole.at(*found->second.begin()) - Eigen::Vector3d(1, 0.5, 0)).norm();
  };
  CHECK(centre(3, 5, Diagonals::crossed) == Approx(0).margin(1e-15));
  CHECK(centre(4, 2, Diagonals::crossed) == Approx(0).margin(1e-15));
  CHECK(centre(3, 4, Diagonals::crossed) == -1);
  CHECK(centre(3, 5, Diagonals::right) == -1);
  CHECK(centre(4, 4, Diagonals::right, 2) == -1);
}

TEST_CASE("diagonals run as they are called") {
  const auto first = [](Diagonals diagonals) {
    const auto all = testing::whole(
        generate::plate(PETSC_COMM_SELF, {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 2, 1, ShellCells::triangles, diagonals}));
    const auto edges = testing::edges_of(all);  // nodes 0 1 2 below, 3 4 5 above
    return std::array<bool, 4>{edges.contains({0, 4}), edges.contains({1, 3}), edges.contains({1, 5}),
                               edges.contains({2, 4})};
  };
  CHECK(first(Diagonals::right) == std::array<bool, 4>{true, false, true, false});
  CHECK(first(Diagonals::left) == std::array<bool, 4>{false, true, false, true});
  CHECK(first(Diagonals::alternating) == std::array<bool, 4>{true, false, false, true});
}

TEST_CASE("a graded plate has cells in geometric progression") {
  Plate given{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, 5, 4, ShellCells::quadrilaterals};
  given.grading_a = 16;
  given.grading_b = 1 / 8.;
  const auto all = testing::sound([&](MPI_Comm comm) { return generate::plate(comm, given); });
  const auto length = [&](PetscInt i) { return all.at(i + 1)[0] - all.at(i)[0]; };
  const auto height = [&](PetscInt j) { return all.at(6 * (j + 1))[1] - all.at(6 * j)[1]; };
  for (PetscInt i = 1; i < 5; ++i) CHECK(length(i) / length(i - 1) == Approx(2).epsilon(1e-12));
  for (PetscInt j = 1; j < 4; ++j) CHECK(height(j) / height(j - 1) == Approx(0.5).epsilon(1e-12));
  CHECK(all.at(29) == Eigen::Vector3d(2, 3, 0));
}

TEST_CASE("arguments that make no plate are reported together") {
  const double nan = std::nan("");
  const auto fault = [](const Plate& plate) {
    return testing::fault_of([&] { generate::plate(PETSC_COMM_WORLD, plate); });
  };
  CHECK(fault({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0, -3}) ==
        "plate: na = 0, expected at least 1\nplate: nb = -3, expected at least 1");
  CHECK(fault({{0, 0, 0}, {1, 0, 0}, {-2, 0, 0}, 1, 1}) == "plate: edges a and b are parallel");
  CHECK(fault({{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, 1, 1}) == "plate: an edge has no length");
  CHECK_THAT(fault({{0, nan, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1}), Contains("origin") && Contains("not finite"));
  CHECK_THAT(fault({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1, ShellCells::quadrilaterals, Diagonals::crossed}),
             Contains("crossed"));
  CHECK_THAT(fault({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1, ShellCells::triangles, Diagonals::left, 0, nan}),
             Contains("grading_a = 0, expected a number above 0") && Contains("grading_b = nan"));
}

TEST_CASE("a plate that PetscInt cannot count names the build that can") {
  if (sizeof(PetscInt) == 8) return;
  const PetscInt most = PETSC_MAX_INT;
  const auto fault = [](PetscInt na, PetscInt nb) {
    return testing::fault_of([&] {
      generate::plate(PETSC_COMM_WORLD, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, na, nb, ShellCells::triangles});
    });
  };
  CHECK_THAT(fault(40000, 40000), Contains("3.2e+09 elements") && Contains("petsc64"));
  CHECK_THAT(fault(most, most), Contains("petsc64"));
}
