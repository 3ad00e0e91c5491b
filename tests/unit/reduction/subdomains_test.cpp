#include "../../../src/reduction/subdomains.h"

#include <catch2/catch.hpp>
#include <map>
#include <string>

#include "bodies_in_space.h"
#include "floe/fem/subdomains.h"
#include "options.h"

using namespace floe;
using namespace floe::testing;

namespace {

/// Those of examples/blade/options/subdomains.opts, for a solver with a prefix.
std::map<std::string, std::string> by_subdomains(const std::string& prefix) {
  return {{"-" + prefix + "ksp_type", "gmres"},
          {"-" + prefix + "pc_type", "bddc"},
          {"-" + prefix + "pc_bddc_monolithic", "1"},
          {"-" + prefix + "pc_bddc_use_deluxe_scaling", "1"},
          {"-" + prefix + "pc_bddc_adaptive_userdefined", "1"},
          {"-" + prefix + "pc_bddc_adaptive_threshold", "10"},
          {"-" + prefix + "pc_bddc_dirichlet_pc_type", "cholesky"},
          {"-" + prefix + "pc_bddc_dirichlet_pc_factor_mat_solver_type", "mumps"},
          {"-" + prefix + "pc_bddc_neumann_pc_type", "cholesky"},
          {"-" + prefix + "pc_bddc_neumann_pc_factor_mat_solver_type", "mumps"}};
}

/// A plate of 12 x 9 cells, rolled to a quarter of a cylinder.
fem::Structure panel() {
  generate::Plate plate{{0, 0, 0}, {1, 0, 0}, {0, 0.7, 0}, 12, 9};
  plate.cells = generate::ShellCells::triangles;
  mesh::RawMesh raw = generate::plate(PETSC_COMM_WORLD, plate);
  for (Eigen::Vector3d& x : raw.positions) x = {x.x(), 0.5 * std::sin(2 * x.y()), 0.5 - 0.5 * std::cos(2 * x.y())};
  return structure_of(raw, {fem::shell_section({{fem::isotropic(1e4, 0.3, 2), 0.002, 0}})}, Spread::metis);
}

/// Nodes of its edge x = 0.
std::vector<PetscInt> edge() {
  std::vector<PetscInt> nodes;
  for (PetscInt row = 0; row < 10; ++row) nodes.push_back(13 * row);
  return nodes;
}

Eigen::MatrixXd modes_and_derivatives(Kind kind, const std::vector<PetscInt>& constrained, std::vector<double>& omega) {
  const SpatiallyConstrained body(panel(), kind, constrained);
  const reduction::Modes modes = body.modes(3);
  omega = modes.omega;
  const reduction::Columns theta =
      reduction::static_derivatives(body.structure, body.statics, modes.shapes, reduction::all_pairs(3));
  Eigen::MatrixXd all(body.structure.dofs(), 9);
  for (int j = 0; j < 9; ++j) all.col(j) = everywhere(j < 3 ? modes.shapes[j] : theta[j - 3]);
  return all;
}

/// Modes and derivatives as those of a factor; on one rank, which has nothing to balance, the error instead.
void check_same(Kind kind, const std::vector<PetscInt>& constrained, std::map<std::string, std::string> options) {
  std::vector<double> exact, omega;
  if (ranks() == 1) {
    const Options set(std::move(options));
    CHECK_THROWS_WITH(modes_and_derivatives(kind, constrained, omega),
                      Catch::Contains("option -derivatives_pc_type bddc") && Catch::Contains("expected several ranks"));
    return;
  }
  const Eigen::MatrixXd direct = modes_and_derivatives(kind, constrained, exact);
  const Options set(std::move(options));
  const Eigen::MatrixXd iterated = modes_and_derivatives(kind, constrained, omega);
  for (std::size_t i = 0; i < exact.size(); ++i) CHECK(omega[i] == Approx(exact[i]).epsilon(1e-9));
  for (Eigen::Index j = 0; j < direct.cols(); ++j)
    CHECK((iterated.col(j) - direct.col(j)).norm() < 1e-6 * direct.col(j).norm());
}

}  // namespace

TEST_CASE("the sum of the subdomains is the assembled matrix") {
  const What what = GENERATE(What::triangles, What::beams, What::mixed, What::linked_second_order, What::curved);
  const SpatiallyConstrained body(body_of(what, PETSC_COMM_WORLD, Spread::metis), Kind::clamped, {0});
  const fem::Conditions& held = body.holding.constrained;
  const Eigen::MatrixXd whole = dense(body.structure, fem::assemble(body.structure, held, 0, 1, 0.5)),
                        sum = dense(body.structure, fem::assemble_subdomains(body.structure, held, 1, 0.5));
  Eigen::MatrixXd difference = sum - whole;
  Eigen::Index held_dofs = 0;
  for (Eigen::Index i = 0; i < whole.rows(); ++i) {
    if (whole.row(i).any()) continue;
    CHECK(sum(i, i) > 0);
    difference(i, i) = 0, ++held_dofs;
  }
  CHECK(held_dofs >= static_cast<Eigen::Index>(held.size()));
  CHECK(difference.cwiseAbs().maxCoeff() < 1e-12 * whole.cwiseAbs().maxCoeff());
}

TEST_CASE("balancing by constraints finds the modes and derivatives that a factor finds; one rank is refused") {
  check_same(Kind::clamped, edge(), by_subdomains("derivatives_"));
}

TEST_CASE("balancing by constraints: a body without constraints") {
  auto options = by_subdomains("derivatives_");
  auto of_modes = by_subdomains("modes_st_");
  options.merge(of_modes);
  check_same(Kind::mean_axis, {}, options);
}
