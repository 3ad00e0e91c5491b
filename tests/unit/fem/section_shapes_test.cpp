#include <catch2/catch.hpp>
#include <cmath>

#include "floe/error.h"
#include "floe/fem/beam_section_3d.h"

using namespace floe;

namespace {
constexpr double pi = 3.14159265358979323846;

/// Prandtl's stress function on a grid: J = 2 int phi, laplace phi = -2, phi = 0 on the rim; Richardson from two grids
/// of n and 2n intervals along the width.
double prandtl(double b, double h, int n) {
  const auto solve = [&](int across) {
    const double step = b / across;
    const int nx = across - 1, ny = static_cast<int>(std::lround(h / step)) - 1;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(nx * ny, nx * ny);
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j) {
        const int k = i * ny + j;
        A(k, k) = 4;
        if (i > 0) A(k, k - ny) = -1;
        if (i + 1 < nx) A(k, k + ny) = -1;
        if (j > 0) A(k, k - 1) = -1;
        if (j + 1 < ny) A(k, k + 1) = -1;
      }
    const Eigen::VectorXd phi = A.llt().solve(Eigen::VectorXd::Constant(nx * ny, 2 * step * step));
    return 2 * phi.sum() * step * step;
  };
  return (4 * solve(2 * n) - solve(n)) / 3;
}
}  // namespace

TEST_CASE("rectangle: second moments and Timoshenko's torsion factors") {
  const fem::SectionShape s = fem::rectangle(0.03, 0.05);
  CHECK(s.A == Approx(0.0015).epsilon(1e-14));
  CHECK(s.Iy == Approx(0.03 * std::pow(0.05, 3) / 12).epsilon(1e-14));
  CHECK(s.Iz == Approx(0.05 * std::pow(0.03, 3) / 12).epsilon(1e-14));
  // Timoshenko & Goodier, Theory of elasticity, 3rd ed., art. 109, table of k1 = J / (a b^3)
  const double table[][2] = {{1, 0.1406}, {1.2, 0.166}, {1.5, 0.196}, {2, 0.229},  {2.5, 0.249},
                             {3, 0.263},  {4, 0.281},   {5, 0.291},   {10, 0.312}, {1e4, 0.333}};
  for (const auto& [ratio, k1] : table) {
    CHECK(fem::rectangle(ratio, 1).J / ratio == Approx(k1).margin(ratio == 1 ? 5e-5 : 5.1e-4));
    CHECK(fem::rectangle(1, ratio).J == Approx(fem::rectangle(ratio, 1).J).epsilon(1e-15));
  }
  CHECK(fem::rectangle(2, 2).J == Approx(16 * fem::rectangle(1, 1).J).epsilon(1e-14));
  // far from square the series tends to a b^3 (1/3 - 0.2100... b/a), 64/pi^5 sum 1/n^5 = 64/pi^5 31/32 zeta(5)
  const double edge = 64 / std::pow(pi, 5) * 31 / 32 * 1.0369277551433699263;
  CHECK(fem::rectangle(1, 40).J == Approx(40 * (1. / 3 - edge / 40)).epsilon(1e-13));
}

TEST_CASE("rectangle: torsion constant is that of Prandtl's stress function solved on a grid") {
  CHECK(fem::rectangle(1, 1).J == Approx(prandtl(1, 1, 12)).epsilon(2e-4));
  CHECK(fem::rectangle(1, 1.5).J == Approx(prandtl(1, 1.5, 10)).epsilon(2e-4));
}

TEST_CASE("circle and tube: polar moment") {
  const fem::SectionShape s = fem::circle(0.2), t = fem::tube(0.2, 0.15);
  CHECK(s.A == Approx(pi * 0.04).epsilon(1e-14));
  CHECK(s.Iy == Approx(pi * std::pow(0.2, 4) / 4).epsilon(1e-14));
  CHECK(s.Iz == s.Iy);
  CHECK(s.J == Approx(pi * std::pow(0.2, 4) / 2).epsilon(1e-14));
  CHECK(t.A == Approx(pi * (0.04 - 0.0225)).epsilon(1e-14));
  CHECK(t.J == Approx(pi / 2 * (std::pow(0.2, 4) - std::pow(0.15, 4))).epsilon(1e-14));
  CHECK(t.Iy + t.Iz == Approx(t.J).epsilon(1e-14));
}

// Timoshenko & Goodier, Theory of elasticity, 3rd ed., art. 109, table of k_2: tau = T / (k_2 a b^2).
TEST_CASE("greatest shear stress of torsion: rectangles, round sections, thin walls") {
  for (const auto& [ratio, k] : {std::pair{1., 0.208}, {1.5, 0.231}, {2., 0.246}, {3., 0.267}, {10., 0.312}}) {
    CHECK(fem::rectangle(0.02, 0.02 * ratio).W == Approx(k * ratio * 8e-6).epsilon(3e-3));
    CHECK(fem::rectangle(0.02 * ratio, 0.02).W == Approx(k * ratio * 8e-6).epsilon(3e-3));
  }
  CHECK(fem::circle(0.2).W == Approx(pi * std::pow(0.2, 3) / 2).epsilon(1e-14));
  CHECK(fem::tube(0.2, 0.15).W == Approx(fem::tube(0.2, 0.15).J / 0.2).epsilon(1e-14));
  CHECK(fem::box(0.1, 0.2, 0.004, 0.006).W == Approx(2 * 0.096 * 0.194 * 0.004).epsilon(1e-14));  // Bredt
  CHECK(fem::i_section(166, 529, 13.6, 9.7).W == Approx(fem::i_section(166, 529, 13.6, 9.7).J / 13.6).epsilon(1e-14));
  CHECK(fem::rotated(fem::circle(0.2), 0.3).W == fem::circle(0.2).W);
}

TEST_CASE("box: differences of rectangles, and Bredt's torsion constant") {
  const double b = 0.1, h = 0.2, side = 0.004, cover = 0.006;
  const fem::SectionShape s = fem::box(b, h, side, cover);
  CHECK(s.A == Approx(2 * b * cover + 2 * (h - 2 * cover) * side).epsilon(1e-13));
  // parallel axes: two covers at +-(h - cover)/2 and two sides
  const double hs = h - 2 * cover;
  CHECK(s.Iy ==
        Approx(2 * (b * std::pow(cover, 3) / 12 + b * cover * std::pow((h - cover) / 2, 2) + side * hs * hs * hs / 12))
            .epsilon(1e-13));
  CHECK(s.Iz ==
        Approx(2 * (cover * b * b * b / 12 + hs * std::pow(side, 3) / 12 + hs * side * std::pow((b - side) / 2, 2)))
            .epsilon(1e-13));
  // Young & Budynas, Roark's formulas, 7th ed., table 10.1, case 16: 2 t t1 (a-t)^2 (b-t1)^2 / (a t + b t1 - t^2 -
  // t1^2)
  const double a = h, t = cover, t1 = side;
  CHECK(s.J == Approx(2 * t * t1 * std::pow(a - t, 2) * std::pow(b - t1, 2) / (a * t + b * t1 - t * t - t1 * t1))
                   .epsilon(1e-13));
}

TEST_CASE("I section: parallel axes, and the published torsion constant") {
  const double b = 166, h = 529, t = 13.6, w = 9.7;  // W530x74 [mm], without fillets
  const fem::SectionShape s = fem::i_section(b, h, t, w);
  const double hw = h - 2 * t;
  CHECK(s.A == Approx(2 * b * t + hw * w).epsilon(1e-14));
  CHECK(s.Iy ==
        Approx(2 * (b * t * t * t / 12 + b * t * std::pow((h - t) / 2, 2)) + w * hw * hw * hw / 12).epsilon(1e-13));
  CHECK(s.Iz == Approx(2 * t * b * b * b / 12 + hw * w * w * w / 12).epsilon(1e-13));
  CHECK(s.J == Approx((2 * b * t * t * t + (h - t) * w * w * w) / 3).epsilon(1e-14));
}

TEST_CASE("turned sections: moments on a circle, principal ones given back") {
  fem::SectionShape s{4, 3, 1, 0.5, 0.2};
  s.shear_centre << 0.3, -0.1;
  const fem::SectionShape quarter = fem::rotated(s, pi / 2);  // y -> z, z -> -y
  CHECK(quarter.Iy == Approx(s.Iz).epsilon(1e-14));
  CHECK(quarter.Iz == Approx(s.Iy).epsilon(1e-14));
  CHECK(quarter.Iyz == Approx(-s.Iyz).epsilon(1e-14));
  CHECK((quarter.shear_centre - Eigen::Vector2d(0.1, 0.3)).norm() < 1e-15);
  const fem::SectionShape some = fem::rotated(s, 0.3);
  CHECK(some.Iy + some.Iz == Approx(4).epsilon(1e-14));
  CHECK(some.Iy * some.Iz - some.Iyz * some.Iyz == Approx(2.75).epsilon(1e-14));
  // a thin strip along y rotated by 30 degrees towards z lies in the first and third quadrant
  const fem::SectionShape strip = fem::rotated(fem::rectangle(1, 1e-3), pi / 6);
  CHECK(strip.Iyz == Approx(1e-3 / 12 * std::cos(pi / 6) * std::sin(pi / 6)).epsilon(1e-5));
}

TEST_CASE("a section of a material: stiffness, mass, and the shear modulus of nu") {
  CHECK(fem::shear_modulus(210e9, 0.3) == Approx(80.769230769e9).epsilon(1e-10));
  fem::SectionShape shape{4, 3, 1, 0.5, 0.2};
  shape.shear_centre << 0.3, -0.1;
  const fem::SpatialBeamSection s = fem::spatial_section(shape, {10, 7, 2}, {0.5, 0.25});
  CHECK(s.EA == 40);
  CHECK(s.EIy == 30);
  CHECK(s.EIz == 10);
  CHECK(s.EIyz == 5);
  CHECK(s.GJ == Approx(1.4));
  CHECK(s.rhoA == 8);
  CHECK(s.rhoIy == 6);
  CHECK(s.rhoIz == 2);
  CHECK(s.rhoIyz == 1);
  CHECK((s.centroid - Eigen::Vector2d(0.5, 0.25)).norm() == 0);
  CHECK((s.shear_centre - Eigen::Vector2d(0.8, 0.15)).norm() < 1e-15);
}

TEST_CASE("sections that cannot be are input errors") {
  CHECK_THROWS_AS(fem::rectangle(0, 1), InputError);
  CHECK_THROWS_AS(fem::rectangle(1, std::nan("")), InputError);
  CHECK_THROWS_AS(fem::circle(-1), InputError);
  CHECK_THROWS_AS(fem::tube(1, 1), InputError);
  CHECK_THROWS_AS(fem::box(1, 1, 0.5, 0.1), InputError);
  CHECK_THROWS_AS(fem::i_section(1, 1, 0.5, 0.1), InputError);
  CHECK_THROWS_AS(fem::i_section(1, 3, 0.5, 1.1), InputError);
  CHECK_THROWS_AS(fem::shear_modulus(1, 0.6), InputError);
  CHECK_THROWS_AS(fem::spatial_section(fem::rectangle(1, 1), {-1, 1, 1}), InputError);
  CHECK_THROWS_AS(fem::spatial_section(fem::rectangle(1, 1), {1, -1, 1}), InputError);
  CHECK_THROWS_AS(fem::spatial_section({1, 1, 1, 2, 1}, {1, 1, 1}), InputError);
}
