#include "floe/fem/spatial_beam_fixed.h"

#include <catch2/catch.hpp>

#include "differences.h"
#include "random.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Random;
using testing::relative_error;

TEST_CASE("the arrays of fixed size give what the maps give") {
  const bool wagner = GENERATE(false, true);
  const fem::BeamPlace place{{0.3, -0.2, 0.5}, {1.1, 0.4, 0.1}, {0.2, 0.9, 0.7}};
  fem::SpatialBeamSection s{50, 0.9, 0.7, 0.3, 0.4, 3, 0.25, 0.2, -0.08};
  s.centroid << 0.1, -0.2;
  s.shear_centre << -0.05, 0.15;
  if (GENERATE(false, true)) s.GA << 4, 7;
  const fem::ElementMaps maps = fem::spatial_beam(place, s, {fem::MembraneStrain::averaged, wagner});
  const body::Elasticity e = fem::elasticity(maps, MatrixXd::Identity(12, 12));
  const fem::FixedSpatialBeam beam = fem::fixed_spatial_beam(place, s, wagner);

  CHECK(relative_error(fem::stiffness(beam), maps.stiffness()) < 1e-14);
  CHECK(relative_error(fem::spatial_beam_mass(place, s), maps.mass_matrix()) < 1e-13);
  const fem::Vector12 q = Random(41).vector(12), a = Random(42).vector(12);
  CHECK(fem::energy(beam, q) == Approx(body::energy(e, q)).epsilon(1e-13));
  body::ElasticityWork work;
  VectorXd f = VectorXd::Zero(12);
  body::add_force(e, q, work, f);
  CHECK(relative_error(fem::force(beam, q), f) < 1e-13);
  MatrixXd K = MatrixXd::Zero(12, 12);
  body::add_tangent(e, q, 1, work, K);
  CHECK(relative_error(fem::tangent(beam, q), K) < 1e-13);
  CHECK(relative_error(fem::stiffness_derivative(beam, a, q), fem::stiffness_derivative(maps, a, q)) < 1e-13);
}

TEST_CASE("a short element in space that is soft in shear keeps all digits of its stiffness") {
  const double l = 1e-4;
  const fem::BeamPlace place{{0, 0, 0}, {l, 0, 0}, {0, 1, 0}};
  fem::SpatialBeamSection s{50, 0.9, 0.7, 0, 0.4, 3, 0.25, 0.2, 0};
  s.GA << 1e-3, 2e-3;
  const fem::Matrix12 K = fem::stiffness(fem::fixed_spatial_beam(place, s, false));
  CHECK(K(1, 1) == Approx(s.GA[0] / l / (1 + s.GA[0] * l * l / (12 * s.EIz))).epsilon(1e-14));
  CHECK(K(2, 2) == Approx(s.GA[1] / l / (1 + s.GA[1] * l * l / (12 * s.EIy))).epsilon(1e-14));
}
