#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "corotational_chain.h"

using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// (u, v, theta) of the tip of a cantilever L = EI = 1 under a tip load, reached in `increments` equal ones.
Vector3d tip(int elements, double EA, const Vector3d& load, int increments = 4) {
  const CorotationalChain chain(elements, 1, {EA, 1, 1, 0});
  VectorXd q = chain.zero(), force = chain.zero();
  for (int k = 1; k <= increments; ++k) {
    force.tail<3>() = load * k / increments;
    q = chain.equilibrium(force, q);
  }
  return q.tail<3>();
}

}  // namespace

TEST_CASE("corotational cantilever rolls up under an end moment", "[corotational]") {
  // exact: a circular arc of angle phi = M L / EI, whatever EA
  const auto error = [](int elements, double phi) -> Vector3d {
    return tip(elements, 1e4, {0, 0, phi}, 1 + static_cast<int>(2 * phi)) -
           Vector3d(std::sin(phi) / phi - 1, (1 - std::cos(phi)) / phi, phi);
  };
  const double pi = std::numbers::pi;
  // A quarter circle at 8 elements. The cubic's chord l0 (1 - a^2/6) against l0 sin(a)/a, a = phi/16: a^4/120 of 2/pi.
  CHECK(error(8, pi / 2).cwiseAbs().maxCoeff() == Approx(std::pow(pi / 32, 4) / 120 * 2 / pi).epsilon(0.01));
  for (const double phi : {pi / 2, 1.5 * pi}) {
    const double order = std::log2(error(8, phi).norm() / error(16, phi).norm());
    CHECK(order == Approx(4).margin(0.05));
  }
  CHECK(error(4, 2 * pi).norm() < 1e-12);  // a full circle: by symmetry on any mesh
  CHECK(error(32, 9 * pi).norm() < 1e-4);  // four turns and a half
}

TEST_CASE("corotational cantilever under a dead tip load follows the elastica", "[corotational]") {
  // P L^2/EI, w/L, u/L by elliptic integrals (inextensible; EA L^2/EI = 1e9 stretches by 1e-9 here)
  const double exact[4][3] = {{0.1, .033295319268, .000665399963},
                              {0.5, .16214357566, .015918962471},
                              {1, .30172077380, .056433236283},
                              {2, .49345748040, .16064172083}};
  for (const auto& [load, w, u] : exact) {
    const auto error = [&, w = w, u = u, load = load](int elements) -> Vector3d {
      return tip(elements, 1e9, {0, load, 0}) - Vector3d(-u, w, 0);
    };
    const double coarse = error(4).head<2>().norm(), fine = error(8).head<2>().norm();
    CHECK(std::log2(coarse / fine) == Approx(4).margin(0.1));
    CHECK(error(32).head<2>().norm() < 1e-8);
  }
}

TEST_CASE("corotational cantilever does not lock", "[corotational]") {
  // P L^2/EI = 1 on 10 elements: the elastica at every slenderness L/r = sqrt(EA L^2/EI)
  for (const double slenderness : {1e3, 1e4, 1e5})
    CHECK(tip(10, slenderness * slenderness, {0, 1, 0})[1] == Approx(.30172077380).epsilon(3e-6));
}
