#include <catch2/catch.hpp>
#include <cmath>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;
using Eigen::Vector3d;

// Bodies that have no mesh: mass, centre and inertia are given.

// From rest at 90 deg: T = 4 K(sin 45 deg) sqrt((J + m a^2) / (m g a)).
TEST_CASE("rigid bodies by their mass: the period of a physical pendulum at a large amplitude") {
  const double m = 2, a = 0.5, J = 0.1, g = 9.81;
  const double T = 4 * std::comp_ellint_1(std::sqrt(0.5)) * std::sqrt((J + m * a * a) / (m * g * a));
  for (const bool space : {false, true}) {
    const History at = move(space ? R"yaml(
gravity: [0, 0, -9.81]
bodies:
  pendulum: {rigid: {mass: 2, centre: [0.7, 0.4, 0.1], inertia: [0.3, 0.1, 0.35, 0, 0.02, 0]}}
joints: {hinge: {type: revolute, between: [ground, {body: pendulum, node: [0.2, 0, 0.1]}], axis: [0, 1, 0]}}
motion: {end: 4, step: 2e-3, spectral_radius: 0.99}
probes: {pendulum: {formula: hinge.angle}}
)yaml"
                                  : R"yaml(
gravity: [0, -9.81]
bodies:
  pendulum: {rigid: {mass: 2, centre: [0.5, 0.3], inertia: 0.1}}
joints: {hinge: {type: revolute, between: [ground, {body: pendulum, node: [0, 0.3]}]}}
motion: {end: 4, step: 2e-3, spectral_radius: 0.99}
probes: {pendulum: {formula: -hinge.angle}}
)yaml",
                            Formulation::vm_md);
    std::vector<double> down;  // times at the lowest point
    const auto& x = at["pendulum.value"];
    for (std::size_t i = 1; i < x.size(); ++i)
      if ((x[i - 1] - M_PI / 2) * (x[i] - M_PI / 2) < 0)
        down.push_back(at.t[i - 1] + (at.t[i] - at.t[i - 1]) * (M_PI / 2 - x[i - 1]) / (x[i] - x[i - 1]));
    REQUIRE(down.size() >= 3);
    CHECK(down[2] - down[0] == Approx(T).epsilon(2e-5));
    CHECK(down[0] == Approx(T / 4).epsilon(2e-5));
    CHECK(drift(at) < 1e-4);
  }
}

// Euler's equations without moment, J1 < J2 < J3 and L^2 > 2 T J2 (Whittaker, Analytical Dynamics, 69): w = (a1 cn, a2
// sn, a3 dn)(s t | k^2), up to signs.
TEST_CASE("rigid bodies by their mass: a free asymmetric top rotates by Jacobi's functions") {
  const Vector3d J(1.0, 1.6, 2.2), w0(1.2, 0, 1.5);
  const double twice_T = w0.dot(J.cwiseProduct(w0)), L2 = J.cwiseProduct(w0).squaredNorm();
  REQUIRE(L2 > twice_T * J[1]);
  const double s = std::sqrt((J[2] - J[1]) * (L2 - twice_T * J[0]) / J.prod());
  const double k = std::sqrt((J[1] - J[0]) * (twice_T * J[2] - L2) / ((J[2] - J[1]) * (L2 - twice_T * J[0])));
  const double a2 = std::sqrt((twice_T * J[2] - L2) / (J[1] * (J[2] - J[1]))), quarter = std::comp_ellint_1(k) / s;
  const History at = move(R"yaml(
bodies:
  top:
    rigid: {mass: 3, centre: [0.4, -0.2, 0.7], inertia: [1.0, 1.6, 2.2]}
    initial: {angular_velocity: [1.2, 0, 1.5]}
motion: {end: 12, step: 2e-3, spectral_radius: 0.99}
probes:
  w: {at: top.centre, quantity: angular_velocity}
  r: {at: top.centre, quantity: rotation}
)yaml",
                          Formulation::vm_md);
  double worst = 0;
  std::vector<double> second;
  for (std::size_t i = 0; i < at.t.size(); ++i) {
    const Vector3d r(at["r.rx"][i], at["r.ry"][i], at["r.rz"][i]);
    second.push_back((math::rotation(r).transpose() * vector_at(at, "w", i)).y());
    if (at.t[i] > 0.95 * quarter) continue;
    worst = std::max(worst, std::abs(std::ellint_1(k, std::asin(std::abs(second[i]) / a2)) / s - at.t[i]));
  }
  CHECK(worst < 1e-5 * quarter);
  std::vector<double> zeros;
  for (std::size_t i = 1; i < second.size(); ++i)
    if (second[i - 1] * second[i] < 0)
      zeros.push_back(at.t[i - 1] + (at.t[i] - at.t[i - 1]) * second[i - 1] / (second[i - 1] - second[i]));
  REQUIRE(zeros.size() >= 2);
  CHECK(zeros[0] == Approx(2 * quarter).epsilon(2e-5));
  CHECK(zeros[1] == Approx(4 * quarter).epsilon(2e-5));
}

TEST_CASE("rigid bodies by their mass: a rod's mass, centre and inertia move as its mesh does") {
  const std::string scene = R"yaml(
gravity: [0, -9.81]
bodies:
  arm: {mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}, section: {EA: 1e4, EI: 3, rhoA: 1}}
  rod: {$rod, initial: {position: [1, 0], angle: 0.4}}
joints:
  root: {type: revolute, between: [ground, arm.start]}
  hinge: {type: revolute, between: [arm.end, {body: rod, node: [0, 0]}]}
motion: {end: 0.5, step: 2e-3}
probes: {tip: {at: {body: rod, node: [1, 0]}}}
)yaml";
  for (const Formulation formulation : {Formulation::vm_md, Formulation::nlffr, Formulation::cfr}) {
    const History mesh = move(fill(scene, {{"rod",
                                            "rigid: true, mesh: {line: {from: [0, 0], to: [1, 0], elements: 1}}, "
                                            "section: {EA: 1, EI: 1, rhoA: 3, rhoI: 0}"}}),
                              formulation),
                  mass = move(fill(scene, {{"rod", "rigid: {mass: 3, centre: [0.5, 0], inertia: 3/12}"}}), formulation);
    CHECK(relative_error(mass, mesh, "tip.x") < 1e-4);  // the origins of their frames differ
    CHECK(relative_error(mass, mesh, "tip.y") < 1e-4);  // the origins of their frames differ
  }
}
