#include <catch2/catch.hpp>
#include <cstring>

#include "bodies_in_space.h"
#include "floe/reduction/place_set.h"

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

/// Clamped at original node 0, on its modes and all their derivatives.
struct Reduced {
  SpatiallyConstrained constrained;
  reduction::Basis basis;
  body::FlexibleBody body;
  Reduced(What what, MPI_Comm comm, Spread spread, int modes)
      : constrained(body_of(what, comm, spread), Kind::clamped, {0}),
        basis(constrained.basis(modes)),
        body(reduction::project(constrained.structure, basis)) {}
};

VectorXd force_of(const body::Elasticity& e, const VectorXd& eta) {
  VectorXd f = VectorXd::Zero(eta.size());
  body::ElasticityWork work;
  body::add_force(e, eta, work, f);
  return f;
}

}  // namespace

TEST_CASE("reduced energy and force of bodies in space equal the projected full ones") {
  const What what = GENERATE(What::triangles, What::quadrilaterals, What::beams, What::mixed, What::second_order,
                             What::linked_second_order, What::curved, What::curved_plate);
  const Reduced r(what, PETSC_COMM_WORLD, Spread::shuffled, 3);
  CHECK(r.basis.columns > 3);
  const MatrixXd V = testing::columns_in_originals(r.constrained.structure, r.basis);
  for (const double deflection : {1e-3, 0.05, 0.5}) {  // of a body of size 1: linear, moderate, far
    VectorXd eta = testing::Random(81).vector(V.cols());
    eta *= deflection / (V * eta).cwiseAbs().maxCoeff();
    const testing::SpatialElasticity full(r.constrained.structure, V * eta);
    CHECK(body::energy(r.body.elasticity, eta) == Approx(full.energy).epsilon(1e-11));
    CHECK(testing::relative_error(force_of(r.body.elasticity, eta), V.transpose() * full.force) < 1e-10);
  }
  const MatrixXd K = testing::dense(r.constrained.structure, fem::stiffness(r.constrained.structure, {}));
  CHECK(testing::relative_error(r.body.elasticity.linear_stiffness(), V.transpose() * K * V) < 1e-11);
}

TEST_CASE("reduced inertia constants of bodies in space are V' times those of the full body") {
  const What what = GENERATE(What::quadrilaterals, What::mixed, What::curved, What::curved_plate);
  const Reduced r(what, PETSC_COMM_WORLD, Spread::metis, 3);
  const fem::Structure& s = r.constrained.structure;
  const MatrixXd V = testing::columns_in_originals(s, r.basis), M = testing::dense(s, fem::mass(s, {}));
  MatrixXd rigid(s.dofs(), 6);
  for (int i = 0; i < 6; ++i) rigid.col(i) = testing::in_original_order(s, r.constrained.frame.rigid[i]);
  const MatrixXd mass = rigid.transpose() * M * rigid;
  const body::Inertia& in = r.body.inertia;
  REQUIRE(in.dimension() == 3);
  CHECK(in.m == Approx(mass(0, 0)).epsilon(1e-12));
  for (int a = 0; a < 3; ++a)  // e_b x x has the component -x_a along e_c (a, b, c in turn)
    CHECK(in.s0[a] == Approx(-mass((a + 2) % 3, 3 + (a + 1) % 3)).epsilon(1e-11).margin(1e-13));
  CHECK(testing::relative_error(in.C0.trace() * Eigen::Matrix3d::Identity() - in.C0, mass.bottomRightCorner(3, 3)) <
        1e-11);
  CHECK(testing::relative_error(in.S, rigid.leftCols(3).transpose() * M * V) < 1e-10);
  // int rho (e_r x x)' N: about x it is h_yz - h_zy
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    const MatrixXd found = in.h[b][c] - in.h[c][b], expected = rigid.col(3 + a).transpose() * M * V;
    CHECK((found.reshaped() - expected.reshaped()).cwiseAbs().maxCoeff() < 1e-10 * std::sqrt(mass(3 + a, 3 + a)));
  }
  if (what == What::mixed || what == What::curved) {  // W of the elements, by their own maps
    body::Inertia full(3, static_cast<int>(s.dofs()));
    full.allocate_rotary();
    for (const auto& cell : s.mesh.cells) {
      MatrixXd pick = MatrixXd::Zero(static_cast<Eigen::Index>(s.cell_dofs(cell).size()), s.dofs());
      for (Eigen::Index i = 0; i < pick.rows(); ++i) pick(i, s.original_dof(s.cell_dofs(cell)[i])) = 1;
      for (const body::RotatingMass& part : s.maps(cell).rotary)
        full.add(body::RotatingMass(part, part.rotation * pick));
    }
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        MPI_Allreduce(MPI_IN_PLACE, full.W[a][b].data(), static_cast<int>(full.W[a][b].size()), MPI_DOUBLE, MPI_SUM,
                      s.mesh.comm);
        const MatrixXd expected = V.transpose() * full.W[a][b] * V;
        CHECK(expected.norm() > 0);
        CHECK(testing::relative_error(in.W[a][b], expected) < 1e-11);
      }
  } else {
    CHECK(in.W.empty());
  }
  const MatrixXd sum = in.M[0][0] + in.M[1][1] + in.M[2][2];
  CHECK((sum - MatrixXd::Identity(V.cols(), V.cols())).cwiseAbs().maxCoeff() < 1e-10);
}

TEST_CASE("energies and inertia of a reduced body in space do not depend on the partition") {
  const What what = GENERATE(What::triangles, What::beams, What::mixed);
  const auto numbers = [&](MPI_Comm comm, Spread spread) {
    const Reduced r(what, comm, spread, 3);
    std::vector<double> all{double(r.basis.columns)};
    for (unsigned seed : {1u, 2u, 3u}) {
      VectorXd z = VectorXd::Zero(r.basis.columns);
      z.head(3) = 0.3 * testing::Random(seed).vector(3);  // of the modes: signs and order are fixed
      all.insert(all.end(), {body::energy(r.body.elasticity, z), (r.body.inertia.S * z).norm(),
                             z.dot(r.body.inertia.M[0][1] * z), z.dot(r.body.inertia.M[2][2] * z)});
    }
    all.push_back(r.body.inertia.m);
    all.push_back(r.body.inertia.C0.trace());
    all.push_back(r.body.elasticity.linear_stiffness().trace());
    all.push_back(r.body.inertia.S.squaredNorm());
    all.push_back(r.body.line.m);
    return all;
  };
  const std::vector<double> expected = numbers(PETSC_COMM_SELF, Spread::last);
  for (const Spread spread : {Spread::metis, Spread::shuffled}) {
    const std::vector<double> found = numbers(PETSC_COMM_WORLD, spread);
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      INFO("number " << i);
      CHECK(found[i] == Approx(expected[i]).epsilon(1e-9).margin(1e-9));
    }
  }
}

TEST_CASE("a reduced body in space is the same to the bit on all ranks; a place map holds the rows of V at its node") {
  const Reduced r(What::mixed, PETSC_COMM_WORLD, Spread::shuffled, 2);
  const auto same = [](const double* values, Eigen::Index count) {
    std::vector<double> first(values, values + count);
    MPI_Bcast(first.data(), static_cast<int>(count), MPI_DOUBLE, 0, PETSC_COMM_WORLD);
    CHECK(std::memcmp(first.data(), values, sizeof(double) * static_cast<std::size_t>(count)) == 0);
  };
  same(r.body.elasticity.F.data(), r.body.elasticity.F.size());
  same(r.body.elasticity.bending.data(), r.body.elasticity.bending.size());
  same(r.body.inertia.S.data(), r.body.inertia.S.size());
  const MatrixXd V = testing::columns_in_originals(r.constrained.structure, r.basis);
  const mesh::RawMesh raw = testing::mixed_mesh(PETSC_COMM_SELF);
  for (PetscInt original : {0, 7, 20}) {
    const PetscInt node = fem::global_nodes(r.constrained.structure.mesh, {original})[0];
    const body::PlaceMap place = reduction::place_map(r.constrained.structure, r.basis, node);
    CHECK(place.x == Eigen::VectorXd(raw.positions[original]));
    CHECK(place.S == V.middleRows(6 * original, 3));
    CHECK(place.psi == V.middleRows(6 * original + 3, 3));
  }
}

// The second-order displacements of the nodes of an edge cancel but for round-off where their arms do.
TEST_CASE("the mean of a rigid edge about its middle has no second-order displacement, that of a part has one") {
  const generate::Plate plate{{0, 0, 0}, {1, 0, 0}, {0, 0.7, 0}, 4, 4};
  const mesh::RawMesh raw = generate::plate(PETSC_COMM_WORLD, plate);
  SpatiallyConstrained constrained(
      {fem::mesh_of(raw, testing::ranks_of(raw, Spread::shuffled), {{4, 14}, {9, 14}, {19, 14}, {24, 14}}),
       {fem::shell_section({{fem::isotropic(1e4, 0.3, 2), 0.02, 0}})},
       fem::MembraneStrain::averaged},
      Kind::clamped, {0, 5, 10, 15, 20});
  const reduction::Basis basis = constrained.basis(3);
  const auto map_of = [&](const std::vector<PetscInt>& originals) {
    std::vector<reduction::WeightedNode> nodes;
    for (const PetscInt node : fem::global_nodes(constrained.structure.mesh, originals))
      nodes.push_back({node, 1.0 / static_cast<double>(originals.size())});
    return reduction::place_map(constrained.structure, basis, nodes);
  };
  CHECK(map_of({4, 9, 14, 19, 24}).Q.empty());
  REQUIRE(map_of({14, 19}).Q.size() == 3);
}

TEST_CASE("strains of second order: loads of derivatives are those of the elements, one by one") {
  const What what = GENERATE(What::second_order, What::linked_second_order);
  const SpatiallyConstrained constrained(body_of(what, PETSC_COMM_WORLD, Spread::shuffled), Kind::clamped, {0});
  const fem::Structure& s = constrained.structure;
  std::vector<petsc::VecHandle> fields;
  for (unsigned seed : {1u, 2u, 3u})
    fields.push_back(testing::field_of_originals(s, testing::Random(seed).vector(s.dofs())));
  const std::vector<std::array<int, 2>> pairs{{0, 0}, {0, 2}, {1, 2}};
  const auto found = fem::stiffness_derivatives(s, fields, pairs);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const VectorXd expected =
        testing::in_original_order(s, fem::stiffness_derivative(s, fields[pairs[p][0]], fields[pairs[p][1]]));
    CHECK(testing::relative_error(testing::in_original_order(s, found[p]), expected) < 1e-10);
  }
}
