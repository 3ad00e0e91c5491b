#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

namespace {

/// omega_n of a beam with L = EI = rhoA = 1 and axial modes out of the way.
std::vector<double> frequencies(const std::string& frame, const std::string& joints, int count) {
  const std::string text = fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 32}}
    section: {EA: 1e6, EI: 1, rhoA: 1}
    frame: $frame
    reduction: {modes: $count}
joints: {$joints}
motion: {end: 1, step: 1}
)yaml",
                                {{"frame", frame}, {"count", std::to_string(count)}, {"joints", joints}});
  return assembly::body_modes(scene::parse_scene(text, "scene"), PETSC_COMM_WORLD).at(0).omega;
}

const std::string left = "a: {type: fixed, between: [ground, beam.start]}",
                  right = "b: {type: fixed, between: [ground, beam.end]}",
                  hinges =
                      "a: {type: revolute, between: [ground, beam.start]}, "
                      "b: {type: revolute, between: [ground, beam.end]}";

}  // namespace

// Roots of 1 + cos cosh, 1 - cos cosh and sin (closed form).
TEST_CASE("linear frequencies of beams") {
  const double CF[] = {3.5160152685, 22.034491565, 61.697214414}, FF[] = {22.373285448, 61.672822868};
  for (const std::string frame : {"pinned", "clamped", "mean-axis"}) {
    INFO("frame " << frame);
    const auto clamped = frequencies(frame, left, 3), both = frequencies(frame, left + ", " + right, 2),
               simple = frequencies(frame, hinges, 3), free = frequencies(frame, "", 2);
    for (int i = 0; i < 3; ++i) CHECK(clamped[i] == Approx(CF[i]).epsilon(1e-5));
    for (int i = 0; i < 2; ++i) CHECK(both[i] == Approx(FF[i]).epsilon(1e-5));
    for (int i = 0; i < 2; ++i) CHECK(free[i] == Approx(FF[i]).epsilon(1e-5));
    for (int i = 0; i < 3; ++i) CHECK(simple[i] == Approx(std::pow((i + 1) * M_PI, 2)).epsilon(1e-5));
  }
}

// Timoshenko beam, hinged: of (rhoA rhoI / GA) omega^4 - (rhoA + k^2 (rhoI + rhoA EI / GA)) omega^2 + EI k^4 = 0, k = n
// pi / L, the lesser root. Timoshenko, Vibration problems in engineering, 3rd ed., art. 55. Shear is constant in an
// element: order 2, and two meshes give the limit.
TEST_CASE("linear frequencies with shear and rotary inertia") {
  const double EI = 1, rhoA = 1, rhoI = 0.01, GA = 40;
  const std::string plane = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: $elements}}
    section: {EA: 1e6, EI: 1, rhoA: 1, rhoI: 0.01, GA: 40}
    reduction: {modes: 3}
joints: {a: {type: revolute, between: [ground, beam.start]}, b: {type: revolute, between: [ground, beam.end]}}
motion: {end: 1, step: 1}
)yaml";
  // EA = 100, EIz = 1, rho A = 1, rho Iz = 0.01, kappa G A = 40 along y
  const std::string space = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: $elements}}
    section: {A: 1, Iy: 100, Iz: 0.01, J: 100, orientation: [0, 1, 0], shear_factor: [8e-3, 1]}
    material: {E: 100, G: 5000, rho: 1}
    reduction: {modes: 1}
joints:
  a: {type: revolute, between: [ground, beam.start], axis: [0, 0, 1]}
  b: {type: revolute, between: [ground, beam.end], axis: [0, 0, 1]}
motion: {end: 1, step: 1}
)yaml";
  const auto squares = [](const std::string& text, int elements) {
    const std::string scene = fill(text, {{"elements", std::to_string(elements)}});
    std::vector<double> all = assembly::body_modes(scene::parse_scene(scene, "scene"), PETSC_COMM_WORLD).at(0).omega;
    for (double& omega : all) omega *= omega;
    return all;
  };
  for (const std::string& text : {plane, space}) {
    const auto coarse = squares(text, 32), fine = squares(text, 64);
    for (std::size_t n = 1; n <= coarse.size(); ++n) {
      const double k = double(n) * M_PI, a = rhoA * rhoI / GA, b = rhoA + k * k * (rhoI + rhoA * EI / GA);
      const double c = EI * k * k * k * k, exact = 2 * c / (b + std::sqrt(b * b - 4 * a * c));
      const double limit = (4 * fine[n - 1] - coarse[n - 1]) / 3;
      CHECK(limit == Approx(exact).epsilon(2e-5));
      CHECK((coarse[n - 1] - exact) / (fine[n - 1] - exact) == Approx(4).margin(0.2));
    }
  }
}

// Rayleigh beam (no shear), hinged: omega^2 = beta^4 EI / (rhoA + beta^2 rhoI), beta = n pi / L.
TEST_CASE("linear frequencies with rotary inertia") {
  const std::string text = R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 32}}
    section: {EA: 1e6, EI: 1, rhoA: 1, rhoI: 0.01}
    reduction: {modes: 3}
joints: {a: {type: revolute, between: [ground, beam.start]}, b: {type: revolute, between: [ground, beam.end]}}
motion: {end: 1, step: 1}
)yaml";
  const auto omega = assembly::body_modes(scene::parse_scene(text, "scene"), PETSC_COMM_WORLD).at(0).omega;
  for (int n = 1; n <= 3; ++n) {
    const double beta = n * M_PI;
    CHECK(omega[n - 1] == Approx(std::sqrt(std::pow(beta, 4) / (1 + beta * beta * 0.01))).epsilon(1e-5));
  }
}

namespace {

/// How many frequencies are those of a clamped-free rod of 40 linear elements with a consistent mass:
/// omega = (2 c/h) sqrt(3) sin x / sqrt(3 - 2 sin^2 x), x = (2k - 1) pi/160.
int axial(const std::vector<double>& omega) {
  const double h = 2.5, c = std::sqrt(1.12e6 / 0.546);
  int count = 0;
  for (int k = 1; k <= 17; ++k) {
    const double s = std::sin((2 * k - 1) * M_PI / 160),
                 exact = 2 * c / h * std::sqrt(3.) * s / std::sqrt(3 - 2 * s * s);
    for (const double value : omega) count += std::abs(value - exact) < 1e-6 * exact;
  }
  return count;
}

}  // namespace

// The paper's cantilever: independent converged computation, in rad/s.
TEST_CASE("linear frequencies of the paper's cantilever") {
  const auto omega = [](const std::string& rotary) {
    const std::string text = fill(R"yaml(
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [100, 0], elements: 40}}
    section: {A: 70, I: 585}
    material: {E: 16000, rho: 0.0078}
    rotary_inertia: $rotary
    reduction: {modes: 17}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
motion: {end: 1, step: 1}
)yaml",
                                  {{"rotary", rotary}});
    return assembly::body_modes(scene::parse_scene(text, "scene"), PETSC_COMM_WORLD).at(0).omega;
  };
  const auto with = omega("true"), without = omega("false");
  // bending; the third mode is axial: (pi/2L) sqrt(EA/rhoA) = 22.497
  CHECK(with[0] == Approx(1.45295).margin(2e-5));
  CHECK(with[1] == Approx(9.00192).margin(2e-5));
  CHECK(with[2] == Approx(M_PI / 200 * std::sqrt(1.12e6 / 0.546)).epsilon(1e-4));
  CHECK(with[3] == Approx(24.758).margin(1e-3));
  CHECK(without[0] == Approx(1.4558).margin(1e-4));
  CHECK(without[1] == Approx(9.1232).margin(1e-4));
  CHECK(without[3] == Approx(25.55).margin(1e-2));
  // Seven of the first seventeen are axial with rotary inertia, eight without (it lowers the bending modes).
  CHECK(axial(with) == 7);
  CHECK(axial(without) == 8);
}
