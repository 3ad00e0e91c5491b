#include <catch2/catch.hpp>
#include <cmath>

#include "bodies.h"
#include "eigenvalues.h"

// A beam with L = EI = rhoA = 1, of so many elements that an assembled stiffness misses eps (L/h)^4 of the energy.

using namespace floe;
using testing::Held;
using testing::Kind;

namespace {

fem::Structure beam(PetscInt elements) { return testing::straight(PETSC_COMM_WORLD, elements, 1, {1e4, 1, 1, 0}); }

const double clamped_free[] = {3.51601526850015, 22.0344915646688};  // roots of 1 + cos cosh, squared

}  // namespace

TEST_CASE("a held beam of many elements keeps its frequencies, its static answers and its reduced stiffness",
          "[long]") {
  const PetscInt n = GENERATE(4096, 20000);
  const Held body(beam(n), Kind::clamped, {0, 1, 2});
  const auto modes = reduction::vibration_modes(body.structure, body.frame, body.holding, body.statics, 2);
  for (int i = 0; i < 2; ++i) {
    CHECK(modes.omega[i] == Approx(clamped_free[i]).epsilon(1e-7));
    CHECK(modes.residual[i] < 1e-6);
  }
  reduction::Columns loads;
  const PetscInt tip = 3 * n + 1;
  loads.push_back(testing::field_of(body.structure, Eigen::VectorXd::Unit(body.structure.dofs(), tip)));
  CHECK(testing::everywhere(body.statics.solve(loads)[0])[tip] == Approx(1. / 3).epsilon(1e-7));  // F L^3 / 3 EI

  std::vector<reduction::ColumnOrigin> origins(2);
  const reduction::Basis basis = reduction::orthonormal_basis(body.structure, modes.shapes, origins, 1e-7);
  const body::FlexibleBody reduced = reduction::project(body.structure, basis);
  const Eigen::MatrixXd K = reduced.elasticity.linear_stiffness(),
                        M = reduced.inertia.M[0][0] + reduced.inertia.M[1][1];
  const Eigen::VectorXd lambda = testing::eigenvalues(K, M);
  for (int i = 0; i < 2; ++i) CHECK(std::sqrt(lambda[i]) == Approx(clamped_free[i]).epsilon(1e-6));
}

TEST_CASE("a free beam of many elements keeps its frequencies", "[long]") {
  const Held body(beam(8192), Kind::mean_axis, {});
  const auto modes = reduction::vibration_modes(body.structure, body.frame, body.holding, body.statics, 2);
  CHECK(modes.omega[0] == Approx(22.3732854481).epsilon(1e-7));  // 1 - cos cosh
  CHECK(modes.omega[1] == Approx(61.6728228676).epsilon(1e-7));
}

// Axial and bending stiffness meet in the same rows: an assembled stiffness misses eps EA h^2 / EI of the energy.
TEST_CASE("a free oblique and slender beam keeps its frequencies") {
  const fem::Segments line{{{0, 0, 0}, {0.6, 0.8, 0}}, {{0, 1}}, {100}};
  const Held body(
      fem::planar_structure(fem::mesh_of(PETSC_COMM_WORLD, line), {{1e14, 1, 1, 0}}, fem::MembraneStrain::averaged),
      Kind::mean_axis, {});
  const auto modes = reduction::vibration_modes(body.structure, body.frame, body.holding, body.statics, 2);
  CHECK(modes.omega[0] == Approx(22.3732854481).epsilon(1e-6));
  CHECK(modes.omega[1] == Approx(61.6728228676).epsilon(1e-6));
}

TEST_CASE("derivatives with inertia of a held beam of many elements are those of few", "[long]") {
  const auto tip = [](PetscInt n) {
    const Held body(beam(n), Kind::clamped, {0, 1, 2});
    const auto modes = reduction::vibration_modes(body.structure, body.frame, body.holding, body.statics, 2);
    reduction::Pairs which;
    std::vector<double> shortening;
    for (const auto& theta : reduction::full_derivatives(body.structure, body.frame, body.holding, body.statics, modes,
                                                         reduction::all_pairs(2), which))
      shortening.push_back(testing::everywhere(theta)[3 * n]);
    return shortening;
  };
  const std::vector<double> few = tip(128), many = tip(8192);
  REQUIRE(many.size() == 4);
  for (int p = 0; p < 4; ++p) CHECK(many[p] == Approx(few[p]).epsilon(1e-4).margin(1e-4));
}

TEST_CASE("a mesh that double precision does not resolve is refused, or right", "[long]") {
  const Held body(beam(200000), Kind::clamped, {0, 1, 2});
  try {
    const auto modes = reduction::vibration_modes(body.structure, body.frame, body.holding, body.statics, 1);
    CHECK(modes.omega[0] == Approx(clamped_free[0]).epsilon(1e-4));
  } catch (const RunError& error) {
    CHECK_THAT(error.what(), Catch::Contains("the mesh of 200000 elements is finer than double precision resolves") &&
                                 Catch::Contains("take fewer elements"));
  }
}

TEST_CASE("with a solver of the user's own, a spoilt factor's frequency is as uncertain as its residual says") {
  const PetscInt n = GENERATE(2000, 20000);
  petsc::check(PetscOptionsSetValue(nullptr, "-modes_st_ksp_type", "preonly"));
  const Held body(beam(n), Kind::clamped, {0, 1, 2});
  try {
    const auto modes = reduction::vibration_modes(body.structure, body.frame, body.holding, body.statics, 1);
    CHECK(modes.residual[0] > 1e-9);
    CHECK(std::abs(std::pow(modes.omega[0] / clamped_free[0], 2) - 1) < modes.residual[0]);
  } catch (const RunError& error) {
    CHECK_THAT(error.what(), Catch::Contains("is finer than double precision resolves: mode 1 lies between"));
  }
  petsc::check(PetscOptionsClearValue(nullptr, "-modes_st_ksp_type"));
}

// What is left along a bending mode, 1e-13 of it, would bend the derivatives by EA L^2 / EI times as much.
TEST_CASE("modes of a slender straight beam have nothing along it, nor their derivatives across it") {
  const Held body(testing::straight(PETSC_COMM_WORLD, 20, 1, {1e10, 1, 1, 0}), Kind::clamped, {0, 1, 2, 30, 31, 32});
  const reduction::Generators g = body.generators(3);
  const reduction::DerivativeColumns theta = reduction::derivative_columns(
      body.structure, body.frame, body.holding, body.statics, g, reduction::all_pairs(3), false);
  const auto parts = [](Vec field) {
    const Eigen::VectorXd u = testing::everywhere(field);
    const auto rows = Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic>>(u.data(), 3, u.size() / 3);
    return std::pair(rows.row(0).norm(), rows.bottomRows<2>().norm());
  };
  for (const auto& mode : g.modes.raw) {
    const auto [along, across] = parts(mode);
    CHECK(along == 0);
    CHECK(across > 0);
  }
  REQUIRE(theta.columns.size() == 6);
  int stretched = 0;  // modes of the two spans have no derivative in common
  for (const auto& column : theta.columns) {
    const auto [along, across] = parts(column);
    CHECK(across == 0);
    if (along > 0) ++stretched;
  }
  CHECK(stretched == 4);
}
