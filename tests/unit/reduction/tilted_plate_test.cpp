#include <catch2/catch.hpp>

#include "bodies_in_space.h"
#include "floe/fem/flat_body.h"

using namespace floe;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using generate::ShellCells;

namespace {

/// A thin cantilever plate, 2 x 1 x 0.002, rotated by R, on four modes and all their derivatives.
struct Cantilever {
  fem::Structure structure;
  fem::ReferenceFrame frame;
  fem::Holding holding;
  reduction::Statics statics;
  reduction::Generators generators;
  reduction::Basis basis;
  body::FlexibleBody body;

  static fem::Structure plate(const Matrix3d& R, ShellCells cells) {
    generate::Plate plate;
    plate.a = R * Vector3d(2, 0, 0), plate.b = R * Vector3d(0, 1, 0), plate.na = 16, plate.nb = 8, plate.cells = cells;
    return testing::structure_of(generate::plate(PETSC_COMM_WORLD, plate),
                                 {fem::shell_section({{fem::isotropic(7e10, 0.3, 2700), 0.002}})},
                                 testing::Spread::shuffled);
  }
  static PetscInt clamp(const fem::Structure& s, const Matrix3d& R) { return clamped(s, R)[0] / 6; }
  static fem::Conditions clamped(const fem::Structure& s, const Matrix3d& R) {
    const auto left = testing::nodes_where(s, [&](const Vector3d& x) { return (R.transpose() * x).x() < 1e-9; });
    return testing::dofs_of(s, left, {0, 1, 2, 3, 4, 5});
  }
  Cantilever(const Matrix3d& R, ShellCells cells)
      : structure(plate(R, cells)),
        frame(fem::reference_frame(structure, fem::ReferenceFrame::Kind::clamped, clamp(structure, R),
                                   clamp(structure, R))),
        holding(fem::holding(structure, frame, clamped(structure, R))),
        statics(structure, frame, holding),
        generators(reduction::generators(structure, frame, holding, statics, 4, {}, 1e-7)),
        basis(reduction::basis_of(structure, generators,
                                  reduction::derivative_columns(structure, frame, holding, statics, generators,
                                                                reduction::all_pairs(4), false),
                                  1e-7)),
        body(reduction::project(structure, basis)) {}
};

/// The columns, each displacement and rotation rotated by R.
MatrixXd rotated(const Matrix3d& R, MatrixXd columns) {
  for (Eigen::Index i = 0; i < columns.rows(); i += 3) columns.middleRows(i, 3) = (R * columns.middleRows(i, 3)).eval();
  return columns;
}

}  // namespace

TEST_CASE("a tilted plate reduces to the same body as one in a coordinate plane") {
  const ShellCells cells = GENERATE(ShellCells::triangles, ShellCells::quadrilaterals);
  const Matrix3d R = Eigen::AngleAxisd(0.9, Vector3d(0.3, -0.7, 0.5).normalized()).toRotationMatrix();
  const Cantilever flat(Matrix3d::Identity(), cells), tilted(R, cells);
  REQUIRE(fem::flat_body(flat.structure));
  REQUIRE(fem::flat_body(tilted.structure));
  for (int i = 0; i < 4; ++i)
    CHECK(tilted.generators.modes.omega[i] == Approx(flat.generators.modes.omega[i]).epsilon(1e-9));
  REQUIRE(tilted.basis.columns == flat.basis.columns);
  CHECK(flat.body.elasticity.pairs.size() == 10);  // of the four modes; their derivatives stay in the plane
  REQUIRE(tilted.body.elasticity.pairs == flat.body.elasticity.pairs);

  const MatrixXd V = rotated(R, testing::columns_in_originals(flat.structure, flat.basis)),
                 W = testing::columns_in_originals(tilted.structure, tilted.basis);
  VectorXd sign(V.cols());  // the rule for signs looks at the axes
  for (Eigen::Index j = 0; j < V.cols(); ++j) sign[j] = V.col(j).dot(W.col(j)) < 0 ? -1 : 1;
  CHECK(testing::relative_error(W, V * sign.asDiagonal()) < 1e-7);
  testing::Random random(17);
  for (const double size : {1e-4, 3e-3, 0.1}) {
    const VectorXd q = size * random.vector(V.cols());
    CHECK(body::energy(tilted.body.elasticity, q) ==
          Approx(body::energy(flat.body.elasticity, sign.cwiseProduct(q))).epsilon(1e-9));
  }
  const body::Inertia &a = flat.body.inertia, &b = tilted.body.inertia;
  CHECK(testing::relative_error(b.C0, R * a.C0 * R.transpose()) < 1e-12);
  CHECK(testing::relative_error(b.S, R * a.S * sign.asDiagonal()) < 1e-8);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      MatrixXd expected = MatrixXd::Zero(V.cols(), V.cols());
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) expected += R(i, k) * R(j, l) * a.M[k][l];
      CHECK((b.M[i][j] - sign.asDiagonal() * expected * sign.asDiagonal()).cwiseAbs().maxCoeff() < 1e-8);
    }
}

TEST_CASE("bent, layered and stiffened bodies are not taken for flat ones") {
  const fem::Structure mixed = testing::mixed_structure(PETSC_COMM_WORLD, testing::Spread::metis);
  CHECK(fem::flat_body(mixed) == nullptr);
  generate::Plate plate;
  plate.a = {2, 0, 0}, plate.b = {0, 1, 0}, plate.na = 2, plate.nb = 2;
  const fem::ShellMaterial ply{900, 300, 0.25, 150, 2};
  const auto layered = [&](std::vector<fem::Ply> plies) {
    return testing::structure_of(generate::plate(PETSC_COMM_WORLD, plate), {fem::shell_section(plies, 0, {1, 0, 0})},
                                 testing::Spread::metis);
  };
  CHECK(fem::flat_body(layered({{ply, 0.1, 0}, {ply, 0.1, 1}})) == nullptr);      // bends when it is stretched
  CHECK(fem::flat_body(layered({{ply, 0.1, 0}, {ply, 0.1, 1}, {ply, 0.1, 0}})));  // symmetric
}

TEST_CASE("the mass matrix is shared, conditions take a copy, and a spoilt one is not handed on") {
  const fem::Structure s = testing::mixed_structure(PETSC_COMM_WORLD, testing::Spread::metis);
  const petsc::MatHandle first = fem::mass(s, {});
  const VectorXd x = testing::Random(3).vector(s.dofs()), y = testing::product_in_originals(s, first, x);
  const petsc::MatHandle constrained = fem::mass(s, {0, 1, 8}), second = fem::mass(s, {});
  CHECK(first.get() == second.get());
  CHECK(constrained.get() != first.get());
  CHECK(testing::product_in_originals(s, second, x) == y);
  petsc::check(MatScale(first, 2));
  CHECK(testing::relative_error(testing::product_in_originals(s, fem::mass(s, {}), x), y) < 1e-15);
}
