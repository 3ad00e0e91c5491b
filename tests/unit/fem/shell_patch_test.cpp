#include <catch2/catch.hpp>
#include <cmath>

#include "differences.h"
#include "shell_plate.h"
#include "shell_states.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::Cells;
using testing::ConstantState;
using testing::Plate;

namespace {

bool inside(const Vector3d& x) { return x.x() > 1e-9 && x.x() < 2 - 1e-9 && x.y() > 1e-9 && x.y() < 1 - 1e-9; }

/// The states of the patch test: three strains, drilling, two bendings, twist, and all at once.
std::vector<ConstantState> states() {
  std::vector<ConstantState> all;
  for (int k = 0; k < 4; ++k) {
    ConstantState s{Eigen::Matrix2d::Zero(), Vector3d::Zero()};
    s.gradient(k / 2, k % 2) = 1e-3;
    all.push_back(s);
  }
  for (int k = 0; k < 3; ++k) all.push_back({Eigen::Matrix2d::Zero(), Vector3d::Unit(k)});
  testing::Random random;
  all.push_back({1e-3 * random.matrix(2, 2), random.vector(3)});
  return all;
}

}  // namespace

TEST_CASE("patch test: distorted meshes carry every constant state without force inside, with its exact energy") {
  for (const Cells cells : {Cells::triangles, Cells::crossed, Cells::quadrilaterals})
    for (const auto& section : {testing::aluminium(0.02), testing::skew_laminate(2e-3, {1, 0, 0})}) {
      const Plate p = testing::plate(2, 1, 4, 3, cells, 0.3);
      const testing::SparseMatrix K = testing::stiffness(p, section);
      for (const ConstantState& state : states()) {
        const VectorXd q = testing::nodal(state, p.nodes), f = K * q;
        double inner = 0;
        for (std::size_t i = 0; i < p.nodes.size(); ++i)
          if (inside(p.nodes[i])) inner = std::max(inner, f.segment<6>(6 * i).cwiseAbs().maxCoeff());
        CHECK(inner < 1e-9 * f.cwiseAbs().maxCoeff() + 1e-15 * K.coeffs().cwiseAbs().maxCoeff());
        CHECK(q.dot(f) == Approx(2 * state.square(section)).epsilon(1e-9).margin(1e-12));
      }
    }
}

TEST_CASE("patch test: with the states prescribed on the boundary the inner nodes are found") {
  for (const Cells cells : {Cells::triangles, Cells::quadrilaterals}) {
    Plate p = testing::plate(2, 1, 4, 3, cells, 0.3);
    p.hold([](const Vector3d& x) { return !inside(x); }, {0, 1, 2, 3, 4, 5});
    const auto section = testing::skew_laminate();
    const Plate all = testing::plate(2, 1, 4, 3, cells, 0.3);
    const testing::SparseMatrix K = testing::stiffness(p, section), whole = testing::stiffness(all, section);
    const VectorXd exact = testing::nodal(states().back(), p.nodes);
    VectorXd boundary = exact;
    for (int d = 0; d < p.dofs(); ++d)
      if (!p.constrained[d]) boundary[d] = 0;
    VectorXd load = -(whole * boundary);
    for (int d = 0; d < p.dofs(); ++d)
      if (p.constrained[d]) load[d] = exact[d];
    CHECK(testing::relative_error(testing::solved(K, load), exact) < 1e-9);
  }
}

TEST_CASE("a cross-ply strip under tension curves as classical lamination theory says") {
  const fem::ShellSection section =
      fem::shell_section({{testing::carbon, 1e-3, 0}, {testing::carbon, 1e-3, M_PI / 2}}, 0, {1, 0, 0});
  Eigen::Matrix<double, 6, 6> ABD;
  ABD << section.A, section.B(), section.B(), section.D();
  const double N = 1e4;
  const Eigen::Matrix<double, 6, 1> answer = ABD.ldlt().solve(N * Eigen::Matrix<double, 6, 1>::Unit(0));
  REQUIRE(std::abs(answer[3]) > 0.1);  // it does curve [1/m]
  ConstantState state{Eigen::Matrix2d::Zero(), answer.tail<3>()};
  state.gradient.diagonal() = answer.head<2>();

  const Plate p = testing::plate(2, 1, 4, 3, Cells::crossed, 0.3);
  const VectorXd f = testing::stiffness(p, section) * testing::nodal(state, p.nodes);
  Eigen::Matrix<double, 6, 1> end = Eigen::Matrix<double, 6, 1>::Zero();
  double elsewhere = 0;
  for (std::size_t i = 0; i < p.nodes.size(); ++i) {
    const Vector3d& x = p.nodes[i];
    if (x.x() > 2 - 1e-9) {
      end += f.segment<6>(6 * i);
      end[5] -= (x.y() - 0.5) * f[6 * i];
    } else if (x.x() > 1e-9) {
      elsewhere = std::max(elsewhere, f.segment<5>(6 * i).cwiseAbs().maxCoeff());
    }
  }
  CHECK(end[0] == Approx(N).epsilon(1e-10));  // width 1: the force, and no other resultant
  CHECK(end.tail<5>().cwiseAbs().maxCoeff() < 1e-9 * N);
  CHECK(elsewhere < 1e-9 * N);
}

TEST_CASE("in-plane bending of a rectangle of any aspect ratio has the energy of the beam") {
  // Felippa 2003: the optimal template, u = -x y, v = x^2 / 2, rotation x at the corners of a x 1: U = E I a / 2
  for (const double nu : {0.0, 0.3, 0.45})
    for (const double a : {1.0, 2.0, 4.0, 16.0})
      for (const Cells cells : {Cells::triangles, Cells::quadrilaterals}) {
        const Plate p = testing::plate(a, 1, 1, 1, cells);
        VectorXd q = VectorXd::Zero(24);
        for (int i = 0; i < 4; ++i) {
          const double x = p.nodes[i].x() - a / 2, y = p.nodes[i].y() - 0.5;
          q[6 * i] = -x * y;
          q[6 * i + 1] = x * x / 2;
          q[6 * i + 5] = x;
        }
        const auto section = fem::shell_section({{fem::isotropic(12, nu, 1), 1}});
        CHECK(q.dot(testing::stiffness(p, section) * q) == Approx(a).epsilon(1e-9));
      }
}
