#include <catch2/catch.hpp>
#include <cmath>

#include "floe/fem/transform.h"
#include "shell_plate.h"
#include "shell_states.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using fem::Strains;

namespace {

/// A square tube of side 1 along x, m quadrilaterals a side and n along it, clamped at x = 0.
testing::Plate tube(double length, int n, int m) {
  testing::Plate p;
  const int ring = 4 * m;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < ring; ++j) {
      const double s = double(j % m) / m;
      const double y[] = {s - 0.5, 0.5, 0.5 - s, -0.5}, z[] = {-0.5, s - 0.5, 0.5, 0.5 - s};
      p.nodes.emplace_back(length * i / n, y[j / m], z[j / m]);
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < ring; ++j) {
      const int a = i * ring + j, b = i * ring + (j + 1) % ring;
      p.cells.push_back({a, a + ring, b + ring, b});
    }
  p.constrained.assign(p.dofs(), false);
  p.hold([](const Vector3d& x) { return x.x() < 1e-9; }, {0, 1, 2, 3, 4, 5});
  return p;
}

fem::ShellSection wall(Strains strains, double thickness = 0.05) {
  fem::ShellSection section = testing::aluminium(thickness);
  section.strains = strains;
  return section;
}

double tip_force(double length, double deflection) { return 3 * 7e10 * 0.05 * 2 / 3 * deflection / (length * length); }

/// w/L of the end under a force shared evenly by its nodes; `deflection` is the beam's.
double free_end(Strains strains, double length, int n, int m, double deflection) {
  const testing::Plate p = tube(length, n, m);
  const int ring = 4 * m;
  VectorXd f = VectorXd::Zero(p.dofs());
  for (int j = 0; j < ring; ++j) f[6 * (n * ring + j) + 2] = tip_force(length, deflection) / ring;
  const VectorXd q = testing::equilibrium(p, wall(strains), f, deflection > 0.05 ? 2 : 1);
  double w = 0;
  for (int j = 0; j < ring; ++j) w += q[6 * (n * ring + j) + 2] / ring;
  return w / length;
}

enum class End { rigid_first_order, rigid_second_order, diaphragm };

/// Motion of the middle of the end of a square tube, 10 sides long: its edge follows that node rigidly, or a thick
/// plate of shells, all of whose nodes are free, holds it.
VectorXd capped_end(End end, const VectorXd& load) {
  constexpr int n = 20, m = 2, ring = 4 * m, first = n * ring;
  testing::Plate p = tube(10, n, m);
  const int middle = static_cast<int>(p.nodes.size());
  p.nodes.emplace_back(10, 0, 0);
  p.constrained.resize(p.dofs(), false);
  std::vector<fem::ElementMaps> maps = testing::all_maps(p, wall(Strains::second_order));
  if (end == End::diaphragm) {
    for (int j = 0; j < ring; j += 2) {
      p.cells.push_back({first + j, first + j + 1, middle, first + (j + ring - 1) % ring});
      maps.push_back(testing::maps_of(p, p.cells.back(), wall(Strains::second_order, 0.5)));
    }
  } else {
    for (int j = 0; j < ring; ++j)
      for (int d = 0; d < 6; ++d) p.constrained[6 * (first + j) + d] = true;
    for (std::size_t c = 0; c < p.cells.size(); ++c) {
      std::vector<int>& cell = p.cells[c];
      MatrixXd T = MatrixXd::Identity(24, 24);
      std::vector<fem::RigidArm> arms;
      fem::QuadrilateralNodes nodes;
      for (int i = 0; i < 4; ++i) nodes[i] = p.nodes[cell[i]];
      for (int i = 0; i < 4; ++i) {
        if (cell[i] < first) continue;
        const Vector3d arm = nodes[i] - p.nodes[middle];
        T.block<6, 6>(6 * i, 6 * i) = fem::rigid_arm(arm);
        arms.push_back({6 * i, 6 * i + 3, arm});
        cell[i] = middle;
      }
      if (arms.empty()) continue;
      if (end == End::rigid_first_order) arms.clear();
      maps[c] = fem::transformed(maps[c], T, arms);
    }
  }
  VectorXd f = VectorXd::Zero(p.dofs());
  f.segment<6>(6 * middle) = load;
  return testing::equilibrium(p, maps, f, 4).segment<6>(6 * middle);
}

/// The lowest frequency in the plane of a strip 1 x 0.05 that rotates at gamma about z, without Coriolis' forces, over
/// sqrt(EI / (rho A)).
double lag(double gamma) {
  testing::Plate p = testing::plate(1, 0.05, 40, 2, testing::Cells::quadrilaterals);
  for (Vector3d& x : p.nodes) x.y() -= 0.025;
  fem::ShellSection section = fem::shell_section({{fem::isotropic(7e10, 0, 2700), 2e-3}});
  section.strains = Strains::second_order;
  p.hold([](const Vector3d&) { return true; }, {2, 3, 4});
  p.hold([](const Vector3d& x) { return x.x() < 1e-9; }, {0, 1, 5});
  const double unit = std::sqrt(7e10 * 0.05 * 0.05 / 12 / 2700), spin = gamma * unit;
  const auto maps = testing::all_maps(p, section);
  const testing::SparseMatrix M = testing::mass(p, section);
  VectorXd place = VectorXd::Zero(p.dofs());
  for (std::size_t i = 0; i < p.nodes.size(); ++i) place.segment<3>(6 * i) = p.nodes[i];
  testing::Plate whole = p;
  whole.constrained.assign(p.dofs(), false);
  VectorXd pull = spin * spin * (testing::mass(whole, section) * place);
  for (int d = 0; d < p.dofs(); ++d)
    if (p.constrained[d]) pull[d] = 0;
  VectorXd q = VectorXd::Zero(p.dofs());
  for (int round = 0; round < 3; ++round) q = testing::equilibrium(p, maps, pull + spin * spin * (M * q), 1);
  std::size_t cell = 0;
  const testing::SparseMatrix K = testing::assembled(p, 1, [&](const std::vector<int>& c) {
    VectorXd f;
    MatrixXd tangent;
    testing::add_tension(maps[cell++], testing::gathered(c, q), f, tangent);
    return tangent;
  });
  const testing::SparseMatrix A = K - spin * spin * M;
  const Eigen::SimplicialLDLT<testing::SparseMatrix> factor(A);
  VectorXd x = VectorXd::Zero(p.dofs());
  x[6 * p.nearest({1, 0, 0}) + 1] = 1;
  double square = 0;
  for (int round = 0; round < 30; ++round) {
    x = factor.solve(VectorXd(M * x));
    x /= std::sqrt(x.dot(M * x));
    square = x.dot(A * x);
  }
  return std::sqrt(square) / unit;
}

}  // namespace

// Reference: CalculiX 2.20, NLGEOM, S8R, 20 x 4 (4 %) and 20 x 2 (10 %) elements a side, root clamped, the force shared
// evenly along the edge of the end: 0.041562 and 0.103957.
TEST_CASE("second order: a square tube 10 sides long bends as CalculiX has it, by 4 % and 10 % of its length",
          "[long]") {
  const double four = free_end(Strains::second_order, 10, 40, 4, 0.04),
               ten = free_end(Strains::second_order, 10, 40, 4, 0.1);
  CHECK(four == Approx(0.041562).epsilon(0.005));
  CHECK(ten == Approx(0.103957).epsilon(0.005));
  CHECK(free_end(Strains::von_karman, 10, 20, 2, 0.04) < 0.95 * 0.041562);
}

// The loss or gain of deflection against the linear response; the true tube stays linear in its twist to 1 %
// (corotational shells). Of first order the end is 18 % too stiff against bending and 25 % against twist; of second
// order -1.6 % (against a cap that is not quite rigid) and +6.2 % are left, as the square of the rotation. Strains e(T
// q, R(q, q)) of third order are dropped. Until the drilling of corners was relative to rotated walls, walls that were
// too stiff hid a part of that: +3.6 %.
TEST_CASE("second order: a tube with a rigid end, bent by a fifth of its length and twisted by 0.2 rad", "[long]") {
  VectorXd force = VectorXd::Zero(6), moment = VectorXd::Zero(6);
  force[2] = tip_force(10, 0.2), moment[3] = 0.2 * 7e10 / 2.6 * 0.05 / 10;
  const auto against_linear = [](End end, const VectorXd& load, int dof) {
    return capped_end(end, load)[dof] / (1e3 * capped_end(end, 1e-3 * load)[dof]);
  };
  const double bent = against_linear(End::diaphragm, force, 2);
  const double rigid = against_linear(End::rigid_second_order, force, 2),
               first_order = against_linear(End::rigid_first_order, force, 2),
               twisted = against_linear(End::rigid_second_order, moment, 3),
               first_order_twisted = against_linear(End::rigid_first_order, moment, 3);
  CAPTURE(bent, rigid, first_order, twisted, first_order_twisted);
  CHECK(rigid == Approx(bent).epsilon(0.02));
  CHECK(twisted == Approx(1).epsilon(0.07));
  CHECK(against_linear(End::rigid_second_order, moment / 2, 3) == Approx(1).epsilon(0.016));
  CHECK(first_order < 0.95 * bent);
  CHECK(first_order_twisted < 0.95);
}

// lag^2 = flap^2 - gamma^2; flap of a clamped beam, hub radius 0: 4.1373196, 13.1701505 at gamma = 2, 12.
TEST_CASE("second order: rotation stiffens a strip against bending in its own plane", "[long]") {
  CHECK(lag(0) == Approx(3.5160153).epsilon(0.005));
  CHECK(lag(2) == Approx(3.6218).epsilon(0.005));
  CHECK(lag(5) == Approx(4.0738).epsilon(0.005));
  CHECK(lag(12) == Approx(std::sqrt(13.1701505 * 13.1701505 - 144)).epsilon(0.005));
}

// Rotation vectors of all nodes and exact places: U = O(a^6) about any axis, the square of third-order terms.
TEST_CASE("second order: a rigid rotation of folded shells costs energy of order a^6 about any axis") {
  const Vector3d axis = GENERATE(Vector3d(0.6, 0.5, -0.7), Vector3d(0, 0.8, 0.6), Vector3d(-0.3, 0.9, 0.1));
  const double twist = GENERATE(0.0, 0.2);  // per length: the elements are warped
  testing::Plate p = tube(3, 2, 2);
  for (Vector3d& x : p.nodes) x = Eigen::AngleAxisd(twist * x.x(), Vector3d::UnitX()) * x;
  const auto maps = testing::all_maps(p, wall(Strains::second_order));
  const auto energy = [&](double angle) {
    const Vector3d theta = angle * axis.normalized();
    const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
    VectorXd q(p.dofs());
    for (std::size_t i = 0; i < p.nodes.size(); ++i) q.segment<6>(6 * i) << R * p.nodes[i] - p.nodes[i], theta;
    double twice = 0;
    for (std::size_t c = 0; c < maps.size(); ++c) {
      const VectorXd own = testing::gathered(p.cells[c], q);
      twice += own.dot(maps[c].bending * own);
      for (const fem::StrainPoint& point : maps[c].membrane) {
        const VectorXd slope = point.G * own, strain = point.L * own + 0.5 * point.bilinear(slope, slope);
        twice += point.weight * strain.dot(point.D * strain);
      }
    }
    return twice;
  };
  CHECK(std::log2(energy(0.2) / energy(0.1)) > 5.8);
}
