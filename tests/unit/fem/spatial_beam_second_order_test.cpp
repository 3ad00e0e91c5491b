#include <catch2/catch.hpp>
#include <cmath>

#include "differences.h"
#include "eigenvalues.h"
#include "floe/fem/spatial_beam.h"
#include "random.h"
#include "spatial_beam_chain.h"

using namespace floe;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using fem::MembraneStrain;
using fem::Strains;
using testing::Random;
using testing::relative_error;

namespace {

constexpr fem::SpatialBeamStrain second_order{MembraneStrain::averaged, false, Strains::second_order};
const fem::BeamPlace oblique{{0.3, -0.2, 0.5}, {1.1, 0.4, 0.1}, {0.2, 0.9, 0.7}};

/// Eccentric, unsymmetric or with shear.
fem::SpatialBeamSection section(bool eccentric, bool shears) {
  fem::SpatialBeamSection s{50, 0.9, 0.7, 0.3, 0.4, 3, 0.25, 0.2, -0.08};
  if (eccentric) s.centroid << 0.1, -0.2, s.shear_centre << -0.05, 0.15;
  if (shears) s.GA << 20, 13;
  return s;
}

double energy(const fem::ElementMaps& maps, const VectorXd& q) {
  return body::energy(fem::elasticity(maps, MatrixXd::Identity(12, 12)), q);
}

/// A rigid motion of two nodes: rotation vector a t about the origin, and a shift.
VectorXd rigid(const fem::BeamPlace& place, double a, const Vector3d& t) {
  const Matrix3d R = Eigen::AngleAxisd(a * t.norm(), t.normalized()).toRotationMatrix();
  VectorXd q(12);
  q << R * place.from - place.from, a * t, R * place.to - place.to, a * t;
  q.segment<3>(0) += a * Vector3d(0.2, 0.1, -0.3), q.segment<3>(6) += a * Vector3d(0.2, 0.1, -0.3);
  return q;
}

/// Of what is proportional to a power of a.
template <class Function>
double order(const Function& f, double a) {
  return std::log2(f(a) / f(a / 2));
}

/// The share of the load at which the tangent of the free dofs is singular, by bisection.
template <class Load>
double critical(const testing::BeamChain& chain, const Load& load) {
  const auto stable = [&](double share) {
    const VectorXd q = testing::nonlinear_deflection(chain, share * load);
    MatrixXd K = MatrixXd::Zero(chain.dofs(), chain.dofs());
    for (std::size_t e = 0; e < chain.elements.size(); ++e)
      K.block<12, 12>(6 * e, 6 * e) += chain.elements[e].tangent(q.segment<12>(6 * e));
    const MatrixXd free = K(chain.free, chain.free);
    return testing::eigenvalues(free)[0] > 0;
  };
  double low = 0.5, high = 1.5;
  while (high - low > 1e-4) (stable((low + high) / 2) ? low : high) = (low + high) / 2;
  return low;
}

}  // namespace

TEST_CASE("strains of second order have the linear stiffness of von Karman's, and in one plane their energy") {
  const bool eccentric = GENERATE(false, true), shears = GENERATE(false, true);
  const fem::SpatialBeamSection s = section(eccentric, shears);
  CHECK(relative_error(fem::spatial_beam(oblique, s, second_order).stiffness(),
                       fem::spatial_beam(oblique, s).stiffness()) < 1e-13);
  fem::SpatialBeamSection symmetric = section(false, shears);
  symmetric.EIyz = 0;
  const fem::BeamPlace along{{0, 0, 0}, {0.8, 0, 0}, {0, 1, 0}};
  VectorXd q = VectorXd::Zero(12);
  for (const int dof : {0, 1, 5, 6, 7, 11}) q[dof] = std::sin(1. + dof);
  CHECK(energy(fem::spatial_beam(along, symmetric, second_order), q) ==
        Approx(energy(fem::spatial_beam(along, symmetric), q)).epsilon(1e-12));
}

TEST_CASE("a rigid rotation by a costs strains of second order an energy of order a^6, von Karman's of a^4") {
  const bool eccentric = GENERATE(false, true), shears = GENERATE(false, true);
  const fem::ElementMaps exact = fem::spatial_beam(oblique, section(eccentric, shears), second_order),
                         rough = fem::spatial_beam(oblique, section(eccentric, shears));
  for (const Vector3d& t : {Vector3d(0.3, -0.5, 0.4), Vector3d(-0.2, 0.6, 0.7), Vector3d(0.8, 0.1, -0.4)}) {
    CHECK(order([&](double a) { return energy(exact, rigid(oblique, a, t)); }, 0.02) == Approx(6).margin(0.1));
    CHECK(order([&](double a) { return energy(rough, rigid(oblique, a, t)); }, 0.02) == Approx(4).margin(0.1));
  }
}

TEST_CASE("a kinked line of two members, turned anyhow, costs an energy of order a^6") {
  const fem::BeamPlace first{{0, 0, 0}, {0.7, 0.1, 0}, {0, 1, 0.2}},
      second{{0.7, 0.1, 0}, {0.9, 0.6, 0.4}, {1, 0, 0.3}};
  const fem::SpatialBeamSection s = section(true, false);
  const fem::ElementMaps a = fem::spatial_beam(first, s, second_order), b = fem::spatial_beam(second, s, second_order);
  const auto whole = [&](double rotation, const Vector3d& t) {  // the node between has one rotation vector
    return energy(a, rigid(first, rotation, t)) + energy(b, rigid(second, rotation, t));
  };
  for (const Vector3d& t : {Vector3d(0.3, -0.5, 0.4), Vector3d(0.8, 0.1, -0.4)})
    CHECK(order([&](double rotation) { return whole(rotation, t); }, 0.02) == Approx(6).margin(0.1));
}

TEST_CASE("strains of second order: force is the gradient of the energy, tangent that of the force") {
  const bool wagner = GENERATE(false, true), shears = GENERATE(false, true);
  const fem::ElementMaps maps =
      fem::spatial_beam(oblique, section(true, shears), {MembraneStrain::averaged, wagner, Strains::second_order});
  const body::Elasticity e = fem::elasticity(maps, MatrixXd::Identity(12, 12));
  const VectorXd q = Random(34).vector(12), a = Random(35).vector(12);
  body::ElasticityWork work;
  const auto force = [&](const VectorXd& x) {
    VectorXd f = VectorXd::Zero(12);
    body::add_force(e, x, work, f);
    return f;
  };
  const auto tangent = [&](const VectorXd& x) { return maps.tangent(x); };
  CHECK(relative_error(force(q), testing::gradient([&](const VectorXd& x) { return body::energy(e, x); }, q, 0.1)) <
        1e-11);
  CHECK(relative_error(tangent(q), testing::jacobian(force, q, 0.1)) < 1e-11);
  const auto along = [&](double eta) { return VectorXd(tangent(eta * q) * a); };
  CHECK(relative_error(fem::stiffness_derivative(maps, a, q), testing::derivative(along, 0, 0.1)) < 1e-11);
}

// Timoshenko & Gere, Theory of elastic stability, art. 6.2 and 6.3, times (1 + (EIy + GJ)/2EIz) for the bending before.
TEST_CASE("lateral buckling of a narrow beam within 0.3 % from 16 elements: Michell's loads") {
  const double EIy = 1e-3, GJ = 1.5e-3, L = 1, pi = 3.14159265358979323846;
  const fem::SpatialBeamSection s{1e4, EIy, 1, 0, GJ, 0, 0, 0, 0};
  const double before = 1 + (EIy + GJ) / 2;
  const testing::BeamChain cantilever = testing::beam_chain(16, L, s, testing::clamped_root, second_order);
  VectorXd force = VectorXd::Zero(cantilever.dofs());
  force[cantilever.dofs() - 5] = 4.0126 * std::sqrt(EIy * GJ) / (L * L);
  CHECK(critical(cantilever, force) == Approx(before).epsilon(0.003));
  const int end = 6 * 16;
  const testing::BeamChain constrained =
      testing::beam_chain(16, L, s, {0, 1, 2, 3, end + 1, end + 2, end + 3}, second_order);
  VectorXd moments = VectorXd::Zero(constrained.dofs());
  moments[5] = -pi * std::sqrt(EIy * GJ) / L, moments[end + 5] = -moments[5];
  CHECK(critical(constrained, moments) == Approx(before).epsilon(0.003));
}

// At 0.9 of the load with 0.005 of it sideways, a geometrically exact rod (lateral_buckling.py); 0.0067 without
// coupling.
TEST_CASE("a narrow cantilever near its lateral buckling load deflects as the geometrically exact rod") {
  const fem::SpatialBeamSection s{1e6, 1, 1e3, 0, 1, 0, 0, 0, 0};
  const testing::BeamChain chain = testing::beam_chain(32, 1, s, testing::clamped_root, second_order);
  Eigen::Matrix<double, 6, 1> load;
  load << 0, -4.0126, 4.0126 * 0.005, 0, 0, 0;
  VectorXd q;
  for (int step = 1; step <= 10; ++step)
    q = testing::nonlinear_deflection(chain, testing::tip_load(chain, 0.09 * step * load), q);
  CHECK(q[6 * 32 + 1] == Approx(-0.001690762).epsilon(0.01));
  CHECK(q[6 * 32 + 2] == Approx(0.024877689).epsilon(0.01));
}

// A force across both axes and a torque: with locking eight elements would be far off, more so the more slender.
TEST_CASE("strains of second order do not lock from slenderness 1e1 to 1e4") {
  const auto tip = [](int n, double slenderness, double ratio) {
    const double EI = 1, EA = slenderness * slenderness;
    const fem::SpatialBeamSection s{EA, EI, ratio * EI, 0, 0.8, 0, 0, 0, 0};
    const testing::BeamChain chain = testing::beam_chain(n, 1, s, testing::clamped_root, second_order);
    Eigen::Matrix<double, 6, 1> load;
    load << 0, ratio > 1 ? 1.5 : 0.5, 0.6, 0.2, 0, 0;
    VectorXd q;
    for (int step = 1; step <= 10; ++step)
      q = testing::nonlinear_deflection(chain, testing::tip_load(chain, 0.1 * step * load), q);
    return VectorXd(q.tail<6>());
  };
  for (const double ratio : {1., 1000.})
    for (const double slenderness : {1e1, 1e2, 1e3, 1e4}) {
      INFO(ratio << " " << slenderness);
      CHECK(relative_error(tip(8, slenderness, ratio), tip(32, slenderness, ratio)) < 0.01);
    }
}
