#include "../../../src/reduction/multigrid.h"

#include <catch2/catch.hpp>
#include <map>
#include <string>

#include "bodies_in_space.h"
#include "options.h"

using namespace floe;
using namespace floe::testing;

namespace {

/// Those of examples/blade/options/iterative.opts, for a solver with a prefix.
std::map<std::string, std::string> multigrid(const std::string& prefix) {
  return {{"-" + prefix + "ksp_type", "cg"},
          {"-" + prefix + "pc_type", "gamg"},
          {"-" + prefix + "pc_gamg_asm_use_agg", "1"},
          {"-" + prefix + "mg_levels_pc_type", "asm"},
          {"-" + prefix + "mg_levels_pc_asm_overlap", "0"},
          {"-" + prefix + "mg_levels_sub_pc_type", "lu"}};
}

Eigen::MatrixXd all(const reduction::Columns& columns, PetscInt dofs) {
  Eigen::MatrixXd values(dofs, columns.size());
  for (std::size_t j = 0; j < columns.size(); ++j) values.col(j) = everywhere(columns[j]);
  return values;
}

/// Modes, then their derivatives.
Eigen::MatrixXd columns_of(Kind kind, const std::vector<PetscInt>& constrained, std::vector<double>& omega) {
  const SpatiallyConstrained body(body_of(What::triangles, PETSC_COMM_WORLD, Spread::metis), kind, constrained);
  const PetscInt dofs = body.structure.dofs();
  const reduction::Modes modes = body.modes(3);
  omega = modes.omega;
  const reduction::Columns theta =
      reduction::static_derivatives(body.structure, body.statics, modes.shapes, reduction::all_pairs(3));
  Eigen::MatrixXd both(dofs, 9);
  both << all(modes.shapes, dofs), all(theta, dofs);
  return both;
}

void check_same(Kind kind, const std::vector<PetscInt>& constrained, std::map<std::string, std::string> options) {
  std::vector<double> exact, omega;
  const Eigen::MatrixXd direct = columns_of(kind, constrained, exact);
  const Options set(std::move(options));
  const Eigen::MatrixXd iterated = columns_of(kind, constrained, omega);
  for (std::size_t i = 0; i < exact.size(); ++i) CHECK(omega[i] == Approx(exact[i]).epsilon(1e-9));
  for (Eigen::Index j = 0; j < direct.cols(); ++j)
    CHECK((iterated.col(j) - direct.col(j)).norm() < 1e-6 * direct.col(j).norm());
}

}  // namespace

TEST_CASE("the near null space of a body that nothing holds is that of its stiffness") {
  const What what = GENERATE(What::triangles, What::beams);
  const SpatiallyConstrained body(body_of(what, PETSC_COMM_WORLD, Spread::metis), Kind::mean_axis, {});
  const petsc::MatHandle K = fem::stiffness(body.structure, {}), rows = reduction::for_multigrid(K, body.frame, {});
  MatNullSpace near = nullptr;
  PetscInt count = 0, block = 0;
  const Vec* motions = nullptr;
  double stiffest = 0;
  petsc::check(MatGetBlockSize(rows, &block));
  CHECK(block == 6);
  petsc::check(MatGetNearNullSpace(rows, &near));
  petsc::check(MatNullSpaceGetVecs(near, nullptr, &count, &motions));
  REQUIRE(count == 6);
  petsc::check(MatNorm(rows, NORM_INFINITY, &stiffest));
  for (PetscInt i = 0; i < count; ++i)
    for (PetscInt j = 0; j <= i; ++j) {
      double product = 0;
      petsc::check(VecDot(motions[i], motions[j], &product));
      CHECK(product == Approx(i == j).margin(1e-12));
    }
  for (PetscInt i = 0; i < count; ++i) CHECK(product(rows, motions[i]).norm() < 1e-12 * stiffest);
}

TEST_CASE("conjugate gradients with multigrid find the modes and derivatives that a factor finds") {
  check_same(Kind::clamped, root_of_plate(), multigrid("derivatives_"));
}

TEST_CASE("so they do of a body that nothing holds") {
  auto options = multigrid("derivatives_");
  options.merge(multigrid("modes_st_"));
  check_same(Kind::mean_axis, {}, options);
}

TEST_CASE("derivatives with inertia want a factor") {
  const SpatiallyConstrained body(small_plate(PETSC_COMM_WORLD, generate::ShellCells::triangles, Spread::metis),
                                  Kind::clamped, root_of_plate());
  const reduction::Modes modes = body.modes(1);
  const Options set(multigrid("derivatives_"));
  reduction::Pairs which;
  CHECK_THROWS_WITH(
      reduction::full_derivatives(body.structure, body.frame, body.holding, body.statics, modes, {{0, 0}}, which),
      Catch::Contains("expected a factorisation"));
}
