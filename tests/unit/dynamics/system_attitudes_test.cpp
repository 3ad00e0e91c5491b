#include <catch2/catch.hpp>

#include "floe/dynamics/system.h"
#include "floe/petsc/values.h"

using namespace floe;
using Eigen::Vector3d;

namespace {

/// Two attitudes among shared unknowns, 7 and 13 of the first block, and dofs that each rank has for itself: 3 each.
struct Two {
  std::shared_ptr<dynamics::Attitude> one = std::make_shared<dynamics::Attitude>(),
                                      two = std::make_shared<dynamics::Attitude>();
  std::unique_ptr<dynamics::System> system;
  petsc::VecHandle U, V, W;

  Two() {
    dynamics::Coordinates coordinates(PETSC_COMM_WORLD);
    coordinates.add_distributed(3, {});
    const int first = coordinates.add_shared(20);
    coordinates.number();
    system = std::make_unique<dynamics::System>(coordinates, std::vector<std::unique_ptr<dynamics::Term>>{},
                                                dynamics::Attitudes{{first + 7, one}, {first + 13, two}});
    U = system->create_vector(), V = system->create_vector(), W = system->create_vector();
    const auto& global = coordinates.global();
    petsc::Values u(U), v(V);
    for (int i = 0; i < coordinates.local_size(); ++i)
      if (global[i] >= u.first && global[i] < u.end) u[global[i]] = 0.1 * (i - first), v[global[i]] = 1. / (i + 1);
  }
};

Vector3d three(const Eigen::VectorXd& x, int first) { return x.segment<3>(first); }

}  // namespace

TEST_CASE("rebase: every rank's bases take over the rotations, whose unknowns become zero; all else stays") {
  Two two;
  two.one->base = math::quaternion({1, 2, 3});
  const Eigen::Matrix3d before = two.one->axes({0.7, 0.8, 0.9});
  Eigen::VectorXd was, is;
  two.system->gather(two.U, was);
  two.system->rebase(two.U);
  two.system->gather(two.U, is);
  CHECK((two.one->base.toRotationMatrix() - before).norm() < 1e-15);
  CHECK((two.two->base.toRotationMatrix() - math::rotation({1.3, 1.4, 1.5})).norm() < 1e-15);
  for (int first : {3 + 7, 3 + 13}) was.segment<3>(first).setZero();
  CHECK(is == was);
}

TEST_CASE("bracket: the cross product in the rows of attitudes, zero elsewhere") {
  Two two;
  Eigen::VectorXd u, v, w;
  two.system->gather(two.U, u), two.system->gather(two.V, v);
  two.system->bracket(two.U, two.V, two.W);
  two.system->gather(two.W, w);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(u.size());
  for (int first : {3 + 7, 3 + 13}) expected.segment<3>(first) = three(u, first).cross(three(v, first));
  CHECK(w == expected);
  CHECK(expected.norm() > 0);
}
