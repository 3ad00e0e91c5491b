#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// A soft double pendulum: hinge to the ground, hinge between; all its motions are resolved by the steps.
History mechanism(Formulation formulation, double step, const std::string& radius = "0.8") {
  return move(fill(R"yaml(
gravity: [0, -9.81]
bodies:
  upper:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}
    section: {EA: 500, EI: 5, rhoA: 1, rhoI: 0.01}
    reduction: {modes: 2, derivatives: all}
  lower:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 2}}
    section: {EA: 500, EI: 5, rhoA: 1, rhoI: 0.01}
    reduction: {modes: 2, derivatives: all}
    initial: {position: [1, 0]}
joints:
  hinge: {type: revolute, between: [ground, upper.start]}
  knee: {type: revolute, between: [upper.end, lower.start]}
motion: {end: 0.5, step: $step, spectral_radius: $radius}
probes: {tip: {at: lower.end, quantity: position}, speed: {at: lower.end, quantity: velocity}}
)yaml",
                   {{"step", number(step)}, {"radius", radius}}),
              formulation);
}

struct End {
  Eigen::Vector2d position, velocity;
  Eigen::VectorXd multipliers;
};

End end_of(const History& at) {
  const Eigen::VectorXd U = everywhere(at.model.U);
  const std::vector<PetscInt> rows = multipliers(*at.model.system);
  End end{{at["tip.x"].back(), at["tip.y"].back()}, {at["speed.x"].back(), at["speed.y"].back()}, {}};
  end.multipliers.resize(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) end.multipliers[i] = U[rows[i]];
  return end;
}

void check_order_two(Formulation formulation, double step, const std::string& radius = "0.8") {
  const End a = end_of(mechanism(formulation, step, radius)), b = end_of(mechanism(formulation, step / 2, radius)),
            c = end_of(mechanism(formulation, step / 4, radius));
  CHECK(std::log2((a.position - b.position).norm() / (b.position - c.position).norm()) == Approx(2).margin(0.2));
  CHECK(std::log2((a.velocity - b.velocity).norm() / (b.velocity - c.velocity).norm()) == Approx(2).margin(0.2));
  if (a.multipliers.size() > 0)
    CHECK(std::log2((a.multipliers - b.multipliers).norm() / (b.multipliers - c.multipliers).norm()) ==
          Approx(2).margin(0.25));
}

}  // namespace

// Generalised-alpha for index-3 systems, Arnold and Bruels: second order in positions, velocities and multipliers.
TEST_CASE("order: reduced mechanism, second order in the step") { check_order_two(Formulation::vm_md, 2.5e-4); }
TEST_CASE("order: full-order floating frames, second order in the step") {
  check_order_two(Formulation::nlffr, 2.5e-4);
}
TEST_CASE("order: corotational mechanism, second order in the step") { check_order_two(Formulation::cfr, 2.5e-4); }
TEST_CASE("order: the same for other spectral radii") {
  for (const std::string radius : {"0.5", "0.9"}) check_order_two(Formulation::vm_md, 2.5e-4, radius);
}
