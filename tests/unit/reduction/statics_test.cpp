#include "floe/reduction/statics.h"

#include <catch2/catch.hpp>

#include "bodies.h"

using namespace floe;
using Eigen::VectorXd;
using testing::everywhere;
using testing::Held;
using testing::Kind;

namespace {

VectorXd response(const Held& body, PetscInt dof, double load) {
  reduction::Columns loads;
  loads.push_back(testing::field_of(body.structure, load * VectorXd::Unit(body.structure.dofs(), dof)));
  return everywhere(body.statics.solve(loads)[0]);
}

}  // namespace

TEST_CASE("L-shaped frame, clamped at its foot: the unit-load theorem") {
  const double a = 2, b = 1.5, EA = 50, EI = 0.7;
  const fem::Mesh mesh = fem::mesh_of(PETSC_COMM_WORLD, testing::l_shape(a, b, 4));
  const Held body(fem::planar_structure(mesh, {{EA, EI, 3, 0}, {EA, EI, 3, 0}}, fem::MembraneStrain::averaged),
                  Kind::clamped, {0, 1, 2});
  const PetscInt tip = 3 * (mesh.node_count - 1);
  // F_x at the free end: moment F (b - y) in the post, F b along the foot; normal force F in the foot
  const VectorXd sideways = response(body, tip, 1);
  CHECK(sideways[tip] == Approx((b * b * b / 3 + a * b * b) / EI + a / EA).epsilon(1e-10));
  CHECK(sideways[tip + 1] == Approx(-a * a * b / 2 / EI).epsilon(1e-10));
  CHECK(sideways[tip + 2] == Approx(-(b * b / 2 + a * b) / EI).epsilon(1e-10));
  // F_y: moment F (a - x) in the foot, normal force F in the post
  const VectorXd upwards = response(body, tip + 1, 2);
  CHECK(upwards[tip + 1] == Approx(2 * (a * a * a / 3 / EI + b / EA)).epsilon(1e-10));
  CHECK(upwards[tip] == Approx(2 * sideways[tip + 1]).epsilon(1e-10));  // Maxwell
  CHECK(upwards.head(3).norm() == 0);
}

TEST_CASE("three members that meet in a rigid knot share its moment as 3 EI/l, 4 EI/l ask") {
  // Far ends clamped: a moment at the knot meets 4 EI/l of each member.
  const double EI = 0.7, M = 0.3;
  const fem::Segments star{{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {4, 0, 0}}, {{0, 1}, {2, 1}, {1, 3}}, {2, 4, 6}};
  const fem::Mesh mesh = fem::mesh_of(PETSC_COMM_WORLD, star);
  const fem::BeamSection stiff{1e9, EI, 1, 0};  // members that do not stretch: the knot only rotates
  const auto node = [&](double x, double y) { return fem::nearest_node(mesh, {x, y, 0}).node; };
  fem::Conditions constrained;
  for (PetscInt n : {node(0, 0), node(1, 2), node(4, 0)})
    constrained.insert(constrained.end(), {3 * n, 3 * n + 1, 3 * n + 2});
  std::sort(constrained.begin(), constrained.end());
  const Held body(fem::planar_structure(mesh, {stiff, stiff, stiff}, fem::MembraneStrain::averaged), Kind::clamped,
                  constrained);
  const PetscInt knot = 3 * node(1, 0);
  CHECK(response(body, knot + 2, M)[knot + 2] == Approx(M / (4 * EI * (1 / 1. + 1 / 2. + 1 / 3.))).epsilon(1e-7));
  // the far end of the second member hinged: 3 EI/l of it
  fem::Conditions hinged = constrained;
  hinged.erase(std::find(hinged.begin(), hinged.end(), 3 * node(1, 2) + 2));
  const Held other(fem::planar_structure(mesh, {stiff, stiff, stiff}, fem::MembraneStrain::averaged), Kind::clamped,
                   hinged);
  CHECK(response(other, knot + 2, M)[knot + 2] == Approx(M / EI / (4 / 1. + 3 / 2. + 4 / 3.)).epsilon(1e-7));
}

TEST_CASE("responses about a deformation are those of the tangent there, however the free body is supported") {
  const Kind kind = GENERATE(Kind::pinned, Kind::clamped, Kind::mean_axis);
  const Held body(testing::straight(PETSC_COMM_WORLD, 6, 3, {50, 0.7, 3, 0.2}), kind, {});
  const fem::Structure& s = body.structure;
  const auto elastic_force =
      [&](const VectorXd& q) {  // K q + (dK/dq q) q / 2 + cubic terms, from K_T by Simpson's rule
        VectorXd sum = VectorXd::Zero(q.size());
        const petsc::VecHandle along = testing::field_of(s, q);
        for (const auto& [at, weight] : {std::pair(0., 1 / 6.), {0.5, 4 / 6.}, {1., 1 / 6.}})
          sum += weight * testing::product(fem::tangent_stiffness(s, {}, testing::field_of(s, at * q)), along);
        return sum;
      };
  const VectorXd bent = everywhere(body.statics.solve([&] {
    reduction::Columns loads;
    loads.push_back(testing::field_of(s, 0.1 * testing::Random(5).vector(s.dofs())));
    return loads;
  }())[0]);
  const VectorXd direction = testing::Random(6).vector(s.dofs());
  reduction::Columns loads;
  loads.push_back(testing::field_of(s, direction));
  const petsc::VecHandle q = testing::field_of(s, bent);
  const VectorXd u = everywhere(body.statics.solve_bent(q, loads)[0]);
  const petsc::VecHandle stays = testing::field_of(s, u);
  fem::to_frame(body.frame, stays);
  CHECK(testing::relative_error(everywhere(stays), u) < 1e-12);
  // the force grows by the load, both as far as they do not move the body
  const double h = 1e-4 / u.cwiseAbs().maxCoeff();
  const petsc::VecHandle grown =
      testing::field_of(s, (elastic_force(bent + h * u) - elastic_force(bent - h * u)) / (2 * h));
  fem::balance(body.frame, grown);
  fem::balance(body.frame, loads[0]);
  CHECK(testing::relative_error(everywhere(grown), everywhere(loads[0])) < 1e-6);
  CHECK(testing::relative_error(u, everywhere(body.statics.solve(loads)[0])) > 1e-2);
}

TEST_CASE("the answer stands in the frame and satisfies K u = P' f, however the free body is supported") {
  const Kind kind = GENERATE(Kind::pinned, Kind::clamped, Kind::mean_axis);
  const Held body(testing::straight(PETSC_COMM_WORLD, 6, 3, {50, 0.7, 3, 0.2}), kind, {});
  const fem::Structure& s = body.structure;
  const VectorXd f = testing::Random(51).vector(s.dofs());
  reduction::Columns loads;
  loads.push_back(testing::field_of(s, f));
  loads.push_back(testing::field_of(s, 2 * f.reverse()));
  const reduction::Columns u = body.statics.solve(loads);
  REQUIRE(u.size() == 2);
  for (int i = 0; i < 2; ++i) {
    const VectorXd before = everywhere(u[i]);
    fem::to_frame(body.frame, u[i]);
    CHECK(testing::relative_error(everywhere(u[i]), before) < 1e-13);
    fem::balance(body.frame, loads[i]);
    CHECK(testing::relative_error(testing::product(fem::stiffness(s, {}), u[i]), everywhere(loads[i])) < 1e-10);
  }
}

TEST_CASE("a block solve solves every column, and none is no work") {
  const Held body(testing::straight(PETSC_COMM_WORLD, 5, 1, {50, 0.7, 3, 0}), Kind::clamped, {0, 1, 2});
  const petsc::MatHandle K = fem::stiffness(body.structure, {0, 1, 2});
  const petsc::KspHandle ksp = reduction::direct_solver(K, "test_");
  reduction::Columns B;
  testing::Random random(52);
  for (int i = 0; i < 7; ++i) B.push_back(testing::field_of(body.structure, random.vector(body.structure.dofs())));
  const reduction::Columns X = reduction::block_solve(ksp, B);
  REQUIRE(X.size() == 7);
  for (int i = 0; i < 7; ++i) CHECK(testing::relative_error(testing::product(K, X[i]), everywhere(B[i])) < 1e-10);
  CHECK(reduction::block_solve(ksp, {}).empty());
}
