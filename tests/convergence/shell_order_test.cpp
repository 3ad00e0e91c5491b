#include <catch2/catch.hpp>
#include <cmath>

#include "shell_plate.h"
#include "shell_states.h"

using namespace floe;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::Cells;
using testing::Plate;

namespace {

bool at(double x, double place) { return std::abs(x - place) < 1e-9; }
bool along_x(const Vector3d& x) { return at(x.y(), 0) || at(x.y(), 1); }
bool along_y(const Vector3d& x) { return at(x.x(), 0) || at(x.x(), 1); }
bool anywhere(const Vector3d&) { return true; }
bool root(const Vector3d& x) { return at(x.x(), 0); }

/// omega a^2 sqrt(rho h / D), unit square, t = 1e-3: no rotary inertia to speak of.
VectorXd square(int n, Cells cells, double distortion, const std::function<void(Plate&)>& support, int count) {
  Plate p = testing::plate(1, 1, n, n, cells, distortion);
  p.hold(anywhere, {0, 1, 5});
  support(p);
  const auto section = testing::aluminium(1e-3);
  return testing::frequencies(p, section, count) * std::sqrt(section.mass / section.bending(0, 0));
}

void simply_supported(Plate& p) {
  p.hold(along_x, {2, 4});
  p.hold(along_y, {2, 3});
}
void clamped(Plate& p) {
  p.hold(along_x, {2, 3, 4});
  p.hold(along_y, {2, 3, 4});
}
void cantilever(Plate& p) { p.hold(root, {2, 3, 4}); }

/// Frequencies on n = 8 and 16: the error of the finer mesh and log2 of the ratio of the errors.
void check(const std::function<void(Plate&)>& support, const std::vector<double>& exact, double error, double order) {
  const int count = static_cast<int>(exact.size());
  for (const Cells cells : {Cells::triangles, Cells::quadrilaterals}) {
    const VectorXd coarse = square(8, cells, 0.15, support, count), fine = square(16, cells, 0.15, support, count);
    for (int k = 0; k < count; ++k) {
      INFO("mode " << k << " cells " << int(cells) << ": " << coarse[k] << " " << fine[k]);
      CHECK(std::abs(fine[k] / exact[k] - 1) < error);
      if (order > 0) CHECK(std::log2((coarse[k] - exact[k]) / (fine[k] - exact[k])) > order);
    }
  }
}

}  // namespace

// nu = 0.3. Simply supported: closed form. Clamped, cantilever: converged Ritz values (Leissa 1973 tabulates the same
// plates; his cantilever is an upper bound, 0.2 to 0.6 % high). The elements err by O(h^2).
TEST_CASE("order: frequencies of square plates") {
  SECTION("simply supported") { check(simply_supported, {19.7392088, 49.3480220, 49.3480220, 78.9568352}, 0.009, 1.7); }
  SECTION("clamped") { check(clamped, {35.9851911, 73.3938455, 73.3938455, 108.2165017}, 0.013, 1.6); }
  SECTION("cantilever") { check(cantilever, {3.47100, 8.5062, 21.2840, 27.19870, 30.9543}, 0.0025, 0); }
}

// lambda = omega a^2 sqrt(rho h / D) of a cantilever plate whose width is half its length, nu = 0.3, by finer meshes of
// another element.
TEST_CASE("order: frequencies of a cantilever plate, b / a = 1/2") {
  Plate p = testing::plate(1, 0.5, 24, 12, Cells::crossed);
  p.hold(anywhere, {0, 1, 5});
  cantilever(p);
  const auto section = testing::aluminium(1e-3);
  const VectorXd found = testing::frequencies(p, section, 5) * std::sqrt(section.mass / section.bending(0, 0));
  const double exact[5] = {3.4392, 14.801, 21.434, 48.178, 60.159};
  for (int k = 0; k < 5; ++k) CHECK(found[k] == Approx(exact[k]).epsilon(2.5e-3));
}

// Antisymmetric cross-ply, simply supported with edges free to move normally: Navier's solution (Jones, ch. 5).
TEST_CASE("order: a coupled laminate converges to its closed form") {
  const fem::ShellSection s =
      fem::shell_section({{testing::carbon, 1e-3, 0}, {testing::carbon, 1e-3, M_PI / 2}}, 0, {1, 0, 0});
  const Eigen::Matrix3d A = s.A, B = s.B(), D = s.D();
  const double g = M_PI;
  Eigen::Matrix2d C;
  C << A(0, 0) + A(2, 2), A(0, 1) + A(2, 2), A(0, 1) + A(2, 2), A(1, 1) + A(2, 2);
  const Eigen::Vector2d b(-B(0, 0) * g, -B(1, 1) * g);
  const double k = std::pow(g, 4) * (D(0, 0) + 2 * (D(0, 1) + 2 * D(2, 2)) + D(1, 1)) - g * g * b.dot(C.inverse() * b);
  const double exact = std::sqrt(k / s.mass), uncoupled = exact * std::sqrt((k + g * g * b.dot(C.inverse() * b)) / k);
  REQUIRE(uncoupled > 1.2 * exact);
  double error[2];
  for (int level = 0; level < 2; ++level) {
    const int n = 6 << level;
    Plate p = testing::plate(1, 1, n, n, Cells::quadrilaterals);
    p.hold(along_x, {0, 2, 4});
    p.hold(along_y, {1, 2, 3});
    error[level] = testing::frequencies(p, s, 1)[0] / exact - 1;
  }
  INFO(error[0] << " " << error[1]);
  CHECK(std::abs(error[1]) < 0.01);
  CHECK(std::log2(error[0] / error[1]) > 1.7);
}

TEST_CASE("order: the deflection of a clamped plate under pressure does not depend on its thickness") {
  Plate p = testing::plate(1, 1, 12, 12, Cells::triangles, 0.15);
  clamped(p);
  p.hold(along_x, {0, 1, 5});
  p.hold(along_y, {0, 1, 5});
  const int middle = p.nearest({0.5, 0.5, 0});
  double scaled[2];
  for (int k = 0; k < 2; ++k) {
    const auto section = testing::aluminium(k == 0 ? 1e-1 : 1e-5);
    const VectorXd q = testing::solved(testing::stiffness(p, section), testing::uniform_load(p, {0, 0, 1}));
    scaled[k] = q[6 * middle + 2] * section.bending(0, 0);
  }
  CHECK(scaled[0] == Approx(0.00126532).epsilon(0.02));  // Timoshenko & Woinowsky-Krieger, table 35
  CHECK(scaled[1] == Approx(scaled[0]).epsilon(1e-8));
}

// A strip in bending is developable. Plate against von Karman beam, P L^2 / EI = 1: w / L = 1/3, u / L = -1/15.
TEST_CASE("order: large deflections of a strip without locking at any thickness") {
  for (const double t : {1e-2, 1e-4}) {
    Plate p = testing::plate(1, 0.2, 12, 2, Cells::triangles);
    p.hold(root, {0, 1, 2, 3, 4, 5});
    const auto section = fem::shell_section({{fem::isotropic(12 / (t * t * t), 0, 1), t}});  // D = 1
    VectorXd load = VectorXd::Zero(p.dofs());
    for (std::size_t i = 0; i < p.nodes.size(); ++i)
      if (at(p.nodes[i].x(), 1)) load[6 * i + 2] = at(p.nodes[i].y(), 0.1) ? 0.1 : 0.05;
    const VectorXd q = testing::equilibrium(p, section, load, 10);
    const int tip = p.nearest({1, 0.1, 0});
    INFO(t << ": " << q[6 * tip + 2] << " " << q[6 * tip]);
    CHECK(q[6 * tip + 2] == Approx(1. / 3).epsilon(0.005));
    CHECK(q[6 * tip] == Approx(-1. / 15).epsilon(0.01));
  }
}

// Clamped square plate, u = v = 0 on the edges, Q = q a^4 / (E h^4): deflection of the middle over h; a converged
// solution of the von Karman equations, nu = 0.3.
TEST_CASE("order: large deflections of a clamped plate") {
  const double h = 0.01, E = 1;
  const std::pair<double, double> expected[] = {{25, 0.326962}, {100, 0.937420}, {200, 1.364028}};
  Plate p = testing::plate(0.5, 0.5, 10, 10, Cells::crossed);  // a quarter: constrained at 0, symmetric at 1/2
  for (int d = 0; d < 2; ++d) {
    p.hold([=](const Vector3d& x) { return at(x[d], 0); }, {0, 1, 2, 3, 4, 5});
    p.hold([=](const Vector3d& x) { return at(x[d], 0.5); }, {d, 4 - d, 5});
  }
  const auto section = fem::shell_section({{fem::isotropic(E, 0.3, 1), h}});
  for (const auto& [Q, W] : expected) {
    const VectorXd q = testing::equilibrium(p, section, testing::uniform_load(p, {0, 0, Q * E * h * h * h * h}), 2);
    CHECK(q[6 * p.nearest({0.5, 0.5, 0}) + 2] / h == Approx(W).epsilon(0.01));
  }
}

// Timoshenko's short cantilever, L = 48, H = 12, E = 30000, nu = 1/4, tip shear 40: P L^3 / 3 E I + (4 + 5 nu) P L / 2
// E H = 0.35533.
TEST_CASE("order: an in-plane cantilever under shear, aspect ratios of the elements 1, 2 and 4") {
  for (const auto& [nx, ny, error] : {std::tuple{16, 4, 0.01}, std::tuple{8, 4, 0.02}, std::tuple{4, 4, 0.05}}) {
    Plate p = testing::plate(48, 12, nx, ny, Cells::quadrilaterals);
    p.hold(anywhere, {2, 3, 4});
    p.hold(root, {0, 1, 5});
    const auto section = fem::shell_section({{fem::isotropic(30000, 0.25, 1), 1}});
    VectorXd load = VectorXd::Zero(p.dofs());
    for (std::size_t i = 0; i < p.nodes.size(); ++i)
      if (at(p.nodes[i].x(), 48))
        load[6 * i + 1] = 40.0 / ny * (at(p.nodes[i].y(), 0) || at(p.nodes[i].y(), 12) ? 0.5 : 1);
    const VectorXd q = testing::solved(testing::stiffness(p, section), load);
    INFO(nx << " x " << ny);
    CHECK(q[6 * p.nearest({48, 6, 0}) + 1] == Approx(0.35533).epsilon(error));
  }
}
