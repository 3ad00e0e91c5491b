#include <catch2/catch.hpp>
#include <functional>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;
using Eigen::Vector3d;

namespace {

/// A free beam that tumbles about a skew axis and stretches, bends and twists as it does.
std::string beam(const std::string& frame, const std::string& end, const std::string& step,
                 const std::string& spin = "[1, 4, 2.5]", const std::string& modes = "6") {
  return fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [1, 0.2, 0.1], elements: 6}}
    section: {shape: rectangle, width: 0.06, height: 0.03, orientation: [0, 1, 0]}
    material: {E: 2e6, nu: 0.3, rho: 1000}
    $frame
    reduction: {modes: $modes}
    initial: {rotation: [0.3, -0.5, 0.2], angular_velocity: $spin, velocity: [0.2, -0.1, 0.3]}
motion: {end: $end, step: $step}
probes:
  a: {at: beam.start, quantity: position}
  b: {at: beam.end, quantity: position}
  c: {at: beam.middle, quantity: position}
)yaml",
              {{"frame", frame}, {"end", end}, {"step", step}, {"spin", spin}, {"modes", modes}});
}

std::string plate(const std::string& end, const std::string& step) {
  return fill(R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.6, 0], elements: [3, 2], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 1e7, nu: 0.3, rho: 1000}
    reduction: {modes: 5}
    initial: {rotation: [0.3, -0.5, 0.2], angular_velocity: [3, 1, 2], velocity: [0.2, -0.1, 0.3]}
motion: {end: $end, step: $step}
probes: {a: {at: plate.p1, quantity: position}, b: {at: plate.p3, quantity: position}}
)yaml",
              {{"end", end}, {"step", step}});
}

/// Linear and angular momentum about the world's origin of a scene's one body: with p = M v of the residual's rows,
/// (p_R, R x p_R + A p_theta).
using Momenta = Eigen::Matrix<double, 6, 1>;
Momenta momenta(const assembly::Model& model, Mat M, Vec zero, double t, Vec U, Vec V) {
  const dynamics::System& system = *model.system;
  const assembly::BodyReport& body = model.bodies.at(0);
  const petsc::VecHandle p = system.create_vector();
  system.tangent(t, U, V, zero, {0, 0, 1}, M);
  petsc::check(MatMult(M, V, p));
  Eigen::VectorXd q, of;
  system.gather(U, q), system.gather(p, of);
  const Vector3d R = q.segment<3>(body.first_coordinate), linear = of.segment<3>(body.first_coordinate);
  Momenta all;
  all << linear, R.cross(linear) + body.attitude->axes(q.segment<3>(body.first_coordinate + 3)) *
                                       of.segment<3>(body.first_coordinate + 3);
  return all;
}

/// Greatest change of the momenta since the start, relative to their size.
Eigen::Vector2d lost_momenta(const std::string& text, Formulation formulation) {
  const History scene = history_of(text, formulation);
  const scene::Motion motion = scene::parse_scene(text, "scene").motion;
  const petsc::MatHandle M = scene.model.system->create_tangent();
  const petsc::VecHandle zero = scene.model.system->create_vector();
  Momenta first;
  Eigen::Vector2d lost(0, 0);
  solve::simulate(*scene.model.system, {motion.end, motion.step, motion.spectral_radius, motion.tolerance},
                  scene.model.U, scene.model.V, [&](const solve::Instant& at) {
                    const Momenta now = momenta(scene.model, M, zero, at.t, at.U, at.V);
                    if (at.step == 0) first = now;
                    for (int i : {0, 1})
                      lost[i] =
                          std::max(lost[i], (now - first).segment<3>(3 * i).norm() / first.segment<3>(3 * i).norm());
                  });
  return lost;
}

const std::string mean = "frame: mean-axis", pinned = "frame: pinned", clamped = "frame: clamped";

}  // namespace

TEST_CASE("free in space: energy of a tumbling beam and plate to order 2, reduced and full") {
  for (const bool shell : {false, true})
    for (const Formulation formulation : {Formulation::vm_md, Formulation::nlffr}) {
      INFO((shell ? "plate " : "beam ") << name_of(formulation));
      const auto lost = [&](const std::string& step) {
        return drift(move(shell ? plate("0.4", step) : beam(mean, "0.4", step), formulation));
      };
      const double coarse = lost("2e-3"), fine = lost("1e-3");
      INFO(coarse << " " << fine);
      CHECK(coarse < 2e-3);
      CHECK(fine < coarse / 3);
    }
}

// Orders 2; p of the mean axes' origin, which is the middle, does not see the rotating at all.
TEST_CASE("free in space: momenta of a tumbling beam and plate to order 2, reduced and full") {
  for (const auto& [text, formulation] : std::vector<std::pair<std::function<std::string(std::string)>, Formulation>>{
           {[](const std::string& step) { return beam(mean, "0.4", step); }, Formulation::vm_md},
           {[](const std::string& step) { return beam(mean, "0.4", step); }, Formulation::nlffr},
           {[](const std::string& step) { return beam(pinned, "0.4", step); }, Formulation::vm_md},
           {[](const std::string& step) { return plate("0.4", step); }, Formulation::vm_md}}) {
    const Eigen::Vector2d coarse = lost_momenta(text("4e-3"), formulation),
                          fine = lost_momenta(text("2e-3"), formulation);
    INFO(name_of(formulation) << ": " << coarse.transpose() << ", " << fine.transpose());
    CHECK(coarse.maxCoeff() < 1e-2);
    for (int i : {0, 1}) CHECK((fine[i] < 1e-10 || fine[i] < coarse[i] / 3));
  }
}

// One body seen from three frames: strains differ by the square of slopes, which are small here.
TEST_CASE("free in space: pinned, clamped and mean axes give the same motion") {
  const auto run = [](const std::string& frame, Formulation formulation) {
    return move(beam(frame, "0.5", "2e-3", "[0.3, 0.8, 0.5]", "9"), formulation);
  };
  const History reference = run(mean, Formulation::nlffr);
  for (const auto& [frame, formulation] : {std::pair(pinned, Formulation::nlffr),
                                           {clamped, Formulation::nlffr},
                                           {mean, Formulation::vm_md},
                                           {pinned, Formulation::vm_md},
                                           {clamped, Formulation::vm_md}}) {
    INFO(frame << " " << name_of(formulation));
    const History at = run(frame, formulation);
    for (const std::string place : {"a", "b", "c"}) CHECK(apart(at, reference, place) < 1e-4);
  }
}

// A beam that rotates about its axis of greatest moment, 100 times, without a force: its middle keeps its velocity.
TEST_CASE("free in space: a hundred revolutions without drift") {
  const History at = move(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [-0.5, 0, 0], to: [0.5, 0, 0], elements: 4}}
    section: {shape: rectangle, width: 0.06, height: 0.03, orientation: [0, 1, 0]}
    material: {E: 2e7, nu: 0.3, rho: 1000}
    reduction: {modes: 4}
    initial: {rotation: [0.3, -0.5, 0.2], angular_velocity: [0.2955, 0.7, 5.95]}
motion: {end: 106, step: 1e-2}
probes: {a: {at: beam.start, quantity: position}, b: {at: beam.end, quantity: position}}
)yaml",
                          Formulation::vm_md);
  double off = 0, longest = 0, shortest = 10;
  for (std::size_t i = 0; i < at.t.size(); ++i) {
    off = std::max(off, (vector_at(at, "a", i) + vector_at(at, "b", i)).norm() / 2);
    const double length = (vector_at(at, "a", i) - vector_at(at, "b", i)).norm();
    longest = std::max(longest, length), shortest = std::min(shortest, length);
  }
  CHECK(off < 1e-6);
  CHECK(longest < 1.01);
  CHECK(shortest > 0.99);
  CHECK(drift(at) < 2e-3);
}
