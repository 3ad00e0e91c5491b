#include "floe/fem/shell_section.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "differences.h"
#include "floe/error.h"
#include "shell_states.h"

using namespace floe;
using Eigen::Matrix3d;
using testing::carbon;
using testing::relative_error;

TEST_CASE("an isotropic shell: E t / (1 - nu^2), E t^3 / 12 (1 - nu^2), rho t, rho t^3 / 12") {
  const double E = 70e9, nu = 0.3, t = 2e-3;
  const fem::ShellSection s = testing::aluminium(t);
  Matrix3d Q;
  Q << 1, nu, 0, nu, 1, 0, 0, 0, (1 - nu) / 2;
  Q *= E / (1 - nu * nu);
  CHECK(relative_error(s.A, Q * t) < 1e-14);
  CHECK(relative_error(s.D(), Q * t * t * t / 12) < 1e-14);
  CHECK(s.B().norm() < 1e-14 * s.A.norm() * t);
  CHECK(s.mass == Approx(2700 * t));
  CHECK(s.rotary_inertia() == Approx(2700 * t * t * t / 12));
  CHECK(s.higher_order == Approx((1 - 4 * nu * nu) / 2));  // Felippa 2003
}

TEST_CASE("an offset moves A, B, D and the inertia as parallel axes do") {
  const double z = 0.7;
  const fem::ShellSection s = testing::skew_laminate(0), moved = testing::skew_laminate(z);
  CHECK(relative_error(moved.A, s.A) < 1e-14);
  CHECK(relative_error(moved.B(), s.B() + z * s.A) < 1e-13);
  CHECK(relative_error(moved.D(), s.D() + 2 * z * s.B() + z * z * s.A) < 1e-13);
  CHECK(moved.first_moment() == Approx(s.first_moment() + z * s.mass));
  CHECK(moved.rotary_inertia() == Approx(s.rotary_inertia() + 2 * z * s.first_moment() + z * z * s.mass));
  CHECK(relative_error(moved.bending, s.bending) < 1e-14);
}

TEST_CASE("A, B, D of a cross-ply: the sums of Jones, ch. 4") {
  const double h = 1e-3, d = 1 - 0.3 * 0.3 * 10 / 140;
  const double Q11 = 140e9 / d, Q22 = 10e9 / d, Q12 = 3e9 / d;
  const fem::ShellSection s = fem::shell_section({{carbon, h, 0}, {carbon, h, M_PI / 2}}, 0, {1, 0, 0});
  Matrix3d A, B, D;
  A << Q11 + Q22, 2 * Q12, 0, 2 * Q12, Q11 + Q22, 0, 0, 0, 2 * 5e9;
  B << Q22 - Q11, 0, 0, 0, Q11 - Q22, 0, 0, 0, 0;
  D << Q11 + Q22, 2 * Q12, 0, 2 * Q12, Q11 + Q22, 0, 0, 0, 2 * 5e9;
  CHECK(relative_error(s.A, h * A) < 1e-14);
  CHECK(relative_error(s.B(), h * h / 2 * B) < 1e-13);
  CHECK(relative_error(s.D(), h * h * h / 3 * D) < 1e-13);
}

TEST_CASE("turning a ply or turning the axes: the energy of a strain is the same") {
  const double angle = 0.6, c = std::cos(angle), s = std::sin(angle);
  const Matrix3d along = fem::shell_section({{carbon, 1, 0}}, 0, {1, 0, 0}).A;
  const Matrix3d rotated = fem::shell_section({{carbon, 1, angle}}, 0, {1, 0, 0}).A;
  Eigen::Matrix2d R, e;
  R << c, -s, s, c;
  e << 0.3, -0.2, -0.2, 0.7;  // tensor, in the ply's axes
  const Eigen::Matrix2d f = R * e * R.transpose();
  const Eigen::Vector3d in_ply(e(0, 0), e(1, 1), 2 * e(0, 1)), in_axes(f(0, 0), f(1, 1), 2 * f(0, 1));
  CHECK(in_axes.dot(rotated * in_axes) == Approx(in_ply.dot(along * in_ply)).epsilon(1e-13));
}

TEST_CASE("the higher-order coefficient does not depend on the axes of a material") {
  const double expected = fem::shell_section({{carbon, 1, 0}}, 0, {1, 0, 0}).higher_order;
  for (double angle : {0.3, 0.9, 2.0})
    CHECK(fem::shell_section({{carbon, 1, angle}}, 0, {1, 0, 0}).higher_order == Approx(expected).epsilon(1e-10));
}

TEST_CASE("sections that cannot be") {
  CHECK_THROWS_AS(fem::shell_section({}), InputError);
  CHECK_THROWS_AS(fem::shell_section({{fem::isotropic(1, 0.3, 1), 0}}), InputError);
  CHECK_THROWS_AS(fem::isotropic(1, 0.6, 1), InputError);
  CHECK_THROWS_AS(fem::shell_section({{carbon, 1e-3}}), InputError);  // no axis
  CHECK_THROWS_AS(fem::shell_section({{{1, 10, 0.4, 1, 1}, 1}}, 0, {1, 0, 0}), InputError);
  CHECK_THROWS_AS(fem::shell_section({{{1, -1, 0.4, 1, 1}, 1}}, 0, {1, 0, 0}), InputError);
}

TEST_CASE("a section by its stiffness is the section of the plies that have it") {
  const fem::ShellSection plies = testing::skew_laminate(0.4);
  const fem::ShellSection same = fem::stiffness_section(plies.A, plies.B(), plies.D(), plies.mass, plies.axis);
  CHECK(relative_error(same.A, plies.A) < 1e-14);
  CHECK(relative_error(same.coupling, plies.coupling) < 1e-12);
  CHECK(relative_error(same.bending, plies.bending) < 1e-8);  // the difference of D and B A^-1 B, which are 1e6 larger
  CHECK(same.higher_order == plies.higher_order);
  const fem::ShellSection plate = testing::aluminium(2e-3),
                          again = fem::stiffness_section(plate.A, plate.B(), plate.D(), plate.mass);
  CHECK(again.mass_radius == Approx(plate.mass_radius));
  CHECK(again.shear == Approx(plate.shear));
}

TEST_CASE("a stiffness that is not positive definite, or has directions without an axis, is an input error") {
  const fem::ShellSection plate = testing::aluminium(2e-3), laminate = testing::skew_laminate(0);
  const Matrix3d none = Matrix3d::Zero();
  CHECK_THROWS_AS(fem::stiffness_section(none, none, plate.D(), 1), InputError);
  CHECK_THROWS_AS(fem::stiffness_section(plate.A, none, none, 1), InputError);
  CHECK_THROWS_AS(fem::stiffness_section(plate.A, plate.A, plate.D(), 1), InputError);
  CHECK_THROWS_AS(fem::stiffness_section(plate.A, none, plate.D(), -1), InputError);
  CHECK_THROWS_AS(fem::stiffness_section(laminate.A, none, laminate.D(), 1), InputError);
}
