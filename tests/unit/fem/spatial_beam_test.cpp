#include "floe/fem/spatial_beam.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "differences.h"
#include "floe/body/spatial_frame.h"
#include "floe/error.h"
#include "floe/math/rotation.h"
#include "random.h"
#include "spatial_beam_chain.h"

using namespace floe;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using fem::MembraneStrain;
using testing::Random;
using testing::relative_error;

namespace {

const fem::BeamPlace oblique{{0.3, -0.2, 0.5}, {1.1, 0.4, 0.1}, {0.2, 0.9, 0.7}};

fem::SpatialBeamSection general() {
  fem::SpatialBeamSection s{50, 0.9, 0.7, 0.3, 0.4, 3, 0.25, 0.2, -0.08};
  s.centroid << 0.1, -0.2;
  s.shear_centre << -0.05, 0.15;
  return s;
}

body::Elasticity elasticity(const fem::ElementMaps& maps) { return fem::elasticity(maps, MatrixXd::Identity(12, 12)); }

/// Rigid motions of two nodes: three translations, three rotations about the origin.
MatrixXd rigid_motions(const fem::BeamPlace& p) {
  MatrixXd motions(12, 6);
  motions << fem::rigid_arm(p.from), fem::rigid_arm(p.to);
  return motions;
}

}  // namespace

TEST_CASE("a planar beam in space has the matrices of the planar element, in any attitude") {
  const MembraneStrain strain = GENERATE(MembraneStrain::averaged, MembraneStrain::pointwise);
  const bool rotated = GENERATE(false, true);
  const Matrix3d Q = rotated ? testing::some_rotation() : Matrix3d::Identity();
  const Vector2d from(0.3, -0.2), to(1.1, 0.4);
  const double GA = GENERATE(std::numeric_limits<double>::infinity(), 6.);
  const fem::ElementMaps planar = fem::planar_beam(from, to, {50, 0.7, 3, 0.2, GA}, strain);
  fem::SpatialBeamSection section{50, 0.9, 0.7, 0, 0.4, 3, 0.25, 0.2};
  section.GA << GA, 2 * GA;
  const auto lifted = [&](double x, double y) { return Vector3d(Q * Vector3d(x, y, 0)); };
  const fem::BeamPlace place{lifted(from.x(), from.y()), lifted(to.x(), to.y()), lifted(-1, 1.5)};
  const fem::ElementMaps maps =
      fem::transformed(fem::spatial_beam(place, section, {strain}), testing::rotation_dofs(Q, 2));

  const std::vector<int> in{0, 1, 5, 6, 7, 11}, out{2, 3, 4, 8, 9, 10};
  const MatrixXd K = maps.stiffness(), M = maps.mass_matrix();
  CHECK(relative_error(MatrixXd(K(in, in)), planar.stiffness()) < 1e-13);
  CHECK(relative_error(MatrixXd(M(in, in)), planar.mass_matrix()) < 1e-13);
  CHECK(MatrixXd(K(in, out)).norm() < 1e-13 * K.norm());
  CHECK(MatrixXd(M(in, out)).norm() < 1e-13 * M.norm());

  const VectorXd q = Random(31).vector(6), p = Random(32).vector(6);
  VectorXd q3 = VectorXd::Zero(12), p3 = q3;
  q3(in) = q, p3(in) = p;
  const body::Elasticity flat = fem::elasticity(planar, MatrixXd::Identity(6, 6));
  CHECK(body::energy(elasticity(maps), q3) == Approx(body::energy(flat, q)).epsilon(1e-13));
  const VectorXd d3 = fem::stiffness_derivative(maps, q3, p3);
  CHECK(relative_error(VectorXd(d3(in)), fem::stiffness_derivative(planar, q, p)) < 1e-13);
}

TEST_CASE("bending about y has the signs of w' = -ry: the matrices of the plane x-z") {
  const double l = 1.7;  // the plane x-z seen along -y: (u, w, -ry) are planar (u, v, rotation)
  const double GA = GENERATE(std::numeric_limits<double>::infinity(), 6.);
  fem::SpatialBeamSection section{50, 0.9, 0.7, 0, 0.4, 3, 0.25, 0.2};
  section.GA << 3 * GA, GA;
  const fem::ElementMaps maps = fem::spatial_beam({{0, 0, 0}, {l, 0, 0}, {0, 1, 0}}, section);
  const fem::ElementMaps planar = fem::planar_beam({0, 0}, {l, 0}, {50, 0.9, 3, 0.25, GA}, MembraneStrain::averaged);
  const std::vector<int> in{0, 2, 4, 6, 8, 10};
  const VectorXd sign = (VectorXd(6) << 1, 1, -1, 1, 1, -1).finished();
  const MatrixXd K = maps.stiffness()(in, in), M = maps.mass_matrix()(in, in);
  CHECK(relative_error(K, sign.asDiagonal() * planar.stiffness() * sign.asDiagonal()) < 1e-13);
  CHECK(relative_error(M, sign.asDiagonal() * planar.mass_matrix() * sign.asDiagonal()) < 1e-13);

  // torsion: Przemieniecki, sections 5.6 and 11.5
  const std::vector<int> torsion{3, 9};
  CHECK(relative_error(MatrixXd(maps.stiffness()(torsion, torsion)),
                       0.4 / l * (Eigen::Matrix2d() << 1, -1, -1, 1).finished()) < 1e-14);
  CHECK(relative_error(MatrixXd(maps.mass_matrix()(torsion, torsion)),
                       0.45 * l / 6 * (Eigen::Matrix2d() << 2, 1, 1, 2).finished()) < 1e-13);
}

TEST_CASE("membrane energy is that of the strain's definition on the line of centroids, with and without twist") {
  const MembraneStrain strain = GENERATE(MembraneStrain::averaged, MembraneStrain::pointwise);
  const bool wagner = GENERATE(false, true);
  fem::SpatialBeamSection s = general();
  const double l = 1.3, radius = (s.EIy + s.EIz) / s.EA, yc = 0.1, zc = -0.2, ys = -0.05, zs = 0.15;
  const fem::ElementMaps maps = fem::spatial_beam({{0, 0, 0}, {l, 0, 0}, {0, 1, 0}}, s, {strain, wagner});
  const VectorXd q = Random(33).vector(12);
  // end values of u_C, v_S, w_S, their slopes and the twist, then the cubics by their definition
  const auto uc = [&](int n) { return q[6 * n] + zc * q[6 * n + 4] - yc * q[6 * n + 5]; };
  const auto vs = [&](int n) { return q[6 * n + 1] - zs * q[6 * n + 3]; };
  const auto ws = [&](int n) { return q[6 * n + 2] + ys * q[6 * n + 3]; };
  const auto slope = [&](double a, double b, double da, double db, double t) {
    return (b - a) * 6 * t * (1 - t) / l + da * (1 - 4 * t + 3 * t * t) + db * (3 * t * t - 2 * t);
  };
  const int n = 2000;
  double mean = 0, square = 0;
  const double rate = (q[9] - q[3]) / l;
  for (int i = 0; i <= n; ++i) {
    const double t = double(i) / n, weight = (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) / (3.0 * n);
    const double v = slope(vs(0), vs(1), q[5], q[11], t) - (zc - zs) * rate;
    const double w = slope(ws(0), ws(1), -q[4], -q[10], t) + (yc - ys) * rate;
    const double eps = (uc(1) - uc(0)) / l + (v * v + w * w + (wagner ? radius * rate * rate : 0)) / 2;
    mean += weight * eps, square += weight * eps * eps;
  }
  const double membrane = s.EA * l / 2 * (strain == MembraneStrain::averaged ? mean * mean : square);
  CHECK(body::energy(elasticity(maps), q) - q.dot(maps.bending * q) / 2 == Approx(membrane).epsilon(1e-9));
}

TEST_CASE("the six rigid motions bring no force; nothing else is without energy") {
  const MembraneStrain strain = GENERATE(MembraneStrain::averaged, MembraneStrain::pointwise);
  const fem::ElementMaps maps = fem::spatial_beam(oblique, general(), {strain, true});
  const MatrixXd rigid = rigid_motions(oblique);
  const MatrixXd K = maps.stiffness();
  CHECK((K * rigid).norm() < 1e-13 * K.norm());
  CHECK(K.selfadjointView<Eigen::Lower>().eigenvalues()[6] > 1e-4);
  for (const auto& g : maps.membrane) CHECK((g.G * rigid.leftCols(3)).norm() < 1e-13);  // translations: no slope
  for (const auto& g : maps.membrane)
    CHECK((g.G * rigid * (VectorXd(6) << 0, 0, 0, oblique.to - oblique.from).finished()).norm() <
          1e-13);  // a rotation about the beam neither
}

TEST_CASE("spatial element: force is the gradient of the energy, tangent that of the force") {
  const MembraneStrain strain = GENERATE(MembraneStrain::averaged, MembraneStrain::pointwise);
  const bool wagner = GENERATE(false, true);
  const fem::ElementMaps maps = fem::spatial_beam(oblique, general(), {strain, wagner});
  const body::Elasticity e = elasticity(maps);
  const VectorXd q = Random(34).vector(12), a = Random(35).vector(12);
  body::ElasticityWork work;
  const auto force = [&](const VectorXd& x) {
    VectorXd f = VectorXd::Zero(12);
    body::add_force(e, x, work, f);
    return f;
  };
  const auto tangent = [&](const VectorXd& x) {
    MatrixXd K = MatrixXd::Zero(12, 12);
    body::add_tangent(e, x, 1, work, K);
    return K;
  };
  CHECK(relative_error(force(q), testing::gradient([&](const VectorXd& x) { return body::energy(e, x); }, q, 0.1)) <
        1e-11);
  CHECK(relative_error(tangent(q), testing::jacobian(force, q, 0.1)) < 1e-11);
  CHECK(relative_error(tangent(VectorXd::Zero(12)), maps.stiffness()) < 1e-13);
  const auto along = [&](double eta) { return VectorXd(tangent(eta * q) * a); };
  CHECK(relative_error(fem::stiffness_derivative(maps, a, q), testing::derivative(along, 0, 0.1)) < 1e-11);
}

TEST_CASE("a turned element is the element in turned axes") {
  const Matrix3d Q = testing::some_rotation();
  const fem::SpatialBeamSection s = general();
  const fem::ElementMaps here = fem::spatial_beam(oblique, s, {MembraneStrain::averaged, true});
  const fem::BeamPlace place{Q * oblique.from, Q * oblique.to, Q * oblique.orientation};
  const fem::ElementMaps there =
      fem::transformed(fem::spatial_beam(place, s, {MembraneStrain::averaged, true}), testing::rotation_dofs(Q, 2));
  CHECK(relative_error(there.stiffness(), here.stiffness()) < 1e-13);
  CHECK(relative_error(there.mass_matrix(), here.mass_matrix()) < 1e-13);
  CHECK(relative_error(there.membrane[0].L, here.membrane[0].L) < 1e-13);
  CHECK(relative_error(there.membrane[0].G, here.membrane[0].G) < 1e-13);
  const body::Inertia a = fem::inertia(here, MatrixXd::Identity(12, 12)),
                      b = fem::inertia(there, MatrixXd::Identity(12, 12));
  CHECK(relative_error(b.s0, Q * a.s0) < 1e-13);
  CHECK(relative_error(b.C0, Q * a.C0 * Q.transpose()) < 1e-13);
}

TEST_CASE("mass, centre and second moments of an element are those of its section drawn along its centroids") {
  const fem::SpatialBeamSection s = general();
  const fem::ElementMaps maps = fem::spatial_beam(oblique, s);
  const Matrix3d axes = fem::element_axes(oblique);
  const Vector3d d = oblique.to - oblique.from;
  const double l = d.norm();
  const Vector3d centre = (oblique.from + oblique.to) / 2 + axes * Vector3d(0, s.centroid[0], s.centroid[1]);
  Matrix3d section = Matrix3d::Zero();
  section.bottomRightCorner<2, 2>() << s.rhoIz, s.rhoIyz, s.rhoIyz, s.rhoIy;
  const Matrix3d C0 =
      s.rhoA * l * (centre * centre.transpose() + d * d.transpose() / 12) + l * axes * section * axes.transpose();

  const body::Inertia in = fem::inertia(maps, MatrixXd::Identity(12, 12));
  CHECK(in.m == Approx(s.rhoA * l).epsilon(1e-14));
  CHECK(relative_error(in.s0, s.rhoA * l * centre) < 1e-13);
  CHECK(relative_error(in.C0, C0) < 1e-13);

  // rigid motions as elastic displacements carry the momenta of the rigid bar: m, m x centre, J = tr(C0) I - C0
  const MatrixXd rigid = rigid_motions(oblique), M = rigid.transpose() * maps.mass_matrix() * rigid;
  MatrixXd expected(6, 6);
  const Matrix3d cross = fem::rigid_arm(centre).topRightCorner<3, 3>();
  expected << s.rhoA * l * Matrix3d::Identity(), s.rhoA * l * cross, s.rhoA * l * cross.transpose(),
      C0.trace() * Matrix3d::Identity() - C0;
  CHECK(relative_error(M, expected) < 1e-13);
}

TEST_CASE("mass points are as few as the section's second moments need") {
  const fem::BeamPlace place{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  CHECK(fem::spatial_beam(place, {1, 1, 1, 0, 1, 3, 0.2, 0.1, 0.05}).mass.size() == 16);
  CHECK(fem::spatial_beam(place, {1, 1, 1, 0, 1, 3, 0.2, 0, 0}).mass.size() == 8);
  CHECK(fem::spatial_beam(place, {1, 1, 1, 0, 1, 3, 0, 0, 0}).mass.size() == 4);
  CHECK(fem::spatial_beam(place, {1, 1, 1, 0, 1, 0, 0, 0, 0}).mass.empty());
}

TEST_CASE("a section off the line of its nodes is a beam at its centroids on rigid arms") {
  const MembraneStrain strain = GENERATE(MembraneStrain::averaged, MembraneStrain::pointwise);
  fem::SpatialBeamSection off = general();
  off.shear_centre = off.centroid;
  fem::SpatialBeamSection on = off;
  on.centroid.setZero(), on.shear_centre.setZero();
  const Vector3d arm = fem::element_axes(oblique) * Vector3d(0, off.centroid[0], off.centroid[1]);
  const fem::BeamPlace moved{oblique.from + arm, oblique.to + arm, oblique.orientation};
  const fem::ElementMaps a = fem::spatial_beam(oblique, off, {strain});
  const fem::ElementMaps b = fem::transformed(fem::spatial_beam(moved, on, {strain}), fem::rigid_arms(arm, arm));
  CHECK(relative_error(a.stiffness(), b.stiffness()) < 1e-13);
  CHECK(relative_error(a.mass_matrix(), b.mass_matrix()) < 1e-13);
  const VectorXd q = Random(36).vector(12);
  CHECK(body::energy(elasticity(a), q) == Approx(body::energy(elasticity(b), q)).epsilon(1e-13));
  const body::Inertia ia = fem::inertia(a, MatrixXd::Identity(12, 12)),
                      ib = fem::inertia(b, MatrixXd::Identity(12, 12));
  CHECK(relative_error(ia.C0, ib.C0) < 1e-13);
}

TEST_CASE("the line of a spatial element has its length, its place and the textbook's nodal loads") {
  const fem::SpatialBeamSection s = general();
  const Matrix3d axes = fem::element_axes(oblique);
  const double l = (oblique.to - oblique.from).norm();
  const Vector2d at(0.3, -0.4);
  body::Inertia line(3, 12);
  for (const auto& point : fem::spatial_beam_line(oblique, s, at)) line.add(point);
  CHECK(line.m == Approx(l).epsilon(1e-14));
  CHECK(relative_error(line.s0, l * ((oblique.from + oblique.to) / 2 + axes * Vector3d(0, at[0], at[1]))) < 1e-13);
  // material points follow rigid motions
  const MatrixXd rigid = rigid_motions(oblique);
  CHECK(relative_error(line.S * rigid, l * fem::rigid_arm(Vector3d(line.s0 / l)).topRows<3>()) < 1e-13);
  // unit load along z through the shear centre: half to each node, ry = -+l^2/12, and its arm y_S about x
  body::Inertia centre(3, 12);
  for (const auto& point : fem::spatial_beam_line(oblique, s, s.shear_centre)) centre.add(point);
  const VectorXd load = testing::rotation_dofs(axes, 2).transpose() * (centre.S.transpose() * axes.col(2));
  const double h = l / 2, m = l * l / 12, t = h * s.shear_centre[0];
  CHECK(relative_error(load, (VectorXd(12) << 0, 0, h, t, -m, 0, 0, 0, h, t, m, 0).finished()) < 1e-13);
}

TEST_CASE("the section's y lies in the plane of the beam and the orientation vector") {
  const Matrix3d axes = fem::element_axes(oblique);
  CHECK((axes.transpose() * axes - Matrix3d::Identity()).norm() < 1e-14);
  CHECK(axes.determinant() == Approx(1).epsilon(1e-14));
  CHECK((axes.col(0) - (oblique.to - oblique.from).normalized()).norm() < 1e-15);
  CHECK(std::abs(axes.col(2).dot(oblique.orientation)) < 1e-15);
  CHECK(axes.col(1).dot(oblique.orientation) > 0);
}

TEST_CASE("spatial elements that cannot be are input errors") {
  const Vector3d o(0, 0, 0), x(1, 0, 0), y(0, 1, 0);
  const fem::SpatialBeamSection good = general();
  CHECK_THROWS_AS(fem::spatial_beam({o, x, -3 * x}, good), InputError);
  CHECK_THROWS_AS(fem::spatial_beam({o, x, x + 1e-8 * y}, good), InputError);
  CHECK_THROWS_AS(fem::spatial_beam({o, x, o}, good), InputError);
  CHECK_THROWS_AS(fem::spatial_beam({x, x, y}, good), InputError);
  CHECK_THROWS_AS(fem::spatial_beam_line({x, x, y}, good), InputError);
  const auto bad = [&](auto change) {
    fem::SpatialBeamSection s = good;
    change(s);
    CHECK_THROWS_AS(fem::spatial_beam({o, x, y}, s), InputError);
  };
  bad([](auto& s) { s.EA = 0; });
  bad([](auto& s) { s.EIy = -1; });
  bad([](auto& s) { s.EIyz = 0.9; });
  bad([](auto& s) { s.rhoIyz = 0.3; });
  bad([](auto& s) { s.GJ = std::nan(""); });
  bad([](auto& s) { s.rhoA = 0; });
  bad([](auto& s) { s.centroid[0] = std::nan(""); });
}

// Sections that rotate by exp(theta) about their centroids, with the rotations of the linear element along it. The
// second difference of omega' R J R' omega in theta is exact but for the quartic part, which two steps remove.
TEST_CASE("the moment of inertia of rotated sections is that of exp(theta) to second order") {
  const fem::SpatialBeamSection section = general();
  const body::Inertia in = fem::inertia(fem::spatial_beam(oblique, section), MatrixXd::Identity(12, 12));
  fem::SpatialBeamSection slender = section;
  slender.rhoIy = slender.rhoIz = slender.rhoIyz = 0;
  const body::SpatialInertia whole = body::spatial(in),
                             line = body::spatial(
                                 fem::inertia(fem::spatial_beam(oblique, slender), MatrixXd::Identity(12, 12)));
  const Matrix3d axes = fem::element_axes(oblique);
  Matrix3d J;
  J << section.rhoIy + section.rhoIz, 0, 0, 0, section.rhoIy, -section.rhoIyz, 0, -section.rhoIyz, section.rhoIz;
  J = (axes * J * axes.transpose()).eval();
  const double l = (oblique.to - oblique.from).norm();
  const VectorXd q = Random(33).vector(12);
  const Vector3d omega = Random(34).vector(3);
  const auto moment = [&](double s) {  // of the sections, by eight Gauss points in two halves
    double sum = 0;
    for (const double half : {0., 0.5})
      for (const auto& [at, weight] : {std::pair{0.06943184420297371, 0.17392742256872693},
                                       {0.33000947820757187, 0.32607257743127307},
                                       {0.66999052179242813, 0.32607257743127307},
                                       {0.93056815579702629, 0.17392742256872693}}) {
        const double x = half + at / 2;
        const Vector3d v1 = axes.transpose() * q.segment<3>(0), r1 = axes.transpose() * q.segment<3>(3),
                       v2 = axes.transpose() * q.segment<3>(6), r2 = axes.transpose() * q.segment<3>(9);
        // v_S = v - z_S rx, w_S = w + y_S rx; slopes of Hermite's cubics
        const Vector2d S = section.shear_centre;
        const auto slope = [&](double a, double da, double b, double db) {
          return (b - a) * 6 * x * (1 - x) / l + da * (1 - 4 * x + 3 * x * x) + db * x * (3 * x - 2);
        };
        const double rise_y = slope(v1[1] - S[1] * r1[0], r1[2], v2[1] - S[1] * r2[0], r2[2]),
                     rise_z = slope(v1[2] + S[0] * r1[0], -r1[1], v2[2] + S[0] * r2[0], -r2[1]);
        const Vector3d theta = axes * Vector3d((1 - x) * r1[0] + x * r2[0], -rise_z, rise_y);
        const Matrix3d R = math::rotation(s * theta);
        sum += weight / 2 * l * omega.dot(R * J * R.transpose() * omega);
      }
    return sum;
  };
  const auto second = [&](double s) { return (moment(s) + moment(-s) - 2 * moment(0)) / (s * s); };
  const double expected = (4 * second(0.01) - second(0.02)) / 3;
  const auto form = [&](const body::SpatialInertia& of) {  // omega' d2J/dq2 omega along q
    const auto T = [&](double s) {
      VectorXd at = VectorXd::Zero(18), rate = VectorXd::Zero(18);
      at.tail(12) = s * q, rate.segment<3>(3) = omega;
      return 2 * body::kinetic_energy(of, Matrix3d::Identity(), at, rate);
    };
    return T(1) + T(-1) - 2 * T(0);
  };
  CHECK(form(whole) - form(line) == Approx(expected).epsilon(1e-7));
}
