#include "floe/reduction/modes.h"

#include <catch2/catch.hpp>
#include <numbers>

#include "bodies.h"

using namespace floe;
using Eigen::VectorXd;
using testing::everywhere;
using testing::Held;
using testing::Kind;

namespace {

constexpr PetscInt elements = 24;

fem::Structure unit_beam(MPI_Comm comm) { return testing::straight(comm, elements, 1, {1e8, 1, 1, 0}); }

reduction::Modes modes_of(const Held& body, int count) {
  return reduction::vibration_modes(body.structure, body.frame, body.holding, body.statics, count);
}

}  // namespace

TEST_CASE("bending frequencies beta^2 of beams, exact to the mesh's own error") {
  struct Case {
    const char* name;
    fem::Conditions constrained;
    std::array<double, 3> beta2;
  };
  const double pi2 = std::numbers::pi * std::numbers::pi, last = 3 * elements;
  const PetscInt end = static_cast<PetscInt>(last);
  const Case c =
      GENERATE_COPY(Case{"clamped-free", {0, 1, 2}, {3.5160152685, 22.034491565, 61.697214414}},
                    Case{"clamped-clamped", {0, 1, 2, end, end + 1, end + 2}, {22.373285448, 61.672822868, 0}},
                    Case{"hinged-hinged", {0, 1, end + 1}, {pi2, 4 * pi2, 9 * pi2}},
                    Case{"free-free", {}, {22.373285448, 61.672822868, 0}});
  INFO(c.name);
  const Kind kind = GENERATE(Kind::pinned, Kind::mean_axis);
  const Held body(unit_beam(PETSC_COMM_WORLD), kind, c.constrained);
  const reduction::Modes modes = modes_of(body, 3);
  // cubic elements: relative error of omega (beta h)^4 / 1440
  for (int i = 0; i < 3 && c.beta2[i] > 0; ++i)
    CHECK(modes.omega[i] == Approx(c.beta2[i]).epsilon(1e-9 + std::pow(c.beta2[i] / elements / elements, 2) / 1000));
}

TEST_CASE("a hinge leaves one rigid motion, which is not counted: clamped-hinged's neighbour") {
  // hinged-free: tan beta = tanh beta, the same as clamped-hinged; beta^2 = 15.418205716980062, 49.964862031800162
  const Held body(unit_beam(PETSC_COMM_WORLD), Kind::pinned, {0, 1});
  const reduction::Modes modes = modes_of(body, 2);
  CHECK(modes.omega[0] == Approx(15.418205716980062).epsilon(2e-6));
  CHECK(modes.omega[1] == Approx(49.964862031800162).epsilon(2e-5));
}

TEST_CASE("the paper's cantilever with rotary inertia") {
  // 20 elements with rho I; refined values 1.45295 9.00192 24.758 (independent computation, without shear)
  const Held body(testing::straight(PETSC_COMM_WORLD, 20, 100, testing::paper_section()), Kind::clamped, {0, 1, 2});
  const reduction::Modes modes = modes_of(body, 3);
  CHECK(modes.omega[0] == Approx(1.45295).epsilon(1e-5));
  CHECK(modes.omega[1] == Approx(9.00192).epsilon(2e-5));
  // the third is axial, pi/2 sqrt(EA/rhoA)/L = 22.498; linear elements err by h^2 (pi/2L)^2/24
  CHECK(modes.omega[2] == Approx(std::numbers::pi / 200 * std::sqrt(1.12e6 / 0.546)).epsilon(5e-4));
}

TEST_CASE("modes satisfy K phi = omega^2 M phi, are M-orthonormal, and stand in the frame") {
  const fem::Conditions constrained = GENERATE(fem::Conditions{}, fem::Conditions{0, 1, 2}, fem::Conditions{0, 1});
  const Kind kind = GENERATE(Kind::pinned, Kind::mean_axis);
  const Held body(testing::straight(PETSC_COMM_WORLD, 8, 100, testing::paper_section()), kind, constrained);
  const reduction::Modes modes = modes_of(body, 6);
  const petsc::MatHandle K = fem::stiffness(body.structure, constrained), M = fem::mass(body.structure, constrained);
  for (int i = 0; i < 6; ++i) {
    VectorXd Kphi = testing::product(K, modes.raw[i]);
    for (PetscInt dof : constrained) Kphi[dof] = 0;
    const double lambda = modes.omega[i] * modes.omega[i];
    CHECK(testing::relative_error(Kphi, lambda * testing::product(M, modes.raw[i])) < 1e-7);
    CHECK(modes.residual[i] < 1e-8);
    if (i > 0) CHECK(modes.omega[i] >= modes.omega[i - 1]);
    for (int j = 0; j <= i; ++j)
      CHECK(testing::form(M, modes.raw[i], modes.raw[j]) == Approx(i == j ? 1 : 0).epsilon(0).margin(1e-10));
    // the shape differs from the raw mode by a rigid motion, and repeats under the projector
    const VectorXd shape = everywhere(modes.shapes[i]), apart = everywhere(modes.raw[i]) - shape;
    CHECK(testing::product(fem::stiffness(body.structure, {}), testing::field_of(body.structure, apart)).norm() <
          1e-9 * Kphi.norm());
    fem::to_frame(body.frame, modes.shapes[i]);
    CHECK(testing::relative_error(everywhere(modes.shapes[i]), shape) < 1e-12);
  }
}

TEST_CASE("mean axes: modes of the free body carry no momentum") {
  const Held body(testing::straight(PETSC_COMM_WORLD, 8, 100, testing::paper_section()), Kind::mean_axis, {});
  const reduction::Basis basis = body.basis(4);
  const petsc::MatHandle M = fem::mass(body.structure, {});
  const Eigen::MatrixXd V = testing::columns_of(body.structure, basis);
  for (const auto& motion : body.frame.rigid) {
    const VectorXd momentum = testing::product(M, motion);
    CHECK((V.transpose() * momentum).cwiseAbs().maxCoeff() < 1e-9 * momentum.norm());
  }
}

// The second search has a subspace of 21, that is of the first one's 18 and the three rigid motions: SLEPc kept arrays
// of 18 (seen by valgrind).
TEST_CASE("more modes of a free body after a few are those of a search from the start") {
  const Held body(testing::straight(PETSC_COMM_WORLD, 8, 100, testing::paper_section()), Kind::mean_axis, {});
  reduction::ModeSolver solver(body.structure, body.frame, body.holding, body.statics);
  const reduction::Modes few = solver.solve(2), more = solver.solve(5), at_once = modes_of(body, 5);
  for (int i = 0; i < 5; ++i) CHECK(more.omega[i] == Approx(at_once.omega[i]).epsilon(1e-9));
  for (int i = 0; i < 2; ++i) CHECK(few.omega[i] == Approx(at_once.omega[i]).epsilon(1e-9));
}

TEST_CASE("the same frequencies and shapes on any number of ranks") {
  const fem::Conditions constrained = GENERATE(fem::Conditions{}, fem::Conditions{0, 1, 2});
  const auto beam = [](MPI_Comm comm) { return testing::straight(comm, 12, 100, testing::paper_section()); };
  const Held all(beam(PETSC_COMM_WORLD), Kind::pinned, constrained),
      alone(beam(PETSC_COMM_SELF), Kind::pinned, constrained);
  const reduction::Modes found = modes_of(all, 8), expected = modes_of(alone, 8);
  for (int i = 0; i < 8; ++i) {
    CHECK(found.omega[i] == Approx(expected.omega[i]).epsilon(1e-9));
    CHECK(testing::relative_error(everywhere(found.shapes[i]), everywhere(expected.shapes[i])) < 1e-7);  // sign too
  }
}

TEST_CASE("the sign rule: the first translation above half the greatest is positive") {
  const fem::Structure s = testing::straight(PETSC_COMM_WORLD, 3, 1, {1, 1, 1, 0});
  VectorXd shape = VectorXd::Zero(12);
  shape << 0.1, 0.4, -9, -0.6, 0, 5, 1, 0, 0, 0, 0, 0;  // rotations do not count; -0.6 decides
  const petsc::VecHandle field = testing::field_of(s, shape);
  reduction::fix_sign(s, field);
  CHECK(everywhere(field) == -shape);
  reduction::fix_sign(s, field);
  CHECK(everywhere(field) == -shape);
}

TEST_CASE("more modes than elastic dofs are refused") {
  const Held body(testing::straight(PETSC_COMM_WORLD, 2, 1, {50, 1, 1, 0.1}), Kind::clamped, {0, 1, 2});
  CHECK_THROWS_AS(modes_of(body, 7), InputError);
  CHECK(modes_of(body, 6).omega.size() == 6);
  CHECK(modes_of(body, 0).omega.empty());
}
