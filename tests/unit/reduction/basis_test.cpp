#include "floe/reduction/basis.h"

#include <catch2/catch.hpp>

#include "bodies.h"

using namespace floe;
using Eigen::MatrixXd;
using testing::Held;
using testing::Kind;

namespace {

MatrixXd mass_form(const fem::Structure& s, const MatrixXd& V) {
  const petsc::MatHandle M = fem::mass(s, {});
  MatrixXd MV(V.rows(), V.cols());
  for (Eigen::Index j = 0; j < V.cols(); ++j) MV.col(j) = testing::product(M, testing::field_of(s, V.col(j)));
  return V.transpose() * MV;
}

int kept(const reduction::Basis& basis, reduction::ColumnOrigin::Kind kind) {
  return static_cast<int>(std::count_if(basis.origins.begin(), basis.origins.end(),
                                        [&](const auto& origin) { return origin.kind == kind && origin.kept; }));
}

reduction::ColumnOrigin named(const char* label) { return {reduction::ColumnOrigin::Kind::mode, label}; }

}  // namespace

TEST_CASE("the basis is M-orthonormal to round-off, derivatives included") {
  const bool full = GENERATE(false, true);
  const Held body(testing::straight(PETSC_COMM_WORLD, 10, 100, testing::paper_section()), Kind::pinned, {0, 1, 2});
  const reduction::Basis basis = body.basis(5, full);
  CHECK(basis.columns > 5);
  const MatrixXd V = testing::columns_of(body.structure, basis);
  CHECK((mass_form(body.structure, V) - MatrixXd::Identity(V.cols(), V.cols())).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("columns that add nothing are dropped and named; the kept ones span all") {
  const fem::Structure s = testing::straight(PETSC_COMM_WORLD, 5, 1, {50, 1, 1, 0.1});
  testing::Random random(61);
  const MatrixXd three = random.matrix(s.dofs(), 3);
  MatrixXd given(s.dofs(), 6);
  given << three.col(0), 1e-9 * three.col(1), three.col(0) - 3e9 * (1e-9 * three.col(1)), three.col(2),
      three.col(2) + 1e-5 * three.col(0) + 1e-9 * random.vector(s.dofs()), Eigen::VectorXd::Zero(s.dofs());
  reduction::Columns candidates;
  std::vector<reduction::ColumnOrigin> origins;
  for (const char* label : {"a", "small b", "a and b", "c", "nearly c", "nothing"}) origins.push_back(named(label));
  for (int j = 0; j < 6; ++j) candidates.push_back(testing::field_of(s, given.col(j)));
  const reduction::Basis basis = reduction::orthonormal_basis(s, candidates, origins, 1e-7);
  REQUIRE(basis.columns == 3);
  const std::vector<bool> expected{true, true, false, true, false, false};
  for (int j = 0; j < 6; ++j) CHECK(basis.origins[j].kept == expected[j]);
  CHECK(basis.origins[0].new_part == Approx(1));
  CHECK(basis.origins[2].new_part < 1e-12);
  CHECK((basis.origins[4].new_part > 1e-11 && basis.origins[4].new_part < 1e-7));
  CHECK(basis.origins[5].new_part == 0);
  CHECK(basis.origins[4].label == "nearly c");
  const MatrixXd V = testing::columns_of(s, basis);
  CHECK((mass_form(s, V) - MatrixXd::Identity(3, 3)).cwiseAbs().maxCoeff() < 1e-13);
  MatrixXd both(s.dofs(), 6);
  both << V / V.norm(), three / three.norm();
  CHECK(Eigen::ColPivHouseholderQR<MatrixXd>(both).setThreshold(1e-10).rank() == 3);
}

TEST_CASE("a basis has no more vectors than its body has elastic dofs; those with the smallest new parts are dropped") {
  const fem::Structure s = testing::straight(PETSC_COMM_WORLD, 5, 1, {50, 1, 1, 0.1});
  const Eigen::Index dofs = s.dofs() - 3;
  testing::Random random(62);
  MatrixXd given = random.matrix(s.dofs(), dofs + 2);
  for (const Eigen::Index j : {Eigen::Index(4), dofs + 1})  // next to nothing is new, as of round-off
    given.col(j) = given.col(0) + given.col(1) + 1e-5 * given.col(j);
  reduction::Columns candidates;
  for (Eigen::Index j = 0; j < given.cols(); ++j) candidates.push_back(testing::field_of(s, given.col(j)));
  const reduction::Basis basis =
      reduction::orthonormal_basis(s, candidates, std::vector<reduction::ColumnOrigin>(given.cols()), 1e-7);
  REQUIRE(basis.columns == dofs);
  for (Eigen::Index j = 0; j < given.cols(); ++j) {
    const bool kept = j != 4 && j != dofs + 1;
    CHECK(basis.origins[j].kept == kept);
    CHECK(basis.origins[j].dropped == (kept ? "" : "the body has only 15 elastic dofs"));
  }
  const MatrixXd V = testing::columns_of(s, basis);
  CHECK((mass_form(s, V) - MatrixXd::Identity(dofs, dofs)).cwiseAbs().maxCoeff() < 1e-13);
}

TEST_CASE("eight hinged modes have 36 derivatives, of which 17 are independent") {
  // sin((i - j) x) and sin((i + j) x) for i, j <= 8, with x for the movable end: 2 m + 1
  const PetscInt n = 64;
  const Held body(testing::straight(PETSC_COMM_WORLD, n, 1, {1e8, 1, 1, 0}), Kind::pinned, {0, 1, 3 * n + 1});
  const reduction::Basis basis = body.basis(8, false, 1e-5);
  using Origin = reduction::ColumnOrigin::Kind;
  CHECK(kept(basis, Origin::mode) == 8);
  CHECK(basis.origins.size() == 8 + 36);
  CHECK(kept(basis, Origin::derivative) == 17);
  CHECK(basis.columns == 25);
}

TEST_CASE("axial modes have no derivatives among themselves: round-off does not become a column") {
  const bool full = GENERATE(false, true);
  const Held body(testing::straight(PETSC_COMM_WORLD, 9, 100, testing::paper_section()), Kind::pinned, {0, 1, 2});
  int axial = 0;
  for (const auto& origin : body.basis(8, full).origins)  // modes 3 and 6 are axial
    for (const char* pair : {"derivative 3,3", "derivative 3,6", "derivative 6,3", "derivative 6,6"})
      if (origin.label == pair) {
        ++axial;
        CHECK(!origin.kept);
        CHECK(origin.new_part == 0);
      }
  CHECK(axial == (full ? 4 : 3));
}

TEST_CASE("attachment columns: static responses to unit loads, repeats dropped and named") {
  const PetscInt n = 6;
  const Held body(testing::straight(PETSC_COMM_WORLD, n, 100, testing::paper_section()), Kind::pinned, {});
  const auto load = [&](PetscInt dof, double size) {
    return testing::field_of(body.structure, size * Eigen::VectorXd::Unit(body.structure.dofs(), dof));
  };
  std::vector<reduction::Attachment> attachments;
  attachments.push_back({"root.moment", load(2, 1), {}});
  attachments.push_back({"tip.moment", load(3 * n + 2, 1), {}});
  attachments.push_back({"again.moment", load(2, -7), {}});
  attachments.push_back({"middle.fy", load(3 * (n / 2) + 1, 1), {}});
  const reduction::Generators g =
      reduction::generators(body.structure, body.frame, body.holding, body.statics, 2, attachments, 1e-7);
  REQUIRE(g.fields.size() == 5);
  REQUIRE(g.dropped.size() == 1);
  CHECK(g.dropped[0].label == "attachment again.moment");
  CHECK(g.origins[2].label == "attachment root.moment");
  const petsc::MatHandle M = fem::mass(body.structure, {}), K = fem::stiffness(body.structure, {});
  for (const auto& field : g.fields) CHECK(reduction::mass_norm(M, field) == Approx(1).epsilon(1e-12));
  // K times the column is the balanced load, up to a factor
  const petsc::VecHandle balanced = load(2, 1);
  fem::balance(body.frame, balanced);
  const Eigen::VectorXd f = testing::everywhere(balanced), Ku = testing::product(K, g.fields[2]);
  CHECK((Ku - Ku.dot(f) / f.squaredNorm() * f).norm() < 1e-9 * Ku.norm());
  const auto more = reduction::derivative_columns(body.structure, body.frame, body.holding, body.statics, g,
                                                  {{0, 0}, {0, 2}, {1, 0}}, true);
  REQUIRE(more.columns.size() == 4);  // full ones of (1,1), (1,2) and (2,1); a static one of the pair with a column
  CHECK(more.origins.back().label == "derivative 1,root.moment");
}
