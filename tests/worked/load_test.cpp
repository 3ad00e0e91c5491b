#include <catch2/catch.hpp>
#include <cmath>

#include "floe/dynamics/marker.h"
#include "terms.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::Random;
using testing::State;

// The load of the manual's page on extending floe: from [drag] to [end] it stands there word by word.
namespace {

// [drag]
/// Resistance of a fluid at a place in the plane, f = -c |v| v with its velocity v: a term without multipliers. Rows
/// are those of a force with its sign reversed, -P' f, P = dy/dq of the place's pose y = (x, y, angle).
class Drag final : public dynamics::Term {
 public:
  /// @param c  half the density times the area times the coefficient of resistance [kg/m]
  Drag(dynamics::Marker at, double c) : at_(std::move(at)), c_(c) {}
  const std::vector<int>& coordinates() const override { return at_.coordinates; }

  void residual(const dynamics::Motion& motion, VectorXd& r) const override {
    dynamics::pose(at_, motion.q, motion.v, motion.a, pose_);
    r -= pose_.P.transpose() * force();
  }

  void tangent(const dynamics::Motion& motion, dynamics::Weights weights, MatrixXd& J) const override {
    dynamics::pose(at_, motion.q, motion.v, motion.a, pose_);
    dynamics::add_geometric_stiffness(at_, pose_, force(), -weights.q, J);                     // of P, at fixed f
    J -= pose_.P.transpose() * by_velocity() * (weights.q * pose_.dyd + weights.v * pose_.P);  // of f, by v(q, q')
  }

 private:
  Vector3d velocity() const { return {pose_.yd[0], pose_.yd[1], 0}; }
  Vector3d force() const { return -c_ * velocity().norm() * velocity(); }
  /// df/dv = -c (|v| + v v' / |v|); 0 at rest
  Eigen::Matrix3d by_velocity() const {
    const Vector3d v = velocity();
    Eigen::Matrix3d by = Eigen::Vector3d(1, 1, 0).asDiagonal() * v.norm();
    if (v.norm() > 0) by += v * v.transpose() / v.norm();
    return -c_ * by;
  }
  dynamics::Marker at_;
  double c_;
  mutable dynamics::Pose pose_;
};
// [end]

}  // namespace

TEST_CASE("worked example, load: the drag of a place is differentiated exactly") {
  Random random(33);
  for (const auto& [at, ignored] : testing::place_pairs()) {
    if (at.coordinates.empty()) continue;  // of the ground
    const Drag drag(at, 0.7);
    const auto size = static_cast<Eigen::Index>(drag.coordinates().size());
    CHECK(testing::tangent_error(drag, State(random, size)) < 1e-8);
    State rest(random, size);
    rest.v.setZero();
    CHECK(testing::rows_of(drag, rest).norm() == 0);
    CHECK(testing::tangent_of(drag, rest, {1, 1, 0}).norm() == 0);
  }
}

// The power of the rows is that of the force, which takes energy: v . rows = c |v|^3 at the place.
TEST_CASE("worked example, load: drag takes the energy that its force does") {
  Random random(34);
  for (const auto& [at, ignored] : testing::place_pairs()) {
    if (at.coordinates.empty()) continue;
    const Drag drag(at, 0.7);
    const State s(random, static_cast<Eigen::Index>(drag.coordinates().size()));
    dynamics::Pose pose;
    dynamics::pose(at, s.q, s.v, s.a, pose);
    CHECK(testing::rows_of(drag, s).dot(s.v) == Approx(0.7 * std::pow(pose.yd.head<2>().norm(), 3)).epsilon(1e-12));
  }
}
