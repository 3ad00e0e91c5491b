#include "floe/fem/element.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "differences.h"
#include "random.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The element of the manual's page on extending floe: from [bar] to [end] it stands there word by word.
namespace {

// [bar]
/// Planar bar: it stretches and has mass, and does not bend. Linear u and v, dofs (u, v, rotation) at two nodes, body
/// axes; the rotations are not used.
///
///   eps = u' + 1/2 v'^2   along and across the bar, the same everywhere in it
fem::ElementMaps planar_bar(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double EA, double rhoA) {
  const double length = (to - from).norm();
  const Eigen::RowVector2d along = (to - from).transpose() / length, across(-along.y(), along.x());
  MatrixXd stretch(1, 6), slope(1, 6);
  stretch << -along / length, 0, along / length, 0;
  slope << -across / length, 0, across / length, 0;

  fem::ElementMaps maps;
  maps.bending = MatrixXd::Zero(6, 6);
  maps.membrane.push_back({length, MatrixXd::Constant(1, 1, EA), stretch, slope, {MatrixXd::Ones(1, 1)}});
  for (const double s : {0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12)}) {  // Gauss: exact for N'N
    MatrixXd N = MatrixXd::Zero(2, 6);
    N.leftCols(2) = (1 - s) * Eigen::Matrix2d::Identity();
    N.middleCols(3, 2) = s * Eigen::Matrix2d::Identity();
    maps.mass.push_back({rhoA * length / 2, from + s * (to - from), N});
  }
  return maps;
}
// [end]

constexpr double EA = 1e4;

struct Forces {
  VectorXd force;
  MatrixXd tangent;
};

Forces forces(const fem::ElementMaps& maps, const VectorXd& q) {
  const body::Elasticity elasticity = fem::elasticity(maps, MatrixXd::Identity(6, 6));
  body::ElasticityWork work;
  Forces at{VectorXd::Zero(6), MatrixXd::Zero(6, 6)};
  body::add_force(elasticity, q, work, at.force);
  body::add_tangent(elasticity, q, 1, work, at.tangent);
  return at;
}

}  // namespace

// Two bars in line, pinned at their far ends and pushed across by w at the joint: eps = w^2/2a^2, P = 2 EA eps w/a.
TEST_CASE("worked example, element: two bars in line carry a force across them by their stretch alone") {
  const double a = 2, w = 0.1;
  const fem::ElementMaps left = planar_bar({-a, 0}, {0, 0}, EA, 1), right = planar_bar({0, 0}, {a, 0}, EA, 1);
  VectorXd of_left = VectorXd::Zero(6), of_right = VectorXd::Zero(6);
  of_left[4] = of_right[1] = w;
  CHECK(forces(left, of_left).force[4] + forces(right, of_right).force[1] ==
        Approx(EA * std::pow(w / a, 3)).epsilon(1e-12));
  CHECK(forces(left, of_left).force[3] + forces(right, of_right).force[0] == Approx(0).margin(1e-12));
}

TEST_CASE("worked example, element: what follows from the maps is consistent") {
  const fem::ElementMaps maps = planar_bar({1, 2}, {4, 6}, EA, 3);
  testing::Random random(5);
  const VectorXd q = 0.3 * random.vector(6), a = random.vector(6), b = random.vector(6);
  const auto force = [&](const VectorXd& x) { return forces(maps, x).force; };
  const auto energy = [&](const VectorXd& x) {
    return body::energy(fem::elasticity(maps, MatrixXd::Identity(6, 6)), x);
  };
  CHECK(testing::relative_error(forces(maps, q).force, testing::gradient(energy, q, 1e-3)) < 1e-9);
  CHECK(testing::relative_error(forces(maps, q).tangent, testing::jacobian(force, q, 1e-3)) < 1e-9);
  // the loads of modal derivatives: K(q) to first order in q = eta b, times a
  const auto along_b = [&](double eta) { return VectorXd(forces(maps, eta * b).tangent * a); };
  CHECK(testing::relative_error(fem::stiffness_derivative(maps, a, b), testing::derivative(along_b, 0, 1e-3)) < 1e-9);

  const body::Inertia inertia = fem::inertia(maps, MatrixXd::Identity(6, 6));
  CHECK(inertia.m == Approx(3 * 5).epsilon(1e-14));
  CHECK((inertia.s0 / inertia.m - Eigen::Vector2d(2.5, 4)).norm() < 1e-14);
  VectorXd rotation(6);  // a rigid rotation, to first order: no strain, and the moment of inertia about the origin
  rotation << -2, 1, 1, -6, 4, 1;
  CHECK((maps.stiffness() * rotation).norm() < 1e-9 * EA);
  CHECK(rotation.dot(maps.mass_matrix() * rotation) == Approx(inertia.C0.trace()).epsilon(1e-12));
}
