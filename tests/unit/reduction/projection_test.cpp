#include "floe/reduction/projection.h"

#include <catch2/catch.hpp>
#include <cstring>

#include "bodies.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Held;
using testing::Kind;

namespace {

struct Reduced {
  double energy;
  VectorXd force;
  MatrixXd tangent;
};

Reduced evaluate(const body::Elasticity& e, const VectorXd& eta) {
  Reduced r{body::energy(e, eta), VectorXd::Zero(eta.size()), MatrixXd::Zero(eta.size(), eta.size())};
  body::ElasticityWork work;
  body::add_force(e, eta, work, r.force);
  body::add_tangent(e, eta, 1, work, r.tangent);
  return r;
}

/// A state that bends the body by about `deflection`.
VectorXd state(const MatrixXd& V, double deflection, unsigned seed) {
  VectorXd eta = testing::Random(seed).vector(V.cols());
  return deflection / (V * eta).cwiseAbs().maxCoeff() * eta;
}

void check_same_bits(const double* values, Eigen::Index count) {
  std::vector<double> first(values, values + count);
  MPI_Bcast(first.data(), static_cast<int>(count), MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  CHECK(std::memcmp(first.data(), values, sizeof(double) * static_cast<std::size_t>(count)) == 0);
}

void check_same_bits(const body::Inertia& in) {
  check_same_bits(&in.m, 1);
  check_same_bits(in.s0.data(), in.s0.size());
  check_same_bits(in.C0.data(), in.C0.size());
  check_same_bits(in.S.data(), in.S.size());
  for (int a = 0; a < in.dimension(); ++a)
    for (int b = 0; b < in.dimension(); ++b)
      check_same_bits(in.h[a][b].data(), in.h[a][b].size()), check_same_bits(in.M[a][b].data(), in.M[a][b].size());
}

}  // namespace

TEST_CASE("reduced elastic energy, force and tangent equal the projected full ones, slender or not") {
  // L/r = sqrt(EA L^2/EI)
  const double slenderness = GENERATE(30., 1e3, 1e5);
  const auto strain = GENERATE(fem::MembraneStrain::averaged, fem::MembraneStrain::pointwise);
  const Held body(testing::straight(PETSC_COMM_WORLD, 7, 1, {slenderness * slenderness, 1, 1, 0}, strain), Kind::pinned,
                  {0, 1, 2});
  const reduction::Basis basis = body.basis(4);
  const body::FlexibleBody reduced = reduction::project(body.structure, basis);
  const MatrixXd V = testing::columns_of(body.structure, basis);
  const VectorXd eta = state(V, 0.1, 71);
  const Reduced found = evaluate(reduced.elasticity, eta);
  const testing::FullElasticity full(body.structure, V * eta);
  CHECK(found.energy == Approx(full.energy).epsilon(1e-11));
  CHECK(testing::relative_error(found.force, V.transpose() * full.force) < 1e-11);
  CHECK(testing::relative_error(found.tangent, V.transpose() * full.tangent * V) < 1e-11);
}

TEST_CASE("an L-shaped body reduces as exactly as a straight one") {
  const fem::Mesh mesh = fem::mesh_of(PETSC_COMM_WORLD, testing::l_shape(2, 1, 4));
  const Held body(fem::planar_structure(mesh, {{1e4, 1, 1, 0.01}, {1e4, 2, 1, 0}}, fem::MembraneStrain::averaged),
                  Kind::clamped, {0, 1, 2});
  const reduction::Basis basis = body.basis(3);
  const body::FlexibleBody reduced = reduction::project(body.structure, basis);
  const MatrixXd V = testing::columns_of(body.structure, basis);
  const VectorXd eta = state(V, 0.2, 72);
  const testing::FullElasticity full(body.structure, V * eta);
  const Reduced found = evaluate(reduced.elasticity, eta);
  CHECK(found.energy == Approx(full.energy).epsilon(1e-11));
  CHECK(testing::relative_error(found.force, V.transpose() * full.force) < 1e-11);
}

TEST_CASE("the factor's size does not depend on the mesh") {
  const auto rows = [](PetscInt elements) {
    const Held body(testing::straight(PETSC_COMM_WORLD, elements, 100, testing::paper_section()), Kind::pinned,
                    {0, 1, 2});
    const body::FlexibleBody reduced = reduction::project(body.structure, body.basis(2));
    return std::pair(reduced.elasticity.F.rows(), reduced.elasticity.F.cols());
  };
  CHECK(rows(400) == rows(700));
  CHECK(rows(700).first == rows(700).second);
}

TEST_CASE("a reduced body is the same to the bit on all ranks") {
  const Held body(testing::straight(PETSC_COMM_WORLD, 9, 100, testing::paper_section()), Kind::pinned, {0, 1, 2});
  const reduction::Basis basis = body.basis(4);
  const body::FlexibleBody reduced = reduction::project(body.structure, basis);
  check_same_bits(reduced.inertia);
  check_same_bits(reduced.line);
  check_same_bits(reduced.elasticity.bending.data(), reduced.elasticity.bending.size());
  check_same_bits(reduced.elasticity.F.data(), reduced.elasticity.F.size());
  const body::PlaceMap tip = reduction::place_map(body.structure, basis, 9);
  check_same_bits(tip.S.data(), tip.S.size());
  check_same_bits(tip.psi.data(), tip.psi.size());
  check_same_bits(tip.x.data(), tip.x.size());
}

TEST_CASE("the reduced body has the same energies on any number of ranks") {
  const auto energies = [](MPI_Comm comm) {
    const Held body(testing::straight(comm, 9, 100, testing::paper_section()), Kind::pinned, {0, 1, 2});
    const reduction::Basis basis = body.basis(4);
    const body::FlexibleBody reduced = reduction::project(body.structure, basis);
    const body::PlaceMap tip = reduction::place_map(body.structure, basis, 9);
    std::vector<double> all{double(basis.columns)};
    for (unsigned seed : {1u, 2u, 3u}) {
      const VectorXd eta = 20 * testing::Random(seed).vector(4);  // of the modes: signs and order are fixed
      VectorXd z = VectorXd::Zero(basis.columns);
      z.head(4) = eta;
      const body::PlanarInertia in = body::planar(reduced.inertia);
      all.insert(all.end(), {body::energy(reduced.elasticity, z), z.dot(in.M * z), in.h.dot(z), in.g.dot(z),
                             (tip.S * z).norm(), tip.psi.row(0).dot(z)});
    }
    // what the derivatives add, whatever their order: traces
    all.push_back(reduced.elasticity.linear_stiffness().trace());
    all.push_back(reduced.inertia.S.squaredNorm());
    all.push_back(reduced.line.S.squaredNorm());
    return all;
  };
  const std::vector<double> found = energies(PETSC_COMM_WORLD), expected = energies(PETSC_COMM_SELF);
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) CHECK(found[i] == Approx(expected[i]).epsilon(1e-9).margin(1e-9));
}

TEST_CASE("reduced inertia constants are V' times those of the full body") {
  const Held body(testing::straight(PETSC_COMM_WORLD, 5, 100, testing::paper_section()), Kind::pinned, {0, 1, 2});
  const reduction::Basis basis = body.basis(3);
  const body::FlexibleBody reduced = reduction::project(body.structure, basis);
  const MatrixXd V = testing::columns_of(body.structure, basis);
  const auto rigid = fem::rigid_motions(body.structure);
  const petsc::MatHandle M = fem::mass(body.structure, {});
  const body::PlanarInertia in = body::planar(reduced.inertia);
  CHECK(in.m == Approx(54.6).epsilon(1e-12));
  CHECK(in.s0.x() == Approx(54.6 * 50).epsilon(1e-12));
  CHECK(in.C0 == Approx(54.6 * 1e4 / 3 + 456.3).epsilon(1e-12));
  for (int d = 0; d < 2; ++d)
    CHECK(testing::relative_error(in.S.row(d), testing::product(M, rigid[d]).transpose() * V) < 1e-11);
  CHECK(testing::relative_error(in.g, V.transpose() * testing::product(M, rigid[2])) < 1e-11);
  CHECK((in.M - MatrixXd::Identity(V.cols(), V.cols())).cwiseAbs().maxCoeff() < 1e-12);
  CHECK(testing::relative_error(in.B, -in.B.transpose()) < 1e-12);
  CHECK(reduced.line.m == Approx(100).epsilon(1e-13));
  CHECK(reduced.coordinates() == V.cols());
}

TEST_CASE("a place map holds the rows of V at its node") {
  const Held body(testing::straight(PETSC_COMM_WORLD, 5, 100, testing::paper_section()), Kind::pinned, {0, 1, 2});
  const reduction::Basis basis = body.basis(2);
  const MatrixXd V = testing::columns_of(body.structure, basis);
  for (PetscInt node = 0; node <= 5; ++node) {
    const body::PlaceMap place = reduction::place_map(body.structure, basis, node);
    CHECK(place.x == Eigen::Vector2d(20. * double(node), 0));
    CHECK(place.S == V.middleRows(3 * node, 2));
    CHECK(place.psi == V.middleRows(3 * node + 2, 1));
  }
}

TEST_CASE("a rigid body is its mass alone") {
  const fem::Structure s = testing::straight(PETSC_COMM_WORLD, 4, 2, {1, 1, 3, 0.5});
  const body::FlexibleBody rigid = reduction::rigid_body(s);
  CHECK(rigid.coordinates() == 0);
  const body::PlanarInertia in = body::planar(rigid.inertia);
  CHECK(in.m == Approx(6).epsilon(1e-13));
  CHECK(in.C0 == Approx(3 * 8 / 3. + 1).epsilon(1e-13));
  CHECK(reduction::place_map(s, {}, 4).x.x() == 2);
}
