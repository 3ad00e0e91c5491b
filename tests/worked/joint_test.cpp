#include <catch2/catch.hpp>

#include "floe/dynamics/marker_pair.h"
#include "floe/dynamics/spatial_joint.h"
#include "spatial_terms.h"

using namespace floe;
using dynamics::ConstraintLevel;
using Eigen::Vector2d;
using Eigen::VectorXd;
using testing::Random;
using testing::State;

// The joints of the manual's page on extending floe: from [slot] and [rod] to [end] they stand there word by word.
namespace {

// [slot]
/// A ring on a rod: the second place stays on the z axis of the first, and rotates as it likes. Two rows of the kinds
/// that there are.
dynamics::SpatialConstraint slot() { return {{dynamics::Along{0}, dynamics::Along{1}}}; }
// [end]

// [rod]
/// A massless rod in the plane, C = |p_2 - p_1| - length: a term of its own.
class Rod final : public dynamics::Term {
 public:
  Rod(dynamics::Marker first, dynamics::Marker second, double length, int multiplier)
      : pair_(std::move(first), std::move(second)), length_(length) {
    pair_.coordinates.push_back(multiplier);  // behind those of the places
  }
  const std::vector<int>& coordinates() const override { return pair_.coordinates; }

  void residual(const dynamics::Motion& motion, VectorXd& r) const override {
    pair_.evaluate(motion);
    pair_.add(motion.q[row()] * gradient(), r);
    r[row()] += constraint(motion.level);
  }

  void tangent(const dynamics::Motion& motion, dynamics::Weights weights, Eigen::MatrixXd& J) const override {
    pair_.evaluate(motion);
    const double lambda = motion.q[row()];
    pair_.add_tangent(lambda * gradient(), lambda * hessian(), dynamics::Matrix6::Zero(), weights, J);
    VectorXd C_q = VectorXd::Zero(J.rows());
    pair_.add(gradient(), C_q);
    J.row(row()) += C_q.transpose();  // multipliers' columns and rows have weight 1
    J.col(row()) += C_q;
  }

 private:
  Eigen::Index row() const { return static_cast<Eigen::Index>(pair_.coordinates.size()) - 1; }
  static Vector2d apart(const dynamics::Vector6& y) { return y.segment<2>(3) - y.head<2>(); }

  double constraint(ConstraintLevel level) const {
    const Vector2d d = apart(pair_.y()), v = apart(pair_.yd());
    const Vector2d n = d.normalized();
    if (level == ConstraintLevel::position) return d.norm() - length_;
    if (level == ConstraintLevel::velocity) return n.dot(v);
    return n.dot(apart(pair_.ydd())) + (v.squaredNorm() - std::pow(n.dot(v), 2)) / d.norm();
  }
  /// dC/dy, y = (x_1, y_1, angle_1, x_2, y_2, angle_2)
  dynamics::Vector6 gradient() const {
    const Vector2d n = apart(pair_.y()).normalized();
    return (dynamics::Vector6() << -n, 0, n, 0).finished();
  }
  dynamics::Matrix6 hessian() const {
    const Vector2d d = apart(pair_.y()), n = d.normalized();
    const Eigen::Matrix2d across = (Eigen::Matrix2d::Identity() - n * n.transpose()) / d.norm();
    dynamics::Matrix6 H = dynamics::Matrix6::Zero();
    H.block<2, 2>(0, 0) = H.block<2, 2>(3, 3) = across;
    H.block<2, 2>(0, 3) = H.block<2, 2>(3, 0) = -across;
    return H;
  }
  mutable dynamics::MarkerPair pair_;
  double length_;
};
// [end]

/// Whether levels are time derivatives of one another, along a motion of the coordinates; returns the greatest error.
template <class Motion>
double levels_error(const dynamics::Term& term, const Motion& state, int rows) {
  const auto at = [&](ConstraintLevel level, double t) {
    return VectorXd(testing::rows_of(term, state(t), level).tail(rows));
  };
  const double t = 0.6;
  double greatest = 0;
  for (const auto& [above, below] : {std::pair{ConstraintLevel::position, ConstraintLevel::velocity},
                                     {ConstraintLevel::velocity, ConstraintLevel::acceleration}}) {
    const VectorXd rate = testing::derivative([&](double s) { return at(above, s); }, t, 5e-4);
    greatest = std::max(greatest, (at(below, t) - rate).norm() / (1 + rate.norm()));
  }
  return greatest;
}

}  // namespace

TEST_CASE("worked example, joint: a rod in the plane is differentiated exactly, at all levels") {
  Random random(31);
  for (const auto& [first, second] : testing::place_pairs()) {
    const Rod rod(first, second, 0.7, 100);
    const auto size = static_cast<Eigen::Index>(rod.coordinates().size());
    CHECK(testing::tangent_error(rod, State(random, size), 1) < 1e-8);
    const testing::SmoothMotion motion(random, size);
    const auto state = [&](double t) {
      State s(random, 0);
      s.q = motion.q(t), s.v = motion.v(t), s.a = motion.a(t), s.t = t;
      return s;
    };
    CHECK(levels_error(rod, state, 1) < 1e-8);
  }
}

TEST_CASE("worked example, joint: a ring on a rod is differentiated exactly, at all levels, and does no work") {
  Random random(32);
  for (const auto& places : testing::spatial_pairs()) {
    const dynamics::SpatialJoint ring(places.first, places.second, slot(), 100);
    const auto size = static_cast<Eigen::Index>(ring.coordinates().size());
    State s(random, size);
    CHECK(testing::tangent_error(ring, s, 2) < 1e-8);
    const testing::SpatialMotion motion(random, size, places.frames);
    CHECK(levels_error(
              ring, [&](double t) { return motion.state(t); }, 2) < 1e-8);
    const VectorXd power = testing::rows_of(ring, s).head(size - 2);
    CHECK(power.dot(s.v.head(size - 2)) ==
          Approx(s.q.tail(2).dot(testing::rows_of(ring, s, ConstraintLevel::velocity).tail(2))).margin(1e-12));
  }
}

// A place 0.5 above the ground's and 0.3 beside it: off the z axis by 0.3, wherever it is along it.
TEST_CASE("worked example, joint: what the ring holds, in plain numbers") {
  dynamics::SpatialMarker place;
  place.coordinates = {0, 1, 2};
  place.S = Eigen::Matrix3d::Identity();
  place.psi = Eigen::Matrix3d::Zero();
  const dynamics::SpatialJoint ring(dynamics::SpatialMarker::ground({1, 1, 1}), place, slot(), 3);
  Random random;
  State s(random, 5);
  s.q << 1.3, 1, 1.5, 0, 0;
  CHECK((testing::rows_of(ring, s).tail(2) - Vector2d(0.3, 0)).norm() < 1e-15);
}
