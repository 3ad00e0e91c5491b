#include "floe/fem/beam_releases.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "differences.h"
#include "eigenvalues.h"
#include "spatial_beam_chain.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::relative_error;

namespace {

const fem::SpatialBeamSection section{1e4, 7, 3, 0, 2, 0.5, 0, 0, 0};  // EA EIy EIz EIyz GJ rhoA
constexpr double L = 1.5;

fem::BeamPlace along_x() { return {{0, 0, 0}, {L, 0, 0}, {0, 1, 0}}; }

fem::BeamReleases released_at(std::initializer_list<std::size_t> dofs) {
  fem::BeamReleases releases;
  for (const std::size_t dof : dofs) releases.set(dof);
  return releases;
}

fem::ElementMaps with_releases(const fem::BeamPlace& place, const fem::BeamReleases& releases) {
  return fem::transformed(fem::spatial_beam(place, section), fem::released(place, section, releases));
}

}  // namespace

TEST_CASE("a beam hinged at both ends is a rod: EA/L along it, GJ/L about it, nothing else") {
  const MatrixXd K = with_releases(along_x(), released_at({4, 5, 10, 11})).stiffness();
  MatrixXd rod = MatrixXd::Zero(12, 12);
  const double k = section.EA / L, t = section.GJ / L;
  rod(0, 0) = rod(6, 6) = k, rod(0, 6) = rod(6, 0) = -k;
  rod(3, 3) = rod(9, 9) = t, rod(3, 9) = rod(9, 3) = -t;
  CHECK(relative_error(K, rod) < 1e-12);
  const MatrixXd free = with_releases(along_x(), released_at({3, 4, 5, 9, 10, 11})).stiffness();
  rod(3, 3) = rod(9, 9) = rod(3, 9) = rod(9, 3) = 0;
  CHECK(relative_error(free, rod) < 1e-12);
}

TEST_CASE("rotations at ends of rods that nothing else holds follow the rods") {
  const Eigen::Matrix3d Q = testing::some_rotation();
  const fem::BeamPlace place{Vector3d(0.2, 1, -0.4), Vector3d(0.2, 1, -0.4) + L * Q.col(0), Q.col(1)};
  const MatrixXd K = fem::rod_rotations(place, section, released_at({3, 4, 5, 9, 10, 11}), 3);
  for (int i = 0; i < 3; ++i) {
    const Vector3d e = Vector3d::Unit(i);
    VectorXd moved = VectorXd::Zero(12), turned = moved;
    moved << e, Vector3d::Zero(), e, Vector3d::Zero();
    turned << e.cross(place.from), e, e.cross(place.to), e;
    CHECK((K * moved).norm() < 1e-12 * K.norm());
    CHECK((K * turned).norm() < 1e-12 * K.norm());
  }
  const auto rank = [](const MatrixXd& matrix) {
    const Eigen::VectorXd values = testing::eigenvalues(matrix);
    return (values.array() > 1e-10 * values.maxCoeff()).count();
  };
  CHECK(rank(K) == 5);  // stretching has its own stiffness
  CHECK(rank(fem::rod_rotations(place, section, released_at({4, 5, 10, 11}), 1)) == 2);
}

TEST_CASE("a beam hinged at one end resists a deflection of the other by 3 EI / L^3") {
  const MatrixXd K = with_releases(along_x(), released_at({10, 11})).stiffness();
  CHECK(K(7, 7) == Approx(3 * section.EIz / (L * L * L)));
  CHECK(K(8, 8) == Approx(3 * section.EIy / (L * L * L)));
  CHECK(K(5, 7) == Approx(-3 * section.EIz / (L * L)));
  CHECK(K.row(10).norm() + K.row(11).norm() < 1e-10 * K.norm());
}

TEST_CASE("released ends keep rigid motions, and the axial strain is that of the chord") {
  const Eigen::Matrix3d Q = testing::some_rotation();
  const fem::BeamPlace place{Vector3d(0.2, 1, -0.4), Vector3d(0.2, 1, -0.4) + L * Q.col(0), Q.col(1)};
  const fem::BeamReleases all = released_at({3, 4, 5, 9, 10, 11});
  const fem::Matrix12 T = fem::released(place, section, all);
  for (int i = 0; i < 3; ++i) {
    const Vector3d e = Vector3d::Unit(i);
    VectorXd shift(12), rotation(12);
    shift << e, Vector3d::Zero(), e, Vector3d::Zero();
    rotation << e.cross(place.from), e, e.cross(place.to), e;
    CHECK((T * shift - shift).norm() < 1e-12);
    if (i == 0)
      CHECK((fem::released(place, section, released_at({4, 5, 10, 11})) * rotation - rotation).norm() < 1e-11);
  }
  const fem::ElementMaps rod = with_releases(place, all);
  VectorXd q = VectorXd::Random(12);
  const Vector3d du = Q.transpose() * (q.segment<3>(6) - q.head<3>()) / L;
  double energy = 0;  // of the membrane: EA L / 2 (du + (dv^2 + dw^2) / 2)^2
  for (const fem::StrainPoint& point : rod.membrane) {
    const VectorXd slope = point.G * q, strain = point.L * q + 0.5 * point.bilinear(slope, slope);
    energy += point.weight / 2 * strain.dot(point.D * strain);
  }
  const double strain = du[0] + (du[1] * du[1] + du[2] * du[2]) / 2;
  CHECK(energy == Approx(section.EA * L / 2 * strain * strain).epsilon(1e-10));
}

TEST_CASE("a rod has the mass, centre and second moments of a line, whatever its nodes rotate by") {
  const body::Inertia in =
      fem::inertia(with_releases(along_x(), released_at({3, 4, 5, 9, 10, 11})), MatrixXd::Identity(12, 12));
  const double m = section.rhoA * L;
  CHECK(in.m == Approx(m));
  CHECK(in.s0[0] == Approx(m * L / 2));
  CHECK(in.C0(0, 0) == Approx(m * L * L / 3));
  const MatrixXd M = with_releases(along_x(), released_at({3, 4, 5, 9, 10, 11})).mass_matrix();
  CHECK(M(1, 1) == Approx(m / 3));
  CHECK(M(1, 7) == Approx(m / 6));
  CHECK(M.block(3, 3, 3, 3).norm() + M.block(9, 9, 3, 3).norm() < 1e-12 * m);
}

TEST_CASE("a beam without density has the inertia constants of space, which are zero") {
  fem::SpatialBeamSection light = section;
  light.rhoA = 0;
  const body::Inertia in = fem::inertia(fem::spatial_beam(along_x(), light), MatrixXd::Identity(12, 12));
  CHECK(in.m == 0);
  CHECK(in.s0.size() == 3);
  CHECK(in.C0.rows() == 3);
}

TEST_CASE("frequencies of a clamped beam whose last element is hinged on a fixed node: beta^2 = 15.41821, 49.96486") {
  constexpr int n = 24;
  std::vector<int> constrained = testing::clamped_root;
  for (int i = 0; i < 6; ++i) constrained.push_back(6 * n + i);
  for (int node = 1; node < n; ++node)  // in the plane
    for (int dof : {0, 2, 3, 4}) constrained.push_back(6 * node + dof);
  testing::BeamChain chain = testing::beam_chain(n, L, section, constrained);
  chain.elements.back() = with_releases(chain.places.back(), released_at({11}));
  const double scale = std::sqrt(section.EIz / section.rhoA) / (L * L);
  const VectorXd omega = testing::chain_frequencies(chain);
  CHECK(omega[0] == Approx(15.41821 * scale).epsilon(2e-5));
  CHECK(omega[1] == Approx(49.96486 * scale).epsilon(1e-4));
}
