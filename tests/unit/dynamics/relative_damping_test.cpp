#include "floe/dynamics/relative_damping.h"

#include <catch2/catch.hpp>

#include "floe/dynamics/floating_body.h"
#include "floe/dynamics/spatial_body.h"
#include "spatial_terms.h"

using namespace floe;
using dynamics::AccompanyingAxes;
using dynamics::ConstraintLevel;
using dynamics::MovingAxes;
using dynamics::RelativeDamping;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::Random;
using testing::State;

namespace {

constexpr int k = 2;

body::Elasticity none() { return {MatrixXd::Zero(k, k), MatrixXd(0, k), {}}; }

body::Inertia inertia(int dimension) {
  Random random(31);
  body::Inertia sum(dimension, k);
  for (int i = 0; i < 9; ++i)
    sum.add(body::MassPoint{1.5 + random.number(), random.vector(dimension), 0.4 * random.matrix(dimension, k)});
  return sum;
}

/// A body with its axes first, and axes f behind its elastic coordinates.
struct Damped {
  MovingAxes body, f;
  std::unique_ptr<RelativeDamping> term;
  int size;
};

Damped damped(int dimension, bool with_f = true) {
  Random random(32);
  std::vector<int> coordinates;
  const int frame = dimension == 3 ? 6 : 3, first = frame + k;
  for (int i = 0; i < first; ++i) coordinates.push_back(i);
  Damped all{{0, dimension}, {first, first + dimension}, nullptr, with_f ? first + frame : first};
  std::unique_ptr<const dynamics::Term> mass;
  if (dimension == 3) {
    all.body.attitude = testing::attitude(random), all.f.attitude = testing::attitude(random);
    mass = std::make_unique<dynamics::SpatialBody>(coordinates, all.body.attitude, body::spatial(inertia(3)), none());
  } else {
    all.body.origin = {0.3, -0.2, 0}, all.f.angle = 0.4;
    mass = std::make_unique<dynamics::FloatingBody>(coordinates, body::planar(inertia(2)), none());
  }
  std::vector<MovingAxes> moving = {all.body};
  if (dimension == 2) moving.front().origin = Vector3d::Zero();
  all.term = std::make_unique<RelativeDamping>(std::move(mass), moving,
                                               with_f ? std::optional<MovingAxes>(all.f) : std::nullopt, 0.7);
  return all;
}

std::vector<AccompanyingAxes::Row> some_rows(Random& random) {
  std::vector<AccompanyingAxes::Row> rows;
  for (int i = 0; i < 3; ++i) rows.push_back({random.vector(3), random.matrix(9, 1 + k)});
  return rows;
}

}  // namespace

TEST_CASE("relative damping: the tangent is exact") {
  const int dimension = GENERATE(2, 3);
  for (const bool with_f : {true, false}) {
    const Damped all = damped(dimension, with_f);
    Random random(33);
    CHECK(testing::tangent_error(*all.term, State(random, all.size)) < 1e-8);
  }
}

TEST_CASE("relative damping: it takes power, but none of a rigid motion, and has no resultant") {
  const int dimension = GENERATE(2, 3), frame = dimension == 3 ? 6 : 3;
  const Damped all = damped(dimension);
  Random random(34);
  State s(random, all.size);
  s.q.segment(dimension, frame - dimension).setZero();  // axes at their bases
  s.q.tail(frame - dimension).setZero();
  const VectorXd r = testing::rows_of(*all.term, s);
  CHECK(r.dot(s.v) > 0);
  const Vector3d spin = dimension == 3 ? Vector3d(random.vector(3)) : Vector3d(0, 0, 0.8);
  Vector3d R = Vector3d::Zero(), R_f = R;
  R.head(dimension) = s.q.head(dimension), R_f.head(dimension) = s.q.segment(frame + k, dimension);
  const auto rotation = [&](const MovingAxes& axes) -> VectorXd {
    if (dimension == 2) return spin.tail<1>();
    return axes.attitude->axes(Vector3d::Zero()).transpose() * spin;
  };
  const Vector3d at(0.2, -0.7, dimension == 3 ? 0.4 : 0);
  s.v.head(dimension) = (at + spin.cross(R)).head(dimension);
  s.v.segment(dimension, frame - dimension) = rotation(all.body);
  s.v.segment(frame, k).setZero();
  s.v.segment(frame + k, dimension) = (at + spin.cross(R_f)).head(dimension);
  s.v.tail(frame - dimension) = rotation(all.f);
  CHECK(r.dot(s.v) == Approx(0).margin(1e-12));  // no resultant
  CHECK(testing::rows_of(*all.term, s).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("relative damping: conditions of accompanying axes have exact tangents and rates") {
  const int dimension = GENERATE(2, 3), frame = dimension == 3 ? 6 : 3;
  Random random(35);
  MovingAxes axes{k, k + dimension}, f{k + frame, k + frame + dimension};
  if (dimension == 3)
    axes.attitude = testing::attitude(random), f.attitude = testing::attitude(random);
  else
    axes.origin = {0.3, -0.2, 0}, f.angle = 0.4;
  const int size = k + 2 * frame + 3;
  AccompanyingAxes term(axes, {0, 1}, f, size - 3, some_rows(random));
  State s(random, size);
  CHECK(testing::tangent_error(term, s, 3) < 1e-8);
  term.begin_at(s.q);
  CHECK(testing::rows_of(term, s).tail(3).cwiseAbs().maxCoeff() < 1e-14);

  std::vector<Eigen::Index> frames;
  if (dimension == 3) frames = {k, k + frame};
  const testing::SpatialMotion motion(random, size, frames);
  const auto rows = [&](ConstraintLevel level) {
    return [&, level](double t) -> VectorXd { return testing::rows_of(term, motion.state(t), level).tail(3); };
  };
  const double t = 0.3, h = 1e-3;
  CHECK(testing::relative_error(rows(ConstraintLevel::velocity)(t),
                                testing::derivative(rows(ConstraintLevel::position), t, h)) < 1e-8);
  CHECK(testing::relative_error(rows(ConstraintLevel::acceleration)(t),
                                testing::derivative(rows(ConstraintLevel::velocity), t, h)) < 1e-8);
}
