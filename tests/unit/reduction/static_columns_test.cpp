#include <catch2/catch.hpp>

#include "bodies_in_space.h"

using namespace floe;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::in_original_order;
using testing::SpatiallyConstrained;
using testing::Spread;

namespace {

Matrix3d oblique() { return Eigen::AngleAxisd(1.3, Vector3d(0.3, -0.7, 1.1).normalized()).toRotationMatrix(); }

/// Two slender members at an angle, rotated by R, clamped at original node 0: r/L = 1e-4.
fem::Structure bent(MPI_Comm comm, const Matrix3d& R) {
  const generate::Polyline lines{
      {{0, 0, 0}, R * Vector3d(1, 0, 0), R * Vector3d(1.8, 0.4, 0.5)}, {{0, 1}, {1, 2}}, {5, 4}, {}};
  const fem::SpatialBeam beam{
      {1, 2.5e-9, 2.5e-9, 0, 4e-9, 1, 2.5e-9, 2.5e-9, 0, {0, 0}, {0, 0}}, R * Vector3d(0.3, 0.2, 1), {}};
  return testing::structure_of(generate::polyline(comm, lines), {beam}, Spread::shuffled);
}

constexpr PetscInt knee = 5, end = 9;  // original nodes

VectorXd force(const fem::Structure& s, PetscInt node, const Vector3d& direction) {
  VectorXd f = VectorXd::Zero(s.dofs());
  f.segment<3>(6 * node) = direction;
  return f;
}

struct Asked {
  std::string label;
  VectorXd load;  // by original dofs
};

reduction::Generators generators(const SpatiallyConstrained& body, int modes, const std::vector<Asked>& asked) {
  std::vector<reduction::Attachment> attachments;
  for (const Asked& each : asked)
    attachments.push_back({each.label, testing::field_of_originals(body.structure, each.load), {}});
  return reduction::generators(body.structure, body.frame, body.holding, body.statics, modes, attachments, 1e-7);
}

std::vector<Asked> unit_forces(const fem::Structure& s, PetscInt node, const std::string& name) {
  std::vector<Asked> all;
  for (int c = 0; c < 3; ++c) all.push_back({name + ".f" + "xyz"[c], force(s, node, Vector3d::Unit(c))});
  return all;
}

/// What the basis lacks of the response to a load, of it. Collective.
double missing(const SpatiallyConstrained& body, const reduction::Basis& basis, const VectorXd& load) {
  const fem::Structure& s = body.structure;
  reduction::Columns loads;
  loads.push_back(testing::field_of_originals(s, load));
  const VectorXd u = in_original_order(s, body.statics.solve(loads)[0]);
  const MatrixXd V = testing::columns_in_originals(s, basis);
  const VectorXd Mu = testing::product_in_originals(s, fem::mass(s, {}), u);
  const VectorXd left = u - V * (V.transpose() * Mu);
  return std::sqrt(left.dot(testing::product_in_originals(s, fem::mass(s, {}), left)) / u.dot(Mu));
}

}  // namespace

TEST_CASE("unit forces on an oblique slender frame: the basis holds the response along a member") {
  const Matrix3d R = oblique();
  const SpatiallyConstrained body(bent(PETSC_COMM_WORLD, R), testing::Kind::clamped, {0});
  const fem::Structure& s = body.structure;
  std::vector<Asked> asked = unit_forces(s, knee, "knee");
  for (Asked& each : unit_forces(s, end, "end")) asked.push_back(std::move(each));
  const reduction::Generators g = generators(body, 4, asked);
  CHECK(g.dropped.empty());
  REQUIRE(g.fields.size() == 10);
  const reduction::Basis basis = reduction::basis_of(s, g, {}, 1e-7);
  REQUIRE(basis.columns == 10);
  CHECK(missing(body, basis, force(s, knee, R.col(0))) < 1e-8);  // L/(E A), not L^3/(3 E I)
  for (const Asked& each : asked) CHECK(missing(body, basis, each.load) < 1e-8);
  // all that is left of the stiff response has its own size
  for (std::size_t i = 4; i < 7; ++i) CHECK(basis.origins[i].new_part > 1e-4);
}

TEST_CASE("static columns of an oblique body are the same on any number of ranks") {
  const Matrix3d R = oblique();
  const SpatiallyConstrained all(bent(PETSC_COMM_WORLD, R), testing::Kind::clamped, {0}),
      alone(bent(PETSC_COMM_SELF, R), testing::Kind::clamped, {0});
  const auto columns = [](const SpatiallyConstrained& body) {
    const reduction::Generators g = generators(body, 0, unit_forces(body.structure, knee, "knee"));
    REQUIRE(g.fields.size() == 3);
    MatrixXd U(body.structure.dofs(), 3);
    for (int i = 0; i < 3; ++i) U.col(i) = in_original_order(body.structure, g.fields[i]);
    return U;
  };
  const MatrixXd many = columns(all), one = columns(alone);
  for (int i = 0; i < 3; ++i) CHECK(testing::relative_error(many.col(i), one.col(i)) < 1e-6);
}

TEST_CASE("static columns that need no difference of loads are the responses themselves") {
  const SpatiallyConstrained body(bent(PETSC_COMM_WORLD, Matrix3d::Identity()), testing::Kind::clamped, {0});
  const fem::Structure& s = body.structure;
  const reduction::Generators g = generators(body, 0, unit_forces(s, knee, "knee"));
  REQUIRE(g.fields.size() == 3);
  for (int c = 0; c < 3; ++c) {
    reduction::Columns loads;
    loads.push_back(testing::field_of_originals(s, force(s, knee, Vector3d::Unit(c))));
    const VectorXd u = in_original_order(s, body.statics.solve(loads)[0]).normalized(),
                   v = in_original_order(s, g.fields[c]).normalized();
    CHECK((v - (u.dot(v) < 0 ? -1 : 1) * u).norm() < 1e-14);
  }
}

TEST_CASE("loads that repeat others, or do nothing, are told with their reason") {
  const Matrix3d R = oblique();
  const SpatiallyConstrained body(bent(PETSC_COMM_WORLD, R), testing::Kind::clamped, {0});
  const fem::Structure& s = body.structure;
  std::vector<Asked> asked = unit_forces(s, knee, "knee");
  asked.push_back({"again.fy", 3 * asked[1].load});
  asked.push_back({"both.f", asked[1].load + force(s, end, Vector3d::UnitX())});
  asked.push_back({"end.fx", force(s, end, Vector3d::UnitX())});
  asked.push_back({"root.fx", force(s, 0, Vector3d::UnitX())});
  const reduction::Generators g = generators(body, 0, asked);
  CHECK(g.fields.size() == 4);
  REQUIRE(g.dropped.size() == 3);
  CHECK(g.dropped[0].label == "attachment again.fy");
  CHECK(g.dropped[0].dropped == "repeats knee.fy");
  CHECK(g.dropped[2].dropped == "does not deform the body");
  for (const reduction::ColumnOrigin& origin : g.dropped) CHECK(!origin.kept);
}

TEST_CASE("numbers that do not suffice: the words say whether the mesh is too fine or the body too thin") {
  const fem::Structure thin = bent(PETSC_COMM_WORLD, oblique());
  CHECK_THAT(reduction::too_fine(thin, "so it is").what(),
             Catch::StartsWith("the body is thinner than double precision resolves: so it is") &&
                 Catch::Contains("an element of 0.26 m with the radius of gyration 5e-05 m") &&
                 Catch::Contains("take a thicker section"));
  const fem::Structure straight = testing::straight(PETSC_COMM_WORLD, 20, 1, {1e10, 1, 1, 0});
  CHECK_THAT(
      reduction::too_fine(straight, "so it is").what(),
      Catch::Equals("the mesh of 20 elements is finer than double precision resolves: so it is; take fewer elements"));
}

TEST_CASE("numbers that do not suffice: springs are a cause only where no other elements connect their nodes") {
  const generate::Polyline lines{
      {{0, 0, 0}, {1, 0, 0}, {1.8, 0.4, 0.5}, {2, 0, 0}, {3, 0, 0}}, {{0, 1}, {1, 2}, {3, 4}}, {5, 4, 2}, {}};
  const fem::SpatialBeam beam{
      {1, 2.5e-9, 2.5e-9, 0, 4e-9, 1, 2.5e-9, 2.5e-9, 0, {0, 0}, {0, 0}}, Vector3d(0.3, 0.2, 1), {}};
  fem::NodeSpring spring;
  spring.stiffness.setOnes(), spring.axes.setIdentity();
  const auto said = [&](PetscInt a, PetscInt b) {
    mesh::RawMesh raw = generate::polyline(PETSC_COMM_WORLD, lines);
    raw.parts.push_back("spring");
    if (raw.first_node == 0) {  // the first rank
      raw.cells.push_back({mesh::CellKind::spring, mesh::no_nodes<PetscInt>(), 1});
      raw.cells.back().nodes[0] = a, raw.cells.back().nodes[1] = b;
      raw.cell_labels.resize(raw.cells.size());
    } else {
      ++raw.first_cell;
    }
    ++raw.cell_count;
    return std::string(
        reduction::too_fine(testing::structure_of(raw, {beam, spring}, Spread::shuffled), "so it is").what());
  };
  CHECK_THAT(said(0, end), Catch::StartsWith("the body is thinner than double precision resolves: so it is"));
  CHECK_THAT(said(end, end + 1), Catch::StartsWith("so it is: springs, released ends"));
}
