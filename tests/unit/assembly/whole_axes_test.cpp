#include "../../../src/assembly/whole_axes.h"

#include <catch2/catch.hpp>

#include "building.h"
#include "floe/error.h"

using namespace floe;
using assembly::AxesTerms;
using assembly::WholeAxes;
using dynamics::AccompanyingAxes;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// Axes f in the plane, local indices 3 to 5, that follow axes at 0 to 2 by three rows; multipliers 6 to 8.
struct Following {
  WholeAxes whole;
  AxesTerms terms;
  VectorXd q = VectorXd::Zero(9);

  /// @param sine  of the angle between both axes
  explicit Following(double sine) {
    whole.f.position = 3, whole.f.rotation = 5, whole.multipliers = 6;
    int rank = 0;
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    if (rank > 0) return;  // the rows are added over the ranks
    Matrix3d of_sine = Matrix3d::Zero();
    of_sine(1, 0) = 1;  // (A_f'A)_21
    const Matrix3d none = Matrix3d::Zero();
    std::vector<AccompanyingAxes::Row> rows{{Vector3d::UnitX(), none.reshaped()},
                                            {Vector3d::UnitY(), none.reshaped()},
                                            {Vector3d::Zero(), of_sine.reshaped()}};
    terms.push_back(
        std::make_unique<AccompanyingAxes>(dynamics::MovingAxes{0, 2}, std::vector<int>{}, whole.f, 6, rows));
    terms.back()->begin_at(Vector3d::Zero(), sine * of_sine);
  }
  void place() { assembly::place_axes(whole, terms, "body arm", nullptr, q, PETSC_COMM_WORLD); }
};

}  // namespace

TEST_CASE("axes that follow a body are placed where their rows are zero") {
  Following axes(0.5);
  axes.q.head<3>() << 1000, -3, 1;
  axes.q.segment<3>(3) << 1000, -2.5, 0.8;
  axes.place();
  CHECK(axes.q[3] == Approx(1000));
  CHECK(axes.q[4] == Approx(-3));
  CHECK(axes.q[5] == Approx(1 - std::asin(0.5)));
}

TEST_CASE("axes that no place satisfies are an error that names the body") {
  Following axes(2);
  CHECK_THROWS_AS(axes.place(), RunError);
  CHECK_THROWS_WITH(axes.place(), Catch::Contains("the axes of body arm were not found within 20 iterations"));
}

TEST_CASE("axes of places of several nodes are unknowns in the order in which the scene names the places") {
  const assembly::Model model = testing::built(R"yaml(
bodies:
  strip:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.2, 0], elements: [3, 2]}}
    section: {thickness: 0.01}
    material: {E: 2e9, nu: 0.3, rho: 1000}
probes:
  a: {at: strip.right, quantity: rotation}
  b: {at: strip.left, quantity: rotation}
motion: {end: 0.1, step: 1e-2}
)yaml",
                                               scene::Formulation::cfr);
  REQUIRE(model.joints.size() == 2);
  CHECK(model.joints[0].first < model.joints[1].first);
}
