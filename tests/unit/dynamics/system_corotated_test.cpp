#include <catch2/catch.hpp>

#include "floe/dynamics/spatial_joint.h"
#include "random.h"
#include "spatial_systems.h"

using namespace floe;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::numbers_of;
using testing::Random;
using testing::vector_of;

namespace {

petsc::VecHandle vector_of_entries(const dynamics::System& system, const VectorXd& values) {
  return vector_of(system, std::vector<double>(values.begin(), values.end()));
}

/// A state of a system whose vectors in world axes are `vectors` (first of each) of `size` parts.
struct State {
  VectorXd q, v, a;

  State rotated(const MatrixXd& E, const std::vector<int>& vectors) const {
    State out = *this;
    for (VectorXd* x : {&out.q, &out.v, &out.a})
      for (const int first : vectors) x->segment(first, E.rows()) = (E * x->segment(first, E.rows())).eval();
    return out;
  }
};

MatrixXd tangent(const dynamics::System& system, const State& state) {
  const petsc::MatHandle J = system.create_tangent();
  system.tangent(0, vector_of_entries(system, state.q), vector_of_entries(system, state.v),
                 vector_of_entries(system, state.a), {1, 30, 500}, J);
  const auto n = static_cast<PetscInt>(state.q.size());
  MatrixXd entries(n, n);
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j < n; ++j) petsc::check(MatGetValue(J, i, j, &entries(i, j)));
  return entries;
}

/// rotate J rotate_back, column by column.
MatrixXd rotated(const dynamics::System& system, const MatrixXd& J, const std::vector<Matrix3d>& from,
                 const VectorXd& q) {
  const petsc::VecHandle U = vector_of_entries(system, q);
  MatrixXd out(J.rows(), J.cols());
  for (Eigen::Index j = 0; j < J.cols(); ++j) {
    const petsc::VecHandle y = vector_of_entries(system, VectorXd::Unit(J.cols(), j));
    system.rotate(from, U, true, y);
    const petsc::VecHandle z = vector_of_entries(system, J * numbers_of(y));
    system.rotate(from, U, false, z);
    out.col(j) = numbers_of(z);
  }
  return out;
}

double relative(const MatrixXd& found, const MatrixXd& expected) { return (found - expected).norm() / expected.norm(); }

/// A rod on a hinge, (R_x, R_y, theta, lambda_x, lambda_y), whose frame is known to rotate, or not.
dynamics::System rod(bool known, double gravity) {
  dynamics::Coordinates coordinates(PETSC_COMM_SELF);
  coordinates.add_shared(3);
  if (known) coordinates.add_angle(2, true);
  coordinates.add_shared(2, true);
  coordinates.number();
  testing::Terms terms;
  terms.push_back(testing::rigid_rod(2, 1.5));
  terms.push_back(testing::weight(2, 1.5, gravity));
  terms.push_back(testing::to_ground(testing::on_rod(0.4), dynamics::Revolute{}));
  return {std::move(coordinates), std::move(terms)};
}

}  // namespace

TEST_CASE("the tangent of a body on a hinge in the plane turns with the body") {
  const dynamics::System system = rod(true, 0);
  Random random(11);
  const State state{random.vector(5), random.vector(5), random.vector(5)};
  const double angle = 1.3;
  State after = state.rotated(Eigen::Rotation2Dd(angle).toRotationMatrix(), {0, 3});
  after.q[2] += angle;
  std::vector<Matrix3d> from;
  system.frame_axes(vector_of_entries(system, state.q), from);
  const MatrixXd before = tangent(system, state), expected = tangent(system, after);
  CHECK(relative(before, expected) > 0.1);
  CHECK(relative(rotated(system, before, from, after.q), expected) < 1e-14);
}

TEST_CASE("the tangent of a body on a hinge in space turns with the body about the hinge") {
  const auto attitude = std::make_shared<dynamics::Attitude>();
  dynamics::Coordinates coordinates(PETSC_COMM_SELF);
  coordinates.add_shared(6);
  coordinates.add_shared(5, true);
  coordinates.number();
  dynamics::SpatialMarker place;
  place.coordinates = {0, 1, 2, 3, 4, 5}, place.attitude = attitude, place.x0 = Vector3d(0.3, -0.2, 0.5);
  testing::Terms terms;
  terms.push_back(std::make_unique<dynamics::SpatialBody>(std::vector<int>{0, 1, 2, 3, 4, 5}, attitude,
                                                          testing::rigid(2, {1, 1.6, 2.2}), testing::no_elasticity(),
                                                          MatrixXd()));
  terms.push_back(std::make_unique<dynamics::SpatialJoint>(dynamics::SpatialMarker::ground(Vector3d::Zero()), place,
                                                           dynamics::SpatialConstraint::revolute(), 6));
  const dynamics::System system(std::move(coordinates), std::move(terms), dynamics::Attitudes{{3, attitude}});

  Random random(12);
  State state{random.vector(11), random.vector(11), random.vector(11)};
  state.q.segment<3>(3).setZero();
  attitude->base = Eigen::AngleAxisd(0.4, Vector3d::UnitZ());  // the hinge is met: its moments are normal to z
  std::vector<Matrix3d> from;
  system.frame_axes(vector_of_entries(system, state.q), from);
  const MatrixXd before = tangent(system, state);
  const Eigen::Quaterniond E(Eigen::AngleAxisd(1.3, Vector3d::UnitZ()));
  const State after = state.rotated(E.toRotationMatrix(), {0, 6});
  attitude->base = E * attitude->base;
  const MatrixXd expected = tangent(system, after);
  CHECK(relative(before, expected) > 1e-4);
  CHECK(relative(rotated(system, before, from, after.q), expected) < 1e-14);
}

TEST_CASE("a Jacobian that turns with its bodies saves Newton iterations") {
  const auto iterations = [](bool known) {
    const dynamics::System system = rod(known, 9.81);
    const petsc::VecHandle U = vector_of(system, {-0.4, 0, 0, 0, 0}), V = system.create_vector();
    const auto report = solve::simulate(system, {5, 0.005, 0.8, {}}, U, V, [](const solve::Instant&) {});
    return static_cast<double>(report.newton) / static_cast<double>(report.steps);
  };
  const double with = iterations(true), without = iterations(false);
  INFO(with << " " << without);
  CHECK(with < 0.75 * without);
}
