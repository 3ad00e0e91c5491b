#include "floe/reference/corotational_element.h"

#include <catch2/catch.hpp>

#include "floe/fem/quadratic_beam.h"
#include "floe/fem/quadratic_shell.h"
#include "floe/fem/spatial_beam.h"
#include "floe/math/rotation.h"
#include "spatial_terms.h"

using namespace floe;
using dynamics::SpatialMarker;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using reference::CorotationalElement;
using testing::Random;
using testing::State;

namespace {

/// An element, its body rotated somehow at rest.
struct Sample {
  mesh::CellKind kind;
  Matrix3Xd X;
  body::Elasticity elasticity;
};

Sample beam() {
  Random random(901);
  Sample s{mesh::CellKind::line, Matrix3Xd(3, 2), {}};
  s.X.col(0) = random.vector(3), s.X.col(1) = s.X.col(0) + Vector3d(0.7, -0.4, 0.9);
  const fem::SpatialBeamSection section = fem::spatial_section(fem::rectangle(0.2, 0.3), {10, 4, 1});
  s.elasticity = fem::elasticity(fem::spatial_beam({s.X.col(0), s.X.col(1), {0.2, 1, 0.3}}, section, {}),
                                 Eigen::MatrixXd::Identity(12, 12));
  return s;
}

Sample triangle() {
  Random random(902);
  Sample s{mesh::CellKind::triangle, Matrix3Xd(3, 3), {}};
  s.X.col(0) = random.vector(3);
  s.X.col(1) = s.X.col(0) + Vector3d(1, 0.2, 0.4), s.X.col(2) = s.X.col(0) + Vector3d(0.1, 0.8, -0.3);
  s.elasticity = fem::elasticity(fem::shell_triangle({s.X.col(0), s.X.col(1), s.X.col(2)},
                                                     fem::shell_section({{fem::isotropic(10, 0.3, 1), 0.1}})),
                                 Eigen::MatrixXd::Identity(18, 18));
  return s;
}

Sample curved_beam() {
  Random random(908);
  Sample s{mesh::CellKind::line3, Matrix3Xd(3, 3), {}};
  s.X.col(0) = random.vector(3), s.X.col(1) = s.X.col(0) + Vector3d(0.7, -0.4, 0.9);
  s.X.col(2) = s.X.col(0) + Vector3d(0.3, -0.1, 0.5);
  fem::SpatialBeamStrain strain;
  strain.strains = fem::Strains::second_order;
  const fem::SpatialBeamSection section = fem::spatial_section(fem::rectangle(0.2, 0.3), {10, 4, 1});
  s.elasticity =
      fem::elasticity(fem::quadratic_beam({s.X.col(0), s.X.col(1), s.X.col(2), {0.2, 1, 0.3}}, section, strain),
                      Eigen::MatrixXd::Identity(18, 18));
  return s;
}

Sample curved_shell(mesh::CellKind kind) {
  const int n = mesh::node_count(kind), corners = n / 2;
  Random random(909);
  const Vector3d from = random.vector(3);
  const double pi = std::acos(-1.0);
  std::vector<Vector3d> X(n);
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * pi * i / corners + 0.1 * i;
    X[i] = from + Vector3d(std::cos(angle), 0.7 * std::sin(angle), 0.2 * std::cos(2 * angle));
  }
  for (int i = 0; i < corners; ++i) X[corners + i] = (X[i] + X[(i + 1) % corners]) / 2 + 0.05 * Vector3d(i, 1, 2 - i);
  Sample s{kind, Matrix3Xd(3, n), {}};
  for (int i = 0; i < n; ++i) s.X.col(i) = X[i];
  fem::ShellSection section = fem::shell_section({{fem::isotropic(10, 0.3, 1), 0.1}});
  section.strains = fem::Strains::second_order;
  s.elasticity = fem::elasticity(fem::quadratic_shell(X, section), Eigen::MatrixXd::Identity(6 * n, 6 * n));
  return s;
}
Sample six_nodes() { return curved_shell(mesh::CellKind::triangle6); }
Sample eight_nodes() { return curved_shell(mesh::CellKind::quadrilateral8); }

/// Places each on a frame of its own at the start Q; the last one on an arm; with `shared` the first two on one frame.
std::vector<SpatialMarker> places(const Sample& sample, bool shared, const std::vector<Eigen::Quaterniond>& bases) {
  std::vector<SpatialMarker> all;
  for (Eigen::Index i = 0; i < sample.X.cols(); ++i) {
    const bool second = shared && i == 1;
    SpatialMarker at;
    at.attitude = std::make_shared<dynamics::Attitude>(dynamics::Attitude{bases[second ? 0 : i]});
    if (second) at.attitude = all[0].attitude;
    for (int d = 0; d < 6; ++d) at.coordinates.push_back(6 * (second ? 0 : static_cast<int>(i)) + d);
    if (i + 1 == sample.X.cols()) at.x0 = Vector3d(0.1, -0.2, 0.15);
    if (second) at.x0 = sample.X.col(1) - sample.X.col(0);
    all.push_back(at);
  }
  return all;
}

/// A state near a rigid motion: nodes off it by `size`.
struct Near {
  std::vector<Eigen::Quaterniond> bases;
  VectorXd q;
  Near(Random& random, const Sample& sample, double size) {
    const Eigen::Quaterniond Q = math::quaternion(2 * random.vector(3));
    const Vector3d c = 3 * random.vector(3);
    q.resize(6 * sample.X.cols());
    for (Eigen::Index i = 0; i < sample.X.cols(); ++i) {
      bases.push_back(Q * math::quaternion(size * random.vector(3)));
      const Vector3d x =
          i + 1 == sample.X.cols() ? Vector3d(sample.X.col(i) - Vector3d(0.1, -0.2, 0.15)) : Vector3d(sample.X.col(i));
      q.segment<3>(6 * i) = c + Q * x + size * random.vector(3);
      q.segment<3>(6 * i + 3) = size * random.vector(3);
    }
  }
};

State state_of(Random& random, const Near& near, Eigen::Index size) {
  State s(random, size);
  if (near.q.size() == size) s.q = near.q;
  return s;
}

const auto samples = {beam, triangle, curved_beam, six_nodes, eight_nodes};

}  // namespace

TEST_CASE("corotational element in space: the tangent is the difference of the residual, damped or not",
          "[corotational-space]") {
  const auto sample = GENERATE(from_range(samples))();
  const double beta = GENERATE(0.0, 0.3);
  Random random(903);
  for (int i = 0; i < 3; ++i) {
    const Near near(random, sample, 0.1);
    const CorotationalElement element(sample.kind, places(sample, false, near.bases), sample.X, sample.elasticity,
                                      beta);
    CHECK(testing::tangent_error(element, state_of(random, near, 6 * sample.X.cols())) < 1e-8);
  }
}

TEST_CASE("corotational element in space: two places on one frame", "[corotational-space]") {
  const Sample sample = triangle();
  Random random(904);
  const Near near(random, sample, 0.1);
  const CorotationalElement element(sample.kind, places(sample, true, near.bases), sample.X, sample.elasticity, 0.2);
  State s(random, 12);
  s.q << near.q.head<6>(), near.q.tail<6>();
  CHECK(testing::tangent_error(element, s) < 1e-8);
}

TEST_CASE("corotational element in space: its forces are the gradient of its energy and dissipate",
          "[corotational-space]") {
  const auto sample = GENERATE(from_range(samples))();
  Random random(905);
  const Near near(random, sample, 0.1);
  const auto at = places(sample, false, near.bases);
  const CorotationalElement elastic(sample.kind, at, sample.X, sample.elasticity),
      damped(sample.kind, at, sample.X, sample.elasticity, 0.4);
  const State s = state_of(random, near, 6 * sample.X.cols());
  const auto energy = [&](double t) {
    VectorXd q = s.q + t * s.v;
    for (Eigen::Index i = 0; i < sample.X.cols(); ++i) {
      const Vector3d x = s.q.segment<3>(6 * i + 3);
      q.segment<3>(6 * i + 3) = x + t * math::rotation_tangent(x).lu().solve(Vector3d(s.v.segment<3>(6 * i + 3)));
    }
    return elastic.energy({0, q, s.v, s.a}).elastic;
  };
  const VectorXd f = testing::rows_of(elastic, s);
  CHECK(f.dot(s.v) == Approx(testing::derivative(energy, 0, 1e-3)).margin(1e-10 * f.norm() * s.v.norm()));
  CHECK((testing::rows_of(damped, s) - f).dot(s.v) > 0);
}

TEST_CASE("corotational element in space: rigid motions cost nothing, and the forces turn with the element",
          "[corotational-space]") {
  const auto sample = GENERATE(from_range(samples))();
  Random random(906);
  const Near rigid(random, sample, 0);
  const CorotationalElement still(sample.kind, places(sample, false, rigid.bases), sample.X, sample.elasticity, 0.4);
  State s = state_of(random, rigid, 6 * sample.X.cols());
  const Vector3d w = random.vector(3), v = random.vector(3);
  for (Eigen::Index i = 0; i < sample.X.cols(); ++i) {
    s.v.segment<3>(6 * i) = v + w.cross(Vector3d(s.q.segment<3>(6 * i)));
    s.v.segment<3>(6 * i + 3) = rigid.bases[i].conjugate() * w;
  }
  CHECK(testing::rows_of(still, s).norm() < 1e-12);

  const Near near(random, sample, 0.1);
  const CorotationalElement bent(sample.kind, places(sample, false, near.bases), sample.X, sample.elasticity);
  State one = state_of(random, near, 6 * sample.X.cols()), other = one;
  const Eigen::Quaterniond rotation = math::quaternion({1.3, -2.1, 0.8});
  std::vector<Eigen::Quaterniond> bases;
  for (Eigen::Index i = 0; i < sample.X.cols(); ++i) {
    bases.push_back(rotation * near.bases[i]);
    other.q.segment<3>(6 * i) = rotation * Vector3d(one.q.segment<3>(6 * i)) + v;
  }
  const VectorXd loads = testing::rows_of(bent, one);
  Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
  for (Eigen::Index i = 0; i < sample.X.cols(); ++i) {  // no force from within moves the element
    const Vector3d F = loads.segment<3>(6 * i), R = one.q.segment<3>(6 * i), m = loads.segment<3>(6 * i + 3);
    force += F;
    moment += R.cross(F) + near.bases[i] * (math::quaternion(one.q.segment<3>(6 * i + 3)) * m);
  }
  CHECK(force.norm() < 1e-12 * loads.norm());
  CHECK(moment.norm() < 1e-11 * loads.norm());
  const CorotationalElement rotated(sample.kind, places(sample, false, bases), sample.X, sample.elasticity);
  const VectorXd f = testing::rows_of(bent, one), g = testing::rows_of(rotated, other);
  for (Eigen::Index i = 0; i < sample.X.cols(); ++i) {
    CHECK((g.segment<3>(6 * i) - rotation * Vector3d(f.segment<3>(6 * i))).norm() < 1e-12 * f.norm());
    CHECK((g.segment<3>(6 * i + 3) - f.segment<3>(6 * i + 3)).norm() < 1e-12 * f.norm());
  }
}

TEST_CASE("corotational element in space: the order of the places does not matter", "[corotational-space]") {
  Random random(907);
  const Sample one = triangle();
  Sample other = one;
  other.X.col(0) = one.X.col(1), other.X.col(1) = one.X.col(2), other.X.col(2) = one.X.col(0);
  other.elasticity = fem::elasticity(fem::shell_triangle({other.X.col(0), other.X.col(1), other.X.col(2)},
                                                         fem::shell_section({{fem::isotropic(10, 0.3, 1), 0.1}})),
                                     Eigen::MatrixXd::Identity(18, 18));
  Near near(random, one, 0.1);
  auto at = places(one, false, near.bases);
  const CorotationalElement a(one.kind, at, one.X, one.elasticity),
      b(one.kind, {at[1], at[2], at[0]}, other.X, other.elasticity);
  const VectorXd zero = VectorXd::Zero(18);
  VectorXd moved(18);
  moved << near.q.segment<6>(6), near.q.segment<6>(12), near.q.segment<6>(0);
  CHECK(b.energy({0, moved, zero, zero}).elastic == Approx(a.energy({0, near.q, zero, zero}).elastic).epsilon(1e-12));
}
