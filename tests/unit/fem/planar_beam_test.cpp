#include "floe/fem/planar_beam.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "differences.h"
#include "random.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;
using fem::MembraneStrain;
using testing::Random;

namespace {

const Vector2d from(0.3, -0.2), to(1.1, 0.4);  // length 1, direction (0.8, 0.6)
const fem::BeamSection section{50, 0.7, 3, 0.2};

fem::ElementMaps oblique(MembraneStrain strain, double EI = section.EI) {
  return fem::planar_beam(from, to, {section.EA, EI, section.rhoA, section.rhoI}, strain);
}

fem::ElementMaps along_x(double l, const fem::BeamSection& s) {
  return fem::planar_beam({0, 0}, {l, 0}, s, MembraneStrain::averaged);
}

VectorXd force(const body::Elasticity& e, const VectorXd& q) {
  VectorXd f = VectorXd::Zero(q.size());
  body::ElasticityWork work;
  body::add_force(e, q, work, f);
  return f;
}

MatrixXd tangent(const body::Elasticity& e, const VectorXd& q) {
  MatrixXd K = MatrixXd::Zero(q.size(), q.size());
  body::ElasticityWork work;
  body::add_tangent(e, q, 1, work, K);
  return K;
}

/// Nodal values of the rigid motions: (1, 0, 0), (0, 1, 0), (-y, x, 1).
MatrixXd rigid_motions() {
  MatrixXd motions(6, 3);
  motions << 1, 0, -from.y(), 0, 1, from.x(), 0, 0, 1, 1, 0, -to.y(), 0, 1, to.x(), 0, 0, 1;
  return motions;
}

/// u' and v' of the element's own axes at s in (0, 1), written out from the cubic Hermite polynomials.
std::array<double, 2> slopes(const VectorXd& q, double s) {
  const Vector2d e(0.8, 0.6), n(-0.6, 0.8);
  const Vector2d a = q.segment<2>(0), b = q.segment<2>(3);
  const double l = 1, v1 = n.dot(a), v2 = n.dot(b), r1 = q[2], r2 = q[5];
  return {e.dot(b - a) / l,
          (v2 - v1) * (6 * s - 6 * s * s) / l + r1 * (1 - 4 * s + 3 * s * s) + r2 * (3 * s * s - 2 * s)};
}

/// Membrane energy by Simpson's rule in many intervals.
double membrane_energy(const VectorXd& q, MembraneStrain strain) {
  const int n = 2000;
  double mean = 0, square = 0;
  for (int i = 0; i <= n; ++i) {
    const auto [u, v] = slopes(q, double(i) / n);
    const double weight = (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) / (3.0 * n), eps = u + v * v / 2;
    mean += weight * eps, square += weight * eps * eps;
  }
  return 0.5 * section.EA * (strain == MembraneStrain::averaged ? mean * mean : square);
}

}  // namespace

TEST_CASE("membrane energy is 1/2 EA int eps^2 of u' + v'^2/2, averaged or pointwise") {
  const MembraneStrain strain = GENERATE(MembraneStrain::averaged, MembraneStrain::pointwise);
  const body::Elasticity e = fem::elasticity(oblique(strain, 0), MatrixXd::Identity(6, 6));
  Random random(21);
  for (int i = 0; i < 3; ++i) {
    const VectorXd q = random.vector(6);
    CHECK(body::energy(e, q) == Approx(membrane_energy(q, strain)).epsilon(1e-9));
  }
}

TEST_CASE("element force is the gradient of its energy, its tangent that of the force") {
  const MembraneStrain strain = GENERATE(MembraneStrain::averaged, MembraneStrain::pointwise);
  const body::Elasticity e = fem::elasticity(oblique(strain), MatrixXd::Identity(6, 6));
  const VectorXd q = Random(22).vector(6), d = Random(23).vector(6);
  const auto energy = [&](const VectorXd& x) { return body::energy(e, x); };
  CHECK(testing::relative_error(force(e, q), testing::gradient(energy, q, 0.1)) < 1e-12);
  CHECK(testing::relative_error(tangent(e, q),
                                testing::jacobian([&](const VectorXd& x) { return force(e, x); }, q, 0.1)) < 1e-12);
  const auto error = [&](double h) {
    return ((force(e, q + h * d) - force(e, q - h * d)) / (2 * h) - tangent(e, q) * d).norm();
  };
  CHECK(std::log2(error(0.02) / error(0.01)) == Approx(2).margin(1e-4));
}

TEST_CASE("rigid motions bring no linear strain and no linear force") {
  const MembraneStrain strain = GENERATE(MembraneStrain::averaged, MembraneStrain::pointwise);
  const fem::ElementMaps maps = oblique(strain);
  const MatrixXd rigid = rigid_motions();
  for (const auto& g : maps.membrane) CHECK((g.L * rigid).norm() < 1e-15);
  CHECK((maps.stiffness() * rigid).norm() < 1e-13 * maps.stiffness().norm());
  for (const auto& g : maps.membrane) CHECK((g.G * rigid.leftCols(2)).norm() < 1e-14);  // translations: no slope
  const body::Elasticity e = fem::elasticity(maps, MatrixXd::Identity(6, 6));
  CHECK(force(e, rigid.col(0) - 2 * rigid.col(1)).norm() < 1e-12);
  CHECK(Eigen::FullPivLU<MatrixXd>(maps.stiffness()).rank() == 3);
}

TEST_CASE("linear stiffness and consistent mass are the textbook's") {
  // Przemieniecki, Theory of matrix structural analysis, sections 5.6 and 11.5; rotary inertia rhoI/(30 l) [...]
  const double l = 1.7, EA = section.EA, EI = section.EI;
  const fem::ElementMaps maps = along_x(l, section);
  MatrixXd K = MatrixXd::Zero(6, 6), M = MatrixXd::Zero(6, 6), R(4, 4), B(4, 4), T(4, 4);
  B << 12, 6 * l, -12, 6 * l, 6 * l, 4 * l * l, -6 * l, 2 * l * l, -12, -6 * l, 12, -6 * l, 6 * l, 2 * l * l, -6 * l,
      4 * l * l;
  T << 156, 22 * l, 54, -13 * l, 22 * l, 4 * l * l, 13 * l, -3 * l * l, 54, 13 * l, 156, -22 * l, -13 * l, -3 * l * l,
      -22 * l, 4 * l * l;
  R << 36, 3 * l, -36, 3 * l, 3 * l, 4 * l * l, -3 * l, -l * l, -36, -3 * l, 36, -3 * l, 3 * l, -l * l, -3 * l,
      4 * l * l;
  const std::vector<int> axial{0, 3}, bending{1, 2, 4, 5};
  K(axial, axial) = EA / l * (Eigen::Matrix2d() << 1, -1, -1, 1).finished();
  K(bending, bending) = EI / (l * l * l) * B;
  M(axial, axial) = section.rhoA * l / 6 * (Eigen::Matrix2d() << 2, 1, 1, 2).finished();
  M(bending, bending) = section.rhoA * l / 420 * T + section.rhoI / (30 * l) * R;
  CHECK(testing::relative_error(maps.stiffness(), K) < 1e-14);
  CHECK(testing::relative_error(maps.mass_matrix(), M) < 1e-14);
}

TEST_CASE("under spin the sections of a planar element have no centrifugal force of their own") {
  fem::BeamSection slender = section;
  slender.rhoI = 0;
  const MatrixXd one = MatrixXd::Identity(6, 6);
  const auto of = [&](const fem::BeamSection& s) {
    return body::planar(fem::inertia(fem::planar_beam(from, to, s, MembraneStrain::averaged), one));
  };
  CHECK(testing::relative_error(of(section).D, of(slender).M) < 1e-13);
  CHECK(testing::relative_error(of(slender).D, of(slender).M) == 0);
}

TEST_CASE("element mass sums to rho V and the inertia of a rigid bar with its section's") {
  const fem::ElementMaps maps = oblique(MembraneStrain::averaged);
  const MatrixXd rigid = rigid_motions(), M = rigid.transpose() * maps.mass_matrix() * rigid;
  const Vector2d centre = (from + to) / 2;
  CHECK(M(0, 0) == Approx(section.rhoA).epsilon(1e-13));
  CHECK(M(1, 1) == Approx(section.rhoA).epsilon(1e-13));
  CHECK(std::abs(M(0, 1)) < 1e-13);
  CHECK(M(0, 2) == Approx(-section.rhoA * centre.y()).epsilon(1e-12));
  CHECK(M(2, 2) == Approx(section.rhoA * (1. / 12 + centre.squaredNorm()) + section.rhoI).epsilon(1e-13));

  const body::PlanarInertia in = body::planar(fem::inertia(maps, MatrixXd::Identity(6, 6)));
  CHECK(in.m == Approx(section.rhoA).epsilon(1e-13));
  CHECK(testing::relative_error(in.s0, section.rhoA * centre) < 1e-13);
  CHECK(in.C0 == Approx(M(2, 2)).epsilon(1e-13));
  CHECK(testing::relative_error(in.M, maps.mass_matrix()) < 1e-13);
  // the same rotation seen as an elastic displacement: S, h, g are its momenta
  CHECK(testing::relative_error(in.S * rigid.col(2), section.rhoA * Vector2d(-centre.y(), centre.x())) < 1e-13);
  CHECK(in.g.dot(rigid.col(2)) == Approx(M(2, 2)).epsilon(1e-13));
  CHECK(std::abs(in.h.dot(rigid.col(2))) < 1e-13);

  const fem::ElementMaps thin = fem::planar_beam(from, to, {50, 0.7, 3, 0}, MembraneStrain::averaged);
  CHECK(rigid.col(2).dot(thin.mass_matrix() * rigid.col(2)) == Approx(M(2, 2) - section.rhoI).epsilon(1e-13));
}

TEST_CASE("the line of an element has its length and its centre") {
  body::Inertia line(2, 6);
  for (const auto& point : fem::planar_beam_line(from, to)) line.add(point);
  CHECK(line.m == Approx(1).epsilon(1e-14));
  CHECK(testing::relative_error(line.s0, (from + to) / 2) < 1e-14);
  // unit load across: half to each node, moments l^2/12
  const VectorXd across = line.S.transpose() * Vector2d(-0.6, 0.8);
  CHECK(testing::relative_error(across, (VectorXd(6) << -0.3, 0.4, 1. / 12, -0.3, 0.4, -1. / 12).finished()) < 1e-13);
}

TEST_CASE("an element with shear: Timoshenko's cantilever, no strain and the same inertia in rigid motions") {
  const double l = 1.3, EI = 0.7, GA = 2;
  const fem::BeamSection shears{50, EI, 3, 0.2, GA}, stays{50, EI, 3, 0.2};
  const fem::ElementMaps beam = along_x(l, shears), normal = along_x(l, stays);
  const Eigen::Matrix3d tip = beam.stiffness().bottomRightCorner<3, 3>().inverse();
  CHECK(tip(1, 1) == Approx(l * l * l / (3 * EI) + l / GA).epsilon(1e-13));
  CHECK(tip(2, 1) == Approx(l * l / (2 * EI)).epsilon(1e-13));
  CHECK(tip(2, 2) == Approx(l / EI).epsilon(1e-13));
  MatrixXd rigid(6, 3);
  rigid << 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 0, 1, l, 0, 0, 1;
  CHECK((beam.stiffness() * rigid).norm() < 1e-13 * beam.stiffness().norm());
  const MatrixXd M = rigid.transpose() * beam.mass_matrix() * rigid;
  CHECK(testing::relative_error(M, rigid.transpose() * normal.mass_matrix() * rigid) < 1e-13);
  const body::Elasticity e = fem::elasticity(beam, MatrixXd::Identity(6, 6));
  const VectorXd a = Random(26).vector(6), b = Random(27).vector(6);
  const auto K_a = [&](double eta) { return VectorXd(tangent(e, eta * b) * a); };
  CHECK(testing::relative_error(fem::stiffness_derivative(beam, a, b), testing::derivative(K_a, 0, 0.1)) < 1e-12);
}

TEST_CASE("a short element that is soft in shear keeps all digits of its stiffness") {
  const double l = 1e-4, GA = 1e-3;  // a trillion times softer than it bends
  const fem::ElementMaps beam = along_x(l, {50, 1, 3, 0.2, GA});
  CHECK(beam.stiffness()(1, 1) == Approx(GA / l / (1 + GA * l * l / 12)).epsilon(1e-14));
}

TEST_CASE("stiffness derivative is that of the tangent, and symmetric in its two fields") {
  const MembraneStrain strain = GENERATE(MembraneStrain::averaged, MembraneStrain::pointwise);
  const fem::ElementMaps maps = oblique(strain);
  const body::Elasticity e = fem::elasticity(maps, MatrixXd::Identity(6, 6));
  const VectorXd a = Random(24).vector(6), b = Random(25).vector(6);
  const auto K_a = [&](double eta) { return VectorXd(tangent(e, eta * b) * a); };
  CHECK(testing::relative_error(fem::stiffness_derivative(maps, a, b), testing::derivative(K_a, 0, 0.1)) < 1e-12);
  CHECK(testing::relative_error(fem::stiffness_derivative(maps, a, b), fem::stiffness_derivative(maps, b, a)) < 1e-13);
}

TEST_CASE("the element's energy on few columns is that of their sum, without pairs that have no slope") {
  const MembraneStrain strain = GENERATE(MembraneStrain::averaged, MembraneStrain::pointwise);
  const fem::ElementMaps maps = fem::planar_beam({0, 0}, {2, 0}, section, strain);
  MatrixXd V = Random(26).matrix(6, 3);
  V.col(1) << 0.2, 0, 0, 0.7, 0, 0;  // axial alone
  const body::Elasticity whole = fem::elasticity(maps, MatrixXd::Identity(6, 6)), few = fem::elasticity(maps, V);
  CHECK(few.pairs == std::vector<std::pair<int, int>>{{0, 0}, {0, 2}, {2, 2}});
  const VectorXd eta = Random(27).vector(3);
  CHECK(body::energy(few, eta) == Approx(body::energy(whole, V * eta)).epsilon(1e-13));
  CHECK(testing::relative_error(force(few, eta), V.transpose() * force(whole, V * eta)) < 1e-12);
  CHECK(testing::relative_error(tangent(few, eta), V.transpose() * tangent(whole, V * eta) * V) < 1e-12);
}
