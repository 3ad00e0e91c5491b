#include <catch2/catch.hpp>
#include <cmath>

#include "differences.h"
#include "eigenvalues.h"
#include "floe/error.h"
#include "floe/fem/shell.h"
#include "floe/fem/transform.h"
#include "random.h"
#include "shell_states.h"

using namespace floe;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::relative_error;

namespace {

const fem::TriangleNodes flat{Vector3d(0.2, -0.1, 0), Vector3d(1.3, 0.2, 0), Vector3d(0.5, 0.9, 0)};
const double flat_area = (1.1 * 1.0 - 0.3 * 0.3) / 2;
const Matrix3d rotation = Eigen::AngleAxisd(1.1, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();

fem::TriangleNodes rotated(const fem::TriangleNodes& nodes) {
  return {rotation * nodes[0], rotation * nodes[1], rotation * nodes[2]};
}

/// Node-wise rotation of 18 dofs.
MatrixXd rotation_of_dofs() {
  MatrixXd T = MatrixXd::Zero(18, 18);
  for (int block = 0; block < 6; ++block) T.block<3, 3>(3 * block, 3 * block) = rotation;
  return T;
}

}  // namespace

TEST_CASE("shell triangle: fast matrices are those of the maps") {
  for (const auto& section : {testing::skew_laminate(), testing::aluminium(0.01)}) {
    const fem::TriangleNodes nodes = rotated(flat);
    const fem::ElementMaps maps = fem::shell_triangle(nodes, section);
    const fem::ShellStrain strain = fem::shell_triangle_strain(nodes, section);
    CHECK(relative_error(fem::shell_triangle_stiffness(nodes, section), maps.stiffness()) < 1e-13);
    CHECK(relative_error(fem::shell_triangle_mass(nodes, section), maps.mass_matrix()) < 1e-13);
    CHECK(relative_error(fem::shell_triangle_bending(nodes, section), maps.bending) < 1e-13);
    CHECK(relative_error(strain.L, maps.membrane[0].L) < 1e-13);
    CHECK(relative_error(strain.G, maps.membrane[0].G.topRows(strain.G.rows())) < 1e-13);
    const MatrixXd K = fem::shell_triangle_stiffness(nodes, section);
    CHECK(K == K.transpose());
  }
}

TEST_CASE("shell triangle: six rigid motions, drilling included, and nothing else without energy") {
  const fem::TriangleNodes nodes = rotated(flat);
  const fem::ElementMaps maps = fem::shell_triangle(nodes, testing::skew_laminate(0));
  const MatrixXd K = maps.stiffness();
  CHECK((K * testing::rigid_motions(nodes)).cwiseAbs().maxCoeff() < 1e-12 * K.cwiseAbs().maxCoeff());
  const VectorXd values = testing::eigenvalues(K) / K.trace();
  CHECK(values.head(6).cwiseAbs().maxCoeff() < 1e-14);
  CHECK(values[6] > 1e-8);  // bending is t^2 below the membrane
}

TEST_CASE("shell triangle: exact energy of constant strain and curvature, for any A, B, D and offset") {
  testing::Random random;
  for (double offset : {0.0, 3e-3}) {
    const fem::ShellSection section =
        fem::shell_section({{testing::carbon, 1e-3, 0.4}, {testing::carbon, 2e-3, -0.9}}, offset, {1, 0, 0});
    const MatrixXd K = fem::shell_triangle_stiffness(flat, section);
    for (int k = 0; k < 5; ++k) {
      const testing::ConstantState state{random.matrix(2, 2), 500 * random.vector(3)};
      const VectorXd q = testing::nodal(state, flat);
      CHECK(q.dot(K * q) == Approx(flat_area * state.square(section)).epsilon(1e-11));
    }
  }
}

// A plane at a distance from its nodes is the same structure: the curvature of higher degree in an element does not
// stretch it. Plates with an offset of three thicknesses had frequencies up to 48 % too high.
TEST_CASE("shell triangle: an offset is a rigid arm along the normal at every corner") {
  const std::vector<fem::Ply> plies{{testing::carbon, 1e-3, 0.4}, {testing::carbon, 2e-3, -0.9}};
  const fem::TriangleNodes nodes = rotated(flat);
  const Vector3d normal = rotation.col(2);
  const fem::ShellSection centred = fem::shell_section(plies, 0, rotation.col(0));
  const MatrixXd K = fem::shell_triangle_stiffness(nodes, centred), M = fem::shell_triangle_mass(nodes, centred);
  for (const double offset : {2e-3, -0.04}) {
    MatrixXd arms = MatrixXd::Zero(18, 18);
    for (int i = 0; i < 3; ++i) arms.block<6, 6>(6 * i, 6 * i) = fem::rigid_arm(Vector3d(offset * normal));
    const fem::ShellSection section = fem::shell_section(plies, offset, rotation.col(0));
    CHECK(relative_error(fem::shell_triangle_stiffness(nodes, section), arms.transpose() * K * arms) < 1e-12);
    CHECK(relative_error(fem::shell_triangle_mass(nodes, section), arms.transpose() * M * arms) < 1e-12);
  }
}

TEST_CASE("shell triangle: signs of rotation and curvature") {
  // a plate that deflects within the element in the middle along x: w = x^2 / 2 has rotation_y = -x and kappa_x = -1;
  // its top is compressed
  const fem::ShellSection top = fem::shell_section({{fem::isotropic(1, 0, 1), 0.01}}, 0.5);
  const VectorXd q = testing::nodal(testing::ConstantState{Eigen::Matrix2d::Zero(), {-1, 0, 0}}, flat);
  CHECK(q[6 + 4] == Approx(-1.3));
  CHECK(q[6 + 2] == Approx(1.3 * 1.3 / 2));
  const fem::ShellStrain strain = fem::shell_triangle_strain(flat, top);
  const Vector3d e = strain.L * q;  // in the element's axes, along the first edge
  CHECK(e[0] + e[1] == Approx(-0.5));
}

TEST_CASE("shell triangle: a turned element has turned matrices; the order of the nodes does not matter") {
  const MatrixXd T = rotation_of_dofs();
  fem::ShellSection section = testing::skew_laminate();
  const MatrixXd K = fem::shell_triangle_stiffness(flat, section), M = fem::shell_triangle_mass(flat, section);
  section.axis = rotation * section.axis;
  CHECK(relative_error(fem::shell_triangle_stiffness(rotated(flat), section), T * K * T.transpose()) < 1e-12);
  CHECK(relative_error(fem::shell_triangle_mass(rotated(flat), section), T * M * T.transpose()) < 1e-12);

  MatrixXd cycle = MatrixXd::Zero(18, 18);  // isotropic: the element's axes follow another edge
  for (int i = 0; i < 3; ++i) cycle.block<6, 6>(6 * i, 6 * ((i + 1) % 3)).setIdentity();
  const fem::TriangleNodes next{flat[1], flat[2], flat[0]};
  const fem::ShellSection plain = testing::aluminium(0.1);
  CHECK(relative_error(fem::shell_triangle_stiffness(next, plain),
                       cycle * fem::shell_triangle_stiffness(flat, plain) * cycle.transpose()) < 1e-12);
}

TEST_CASE("shell triangle: mass, its first and second moments, and the inertia of its rigid motions") {
  const fem::ShellSection section = testing::skew_laminate(0.05);
  const fem::ElementMaps maps = fem::shell_triangle(flat, section);
  double m = 0;
  Vector3d first = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();
  for (const auto& p : maps.mass) {
    m += p.mass;
    first += p.mass * p.x;
    second += p.mass * p.x * p.x.transpose();
  }
  const Vector3d sum = flat[0] + flat[1] + flat[2], c = sum / 3;
  Matrix3d plane = sum * sum.transpose();  // int x x' = area / 12 (sum x_i x_i' + sum x sum x')
  for (const Vector3d& x : flat) plane += x * x.transpose();
  Matrix3d exact = section.mass * flat_area / 12 * plane;
  exact(2, 2) = section.rotary_inertia() * flat_area;
  for (int d = 0; d < 2; ++d) exact(d, 2) = exact(2, d) = section.first_moment() * flat_area * c[d];
  CHECK(m == Approx(section.mass * flat_area).epsilon(1e-14));
  CHECK((first - flat_area * Vector3d(section.mass * c.x(), section.mass * c.y(), section.first_moment())).norm() <
        1e-14 * m);
  CHECK(relative_error(second, exact) < 1e-13);

  const MatrixXd R = testing::rigid_motions(flat), I = R.transpose() * maps.mass_matrix() * R;
  CHECK(relative_error(MatrixXd(I.topLeftCorner(3, 3)), m * Matrix3d::Identity()) < 1e-13);
  CHECK(I(3, 3) == Approx(exact(1, 1) + exact(2, 2)).epsilon(1e-13));
  CHECK(I(4, 4) == Approx(exact(0, 0) + exact(2, 2)).epsilon(1e-13));
  CHECK(I(5, 5) == Approx(exact(0, 0) + exact(1, 1)).epsilon(1e-13));
  CHECK(maps.mass_matrix().row(5).norm() == 0);  // drilling carries no mass
}

TEST_CASE("shell triangle: the von Karman force is the gradient of the energy, from the strains of its definition") {
  const fem::ShellSection section = testing::skew_laminate();
  const fem::ElementMaps maps = fem::shell_triangle(rotated(flat), section);
  const MatrixXd every = MatrixXd::Identity(18, 18);
  const body::Elasticity elastic = fem::elasticity(maps, every);
  VectorXd q = 0.1 * testing::Random(3).vector(18);
  REQUIRE(maps.membrane.size() == 2);
  const fem::StrainPoint &g = maps.membrane[0], &drilling = maps.membrane[1];
  const MatrixXd slopes = fem::shell_triangle_strain(rotated(flat), section).G;
  const Vector3d n = rotation.col(2), x = (section.axis - n.dot(section.axis) * n).normalized(), y = n.cross(x);
  const auto energy = [&](const VectorXd& at) {
    const Eigen::Vector2d s = slopes * at;
    Vector3d e = g.L * at + Vector3d(s.x() * s.x(), s.y() * s.y(), 2 * s.x() * s.y()) / 2, d = drilling.L * at;
    for (int i = 0; i < 3; ++i) {  // drilling relative to the plane
      const Vector3d theta = at.segment<3>(6 * i + 3);
      const double lost = (s.x() * x.dot(theta) + s.y() * y.dot(theta)) / 2;
      e -= g.L.middleCols<3>(6 * i + 3) * n * lost, d -= drilling.L.middleCols<3>(6 * i + 3) * n * lost;
    }
    return 0.5 * at.dot(maps.bending * at) + 0.5 * g.weight * e.dot(g.D * e) +
           0.5 * drilling.weight * d.dot(drilling.D * d);
  };
  VectorXd force = VectorXd::Zero(18);
  body::ElasticityWork work;
  body::add_force(elastic, q, work, force);
  CHECK(body::energy(elastic, q) == Approx(energy(q)).epsilon(1e-12));
  CHECK(relative_error(force, testing::gradient(energy, q, 1e-2)) < 1e-9);  // exact for quartics
}

// log(R'exp(theta)) does not change where the element rotates by R. With a drilling stiffness against theta_n alone the
// energy changed by 0.32 and 1.27 of itself.
TEST_CASE("shell triangle: a small deformation keeps its energy where the element rotates") {
  fem::ShellSection section = testing::aluminium(0.01);
  section.strains = fem::Strains::second_order;
  const body::Elasticity elastic = fem::elasticity(fem::shell_triangle(flat, section), MatrixXd::Identity(18, 18));
  for (const Vector3d& axis : {Vector3d(1, 0, 0), Vector3d(0.6, -0.8, 0)}) {
    const auto change = [&](double a) {
      const Matrix3d R = Eigen::AngleAxisd(a, axis).toRotationMatrix();
      VectorXd bent = VectorXd::Zero(18), rotated = bent;
      for (int i = 0; i < 3; ++i) {
        const Vector3d bend = 1e-2 * (i == 0 ? Vector3d(0, 0, 0) : i == 1 ? Vector3d(1, 2, 0) : Vector3d(-2, 1, 0));
        const Eigen::AngleAxisd theta(R * Eigen::AngleAxisd(bend.norm(), bend.stableNormalized()).toRotationMatrix());
        bent.segment<3>(6 * i + 3) = bend;
        rotated.segment<6>(6 * i) << (R - Matrix3d::Identity()) * flat[i], theta.angle() * theta.axis();
      }
      return std::abs(body::energy(elastic, rotated) - body::energy(elastic, bent)) / body::energy(elastic, bent);
    };
    CHECK(change(0.02) < 1e-3);
    CHECK(change(0.04) < 2e-3);
  }
}

TEST_CASE("shell triangle: a tilted plane has the von Karman strain of its slope and no bending") {
  const fem::ShellStrain strain = fem::shell_triangle_strain(flat, testing::skew_laminate());
  VectorXd q = testing::rigid_motions(flat).col(3) * 0.2;  // w = 0.2 y
  const Vector3d direction(1, 0.2, 0);
  const Eigen::Vector2d along = direction.head<2>().normalized(), slope = strain.G * q;
  CHECK((slope - 0.2 * Eigen::Vector2d(along.y(), along.x())).norm() < 1e-14);  // y in the section's axes
  CHECK((strain.L * q).norm() < 1e-14);
}

TEST_CASE("shell triangle: strains of second order are Green-Lagrange's of the plane through the displaced nodes") {
  fem::ShellSection section = testing::skew_laminate();
  section.strains = fem::Strains::second_order;
  section.axis = rotation * section.axis;
  const fem::TriangleNodes nodes = rotated(flat);
  const fem::ShellStrain strain = fem::shell_triangle_strain(nodes, section);
  fem::StrainPoint point = fem::shell_triangle(nodes, section).membrane[0];
  for (MatrixXd& P : point.P) P = P.topLeftCorner(6, 6).eval();  // without the products of rotations in its curvature
  const Vector3d x = (rotation * Vector3d(1, 0.2, 0)).normalized(), y = (rotation * Vector3d::UnitZ()).cross(x);
  const Matrix3d H = 0.3 * testing::Random(4).matrix(3, 3);  // u = H x, with the rotations that go along
  VectorXd q(18);
  const Matrix3d skew = (H - H.transpose()) / 2;
  for (int i = 0; i < 3; ++i) q.segment<6>(6 * i) << H * nodes[i], skew(2, 1), skew(0, 2), skew(1, 0);
  const Matrix3d E = (H + H.transpose() + H.transpose() * H) / 2;
  const VectorXd gradients = strain.G * q, found = strain.L * q + point.bilinear(gradients, gradients) / 2,
                 linear = strain.L * q;
  const Matrix3d S = (H + H.transpose()) / 2;
  // the linear part has the curvature's coupling, too, of which this state has some: compare what is quadratic
  const Vector3d expected(x.dot((E - S) * x), y.dot((E - S) * y), 2 * x.dot((E - S) * y));
  CHECK((found - linear - expected).norm() < 1e-14);
}

// Rotation by a about the normal: cos a - 1 is strain to von Karman, E ~ a^4. To second order what is left is a - sin a
// in drilling, E ~ a^6; about two axes in turn slopes differ from rotations by theta_x theta_y / 2 in bending, E ~ a^4,
// but of the bending stiffness, (t/L)^2 of the membrane's.
TEST_CASE("shell triangle: what a rigid rotation costs") {
  const auto cost = [&](fem::Strains strains, const Vector3d& axis, double a) {
    fem::ShellSection section = testing::aluminium(0.01);
    section.strains = strains;
    const fem::ElementMaps maps = fem::shell_triangle(flat, section);
    const Matrix3d R = Eigen::AngleAxisd(a, axis.normalized()).toRotationMatrix();
    VectorXd q(18);
    for (int i = 0; i < 3; ++i) q.segment<6>(6 * i) << (R - Matrix3d::Identity()) * flat[i], a * axis.normalized();
    return body::energy(fem::elasticity(maps, MatrixXd::Identity(18, 18)), q) / 70e9 / 0.01;
  };
  const auto order = [&](fem::Strains strains, const Vector3d& axis, double a = 0.1) {
    return std::log2(cost(strains, axis, 2 * a) / cost(strains, axis, a));
  };
  const Vector3d z(0, 0, 1), tilted(0, 1, 1);
  CHECK(order(fem::Strains::von_karman, z) == Approx(4).margin(0.05));
  CHECK(order(fem::Strains::second_order, z) == Approx(6).margin(0.05));
  CHECK(order(fem::Strains::second_order, Vector3d(1, 0.3, 0)) == Approx(6).margin(0.05));
  CHECK(order(fem::Strains::second_order, tilted) == Approx(6).margin(0.2));
  CHECK(order(fem::Strains::second_order, tilted, 1e-2) == Approx(6).margin(0.05));
  CHECK(cost(fem::Strains::von_karman, tilted, 0.1) > 1e-6);
  CHECK(cost(fem::Strains::second_order, tilted, 0.1) < 1e-3 * cost(fem::Strains::von_karman, tilted, 0.1));
  CHECK(cost(fem::Strains::second_order, z, 0.1) < 1e-3 * cost(fem::Strains::von_karman, z, 0.1));
}

TEST_CASE("shell triangle: samples of the surface give area, centre and the work of a linear pressure") {
  double area = 0, work = 0;
  Vector3d force = Vector3d::Zero();
  const testing::ConstantState state{Eigen::Matrix2d::Zero(), {0, 0, 0}};
  VectorXd q = testing::nodal(state, flat) + testing::rigid_motions(flat).col(4);  // w = -x
  for (const auto& p : fem::shell_triangle_surface(flat)) {
    area += p.area;
    force += p.area * p.normal;
    work += p.area * p.x.y() * p.normal.dot(p.N * q);
  }
  double exact = 0;  // -int x y
  for (const Vector3d& a : flat)
    for (const Vector3d& b : flat) exact -= flat_area / 12 * a.x() * b.y() * (&a == &b ? 2 : 1);
  CHECK(area == Approx(flat_area).epsilon(1e-14));
  CHECK((force - Vector3d(0, 0, flat_area)).norm() < 1e-14);
  CHECK(work == Approx(exact).epsilon(1e-13));
}

TEST_CASE("shell triangle: what cannot be") {
  const fem::ShellSection section = testing::skew_laminate();
  CHECK_THROWS_AS(fem::shell_triangle({flat[0], flat[1], 2 * flat[1] - flat[0]}, section), InputError);
  fem::ShellSection normal = section;
  normal.axis = Vector3d::UnitZ();
  CHECK_THROWS_AS(fem::shell_triangle(flat, normal), InputError);
}
