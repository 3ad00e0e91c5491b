#include <catch2/catch.hpp>

#include "floe/assembly/model.h"
#include "floe/petsc/values.h"
#include "floe/solve/simulation.h"

using namespace floe;
using scene::Formulation;

namespace {

/// A short run of Wu & Tiso's cantilever, and of a pendulum of two bodies, one of them split into two frames.
const char* cantilever = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [100, 0], elements: 10}}
    section: {A: 70, I: 585}
    material: {E: 16000, rho: 0.0078}
    reduction: {modes: 5, derivatives: all}
joints:
  clamp: {type: fixed, between: [ground, beam.start]}
loads:
  tip: {type: force, at: beam.end, force: [0, "2500*sin(9.5*t)"]}
motion: {end: 0.2, step: 0.005}
probes:
  tip: {at: beam.end, quantity: displacement}
  half: {at: beam.middle, quantity: velocity}
  turn: {at: beam.end, quantity: rotation}
)yaml";

const char* chain = R"yaml(
gravity: [0, -9.81]
bodies:
  upper:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 6}}
    section: {EA: 1.2e4, EI: 1, rhoA: 1}
    frame: mean-axis
    reduction: {modes: 3, derivatives: all}
  lower:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 6}}
    section: {EA: 1.2e4, EI: 1, rhoA: 1}
    initial: {position: [1, 0]}
    frames: 2
    reduction: {modes: 2, derivatives: all}
joints:
  hinge: {type: revolute, between: [ground, upper.start]}
  elbow: {type: revolute, between: [upper.end, lower.start]}
motion: {end: 0.1, step: 0.005}
probes:
  tip: {at: lower.end, quantity: position}
  elbow: {at: upper.end, quantity: velocity}
)yaml";

/// Probes of every step; on other ranks than the observers' the same.
std::vector<std::vector<double>> run(const char* text, Formulation formulation, MPI_Comm comm) {
  const scene::Scene scene = scene::parse_scene(text, "test.yaml");
  assembly::Model model = assembly::build(scene, formulation, comm);
  std::vector<std::vector<double>> rows;
  solve::simulate(
      *model.system, {scene.motion.end, scene.motion.step, scene.motion.spectral_radius, {}}, model.U, model.V,
      [&](const solve::Instant& now) { rows.push_back(assembly::probe_values(model, now.t, now.U, now.V)); });
  return rows;
}

}  // namespace

TEST_CASE("the same trajectories on any number of ranks") {
  const char* text = GENERATE(as<const char*>{}, cantilever, chain);
  const Formulation formulation = GENERATE(Formulation::vm_md, Formulation::nlffr, Formulation::lffr, Formulation::cfr);
  INFO(scene::name_of(formulation));
  const auto found = run(text, formulation, PETSC_COMM_WORLD), expected = run(text, formulation, PETSC_COMM_SELF);
  REQUIRE(found.size() == expected.size());
  REQUIRE(found.size() > 20);
  double moved = 0;
  for (std::size_t c = 0; c < expected[0].size(); ++c) {
    double scale = 0, error = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      scale = std::max(scale, std::abs(expected[i][c]));
      error = std::max(error, std::abs(found[i][c] - expected[i][c]));
      moved = std::max(moved, std::abs(expected[i][c] - expected[0][c]));
    }
    CHECK(error < 1e-9 * std::max(scale, 1e-3));
  }
  CHECK(moved > 0.01);
}

TEST_CASE("a reduced model is the same to the bit on every rank") {
  const auto rows = run(cantilever, Formulation::vm_md, PETSC_COMM_WORLD);
  std::vector<double> first = rows.back();
  MPI_Bcast(first.data(), static_cast<int>(first.size()), MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  CHECK(first == rows.back());
}

TEST_CASE("the reduced trajectory follows the full-order one") {
  const auto full = run(cantilever, Formulation::nlffr, PETSC_COMM_WORLD),
             reduced = run(cantilever, Formulation::vm_md, PETSC_COMM_WORLD);
  double error = 0, scale = 0;
  for (std::size_t i = 0; i < full.size(); ++i) {
    error = std::max(error, std::abs(full[i][1] - reduced[i][1]));
    scale = std::max(scale, std::abs(full[i][1]));
  }
  CHECK(error < 0.02 * scale);  // 5 modes, one of them axial
}
