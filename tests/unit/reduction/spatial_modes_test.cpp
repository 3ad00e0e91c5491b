#include <catch2/catch.hpp>

#include "bodies_in_space.h"
#include "eigenvalues.h"
#include "floe/error.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using generate::ShellCells;
using testing::body_of;
using testing::Kind;
using testing::SpatiallyConstrained;
using testing::Spread;
using testing::What;

namespace {

/// Eigenvalues of K phi = lambda M phi, ascending, by a dense solver: M may be singular, K + s M is not.
VectorXd dense_eigenvalues(const fem::Structure& s, double shift) {
  const MatrixXd K = testing::dense(s, fem::stiffness(s, {})), M = testing::dense(s, fem::mass(s, {}));
  const Eigen::VectorXd values = testing::eigenvalues(M, K + shift * M);
  return (1 / values.reverse().array() - shift).matrix();
}

}  // namespace

TEST_CASE("a free body in space has six zero modes, which are deflated, and elastic modes that carry no momentum") {
  const What what = GENERATE(What::triangles, What::quadrilaterals, What::beams, What::mixed);
  const SpatiallyConstrained body(body_of(what, PETSC_COMM_WORLD, Spread::shuffled), Kind::mean_axis, {});
  const fem::Structure alone = body_of(what, PETSC_COMM_SELF, Spread::last);
  const int count = 6;
  const reduction::Modes modes = body.modes(count);
  REQUIRE(modes.omega.size() == count);
  const double first = modes.omega[0] * modes.omega[0];
  const VectorXd expected = dense_eigenvalues(alone, first / 10);
  for (int i = 0; i < 6; ++i) CHECK(std::abs(expected[i]) < 1e-7 * expected[6]);
  for (int i = 0; i < count; ++i) CHECK(modes.omega[i] * modes.omega[i] == Approx(expected[6 + i]).epsilon(1e-8));
  const petsc::MatHandle M = fem::mass(body.structure, {});
  for (int i = 0; i < count; ++i) {
    CHECK(modes.residual[i] < 1e-7);
    for (const auto& motion : body.frame.rigid) {
      const double scale = std::sqrt(testing::form(M, motion, motion));
      CHECK(std::abs(testing::form(M, motion, modes.raw[i])) < 1e-9 * scale);
      CHECK(std::abs(testing::form(M, motion, modes.shapes[i])) < 1e-9 * scale);
    }
    for (int j = 0; j <= i; ++j)
      CHECK(testing::form(M, modes.raw[i], modes.raw[j]) == Approx(i == j ? 1 : 0).epsilon(0).margin(1e-9));
  }
}

TEST_CASE("frequencies and shapes of bodies in space are the same on any partition") {
  const What what = GENERATE(What::triangles, What::quadrilaterals, What::beams, What::mixed);
  const bool constrained = GENERATE(false, true);
  const Spread spread = GENERATE(Spread::metis, Spread::shuffled);
  const std::vector<PetscInt> root = constrained ? std::vector<PetscInt>{0} : std::vector<PetscInt>{};
  const Kind kind = constrained ? Kind::clamped : Kind::mean_axis;
  const SpatiallyConstrained all(body_of(what, PETSC_COMM_WORLD, spread), kind, root),
      alone(body_of(what, PETSC_COMM_SELF, Spread::last), kind, root);
  const int count = 6;
  const reduction::Modes found = all.modes(count), expected = alone.modes(count);
  for (int i = 0; i < count; ++i) {
    CHECK(found.omega[i] == Approx(expected.omega[i]).epsilon(1e-9));
    CHECK(testing::relative_error(testing::in_original_order(all.structure, found.shapes[i]),
                                  testing::in_original_order(alone.structure, expected.shapes[i])) < 1e-6);  // sign too
  }
}

TEST_CASE("modes of a body in space satisfy K phi = omega^2 M phi under its joints") {
  const What what = GENERATE(What::quadrilaterals, What::beams);
  const SpatiallyConstrained body(body_of(what, PETSC_COMM_WORLD, Spread::metis), Kind::clamped, {0, 5});
  const reduction::Modes modes = body.modes(4);
  const petsc::MatHandle K = fem::stiffness(body.structure, body.holding.constrained),
                         M = fem::mass(body.structure, body.holding.constrained);
  for (int i = 0; i < 4; ++i) {
    VectorXd left = testing::product(K, modes.raw[i]);
    for (PetscInt dof : body.holding.constrained) left[dof] = 0;
    const double lambda = modes.omega[i] * modes.omega[i];
    CHECK(testing::relative_error(left, lambda * testing::product(M, modes.raw[i])) < 1e-6);
    for (PetscInt dof : body.holding.constrained) CHECK(testing::everywhere(modes.raw[i])[dof] == 0);
  }
}

// Rotations about a shell's normal have no mass: what the eigenvalue solver leaves there in high modes has to go.
TEST_CASE("high modes of a shell are those of a dense solver, without what the mass does not see") {
  const SpatiallyConstrained body(
      testing::small_plate(PETSC_COMM_WORLD, GENERATE(ShellCells::triangles, ShellCells::quadrilaterals),
                           Spread::metis),
      Kind::clamped, testing::root_of_plate());
  const int count = 40;
  const reduction::Modes modes = body.modes(count);
  const petsc::MatHandle K = fem::stiffness(body.structure, body.holding.constrained),
                         M = fem::mass(body.structure, body.holding.constrained);
  const MatrixXd k = testing::dense(body.structure, K), m = testing::dense(body.structure, M);
  const VectorXd expected = testing::eigenvalues(m, k).reverse().head(count).cwiseInverse();
  for (int i = 0; i < count; ++i) {
    INFO("mode " << i + 1);
    CHECK(modes.omega[i] * modes.omega[i] == Approx(expected[i]).epsilon(1e-9));
    const VectorXd left = testing::product(K, modes.raw[i]);
    CHECK(testing::relative_error(left, expected[i] * testing::product(M, modes.raw[i])) < 1e-6);
    CHECK(modes.residual[i] < 1e-8);
  }
}

TEST_CASE("more modes than elastic dofs of a body in space are refused, free or held") {
  const auto beam = [] {
    const fem::SpatialBeam section{{50, 1, 2, 0, 1, 1, 0.1, 0.1, 0, {0, 0}, {0, 0}}, {0, 1, 0}, {}};
    return testing::structure_of(generate::polyline(PETSC_COMM_WORLD, {{{0, 0, 0}, {1, 0, 0}}, {}, {2}, {}}), {section},
                                 Spread::last);
  };
  const SpatiallyConstrained free(beam(), Kind::mean_axis, {}), constrained(beam(), Kind::clamped, {0});
  CHECK_THROWS_AS(free.modes(13), InputError);
  CHECK_THROWS_AS(constrained.modes(13), InputError);
  CHECK(constrained.modes(12).omega.size() == 12);
  CHECK(free.modes(12).omega.size() == 12);
}
