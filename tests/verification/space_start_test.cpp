#include <catch2/catch.hpp>

#include "space_twin.h"

using namespace floe;
using namespace floe::test;

// Bodies in space that are deformed at the start, or in several floating frames, against their planar twins.

namespace {

const Rotated rotation;

/// A free beam, bent and moving.
std::string flat_beam(const std::string& frame) {
  return fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0.2, 0.1], to: [1.2, 0.1], elements: 8}}
    section: {A: 1e-3, I: 1e-6/12}
    material: {E: 1.2e8, rho: 1000}
    frame: $frame
    reduction: {modes: 4, derivatives: all}
    initial: {position: [0.3, -0.2], velocity: [1, 2], angular_velocity: 3, deformation: ["-0.002*x", "0.03*x^2"],
              deformation_rate: [0, "0.3*(sin(pi*x)-2/pi)"]}
motion: {end: 0.2, step: 1e-3}
probes: {tip: {at: beam.end, quantity: position}, speed: {at: beam.start, quantity: velocity}, bent: {at: beam.middle, quantity: deflection}}
)yaml",
              {{"frame", frame}});
}

std::string beam_in_space(const std::string& frame) {
  return fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0.2, 0.1, 0], to: [1.2, 0.1, 0], elements: 8}}
    section: {A: 1e-3, Iz: 1e-6/12, Iy: 1e-3, J: 1, orientation: [0, 1, 0]}
    material: {E: 1.2e8, nu: 0.3, rho: 1000}
    frame: $frame
    reduction: {modes: 4, derivatives: all}
    initial: {position: $there, rotation: $turn, velocity: $velocity, angular_velocity: $spin,
              deformation: ["-0.002*x", "0.03*x^2", 0], deformation_rate: [0, "0.3*(sin(pi*x)-2/pi)", "0*z"]}
motion: {end: 0.2, step: 1e-3}
probes: {tip: {at: beam.end, quantity: position}, speed: {at: beam.start, quantity: velocity}, bent: {at: beam.middle, quantity: deflection}}
)yaml",
              {{"frame", frame},
               {"there", rotation(0.3, -0.2)},
               {"turn", rotation.text()},
               {"velocity", rotation(1, 2)},
               {"spin", rotation(0, 0, 3)}});
}

}  // namespace

TEST_CASE("a free beam in space with initial bending agrees with the planar beam") {
  for (const std::string frame : {"pinned", "clamped", "mean-axis"})
    for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
      INFO(frame << ", " << scene::name_of(formulation));
      const History flat = move(flat_beam(frame), formulation), at = move(beam_in_space(frame), formulation);
      CHECK(apart(at, rotation.Q, flat, "tip") < 1e-6);
      CHECK(apart(at, rotation.Q, flat, "speed") < 1e-5);
      if (frame != "pinned") CHECK(apart(at, Eigen::Matrix3d::Identity(), flat, "bent") < 1e-5);
    }
}

// w = a sin(pi x) sin(pi y) on a free plate of side 1: elastic energy (D/8) (2 pi^2)^2 a^2, kinetic energy of the rate
// b sin(pi x) sin(pi y) (m/8) b^2, of which the frame has a part.
TEST_CASE("a plate in space starts with the energies of its deformation and its rate") {
  const History at = move(R"yaml(
parameters: {a: 1e-5, b: 1e-4}
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 1, 0], elements: [10, 10], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 12*0.91*1e6, nu: 0.3, rho: 100}
    reduction: {modes: 4, derivatives: none, attachment: none}
    initial: {deformation: [0, 0, "a*sin(pi*x)*sin(pi*y)"], deformation_rate: [0, 0, "b*sin(pi*x)*sin(pi*y)"]}
motion: {end: 1e-3, step: 1e-3}
probes: {middle: {at: plate.centre, quantity: position}}
)yaml",
                          Formulation::lffr);
  CHECK(at.energy.front().elastic == Approx(std::pow(2 * M_PI * M_PI * 1e-5, 2) / 8).epsilon(0.05));
  CHECK(at.energy.front().kinetic == Approx(1e-8 / 8).epsilon(0.05));
  CHECK(at["middle.z"].front() == Approx(1e-5).epsilon(1e-3));
}

// Rates c x^2 of a cantilever: m c^2 / 10. Slopes of formulas have round-off, which does not move the clamp.
TEST_CASE("a cantilever in space starts with the energy of its deformation rate") {
  const auto cantilever = [](const std::string& rate) {
    return fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0.1, 0.2, 0.3], to: [1.1, 0.2, 0.3], elements: 8}}
    section: {shape: rectangle, width: 0.02, height: 0.005, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 1e4}
    frame: clamped
    reduction: {modes: 4}
    initial: {rotation: [0.3, 0.2, 0.7], deformation_rate: [0, 0, "$rate"]}
joints: {j: {type: fixed, between: [ground, beam.start]}}
motion: {end: 1e-3, step: 1e-3}
)yaml",
                {{"rate", rate}});
  };
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md, Formulation::cfr})
    CHECK(move(cantilever("1e-2*(x-0.1)^2"), formulation).energy.front().kinetic == Approx(1e-5).epsilon(0.01));
  CHECK_THROWS_WITH(move(cantilever("1e-2*(x-0.1)"), Formulation::vm_md),
                    Catch::Contains("gives a velocity to body beam, which is clamped to the ground"));
}

// The paper's cantilever in one, two and four frames, in the plane and in space: frames that are welded together.
TEST_CASE("frames: N in space: a cantilever as in the plane") {
  const std::string flat = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [100, 0], elements: 8}}
    section: {A: 70, I: 585}
    material: {E: 16000, rho: 0.0078}
    frames: $n
    reduction: {modes: 4}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "2500*sin(9.5*t)"]}}
motion: {end: 0.6, step: 4e-3}
probes: {tip: {at: beam.end}, inside: {at: {body: beam, node: [37.5, 0]}}}
)yaml",
                    space = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [100, 0, 0], elements: 8}}
    section: {A: 70, Iz: 585, Iy: 585e6, J: 585e6, orientation: [0, 1, 0]}
    material: {E: 16000, nu: 0.3, rho: 0.0078}
    frames: $n
    reduction: {modes: 4}
    initial: {rotation: $turn}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: $force}}
motion: {end: 0.6, step: 4e-3}
probes: {tip: {at: beam.end}, inside: {at: {body: beam, node: [37.5, 0, 0]}}}
)yaml";
  const Eigen::Vector3d y = rotation.Q.col(1);
  const auto along = [&](int i) { return fmt::format("\"{:.17g}*2500*sin(9.5*t)\"", y[i]); };
  const std::string force = fmt::format("[{}, {}, {}]", along(0), along(1), along(2));
  for (const std::string n : {"2", "4"}) {
    INFO(n);
    const History plane = move(fill(flat, {{"n", n}}), Formulation::nlffr);
    const Words words{{"n", n}, {"turn", rotation.text()}, {"force", force}};
    const History at = move(fill(space, words), Formulation::nlffr);
    CHECK(at.model.bodies.size() == std::stoul(n));
    CHECK(apart(at, rotation.Q, plane, "tip") < 1e-3);  // rotary inertia about the stiff axes apart
    CHECK(apart(at, rotation.Q, plane, "inside") < 1e-3);
    CHECK(apart(move(fill(space, words), Formulation::vm_md), rotation.Q, plane, "tip") < 3e-2);
  }
}

TEST_CASE("a body hangs on a place in space that an initial deformation displaces") {
  const std::string text = R"yaml(
bodies:
  a:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 8}}
    section: {shape: rectangle, width: 0.02, height: 0.006, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    initial: {deformation: ["-0.02*0.02*x^3*2/3", 0, "0.02*x^2"]}
  c: {rigid: {mass: 0.4, centre: [1.1, 0, 0], inertia: [1e-3, 1e-3, 1e-3]}, initial: {position: ["-0.02*0.02*2/3", 0, 0.02]}}
joints:
  root: {type: fixed, between: [ground, a.start]}
  end: {type: spherical, between: [a.end, {body: c, node: [1, 0, 0]}]}
motion: {end: 0.01, step: 1e-3}
probes: {end: {at: a.end, quantity: position}, c: {at: {body: c, node: [1, 0, 0]}, quantity: position}}
)yaml";
  for (const auto formulation : {Formulation::nlffr, Formulation::cfr, Formulation::vm_md}) {
    const History at = move(text, formulation);
    CAPTURE(scene::name_of(formulation));
    CHECK(at["end.z"].front() == Approx(0.02).epsilon(1e-3));
    CHECK(at["c.z"].front() == Approx(at["end.z"].front()).epsilon(1e-6));
    CHECK(at["c.z"].back() == Approx(at["end.z"].back()).epsilon(1e-6));
  }
}
