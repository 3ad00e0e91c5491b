#include "floe/reference/full_order.h"

#include <catch2/catch.hpp>

#include "differences.h"
#include "floe/dynamics/floating_body.h"
#include "floe/dynamics/joints.h"
#include "floe/dynamics/system.h"
#include "floe/reduction/reduce.h"
#include "random.h"
#include "structures.h"

using namespace floe;
using dynamics::ConstraintLevel;
using Eigen::VectorXd;
using testing::everywhere;
using testing::Random;
using Kind = fem::ReferenceFrame::Kind;

namespace {

constexpr PetscInt elements = 7, nodes = elements + 1, dofs = 3 * nodes;

fem::Structure beam(MPI_Comm comm) { return testing::straight(comm, elements, 100, testing::paper_section()); }

/// A body in its floating frame as a system: unknowns (q of all nodes, R_x, R_y, theta, then for mean axes three
/// multipliers), numbered alike on any number of ranks.
struct FullOrder {
  fem::Structure structure;
  fem::ReferenceFrame frame;
  std::unique_ptr<dynamics::System> system;
  PetscInt size;

  FullOrder(MPI_Comm comm, Kind kind, reference::ElasticForce force, double viscosity = 0, bool heavy = false)
      : structure(beam(comm)), frame(fem::reference_frame(structure, kind, 0, elements)) {
    dynamics::Coordinates coordinates(comm);
    const int first = coordinates.add_shared(3);
    const reference::NodeCoordinates placed(coordinates, structure.mesh, {0, elements});
    const int multipliers = kind == Kind::mean_axis ? coordinates.add_shared(3, true) : 0;
    coordinates.number();
    auto terms = reference::full_order_terms(structure, frame, placed, first, multipliers, force, viscosity);
    if (heavy)
      for (auto& marker :
           reference::density_markers(structure, frame.conditions, placed, first, reference::Density::mass))
        terms.push_back(std::make_unique<dynamics::Force>(
            marker, [](double) { return Eigen::Vector3d(0.4, -9.81, 0); }, dynamics::Force::Axes::world));
    size = coordinates.global_size();
    system = std::make_unique<dynamics::System>(std::move(coordinates), std::move(terms));
  }

  petsc::VecHandle vector(const VectorXd& values) const {
    petsc::VecHandle v = system->create_vector();
    testing::set(v, values);
    return v;
  }
  VectorXd residual(const VectorXd& q, const VectorXd& v, const VectorXd& a,
                    ConstraintLevel level = ConstraintLevel::position) const {
    const petsc::VecHandle U = vector(q), V = vector(v), A = vector(a), F = system->create_vector();
    system->residual(0, U, V, A, level, F);
    return everywhere(F);
  }
};

/// A random state of a size that bends the beam visibly: displacements of 5, slopes of 0.2.
VectorXd state(Random& random, PetscInt size) {
  VectorXd x = random.vector(size);
  for (PetscInt i = 0; i < dofs; ++i) x[i] *= i % 3 == 2 ? 0.2 : 5;
  return x;
}

}  // namespace

TEST_CASE("full-order residual and energy are the same on any number of ranks") {
  const Kind kind = GENERATE(Kind::pinned, Kind::clamped, Kind::mean_axis);
  const auto force = GENERATE(reference::ElasticForce::von_karman, reference::ElasticForce::linear);
  const FullOrder all(PETSC_COMM_WORLD, kind, force, 0.02, true), alone(PETSC_COMM_SELF, kind, force, 0.02, true);
  REQUIRE(all.size == dofs + 3 + (kind == Kind::mean_axis ? 3 : 0));
  Random random(141);
  const VectorXd q = state(random, all.size), v = state(random, all.size), a = state(random, all.size);
  CHECK(testing::relative_error(all.residual(q, v, a), alone.residual(q, v, a)) < 1e-12);
  const dynamics::Energy found = all.system->energy(0, all.vector(q), all.vector(v));
  const dynamics::Energy expected = alone.system->energy(0, alone.vector(q), alone.vector(v));
  CHECK(found.kinetic == Approx(expected.kinetic).epsilon(1e-12));
  CHECK(found.elastic == Approx(expected.elastic).epsilon(1e-12));
}

TEST_CASE("full-order tangents are the differences of the residual") {
  const Kind kind = GENERATE(Kind::pinned, Kind::mean_axis);
  const auto force = GENERATE(reference::ElasticForce::von_karman, reference::ElasticForce::linear);
  const FullOrder body(PETSC_COMM_WORLD, kind, force, 0.02, true);
  Random random(142);
  const VectorXd q = state(random, body.size), v = state(random, body.size), a = state(random, body.size);
  // along a direction without multipliers or constrained dofs, which count with weight 1 whatever the weights
  VectorXd d = state(random, body.size);
  d.tail(body.size - dofs - 3).setZero();
  for (PetscInt dof : body.frame.conditions) d[dof] = 0;
  const petsc::MatHandle J = body.system->create_tangent();
  for (const dynamics::Weights& w : {dynamics::Weights{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 30, 900}}) {
    body.system->tangent(0, body.vector(q), body.vector(v), body.vector(a), w, J);
    VectorXd found = testing::product(J, body.vector(d));
    const auto along = [&](double h) -> VectorXd {
      return w.q * body.residual(q + h * d, v, a) + w.v * body.residual(q, v + h * d, a) +
             w.a * body.residual(q, v, a + h * d);
    };
    const VectorXd expected = testing::derivative(along, 0, 1e-3);
    CHECK(testing::relative_error(found.head(dofs + 3), expected.head(dofs + 3)) < 1e-7);
  }
}

TEST_CASE("mean axes: the constraint rows are Phi_r' M q at every level, the forces M Phi_r lambda") {
  const FullOrder body(PETSC_COMM_WORLD, Kind::mean_axis, reference::ElasticForce::linear);
  Random random(143);
  const VectorXd q = state(random, body.size), v = state(random, body.size), a = state(random, body.size);
  const petsc::MatHandle M = fem::mass(body.structure, {});
  VectorXd without = q;
  without.tail(3).setZero();
  const VectorXd forces = body.residual(q, v, a) - body.residual(without, v, a);
  VectorXd expected = VectorXd::Zero(dofs);
  for (int i = 0; i < 3; ++i) {
    const VectorXd row = testing::product(M, body.frame.rigid[i]);
    expected += q[dofs + 3 + i] * row;
    const auto at = [&](ConstraintLevel level) { return body.residual(q, v, a, level)[dofs + 3 + i]; };
    CHECK(at(ConstraintLevel::position) == Approx(row.dot(q.head(dofs))).epsilon(1e-11));
    CHECK(at(ConstraintLevel::velocity) == Approx(row.dot(v.head(dofs))).epsilon(1e-11));
    CHECK(at(ConstraintLevel::acceleration) == Approx(row.dot(a.head(dofs))).epsilon(1e-11));
  }
  CHECK((forces.head(dofs) - expected).cwiseAbs().maxCoeff() < 1e-11 * body.residual(q, v, a).cwiseAbs().maxCoeff());
  CHECK(forces.segment<3>(dofs).norm() == 0);  // the frame does not feel them
}

TEST_CASE("dofs that the frame holds are held by their own rows and take no part in the others") {
  const FullOrder body(PETSC_COMM_WORLD, Kind::pinned, reference::ElasticForce::von_karman);
  Random random(144);
  VectorXd q = state(random, body.size);
  const VectorXd v = state(random, body.size), a = state(random, body.size);
  for (PetscInt dof : body.frame.conditions) q[dof] = 0;
  const VectorXd before = body.residual(q, v, a);
  for (PetscInt dof : body.frame.conditions) CHECK(before[dof] == 0);
  VectorXd moved = q;
  moved[body.frame.conditions[2]] = 2;
  VectorXd change = body.residual(moved, v, a) - before;
  CHECK(change[body.frame.conditions[2]] > 1);
  change[body.frame.conditions[2]] = 0;
  CHECK(change.norm() == 0);
}

TEST_CASE("forces on dofs that the frame holds act on the frame and do not move them") {
  const Kind kind = GENERATE(Kind::pinned, Kind::clamped);
  const fem::Structure s = beam(PETSC_COMM_WORLD);
  const fem::ReferenceFrame frame = fem::reference_frame(s, kind, 0, elements);
  const FullOrder heavy(PETSC_COMM_WORLD, kind, reference::ElasticForce::linear, {}, true);
  Random random(146);
  VectorXd q = state(random, heavy.size);
  for (PetscInt dof : frame.conditions) q[dof] = 0;
  const VectorXd r = heavy.residual(q, state(random, heavy.size), state(random, heavy.size));
  for (PetscInt dof : frame.conditions) CHECK(r[dof] == 0);

  dynamics::Coordinates coordinates(PETSC_COMM_SELF);
  const fem::Mesh mesh = beam(PETSC_COMM_SELF).mesh;
  const int first = coordinates.add_shared(3);
  const reference::NodeCoordinates placed(coordinates, mesh, {});
  const dynamics::Marker root = reference::node_marker(frame.conditions, placed, first, 0, {0, 0, 0});
  CHECK(root.S.norm() == 0);  // u and v of the origin's node are constrained, its rotation only by the clamped frame
  CHECK(root.psi[2] == (kind == Kind::pinned ? 1 : 0));
  const dynamics::Marker tip = reference::node_marker(frame.conditions, placed, first, elements, {100, 0, 0});
  CHECK((tip.S(0, 0) == 1 && tip.S(1, 1) == (kind == Kind::pinned ? 0 : 1) && tip.psi[2] == 1));
}

TEST_CASE("Kelvin-Voigt damping adds beta K q' to the elastic rows of the undeformed body, nothing to the frame's") {
  const double beta = 0.02;
  const auto force = GENERATE(reference::ElasticForce::von_karman, reference::ElasticForce::linear);
  const FullOrder damped(PETSC_COMM_WORLD, Kind::pinned, force, beta), free(PETSC_COMM_WORLD, Kind::pinned, force);
  Random random(147);
  const VectorXd a = state(random, free.size);
  VectorXd q = state(random, free.size), v = state(random, free.size);
  if (force == reference::ElasticForce::von_karman) q.head(dofs).setZero();
  for (PetscInt dof : free.frame.conditions) v[dof] = 0;
  const VectorXd more = damped.residual(q, v, a) - free.residual(q, v, a);
  const petsc::VecHandle rate = testing::field_of(free.structure, v.head(dofs));
  VectorXd expected = beta * testing::product(fem::stiffness(free.structure, {}), rate);
  for (PetscInt dof : free.frame.conditions) expected[dof] = 0;
  CHECK(testing::relative_error(more.head(dofs), expected) < 1e-10);
  CHECK(more.segment<3>(dofs).norm() == 0);
}

TEST_CASE("gravity on the full-order body is its weight at its centre") {
  const FullOrder heavy(PETSC_COMM_WORLD, Kind::pinned, reference::ElasticForce::linear, {}, true);
  const FullOrder light(PETSC_COMM_WORLD, Kind::pinned, reference::ElasticForce::linear);
  VectorXd q = VectorXd::Zero(heavy.size);
  const VectorXd zero = q;
  const double theta = q[dofs + 2] = 0.3, m = 54.6;
  const VectorXd weight = heavy.residual(q, zero, zero) - light.residual(q, zero, zero);
  CHECK(weight[dofs] == Approx(-m * 0.4).epsilon(1e-12));
  CHECK(weight[dofs + 1] == Approx(m * 9.81).epsilon(1e-12));
  CHECK(weight[dofs + 2] == Approx(m * 50 * (9.81 * std::cos(theta) + 0.4 * std::sin(theta))).epsilon(1e-12));
}

TEST_CASE("the full-order residual of V eta, projected, is the residual of the reduced body") {
  const Kind kind = GENERATE(Kind::pinned, Kind::clamped, Kind::mean_axis);
  const FullOrder full(PETSC_COMM_WORLD, kind, reference::ElasticForce::von_karman);
  const fem::Structure& s = full.structure;
  const fem::Holding holding = fem::holding(s, full.frame, {0, 1, 2});
  const reduction::Statics statics(s, full.frame, holding);
  const auto generators = reduction::generators(s, full.frame, holding, statics, 3, {}, 1e-7);
  const reduction::Basis basis = reduction::basis_of(
      s, generators,
      reduction::derivative_columns(s, full.frame, holding, statics, generators, reduction::all_pairs(3), false), 1e-7);
  const body::FlexibleBody reduced = reduction::project(s, basis);
  const int k = basis.columns;
  Eigen::MatrixXd V(dofs, k);
  for (int j = 0; j < k; ++j) {
    Vec column = nullptr;
    petsc::check(BVGetColumn(basis.V, j, &column));
    V.col(j) = everywhere(column);
    petsc::check(BVRestoreColumn(basis.V, j, &column));
  }
  std::vector<int> numbers(k + 3);
  for (int i = 0; i < k + 3; ++i) numbers[i] = i;
  const dynamics::FloatingBody body(numbers, body::planar(reduced.inertia), reduced.elasticity);
  Random random(145);
  const auto draw = [&] {
    VectorXd x = random.vector(k + 3);
    x.tail(k) *= 10 / (V * x.tail(k)).cwiseAbs().maxCoeff();
    return x;
  };
  const VectorXd q = draw(), v = draw(), a = draw();
  VectorXd r = VectorXd::Zero(k + 3);
  body.residual({0, q, v, a}, r);
  const auto expand = [&](const VectorXd& x) {
    VectorXd all = VectorXd::Zero(full.size);
    all.head(dofs) = V * x.tail(k);
    all.segment<3>(dofs) = x.head<3>();
    return all;
  };
  const VectorXd F = full.residual(expand(q), expand(v), expand(a));
  VectorXd projected(k + 3);
  projected << F.segment<3>(dofs), V.transpose() * F.head(dofs);
  CHECK(testing::relative_error(r, projected) < 1e-11);
  CHECK(testing::relative_error(r.tail(k), projected.tail(k)) < 1e-10);
}
