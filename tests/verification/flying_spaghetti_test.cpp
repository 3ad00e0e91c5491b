#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// EA = GA = 1e4, EI = 500, mass 1 and rotary inertia 10 per length, from (6, 0) to (0, 8), thrown by a force and a
/// moment at its lower end.
History thrown(Formulation formulation, int frames) {
  return move(fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [6, 0], to: [0, 8], elements: 64}}
    section: {EA: 1e4, EI: 500, rhoA: 1, rhoI: 10, GA: 1e4}
    frame: pinned
    frames: $frames
    reduction: {modes: 4, derivatives: all}
loads:
  force: {type: force, at: beam.start, force: ["20*triangle(t, 2.5, 2.5)", 0]}
  moment: {type: moment, at: beam.start, moment: "-200*triangle(t, 2.5, 2.5)"}
motion: {end: 5, step: 5e-3}
probes: {loaded: {at: beam.start, quantity: position}, free: {at: beam.end, quantity: position}}
)yaml",
                   {{"frames", std::to_string(frames)}}),
              formulation);
}

Eigen::VectorXd ends(const History& at) {
  Eigen::VectorXd all(8);
  all << at.at("loaded.x", 2.5), at.at("loaded.y", 2.5), at.at("free.x", 2.5), at.at("free.y", 2.5),
      at.at("loaded.x", 5), at.at("loaded.y", 5), at.at("free.x", 5), at.at("free.y", 5);
  return all;
}

}  // namespace

// Independent converged computation: geometrically exact shear-flexible elements, linear with one point, extrapolated
// from 32 and 64 of them and from steps of 0.02 and 0.01 s, certain to .001; the extrapolation of the frames adds
// .0005.
TEST_CASE("spaghetti in the plane: the ends of the flying beam with shear, in 4, 8 and 16 frames and none") {
  Eigen::VectorXd table(8);
  table << 3.5781, 0.0539, 3.8383, 8.5401, 18.5849, 7.9246, 12.0207, 0.3973;
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    const Eigen::VectorXd coarse = ends(thrown(formulation, 4)), middle = ends(thrown(formulation, 8)),
                          fine = ends(thrown(formulation, 16)), limit = fine + (fine - middle) / 3;
    const auto away = [&](const Eigen::VectorXd& found) { return (found - table).cwiseAbs().maxCoeff(); };
    CHECK(away(coarse) < 0.01);
    CHECK(away(middle) < 0.005);
    CHECK(away(fine) < 0.0015);
    CHECK(away(limit) < 0.0015);
  }
  CHECK((ends(thrown(Formulation::cfr, 1)) - table).cwiseAbs().maxCoeff() < 0.0015);
}
