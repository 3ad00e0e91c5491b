// How long the first swing of a flexible pendulum takes, for several lengths: floe as a library.
#include <floe/assembly/model.h>
#include <floe/petsc/error.h>
#include <floe/solve/generalized_alpha.h>
#include <floe/solve/simulation.h>
#include <slepc.h>

#include <cstdio>

using namespace floe;

namespace {

scene::Scene pendulum(double length) {
  const std::string L = std::to_string(length);
  return scene::parse_scene(
      "gravity: [0, -9.81]\n"
      "bodies:\n  rod:\n    mesh: {line: {from: [0, 0], to: [" +
          L +
          ", 0], elements: 10}}\n"
          "    section: {EA: 1.2e4, EI: 10, rhoA: 1}\n    reduction: {modes: 3, derivatives: all}\n"
          "joints: {hinge: {type: revolute, between: [ground, rod.start]}}\n"
          "motion: {end: 3, step: 1e-3}\nprobes: {tip: {at: rod.end, quantity: position}}\n",
      "pendulum");
}

double time_of_first_swing(double length) {
  const assembly::Model model = assembly::build(pendulum(length), scene::Formulation::vm_md, PETSC_COMM_WORLD);
  double bottom = -1;
  const auto watch = [&](const solve::Instant& at) {
    if (bottom < 0 && assembly::probe_values(model, at.t, at.U, at.V)[0] < 0) bottom = at.t;
  };
  solve::simulate(*model.system, {3, 1e-3}, model.U, model.V, watch);
  return bottom;
}

}  // namespace

int main(int argc, char** argv) {
  if (SlepcInitialize(&argc, &argv, nullptr, nullptr)) return 1;
  solve::register_generalized_alpha();
  for (double length : {0.5, 1.0, 2.0}) std::printf("%g %.6f\n", length, time_of_first_swing(length));
  return SlepcFinalize();
}
