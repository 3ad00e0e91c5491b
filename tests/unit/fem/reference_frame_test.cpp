#include "floe/fem/reference_frame.h"

#include <catch2/catch.hpp>

#include "differences.h"
#include "eigenvalues.h"
#include "random.h"
#include "structures.h"

using namespace floe;
using Eigen::VectorXd;
using testing::everywhere;
using testing::Random;
using Kind = fem::ReferenceFrame::Kind;

namespace {

fem::Structure beam() { return testing::straight(PETSC_COMM_WORLD, 6, 3, {50, 0.7, 3, 0.2}); }

/// Node 0 is at the origin, node 6 at (3, 0).
fem::ReferenceFrame frame_of(const fem::Structure& s, Kind kind) { return fem::reference_frame(s, kind, 0, 6); }

VectorXd projected(const fem::Structure& s, const fem::ReferenceFrame& frame, const VectorXd& q) {
  const petsc::VecHandle field = testing::field_of(s, q);
  fem::to_frame(frame, field);
  return everywhere(field);
}

VectorXd balanced(const fem::Structure& s, const fem::ReferenceFrame& frame, const VectorXd& f) {
  const petsc::VecHandle field = testing::field_of(s, f);
  fem::balance(frame, field);
  return everywhere(field);
}

}  // namespace

TEST_CASE("the projector of a frame takes rigid motions to nothing and repeats itself") {
  const Kind kind = GENERATE(Kind::pinned, Kind::clamped, Kind::mean_axis);
  const fem::Structure s = beam();
  const fem::ReferenceFrame frame = frame_of(s, kind);
  const VectorXd q = Random(41).vector(s.dofs()), f = Random(42).vector(s.dofs());
  const VectorXd Pq = projected(s, frame, q);
  CHECK(testing::relative_error(projected(s, frame, Pq), Pq) < 1e-14);
  for (const auto& motion : frame.rigid) CHECK(projected(s, frame, everywhere(motion)).cwiseAbs().maxCoeff() < 1e-14);
  // what is taken away is a rigid motion: it brings no force
  CHECK(testing::product(fem::stiffness(s, {}), testing::field_of(s, q - Pq)).cwiseAbs().maxCoeff() < 1e-11);
  // P'f is self-equilibrated, and P' is the transpose of P
  const VectorXd Pf = balanced(s, frame, f);
  for (const auto& motion : frame.rigid) CHECK(std::abs(everywhere(motion).dot(Pf)) < 1e-13);
  CHECK(Pf.dot(q) == Approx(f.dot(Pq)).epsilon(1e-12));
}

TEST_CASE("each kind of frame meets its own conditions") {
  const fem::Structure s = beam();
  const VectorXd q = Random(43).vector(s.dofs());
  const VectorXd pinned = projected(s, frame_of(s, Kind::pinned), q);
  CHECK((pinned[0] == 0 && pinned[1] == 0 && pinned[3 * 6 + 1] == 0));
  CHECK(pinned[2] != 0);
  const VectorXd clamped = projected(s, frame_of(s, Kind::clamped), q);
  CHECK((clamped[0] == 0 && clamped[1] == 0 && clamped[2] == 0));
  const fem::ReferenceFrame mean = frame_of(s, Kind::mean_axis);
  const petsc::VecHandle free = testing::field_of(s, projected(s, mean, q));
  CHECK(mean.conditions.empty());
  for (const auto& motion : mean.rigid) CHECK(std::abs(testing::form(fem::mass(s, {}), motion, free)) < 1e-13);
}

TEST_CASE("frame conditions are ascending, the same on all ranks") {
  const fem::Structure s = beam();
  CHECK(frame_of(s, Kind::pinned).conditions == fem::Conditions{0, 1, 19});
  CHECK(fem::reference_frame(s, Kind::pinned, 6, 0).conditions == fem::Conditions{1, 18, 19});
  CHECK(frame_of(s, Kind::clamped).conditions == fem::Conditions{0, 1, 2});
}

TEST_CASE("a pinned frame through one node twice leaves the rotation free") {
  const fem::Structure s = beam();
  CHECK_THROWS_AS(fem::reference_frame(s, Kind::pinned, 2, 2), InputError);
}

TEST_CASE("holding: what joints leave free, and conditions that make K regular") {
  struct Case {
    fem::Conditions constrained;
    int left;
  };
  // none; a prismatic joint along x; along y; a hinge; two hinges; a clamp; a hinge and a slide along x
  const auto [constrained, left] =
      GENERATE(Case{{}, 3}, Case{{1, 2}, 1}, Case{{0, 2}, 1}, Case{{0, 1}, 1}, Case{{0, 1, 18, 19}, 0},
               Case{{0, 1, 2}, 0}, Case{{0, 1, 19}, 0}, Case{{1, 19}, 1}, Case{{0}, 2});
  const Kind kind = GENERATE(Kind::pinned, Kind::clamped, Kind::mean_axis);
  const fem::Structure s = beam();
  const fem::ReferenceFrame frame = frame_of(s, kind);
  const fem::Holding holding = fem::holding(s, frame, constrained);
  CHECK(holding.constrained == constrained);
  REQUIRE(holding.left.cols() == left);
  for (Eigen::Index r = 0; r < left; ++r) {  // a rigid motion that none of the constrained dofs takes part in
    VectorXd motion = VectorXd::Zero(s.dofs());
    for (int i = 0; i < 3; ++i) motion += holding.left(i, r) * everywhere(frame.rigid[i]);
    CHECK(motion.norm() > 0.1);
    for (PetscInt dof : constrained) CHECK(std::abs(motion[dof]) < 1e-14);
  }
  CHECK(std::is_sorted(holding.statics.begin(), holding.statics.end()));
  CHECK(std::includes(holding.statics.begin(), holding.statics.end(), constrained.begin(), constrained.end()));
  CHECK(holding.statics.size() == constrained.size() + static_cast<std::size_t>(left));
  Eigen::MatrixXd K(s.dofs(), s.dofs());
  const petsc::MatHandle stiffness = fem::stiffness(s, holding.statics);
  for (Eigen::Index j = 0; j < K.cols(); ++j)
    K.col(j) = testing::product(stiffness, testing::field_of(s, VectorXd::Unit(K.rows(), j)));
  CHECK(Eigen::LLT<Eigen::MatrixXd>(K).info() == Eigen::Success);
  CHECK(testing::eigenvalues(K)[0] > 1e-4);
}
