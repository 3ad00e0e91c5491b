#include <catch2/catch.hpp>
#include <cmath>

#include "floe/fem/spatial_beam.h"
#include "spatial_beam_chain.h"

using namespace floe;
using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::VectorXd;
using testing::beam_chain;
using testing::BeamChain;
using testing::clamped_root;
using testing::linear_deflection;
using testing::nonlinear_deflection;
using testing::tip_load;
using Vector6 = Eigen::Matrix<double, 6, 1>;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double L = 1.6;

Vector6 load(double fx, double fy, double fz, double mx = 0, double my = 0, double mz = 0) {
  return (Vector6() << fx, fy, fz, mx, my, mz).finished();
}

Vector6 tip(const VectorXd& q) { return q.tail<6>(); }

}  // namespace

TEST_CASE("cantilever of one element: Gere's tip deflections, turns by the right hand") {
  // Gere & Timoshenko, Mechanics of materials, appendix G: F L^3/3EI with F L^2/2EI, M L^2/2EI with M L/EI, T L/GJ, N
  // L/EA
  const fem::SpatialBeamSection s{50, 0.9, 0.7, 0, 0.4, 0, 0, 0, 0};
  const Matrix3d Q = GENERATE(Matrix3d(Matrix3d::Identity()), testing::some_rotation());
  const BeamChain beam = beam_chain(1, L, s, clamped_root, {}, Q);
  const auto answer = [&](const Vector6& f) { return tip(linear_deflection(beam, tip_load(beam, f))); };
  const double c = L * L * L / 3, d = L * L / 2;
  CHECK((answer(load(1, 0, 0)) - load(L / 50, 0, 0)).norm() < 1e-12);
  CHECK((answer(load(0, 1, 0)) - load(0, c / 0.7, 0, 0, 0, d / 0.7)).norm() < 1e-12);
  CHECK((answer(load(0, 0, 1)) - load(0, 0, c / 0.9, 0, -d / 0.9, 0)).norm() < 1e-12);
  CHECK((answer(load(0, 0, 0, 1, 0, 0)) - load(0, 0, 0, L / 0.4)).norm() < 1e-12);
  CHECK((answer(load(0, 0, 0, 0, 1, 0)) - load(0, 0, -d / 0.9, 0, L / 0.9, 0)).norm() < 1e-12);
  CHECK((answer(load(0, 0, 0, 0, 0, 1)) - load(0, d / 0.7, 0, 0, 0, L / 0.7)).norm() < 1e-12);
}

TEST_CASE("cantilever with shear: Timoshenko's tip deflections, whatever the number of elements") {
  // Timoshenko, Strength of materials I, art. 39: v = F L^3/3EI + F L/GA; the section rotates by F L^2/2EI as without
  // shear. In general axes E [Iz Iyz; Iyz Iy] takes the place of EI, [GAy 0; 0 GAz] that of GA.
  fem::SpatialBeamSection s{50, 0.9, 0.7, 0.3, 0.4, 0, 0, 0, 0};
  s.GA << 2, 0.5;
  const int n = GENERATE(1, 2, 5);
  const BeamChain beam = beam_chain(n, L, s, clamped_root, {}, testing::some_rotation());
  const Matrix2d soft = (Matrix2d() << 0.7, 0.3, 0.3, 0.9).finished().inverse();
  for (const Vector2d& F : {Vector2d(1, 0), Vector2d(0, 1)}) {
    const Vector6 q = tip(linear_deflection(beam, tip_load(beam, load(0, F[0], F[1]))));
    const Vector2d deflection = L * L * L / 3 * soft * F + L * F.cwiseQuotient(s.GA), rotation = L * L / 2 * soft * F;
    CHECK((q - load(0, deflection[0], deflection[1], 0, -rotation[1], rotation[0])).norm() < 1e-12);
  }
}

TEST_CASE("a uniform load on a cantilever with shear: q L^4/8EI + q L^2/2GA, whatever the number of elements") {
  fem::SpatialBeamSection s{50, 0.9, 0.7, 0, 0.4, 0, 0, 0, 0};
  s.GA << 2, 0.5;
  const int n = GENERATE(1, 3);
  const BeamChain beam = beam_chain(n, L, s, clamped_root);
  VectorXd f = VectorXd::Zero(beam.dofs());
  for (int e = 0; e < n; ++e)
    for (const body::MassPoint& point : fem::spatial_beam_line(beam.places[e], s))
      f.segment<12>(6 * e) += point.mass * point.N.transpose() * Eigen::Vector3d(0, 1, 1);
  const Vector6 q = tip(linear_deflection(beam, f));
  CHECK(q[1] == Approx(std::pow(L, 4) / 8 / 0.7 + L * L / 2 / 2).epsilon(1e-12));
  CHECK(q[2] == Approx(std::pow(L, 4) / 8 / 0.9 + L * L / 2 / 0.5).epsilon(1e-12));
}

TEST_CASE("unsymmetrical bending of a Z section: a load down moves the tip sideways") {
  // Z of walls t, flanges b to either side, height 2a (middle lines): the flange at z = +a points to y > 0.
  // Timoshenko, Strength of materials I, unsymmetrical bending: E [Iz Iyz; Iyz Iy] (v, w)'' = moments of (F_y, F_z)
  const double a = 0.1, b = 0.08, t = 0.005, E = 200e9;
  fem::SectionShape z;
  z.A = t * (2 * a + 2 * b);
  z.Iy = t * (2 * a * a * a / 3 + 2 * b * a * a);
  z.Iz = t * 2 * b * b * b / 3;
  z.Iyz = t * b * b * a;
  z.J = t * t * t * (2 * a + 2 * b) / 3;
  CHECK(z.Iyz > 0);
  const BeamChain beam = beam_chain(3, L, fem::spatial_section(z, {E, 80e9, 0}), clamped_root);
  const Matrix2d I = (Matrix2d() << z.Iz, z.Iyz, z.Iyz, z.Iy).finished();
  const Vector2d F(0, -1000), expected = L * L * L / (3 * E) * I.inverse() * F;
  const Vector6 q = tip(linear_deflection(beam, tip_load(beam, load(0, F[0], F[1]))));
  CHECK((q.segment<2>(1) - expected).norm() < 1e-10 * expected.norm());
  CHECK(q[1] > 0.5 * std::abs(q[2]));  // sideways: b^3 2/3 against a b^2, v/w = -Iyz/Iz
  CHECK(q[1] / q[2] == Approx(-z.Iyz / z.Iz).epsilon(1e-10));
  CHECK(std::abs(q[3]) < 1e-14);
}

TEST_CASE("principal axes given by an angle are the orientation vector turned by it") {
  const double angle = 0.4;
  const fem::SectionShape strip = fem::rectangle(0.03, 0.01);
  const fem::BeamMaterial steel{200e9, 80e9, 7800};
  const fem::BeamPlace straight{{0, 0, 0}, {L, 0, 0}, {0, 1, 0}};
  const fem::BeamPlace rolled{{0, 0, 0}, {L, 0, 0}, {0, std::cos(angle), std::sin(angle)}};
  const fem::ElementMaps a = fem::spatial_beam(straight, fem::spatial_section(fem::rotated(strip, angle), steel));
  const fem::ElementMaps b = fem::spatial_beam(rolled, fem::spatial_section(strip, steel));
  CHECK((a.stiffness() - b.stiffness()).norm() < 1e-13 * b.stiffness().norm());
  CHECK((a.mass_matrix() - b.mass_matrix()).norm() < 1e-13 * b.mass_matrix().norm());
}

TEST_CASE("a force beside the shear centre twists by its arm, one through it does not") {
  // Timoshenko & Gere, Theory of elastic stability, 2nd ed., art. 5.2: shear and torsion act at the shear centre
  fem::SpatialBeamSection s{50, 0.9, 0.7, 0, 0.4, 0, 0, 0, 0};
  s.centroid << 0.05, 0.02;
  s.shear_centre << -0.3, 0.1;
  const BeamChain beam = beam_chain(4, L, s, clamped_root);
  // at the node, y = z = 0: moment about x of a force F_z is (0 - y_S) F_z, of F_y it is -(0 - z_S) F_y
  const Vector6 q = tip(linear_deflection(beam, tip_load(beam, load(0, 0, 1))));
  CHECK(q[3] == Approx(0.3 * L / 0.4).epsilon(1e-11));
  CHECK(q[2] == Approx(L * L * L / (3 * 0.9) + 0.3 * 0.3 * L / 0.4).epsilon(1e-11));
  const Vector6 r = tip(linear_deflection(beam, tip_load(beam, load(0, 1, 0))));
  CHECK(r[3] == Approx(0.1 * L / 0.4).epsilon(1e-11));
  const Vector6 through = fem::rigid_arm(Eigen::Vector3d(0, -0.3, 0.1)).transpose() * load(0, 2, 1);
  CHECK(std::abs(tip(linear_deflection(beam, tip_load(beam, through)))[3]) < 1e-12);
}

TEST_CASE("eccentric axial load: moment N e, and the secant formula of the column") {
  // Timoshenko & Gere, Theory of elastic stability, 2nd ed., art. 1.12: delta = e (sec kL - 1), k^2 = P/EI
  const double EIy = 2, EIz = 0.7, ey = 0.02, ez = -0.03;
  fem::SpatialBeamSection s{1e7, EIy, EIz, 0, 0.4, 0, 0, 0, 0};
  s.centroid << -ey, -ez;  // the nodes, where the load acts, stand at (ey, ez) from the centroids
  s.shear_centre = s.centroid;
  const double P = 0.5 * pi * pi * EIz / (4 * L * L);
  const BeamChain beam = beam_chain(8, L, s, clamped_root);
  const VectorXd f = tip_load(beam, load(-P, 0, 0));
  const Vector6 linear = tip(linear_deflection(beam, f));
  CHECK(linear[1] == Approx(P * ey * L * L / (2 * EIz)).epsilon(1e-9));
  CHECK(linear[2] == Approx(P * ez * L * L / (2 * EIy)).epsilon(1e-9));
  CHECK(linear[0] == Approx(-P * L / 1e7 - P * L * (ey * ey / EIz + ez * ez / EIy)).epsilon(1e-9));

  const auto secant = [&](double EI, double e) { return e * (1 / std::cos(std::sqrt(P / EI) * L) - 1); };
  const auto error = [&](int n) {
    const BeamChain chain = beam_chain(n, L, s, clamped_root);
    const Vector6 q = tip(nonlinear_deflection(chain, tip_load(chain, load(-P, 0, 0))));
    return (q.segment<2>(1) - Vector2d(secant(EIz, ey), secant(EIy, ez))).norm();
  };
  const double coarse = error(4), fine = error(8);
  CHECK(fine < 3e-6 * secant(EIz, ey));
  CHECK(std::log2(coarse / fine) == Approx(4).margin(0.1));
}

TEST_CASE("tension stiffens torsion with the Wagner term: T L / (GJ + N Ip/A)") {
  // Hodges & Dowell, NASA TN D-7818, 1974: torsional stiffness GJ + T k_A^2
  const fem::SpatialBeamSection s{50, 0.9, 0.7, 0, 0.4, 0, 0, 0, 0};
  const double N = 4, T = 0.3, radius = (0.9 + 0.7) / 50;
  const BeamChain with = beam_chain(3, L, s, clamped_root, {fem::MembraneStrain::averaged, true});
  const Vector6 q = tip(nonlinear_deflection(with, tip_load(with, load(N, 0, 0, T))));
  const double rate = T / (0.4 + N * radius);
  CHECK(q[3] == Approx(rate * L).epsilon(1e-12));
  CHECK(q[0] == Approx(L * (N / 50 - radius * rate * rate / 2)).epsilon(1e-12));
  const BeamChain without = beam_chain(3, L, s, clamped_root);
  CHECK(tip(nonlinear_deflection(without, tip_load(without, load(N, 0, 0, T))))[3] ==
        Approx(T * L / 0.4).epsilon(1e-12));
}

TEST_CASE(
    "hinged beam between fixed ends: Woinowsky-Krieger's cubic stiffness, in any direction and at any slenderness") {
  // S. Woinowsky-Krieger, J. Appl. Mech. 17 (1950) 35-36: q sin(pi x/L) bends to a sin(pi x/L),
  // q = EI (pi/L)^4 a (1 + a^2 / (4 r^2)), r^2 = I/A; exact in von Karman's theory
  const double slender = GENERATE(1e2, 1e5);
  const double r = L / slender, a = 2 * r, EI = 1, EA = EI / (r * r);
  const double q0 = EI * std::pow(pi / L, 4) * a * (1 + a * a / (4 * r * r));
  const Eigen::Vector3d direction(0, 0.6, 0.8);
  const auto middle = [&](int n) {
    const fem::SpatialBeamSection s{EA, EI, EI, 0, 1, 0, 0, 0, 0};
    const BeamChain beam = beam_chain(n, L, s, {0, 1, 2, 3, 6 * n, 6 * n + 1, 6 * n + 2});
    VectorXd f = VectorXd::Zero(beam.dofs());
    for (int e = 0; e < n; ++e)
      for (const auto& point : fem::spatial_beam_line(beam.places[e], s))
        f.segment<12>(6 * e) += point.mass * q0 * std::sin(pi * point.x[0] / L) * point.N.transpose() * direction;
    const VectorXd start = linear_deflection(beam, f) / 2;  // the answer is half the linear one
    return Eigen::Vector3d(nonlinear_deflection(beam, f, start).segment<3>(6 * (n / 2)));
  };
  const double coarse = (middle(4) - a * direction).norm() / a, fine = (middle(8) - a * direction).norm() / a;
  CHECK(fine < 1e-4);
  CHECK(std::log2(coarse / fine) == Approx(4).margin(0.15));
}
