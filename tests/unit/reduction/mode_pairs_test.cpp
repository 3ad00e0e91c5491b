#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <numbers>

#include "bodies_in_space.h"
#include "eigenvalues.h"
#include "options.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Kind;
using testing::SpatiallyConstrained;
using testing::Spread;

namespace {

/// Equal round beams of length one that stick out of a hub, original node 0, in the plane z = 0. Constrained at the
/// hub, the body has each frequency of one of them twice as often as there are beams.
fem::Structure hub(MPI_Comm comm, int beams, int elements) {
  generate::Polyline lines{{{0, 0, 0}}, {}, {}, {}};
  for (int i = 0; i < beams; ++i) {
    const double angle = 2 * std::numbers::pi * i / beams;
    lines.points.emplace_back(std::cos(angle), std::sin(angle), 0);
    lines.segments.push_back({0, i + 1});
    lines.elements.push_back(elements);
  }
  const fem::SpatialBeam beam{{1e5, 1, 1, 0, 1e3, 1, 1e-5, 1e-5, 0, {0, 0}, {0, 0}}, {0, 0, 1}, {}};
  return testing::structure_of(generate::polyline(comm, lines), {beam}, Spread::shuffled);
}

/// All eigenvalues but those of rigid motions, from dense matrices under conditions.
std::vector<double> dense_values(const SpatiallyConstrained& body) {
  const fem::Conditions& constrained = body.holding.constrained;
  const MatrixXd M = testing::dense(body.structure, fem::mass(body.structure, constrained)),
                 K = testing::dense(body.structure, fem::stiffness(body.structure, constrained)) + M;  // shifted by one
  const Eigen::VectorXd ratios = testing::eigenvalues(M, K);
  std::vector<double> lambda;
  for (Eigen::Index i = K.cols(); i-- > 0;)
    if (const double theta = ratios[i]; theta > 1e-12 && theta < 1 - 1e-6) lambda.push_back(1 / theta - 1);
  return lambda;
}

void check_modes(const SpatiallyConstrained& body, int count, const std::vector<double>& lambda) {
  const reduction::Modes modes = body.modes(count);
  const petsc::MatHandle M = fem::mass(body.structure, body.holding.constrained);
  const petsc::VecHandle product = fem::field(body.structure);
  REQUIRE(std::ssize(modes.raw) == count);
  for (int i = 0; i < count; ++i) {
    CHECK(modes.omega[i] == Approx(std::sqrt(lambda[i])).epsilon(1e-7));
    CHECK(modes.residual[i] < 1e-6);
    std::vector<double> products(i + 1);
    const std::vector<Vec> others(modes.raw.begin(), modes.raw.begin() + i + 1);
    petsc::check(MatMult(M, modes.raw[i], product));
    petsc::check(VecMDot(product, i + 1, others.data(), products.data()));
    for (int j = 0; j <= i; ++j) CHECK(products[j] == Approx(i == j ? 1 : 0).margin(1e-6));
  }
}

}  // namespace

TEST_CASE("no mode is passed over where many have one frequency") {
  const auto [beams, elements] = GENERATE(std::pair{12, 3}, std::pair{16, 2});
  const SpatiallyConstrained body(hub(PETSC_COMM_WORLD, beams, elements), Kind::clamped, {0});
  const SpatiallyConstrained one(hub(PETSC_COMM_SELF, 1, elements), Kind::clamped, {0});
  std::vector<double> lambda;
  for (double value : dense_values(one)) lambda.insert(lambda.end(), beams, value);
  for (const int count : {4, beams, 2 * beams + 4, 3 * beams}) {
    INFO(beams << " beams, " << count);
    check_modes(body, count, lambda);
  }
}

TEST_CASE("no mode of a free body is passed over, its rigid motions are not counted") {
  const SpatiallyConstrained body(hub(PETSC_COMM_WORLD, 12, 2), Kind::mean_axis, {});
  const std::vector<double> lambda = dense_values(body);
  for (const int count : {6, 20, 40}) check_modes(body, count, lambda);
}

using Given = std::map<std::string, std::string>;

TEST_CASE("no mode is passed over where a cluster has more than a block, or the user's solver takes one by one") {
  const testing::Options options(GENERATE(as<Given>(), Given{}, Given{{"-modes_eps_type", "krylovschur"}},
                                          Given{{"-modes_eps_block_lanczos_size", "3"}}));
  const SpatiallyConstrained body(hub(PETSC_COMM_WORLD, 20, 6), Kind::clamped, {0});
  const SpatiallyConstrained one(hub(PETSC_COMM_SELF, 1, 6), Kind::clamped, {0});
  std::vector<double> lambda;
  for (double value : dense_values(one)) lambda.insert(lambda.end(), 20, value);
  check_modes(body, 30, lambda);
}

TEST_CASE("modes of one frequency are the same whether all of them are asked for or a few") {
  const SpatiallyConstrained body(hub(PETSC_COMM_WORLD, 30, 2), Kind::clamped, {0});
  const reduction::Modes all = body.modes(120), some = body.modes(70);  // of 60 and 60
  CHECK(all.left_out == 0);
  CHECK(some.left_out == 50);
  const petsc::VecHandle difference = fem::field(body.structure);
  for (int i = 0; i < 70; ++i) {
    double size = 0, whole = 0;
    petsc::check(VecWAXPY(difference, -1, all.raw[i], some.raw[i]));
    petsc::check(VecNorm(difference, NORM_2, &size));
    petsc::check(VecNorm(all.raw[i], NORM_2, &whole));
    INFO(i);
    CHECK(size < 1e-6 * whole);
  }
}

TEST_CASE("more modes of one frequency than are looked for are refused") {
  const SpatiallyConstrained body(hub(PETSC_COMM_WORLD, 160, 1), Kind::clamped, {0});
  CHECK_THROWS_WITH(body.modes(3), Catch::Contains("modes 1 to 320 have the same frequency; ask for as many"));
}

TEST_CASE("an eigenvalue solver that finds rigid motions is refused") {
  const SpatiallyConstrained body(hub(PETSC_COMM_WORLD, 4, 2), Kind::mean_axis, {});
  const testing::Options options(Given{{"-modes_eps_type", "lapack"}});
  CHECK_THROWS_WITH(body.modes(6), Catch::Contains("rigid motions"));
}
