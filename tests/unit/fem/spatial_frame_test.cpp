#include <catch2/catch.hpp>

#include "differences.h"
#include "eigenvalues.h"
#include "floe/error.h"
#include "floe/fem/constrained_frame.h"
#include "spatial_structures.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Random;
using testing::Spread;
using Kind = fem::ReferenceFrame::Kind;

namespace {

fem::Structure mixed() { return testing::mixed_structure(PETSC_COMM_WORLD, Spread::shuffled); }

/// Origin at (0, 0, 0), x axis through (1, 0, 0): original nodes 0 and 3.
fem::ReferenceFrame frame_of(const fem::Structure& s, Kind kind) {
  const auto nodes = fem::global_nodes(s.mesh, {0, 3});
  return fem::reference_frame(s, kind, nodes[0], nodes[1]);
}

VectorXd projected(const fem::Structure& s, const fem::ReferenceFrame& frame, const VectorXd& q) {
  const petsc::VecHandle field = testing::field_of_originals(s, q);
  fem::to_frame(frame, field);
  return testing::in_original_order(s, field);
}

VectorXd balanced(const fem::Structure& s, const fem::ReferenceFrame& frame, const VectorXd& f) {
  const petsc::VecHandle field = testing::field_of_originals(s, f);
  fem::balance(frame, field);
  return testing::in_original_order(s, field);
}

/// Columns of the fields by original dofs.
MatrixXd columns(const fem::Structure& s, const std::vector<petsc::VecHandle>& fields) {
  MatrixXd all(s.dofs(), static_cast<Eigen::Index>(fields.size()));
  for (std::size_t i = 0; i < fields.size(); ++i)
    all.col(static_cast<Eigen::Index>(i)) = testing::in_original_order(s, fields[i]);
  return all;
}

}  // namespace

TEST_CASE("a frame by what the ground holds rests on displacements, and on rotations where these do not suffice") {
  const fem::Structure s = mixed();
  const auto held = [&](const std::vector<PetscInt>& originals) {
    fem::Conditions dofs;
    for (const PetscInt node : fem::global_nodes(s.mesh, originals))
      for (PetscInt d = 0; d < 6; ++d) dofs.push_back(6 * node + d);
    std::sort(dofs.begin(), dofs.end());
    return dofs;
  };
  const auto rotations = [](const fem::Conditions& dofs) {
    return std::count_if(dofs.begin(), dofs.end(), [](PetscInt dof) { return dof % 6 >= 3; });
  };
  const fem::Conditions all = held({0, 1, 3, 4}), one = held({3});
  const fem::ReferenceFrame frame = fem::constrained_frame(s, all), clamped = fem::constrained_frame(s, one);
  CHECK(frame.conditions.size() == 6);
  CHECK(rotations(frame.conditions) == 0);
  CHECK(std::includes(all.begin(), all.end(), frame.conditions.begin(), frame.conditions.end()));
  CHECK(clamped.conditions == one);
  CHECK(rotations(fem::constrained_frame(s, held({0, 3})).conditions) == 1);  // about the line between them
  CHECK_THROWS_AS(fem::constrained_frame(s, {one[0], one[1], one[3]}), InputError);
}

TEST_CASE("the projector of a frame in space: P^2 = P, P Phi_r = 0, f' P = 0, and balance is its transpose") {
  const Kind kind = GENERATE(Kind::pinned, Kind::clamped, Kind::mean_axis);
  const fem::Structure s = mixed();
  const fem::ReferenceFrame frame = frame_of(s, kind);
  REQUIRE((frame.rigid.size() == 6 && frame.functionals.size() == 6));
  const VectorXd q = Random(61).vector(s.dofs()), f = Random(62).vector(s.dofs());
  const VectorXd Pq = projected(s, frame, q), Pf = balanced(s, frame, f);
  CHECK(testing::relative_error(projected(s, frame, Pq), Pq) < 1e-12);
  const MatrixXd rigid = columns(s, frame.rigid), functionals = columns(s, frame.functionals);
  for (int i = 0; i < 6; ++i) {
    const VectorXd motion = rigid.col(i), functional = functionals.col(i);
    CHECK(projected(s, frame, motion).cwiseAbs().maxCoeff() < 1e-12);
    CHECK(std::abs(functional.dot(Pq)) < 1e-12 * functional.norm() * Pq.norm());
    CHECK(std::abs(functional.dot(q)) > 1e-3 * functional.norm());
    CHECK(std::abs(motion.dot(Pf)) < 1e-12 * motion.norm() * Pf.norm());
  }
  CHECK(Pf.dot(q) == Approx(f.dot(Pq)).epsilon(1e-11));
  // what is taken away is a rigid motion
  const VectorXd away = q - Pq, rest = away - rigid * rigid.colPivHouseholderQr().solve(away);
  CHECK(away.norm() > 0.1);
  CHECK(rest.norm() < 1e-12 * away.norm());
}

TEST_CASE("each kind of frame in space meets its own conditions") {
  const fem::Structure s = mixed();
  const VectorXd q = Random(63).vector(s.dofs());
  const VectorXd pinned = projected(s, frame_of(s, Kind::pinned), q);
  for (int dof : {0, 1, 2, 3, 19, 20}) CHECK(pinned[dof] == 0);
  for (int dof : {4, 5, 18, 21}) CHECK(pinned[dof] != 0);
  CHECK(frame_of(s, Kind::pinned).conditions.size() == 6);
  const VectorXd clamped = projected(s, frame_of(s, Kind::clamped), q);
  for (int dof = 0; dof < 6; ++dof) CHECK(clamped[dof] == 0);
  CHECK(frame_of(s, Kind::clamped).conditions == testing::dofs_of(s, {0}, {0, 1, 2, 3, 4, 5}));
  const fem::ReferenceFrame mean = frame_of(s, Kind::mean_axis);
  CHECK(mean.conditions.empty());
  const VectorXd momentum =
      columns(s, mean.rigid).transpose() * testing::product_in_originals(s, fem::mass(s, {}), projected(s, mean, q));
  CHECK(momentum.cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("a pinned frame in space needs two nodes apart along its x axis") {
  const fem::Structure s = mixed();
  const auto nodes = fem::global_nodes(s.mesh, {0, 8});  // (0, 0, 0) and (0, 1, 0): y, not x
  CHECK_THROWS_AS(fem::reference_frame(s, Kind::pinned, nodes[0], nodes[0]), InputError);
  CHECK_THROWS_AS(fem::reference_frame(s, Kind::pinned, nodes[0], nodes[1]), InputError);
}

TEST_CASE("holding in space: what joints leave free, and conditions that make K regular") {
  struct Case {
    const char* name;
    std::vector<PetscInt> nodes;  ///< original: 0, 4, 8 are the edge x = 0 from (0, 0, 0) to (0, 1, 0)
    std::vector<int> directions;
    int left;
  };
  const Case c =
      GENERATE(Case{"nothing", {}, {}, 6}, Case{"a hinge line", {0, 4, 8}, {0, 1, 2}, 1},
               Case{"a clamped edge", {0, 4, 8}, {0, 1, 2, 3, 4, 5}, 0},
               Case{"translations of a node", {20}, {0, 1, 2}, 3}, Case{"one direction", {7}, {1}, 5},
               Case{"two points", {0, 20}, {0, 1, 2}, 1}, Case{"a clamped node", {20}, {0, 1, 2, 3, 4, 5}, 0},
               Case{"rotations of a node", {13}, {3, 4, 5}, 3}, Case{"a plate in its plane", {0, 3, 8}, {2}, 3});
  INFO(c.name);
  const Kind kind = GENERATE(Kind::pinned, Kind::clamped, Kind::mean_axis);
  const fem::Structure s = mixed();
  const fem::ReferenceFrame frame = frame_of(s, kind);
  const fem::Conditions constrained = testing::dofs_of(s, c.nodes, c.directions);
  const fem::Holding holding = fem::holding(s, frame, constrained);
  CHECK(holding.constrained == constrained);
  REQUIRE(holding.left.cols() == c.left);
  const MatrixXd rigid = columns(s, frame.rigid), free = rigid * holding.left;
  if (c.left > 0) CHECK(free.colPivHouseholderQr().rank() == c.left);
  for (PetscInt node : c.nodes)
    for (int d : c.directions)
      if (c.left > 0) CHECK(free.row(6 * node + d).cwiseAbs().maxCoeff() < 1e-12);
  CHECK(std::is_sorted(holding.statics.begin(), holding.statics.end()));
  CHECK(std::includes(holding.statics.begin(), holding.statics.end(), constrained.begin(), constrained.end()));
  CHECK(holding.statics.size() == constrained.size() + static_cast<std::size_t>(c.left));
  // K is regular: positive definite on the complement of the rigid motions, so that it is enough that none is left
  MatrixXd rows(static_cast<Eigen::Index>(holding.statics.size()), 6);
  for (int i = 0; i < 6; ++i) {
    const VectorXd motion = testing::everywhere(frame.rigid[i]);
    for (std::size_t k = 0; k < holding.statics.size(); ++k)
      rows(static_cast<Eigen::Index>(k), i) = motion[holding.statics[k]];
  }
  CHECK(rows.jacobiSvd().singularValues()[5] > 1e-3);
}

TEST_CASE("the elastic body is stiff in all but its six rigid motions") {
  const fem::Structure s = testing::mixed_structure(PETSC_COMM_SELF, Spread::last);
  const petsc::MatHandle K = fem::stiffness(s, {});
  MatrixXd dense(s.dofs(), s.dofs());
  for (Eigen::Index j = 0; j < dense.cols(); ++j)
    dense.col(j) = testing::product_in_originals(s, K, VectorXd::Unit(dense.rows(), j));
  const VectorXd values = testing::eigenvalues(dense);
  CHECK(std::abs(values[0]) < 1e-11 * values.tail(1)[0]);
  CHECK(std::abs(values[5]) < 1e-11 * values.tail(1)[0]);
  CHECK(values[6] > 1e-7 * values.tail(1)[0]);
}
