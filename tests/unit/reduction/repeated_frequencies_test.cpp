#include <catch2/catch.hpp>

#include "bodies_in_space.h"

using namespace floe;
using testing::Kind;
using testing::SpatiallyConstrained;
using testing::Spread;

namespace {

/// A beam along x of one bending stiffness about all axes: each bending frequency twice, torsion and tension far above.
fem::Structure round_beam(MPI_Comm comm, Spread spread) {
  const generate::Polyline line{{{0, 0, 0}, {1, 0, 0}}, {{0, 1}}, {8}, {}};
  const fem::SpatialBeam beam{{1e5, 1, 1, 0, 1e3, 1, 1e-5, 1e-5, 0, {0, 0}, {0, 0}}, {0, 0, 1}, {}};
  return testing::structure_of(generate::polyline(comm, line), {beam}, spread);
}

/// Modes 2 and 3 of a square plate that is clamped all round are one another's mirror images.
fem::Structure square_plate(MPI_Comm comm, Spread spread) {
  generate::Plate plate{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 6, 6};
  plate.cells = generate::ShellCells::quadrilaterals;
  return testing::structure_of(generate::plate(comm, plate),
                               {fem::shell_section({{fem::isotropic(1e4, 0.3, 2), 0.02, 0}})}, spread);
}

std::vector<PetscInt> edges_of_plate() {
  std::vector<PetscInt> nodes;
  for (PetscInt i = 0; i < 49; ++i)
    if (i % 7 == 0 || i % 7 == 6 || i < 7 || i >= 42) nodes.push_back(i);
  return nodes;
}

}  // namespace

TEST_CASE("modes of one frequency are the same on any partition, however many are asked for") {
  const bool beam = GENERATE(true, false);
  const Spread spread = GENERATE(Spread::metis, Spread::shuffled);
  const int count = GENERATE(1, 2, 3, 5);
  const auto make = beam ? round_beam : square_plate;
  const std::vector<PetscInt> constrained = beam ? std::vector<PetscInt>{0} : edges_of_plate();
  const SpatiallyConstrained all(make(PETSC_COMM_WORLD, spread), Kind::clamped, constrained),
      alone(make(PETSC_COMM_SELF, Spread::last), Kind::clamped, constrained);
  const reduction::Modes found = all.modes(count), expected = alone.modes(count);
  INFO((beam ? "beam, " : "plate, ") << count);
  CHECK(found.left_out == expected.left_out);
  for (int i = 0; i < count; ++i) {
    CHECK(found.omega[i] == Approx(expected.omega[i]).epsilon(1e-9));
    const Eigen::VectorXd a = testing::in_original_order(all.structure, found.raw[i]),
                          b = testing::in_original_order(alone.structure, expected.raw[i]);
    CHECK((a - b).norm() < 1e-6 * b.norm());
  }
}

// The first translation that the two of a round beam share is along y: the first mode takes it, the second has none.
TEST_CASE("modes of a round beam bend along y and z, and the one that the count leaves out is counted") {
  const SpatiallyConstrained body(round_beam(PETSC_COMM_WORLD, Spread::shuffled), Kind::clamped, {0});
  for (const int count : {1, 2, 3, 4}) {
    const reduction::Modes modes = body.modes(count);
    INFO(count);
    CHECK(modes.left_out == count % 2);
    REQUIRE(static_cast<int>(modes.raw.size()) == count);
    for (int i = 0; i < count; ++i) {
      const Eigen::VectorXd u = testing::in_original_order(body.structure, modes.raw[i]);
      double along[3] = {0, 0, 0};
      for (Eigen::Index dof = 0; dof < u.size(); ++dof)
        if (dof % 6 < 3) along[dof % 6] = std::max(along[dof % 6], std::abs(u[dof]));
      CHECK(along[i % 2 == 0 ? 2 : 1] < 1e-6 * along[i % 2 == 0 ? 1 : 2]);
    }
  }
}
