#include "floe/fem/quadratic_beam.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "eigenvalues.h"
#include "floe/error.h"
#include "random.h"

using namespace floe;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

const fem::BeamCurve bent{{0, 0, 0}, {1, 0.1, 0.2}, {0.5, 0.15, 0}, {0, 0.2, 1}};

fem::SpatialBeamSection eccentric() {
  fem::SpatialBeamSection s;
  s.EA = 1e6, s.EIy = 2e2, s.EIz = 3e2, s.EIyz = 20, s.GJ = 1e2;
  s.rhoA = 2, s.rhoIy = 1e-3, s.rhoIz = 2e-3, s.rhoIyz = 2e-4;
  s.centroid = {0.01, 0.02}, s.shear_centre = {-0.01, 0.005}, s.GA = {2e5, 3e5};
  return s;
}

std::vector<Vector3d> nodes_of(const fem::BeamCurve& c) { return {c.from, c.to, c.middle}; }

double energy_of(const fem::ElementMaps& maps, const VectorXd& q) {
  double twice = q.dot(maps.bending * q);
  for (const fem::StrainPoint& g : maps.membrane) {
    const VectorXd e = g.L * q + g.bilinear(g.G * q, g.G * q) / 2;
    twice += g.weight * e.dot(g.D * e);
  }
  return twice / 2;
}

/// Elements of one line, first node clamped: dofs of the others.
struct Chain {
  std::vector<fem::ElementMaps> maps;
  std::vector<std::array<int, 3>> nodes;
  int count = 0;
  Chain(int n, const std::function<Vector3d(double)>& at, const Vector3d& orientation,
        const fem::SpatialBeamSection& section, const fem::SpatialBeamStrain& strain = {}) {
    count = 2 * n + 1;
    for (int e = 0; e < 2 * n; e += 2) {
      nodes.push_back({e, e + 2, e + 1});
      const double m = 2 * n;
      maps.push_back(fem::quadratic_beam({at(e / m), at((e + 2) / m), at((e + 1) / m), orientation}, section, strain));
    }
  }
  MatrixXd sum(const std::function<MatrixXd(std::size_t)>& of) const {
    MatrixXd K = MatrixXd::Zero(6 * count, 6 * count);
    for (std::size_t e = 0; e < maps.size(); ++e) {
      const MatrixXd own = of(e);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) K.block<6, 6>(6 * nodes[e][i], 6 * nodes[e][j]) += own.block<6, 6>(6 * i, 6 * j);
    }
    return K.bottomRightCorner(6 * count - 6, 6 * count - 6);
  }
  MatrixXd stiffness() const {
    return sum([&](std::size_t e) { return maps[e].stiffness(); });
  }
  VectorXd tip(const VectorXd& load) const {
    VectorXd f = VectorXd::Zero(6 * count - 6);
    f.tail<6>() = load;
    return stiffness().ldlt().solve(f).tail<6>();
  }
};

Vector3d straight(double s) { return {s, 0, 0}; }

}  // namespace

TEST_CASE("a beam of three nodes has six rigid motions and no other that cost nothing") {
  fem::SpatialBeamStrain strain;
  strain.strains = GENERATE(fem::Strains::von_karman, fem::Strains::second_order);
  const MatrixXd K = fem::quadratic_beam(bent, eccentric(), strain).stiffness();
  MatrixXd rigid = MatrixXd::Zero(18, 6);
  for (int i = 0; i < 3; ++i)
    for (int d = 0; d < 3; ++d) {
      rigid(6 * i + d, d) = rigid(6 * i + 3 + d, 3 + d) = 1;
      rigid.block<3, 1>(6 * i, 3 + d) = Vector3d(Vector3d::Unit(d)).cross(nodes_of(bent)[i]);
    }
  CHECK((K * rigid).norm() < 1e-12 * K.norm());
  const Eigen::VectorXd lambda = testing::eigenvalues(K);
  CHECK((lambda.array() < 1e-10 * lambda[17]).count() == 6);
}

TEST_CASE("two elements of three nodes have the ends of cantilevers, however slender") {
  const double radius = GENERATE(1e-1, 1e-2, 1e-4);
  fem::SpatialBeamSection s;
  s.EA = 1, s.EIy = radius * radius, s.EIz = 2 * s.EIy, s.GJ = 1.5 * s.EIy, s.GA = {0.3, 0.4};
  Eigen::Matrix<double, 6, 1> load;
  load << 0.1, 1, 2, 0.5, 0, 0;
  const VectorXd q = Chain(2, straight, {0, 1, 0}, s).tip(load);
  CHECK(q[0] == Approx(0.1));
  CHECK(q[1] == Approx(1 / (3 * s.EIz) + 1 / s.GA[0]));
  CHECK(q[2] == Approx(2 / (3 * s.EIy) + 2 / s.GA[1]));
  CHECK(q[3] == Approx(0.5 / s.GJ));
  s.GA.setConstant(std::numeric_limits<double>::infinity());
  CHECK(Chain(2, straight, {0, 1, 0}, s).tip(load)[1] == Approx(1 / (3 * s.EIz)).epsilon(1e-4));
}

TEST_CASE("a quarter of a circle under a force at its end") {
  constexpr double pi = 3.14159265358979, R = 2;
  fem::SpatialBeamSection s;
  s.EA = 1e8, s.EIy = 3, s.EIz = 3, s.GJ = 2;
  const auto circle = [](double t) { return Vector3d(R * std::sin(pi / 2 * t), R * (1 - std::cos(pi / 2 * t)), 0); };
  Eigen::Matrix<double, 6, 1> load = Eigen::Matrix<double, 6, 1>::Zero();
  load[1] = 1, load[2] = 1;
  const VectorXd q = Chain(4, circle, {0, 0, 1}, s).tip(load);
  // Castigliano: in the plane int R^2 (1 - sin)^2 R/EI; across int (R sin)^2 R/EI + (R (1 - cos))^2 R/GJ
  CHECK(q[1] == Approx(R * R * R * (3 * pi / 4 - 2) / 3).epsilon(2e-3));
  CHECK(q[2] == Approx(R * R * R * (pi / 4 / 3 + (3 * pi / 4 - 2) / 2)).epsilon(2e-3));
}

TEST_CASE("a rigid rotation of a beam of three nodes costs energy of order a^6") {
  fem::SpatialBeamStrain strain;
  strain.strains = fem::Strains::second_order;
  const fem::ElementMaps maps = fem::quadratic_beam(bent, eccentric(), strain);
  CHECK(maps.bending.isZero(0));
  const auto energy = [&](double a) {
    const Vector3d theta = a * Vector3d(0.5, -0.7, 0.4);
    const Matrix3d R = Eigen::AngleAxisd(theta.norm(), theta.normalized()).toRotationMatrix();
    VectorXd q(18);
    for (int i = 0; i < 3; ++i) q.segment<6>(6 * i) << R * nodes_of(bent)[i] - nodes_of(bent)[i] + theta, theta;
    return energy_of(maps, q);
  };
  CHECK(std::log2(energy(0.1) / energy(0.05)) > 5.9);
}

TEST_CASE("the tangent of beams of three nodes is that of their energy") {
  fem::SpatialBeamStrain strain;
  strain.strains = GENERATE(fem::Strains::von_karman, fem::Strains::second_order);
  strain.wagner = GENERATE(false, true);
  const fem::ElementMaps maps = fem::quadratic_beam(bent, eccentric(), strain);
  testing::Random random(11);
  const VectorXd q = 0.1 * random.vector(18), d = random.vector(18);
  double error[2];
  for (int k : {0, 1}) {
    const double h = k ? 1e-3 : 2e-3;
    const double second = (energy_of(maps, q + h * d) - 2 * energy_of(maps, q) + energy_of(maps, q - h * d)) / (h * h);
    error[k] = std::abs(second / d.dot(maps.tangent(q) * d) - 1);
  }
  CHECK(error[1] < 1e-4);
  CHECK(error[0] / error[1] == Approx(4).epsilon(0.05));
}

TEST_CASE("a slender line of beams rolls up under an end moment without locking") {
  const double slenderness = GENERATE(1e2, 1e5);
  fem::SpatialBeamSection s;
  s.EA = slenderness * slenderness, s.EIy = s.EIz = 1, s.GJ = 1;
  fem::SpatialBeamStrain strain;
  strain.strains = fem::Strains::second_order;
  const Chain chain(8, straight, {0, 1, 0}, s, strain);
  VectorXd q = VectorXd::Zero(6 * chain.count);
  const auto local = [&](std::size_t e) {
    VectorXd own(18);
    for (int i = 0; i < 3; ++i) own.segment<6>(6 * i) = q.segment<6>(6 * chain.nodes[e][i]);
    return own;
  };
  for (int round = 0; round < 40; ++round) {
    VectorXd rest = VectorXd::Zero(q.size());
    rest[q.size() - 1] = 0.5;  // M L / EI
    for (std::size_t e = 0; e < chain.maps.size(); ++e) {
      const VectorXd own = local(e);
      VectorXd f = VectorXd::Zero(18);
      for (const fem::StrainPoint& g : chain.maps[e].membrane) {
        const VectorXd slope = g.G * own, stress = g.weight * g.D * (g.L * own + g.bilinear(slope, slope) / 2);
        f += g.L.transpose() * stress;
        for (std::size_t k = 0; k < g.P.size(); ++k)
          f += stress[static_cast<Eigen::Index>(k)] * g.G.transpose() * (g.P[k] * slope);
      }
      for (int i = 0; i < 3; ++i) rest.segment<6>(6 * chain.nodes[e][i]) -= f.segment<6>(6 * i);
    }
    const MatrixXd K = chain.sum([&](std::size_t e) { return chain.maps[e].tangent(local(e)); });
    const VectorXd step = K.ldlt().solve(rest.tail(q.size() - 6));
    q.tail(q.size() - 6) += step;
    if (step.norm() < 1e-10 * q.norm()) break;
  }
  const auto end = q.tail<6>();
  CHECK(end[1] == Approx((1 - std::cos(0.5)) / 0.5).epsilon(3e-3));
  CHECK(end[0] == Approx(std::sin(0.5) / 0.5 - 1).epsilon(1e-2));
}

TEST_CASE("mass of a beam of three nodes") {
  const fem::SpatialBeamSection s = eccentric();
  const fem::ElementMaps maps = fem::quadratic_beam(bent, s);
  double length = 0, mass = 0, shared = 0;
  for (const body::MassPoint& point : fem::quadratic_beam_line(bent)) length += point.mass;
  for (const body::MassPoint& point : maps.mass) mass += point.mass;
  for (const fem::BeamShare& own : fem::quadratic_beam_shares(bent)) shared += own.length;
  CHECK(mass == Approx(s.rhoA * length).epsilon(1e-12));
  CHECK(shared == Approx(length).epsilon(1e-3));
  CHECK(maps.rotary.size() == 3);
}

TEST_CASE("beams of three nodes that are folded or have no direction are refused") {
  fem::BeamCurve curve = bent;
  curve.middle = {1.5, 0, 0};
  CHECK_THROWS_AS(fem::quadratic_beam(curve, eccentric()), InputError);
  curve = bent, curve.orientation.setZero();
  CHECK_THROWS_AS(fem::quadratic_beam(curve, eccentric()), InputError);
}
