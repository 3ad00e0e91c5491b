#include "floe/dynamics/spatial_marker.h"

#include <catch2/catch.hpp>

#include "spatial_terms.h"

using namespace floe;
using dynamics::SpatialMarker;
using dynamics::SpatialPose;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::Random;
using testing::SpatialMotion;
using testing::State;

namespace {

std::vector<SpatialMarker> markers() {
  Random random(201);
  SpatialMarker weighted = testing::spatial_marker(random, 0, testing::attitude(random), 3);
  weighted.mass = 2.5;
  SpatialMarker turned = testing::spatial_marker(random, 0, testing::attitude(random), 3);
  for (int a = 0; a < 3; ++a) {
    const Matrix3d form = random.matrix(3, 3);
    turned.H.emplace_back(form + form.transpose());
  }
  SpatialMarker curved = weighted, at_arm = turned, still = testing::still_marker(random, 0, 3);
  std::vector<MatrixXd> forms;
  for (int a = 0; a < 3; ++a) {
    const Matrix3d form = random.matrix(3, 3);
    forms.emplace_back(form + form.transpose());
  }
  curved.Q = forms;
  at_arm.arm = {0.7, -0.4, 1.1}, still.arm = {0.2, 0.9, -0.3};
  SpatialMarker all = curved;
  all.H = turned.H, all.arm = at_arm.arm;
  return {testing::spatial_marker(random, 0, testing::attitude(random), 3),
          weighted,
          testing::still_marker(random, 0, 3),
          turned,
          curved,
          at_arm,
          still,
          all};
}

SpatialPose pose_at(const SpatialMarker& marker, const State& s) {
  SpatialPose out;
  dynamics::pose(marker, s.q, s.v, s.a, out);
  return out;
}

Eigen::Index size(const SpatialMarker& marker) { return static_cast<Eigen::Index>(marker.coordinates.size()); }

/// The columns of x times T(x).
MatrixXd by_chart(const SpatialMarker& marker, const SpatialPose& at, MatrixXd columns) {
  if (marker.framed()) columns.middleCols(3, 3) = (columns.middleCols(3, 3) * at.T).eval();
  return columns;
}

SpatialMotion motion_of(Random& random, const SpatialMarker& marker) {
  return {random, size(marker), marker.framed() ? std::vector<Eigen::Index>{0} : std::vector<Eigen::Index>{}};
}

}  // namespace

TEST_CASE("a place in space lies and is turned as its formula says") {
  Random random(202);
  for (const SpatialMarker& marker : markers()) {
    const State s(random, size(marker));
    const SpatialPose at = pose_at(marker, s);
    const bool framed = marker.framed();
    const Matrix3d A = framed ? Matrix3d(marker.attitude->base.toRotationMatrix() *
                                         Eigen::AngleAxisd(s.q.segment<3>(3).norm(), s.q.segment<3>(3).normalized()))
                              : marker.axes;
    const Vector3d R = framed ? Vector3d(s.q.head<3>()) : marker.origin, e = s.q.tail<3>(), b = marker.psi * e;
    Vector3d beta = b;
    for (std::size_t a = 0; a < marker.H.size(); ++a) beta[static_cast<Eigen::Index>(a)] += b.dot(marker.H[a] * b) / 2;
    const Matrix3d bent = Eigen::AngleAxisd(beta.norm(), beta.normalized()).toRotationMatrix();
    Vector3d c = marker.x0 + marker.S * e + bent * marker.arm - marker.arm - b.cross(marker.arm);
    for (std::size_t a = 0; a < marker.Q.size(); ++a) c[static_cast<Eigen::Index>(a)] += e.dot(marker.Q[a] * e) / 2;
    CHECK((at.p - (marker.mass * R + A * c)).norm() < 1e-14 * (1 + at.p.norm()));
    CHECK((at.D - A * bent * marker.D0).norm() < 1e-14);
  }
}

TEST_CASE("a place of the ground stands still where it is") {
  const Matrix3d axes = math::rotation({0.1, 0.2, 0.3});
  const SpatialMarker ground = SpatialMarker::ground({1, 2, 3}, axes);
  Random random;
  const SpatialPose at = pose_at(ground, State(random, 0));
  CHECK(at.p == Vector3d(1, 2, 3));
  CHECK((at.D - axes).norm() < 1e-15);
  CHECK(at.P.cols() == 0);
  CHECK(at.velocity.norm() + at.spin.norm() + at.acceleration.norm() + at.spin_rate.norm() == 0);
}

TEST_CASE("velocity, spin and their rates are the time derivatives of position and axes") {
  Random random(203);
  for (const SpatialMarker& marker : markers()) {
    const SpatialMotion motion = motion_of(random, marker);
    const auto at = [&](double t) { return pose_at(marker, motion.state(t)); };
    const double t = 0.4, h = 1e-3;
    const SpatialPose now = at(t);
    CHECK(now.spin.norm() > 0.1);
    CHECK((now.velocity - testing::derivative([&](double s) { return at(s).p; }, t, h)).norm() < 1e-9);
    CHECK((now.acceleration - testing::derivative([&](double s) { return at(s).velocity; }, t, h)).norm() < 1e-9);
    const Matrix3d W = testing::derivative([&](double s) { return at(s).D; }, t, h) * now.D.transpose();
    CHECK((now.spin - testing::axial(W)).norm() < 1e-9);
    CHECK((now.spin_rate - testing::derivative([&](double s) { return at(s).spin; }, t, h)).norm() < 1e-9);
  }
}

TEST_CASE("directions of a place: velocity and spin at unit rates, and the derivatives by the chart after T(x)") {
  Random random(204);
  for (const SpatialMarker& marker : markers()) {
    const State s(random, size(marker));
    const SpatialPose at = pose_at(marker, s);
    CHECK((at.P * s.v - (Eigen::Matrix<double, 6, 1>() << at.velocity, at.spin).finished()).norm() < 1e-13);
    const auto moved = [&](const VectorXd& q) {
      State other = s;
      other.q = q;
      return pose_at(marker, other);
    };
    const MatrixXd dp = testing::jacobian([&](const VectorXd& q) { return moved(q).p; }, s.q, 1e-3);
    const MatrixXd dphi = testing::jacobian(
        [&](const VectorXd& q) {
          const Matrix3d W = moved(q).D * at.D.transpose();
          return Vector3d(0.5 * testing::axial(W - W.transpose()));
        },
        s.q, 1e-3);
    const MatrixXd P = by_chart(marker, at, at.P);
    CHECK(testing::relative_error(P.topRows(3), dp) < 1e-9);
    CHECK(testing::relative_error(P.bottomRows(3), dphi) < 1e-9);
  }
}

TEST_CASE("the rows of a wrench, by the place alone, are those of its directions") {
  Random random(208);
  for (const SpatialMarker& marker : markers())
    for (const Vector3d& moment : {Vector3d(0, 0, 0), Vector3d(1, -2, 0.5)}) {
      const State s(random, size(marker));
      const dynamics::Wrench w = (dynamics::Wrench() << 0.3, 2, -1, moment).finished();
      SpatialPose place;
      VectorXd rows;
      dynamics::pose(marker, s.q, s.v, s.a, place, dynamics::EvaluationLevel::position);
      CHECK(place.P.cols() == 0);
      dynamics::pull_back(marker, place, w, rows);
      const VectorXd expected = pose_at(marker, s).P.transpose() * w;
      CHECK(expected.norm() > 0.1);
      CHECK((rows - expected).norm() < 1e-14 * expected.norm());
    }
}

TEST_CASE("the gradient of velocity and spin at fixed rates") {
  Random random(205);
  for (const SpatialMarker& marker : markers()) {
    const State s(random, size(marker));
    const auto rates = [&](const VectorXd& q) {
      State other = s;
      other.q = q;
      const SpatialPose at = pose_at(marker, other);
      return (Eigen::Matrix<double, 6, 1>() << at.velocity, at.spin).finished();
    };
    const SpatialPose at = pose_at(marker, s);
    dynamics::Matrix6Xd found;
    dynamics::rate_gradient(marker, at, found);
    CHECK(testing::relative_error(by_chart(marker, at, found), testing::jacobian(rates, s.q, 1e-3)) < 1e-9);
  }
}

TEST_CASE("the geometric stiffness is the change of a wrench's rows, moments on bent places included") {
  Random random(206);
  for (const SpatialMarker& marker : markers())
    for (const Vector3d& moment : {Vector3d(0, 0, 0), Vector3d(1, -2, 0.5)}) {
      const State s(random, size(marker));
      const dynamics::Wrench w = (dynamics::Wrench() << 0.3, 2, -1, moment).finished();
      const auto rows = [&](const VectorXd& q) {
        State other = s;
        other.q = q;
        return VectorXd(pose_at(marker, other).P.transpose() * w);
      };
      MatrixXd K = MatrixXd::Zero(size(marker), size(marker));
      dynamics::add_geometric_stiffness(marker, pose_at(marker, s), w, 3, K);
      const MatrixXd expected = 3 * testing::jacobian(rows, s.q, 1e-3);
      CHECK((K - expected).cwiseAbs().maxCoeff() < 1e-8);
      const bool bends = marker.framed() || moment.norm() > 0 || marker.arm.norm() > 0;
      CHECK(bends == (expected.norm() > 0.1));
    }
}

TEST_CASE("with planar coordinates a place in space is the planar one") {
  Random random(207);
  const dynamics::Marker flat = testing::framed_marker(random, 0);
  const SpatialMarker marker = testing::in_space(flat, std::make_shared<dynamics::Attitude>());
  const State s(random, 5), lifted = testing::in_space(s, {0, 1, 5, 6, 7}, 8);
  dynamics::Pose planar;
  dynamics::pose(flat, s.q, s.v, s.a, planar);
  const SpatialPose at = pose_at(marker, lifted);
  CHECK((at.p - Vector3d(planar.y.x(), planar.y.y(), 0)).norm() < 1e-14);
  CHECK((at.D - math::rotation({0, 0, planar.y.z()})).norm() < 1e-14);
  CHECK((at.velocity - Vector3d(planar.yd.x(), planar.yd.y(), 0)).norm() < 1e-14);
  CHECK((at.spin - Vector3d(0, 0, planar.yd.z())).norm() < 1e-14);
  CHECK((at.acceleration - Vector3d(planar.ydd.x(), planar.ydd.y(), 0)).norm() < 1e-13);
  CHECK((at.spin_rate - Vector3d(0, 0, planar.ydd.z())).norm() < 1e-14);
}
