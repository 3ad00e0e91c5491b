#include <catch2/catch.hpp>

#include "floe/generate/generate.h"
#include "floe/reduction/derivatives.h"
#include "spatial_scenes.h"

using namespace floe;
using namespace floe::test;

namespace {

constexpr double A = 1e-3, Iy = 4e-8, Iz = 9e-8, J = 6e-8, E = 7e10, G = 2.6e10, rho = 2700, L = 3;

/// Bending about both axes (Euler-Bernoulli), torsion and stretching of a clamped straight beam, ascending.
std::vector<double> cantilever() {
  std::vector<double> all;
  for (const double I : {Iy, Iz})
    for (const double beta2 : {3.5160152685, 22.034491565, 61.697214414, 120.90191612, 199.85953, 298.55553})
      all.push_back(beta2 / (L * L) * std::sqrt(E * I / (rho * A)));
  for (int n = 1; n < 4; ++n) {
    const double wave = (2 * n - 1) * M_PI / (2 * L);
    all.push_back(wave * std::sqrt(G * J / (rho * (Iy + Iz))));
    all.push_back(wave * std::sqrt(E / rho));
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::string beam(const std::string& mesh, const std::string& orientation, const std::string& joints) {
  return fill(R"yaml(
bodies:
  beam:
    mesh: {$mesh}
    section: {A: 1e-3, Iy: 4e-8, Iz: 9e-8, J: 6e-8, orientation: $y}
    material: {E: 7e10, G: 2.6e10, rho: 2700}
    reduction: {modes: 10}
joints: {$joints}
)yaml",
              {{"mesh", mesh}, {"y", orientation}, {"joints", joints}});
}

}  // namespace

TEST_CASE("a cantilever in any direction bends about both axes, twists and stretches (closed form)") {
  const auto exact = cantilever();
  const std::string root = "root: {type: fixed, between: [ground, beam.start]}";
  for (const auto& [line, y] : std::vector<std::pair<std::string, std::string>>{
           {"line: {from: [0, 0, 0], to: [3, 0, 0], elements: 48}", "[0, 1, 0]"},
           {"line: {from: [1, 2, 3], to: [2, 4, 5], elements: 48}", "[1, 1, -1]"},
           {"polyline: {points: [[0, 0, 0], [0, 0, 1], [0, 0, 3]], elements: [16, 32]}", "[-1, 0.2, 0]"}}) {
    INFO(line);
    const auto omega = omega_of(beam(line, y, root));
    // rotary inertia takes (r/L)^2 beta^2 ..., linear twist and stretch err by (wave h)^2 / 24
    for (int i = 0; i < 10; ++i) CHECK(omega[i] == Approx(exact[i]).epsilon(2e-3));
    CHECK(omega[0] == Approx(exact[0]).epsilon(1e-4));
  }
}

// A portal in the plane x-z that is bent in its plane only has the frequencies of the same planar frame.
TEST_CASE("a spatial frame has the modes of the same frame in the plane") {
  const std::string joints =
      "a: {type: fixed, between: [ground, frame.p1]}, b: {type: fixed, between: [ground, frame.p4]}";
  const auto scene = [&](const std::string& points, const std::string& section, const std::string& material,
                         int modes) {
    return omega_of(fill(R"yaml(
bodies:
  frame:
    mesh: {polyline: {points: $points, elements: 8}}
    section: {$section}
    material: {$material}
    reduction: {modes: $modes}
joints: {$joints}
)yaml",
                         {{"points", points},
                          {"section", section},
                          {"material", material},
                          {"modes", std::to_string(modes)},
                          {"joints", joints}}));
  };
  // stiff out of the plane and in torsion: section y lies in the plane of the frame
  const auto plane = scene("[[0, 0], [0, 1], [2, 1], [2, 0]]", "A: 1e-3, I: 9e-8", "E: 7e10, rho: 2700", 3);
  const auto space =
      scene("[[0, 0, 0], [0, 0, 1], [2, 0, 1], [2, 0, 0]]",
            "A: 1e-3, Iz: 9e-8, Iy: 9e-4, J: 9e-4, orientation: [1, 0, 1]", "E: 7e10, G: 2.6e10, rho: 2700", 3);
  for (int i = 0; i < 3; ++i) CHECK(space[i] == Approx(plane[i]).epsilon(1e-6));
}

// Closed form of the hinged von Karman beam with immovable ends: u' + phi_i' phi_j' is constant in each plane of
// bending; modes in different planes do not meet.
TEST_CASE("modal derivatives of a hinged spatial beam in closed form") {
  constexpr int elements = 40;
  constexpr double length = 2;
  const fem::SpatialBeam section{{1e5, 1.7, 1, 0, 50, 1, 0, 0, 0, {0, 0}, {0, 0}}, {0, 1, 0}, {}};
  const mesh::RawMesh raw = generate::polyline(PETSC_COMM_WORLD, {{{0, 0, 0}, {length, 0, 0}}, {}, {elements}, {}});
  const fem::Structure s(fem::mesh_of(raw, std::vector<int>(raw.positions.size(), 0)), {section},
                         fem::MembraneStrain::averaged);
  const fem::ReferenceFrame frame = fem::reference_frame(s, fem::ReferenceFrame::Kind::pinned, 0, elements);
  constexpr int end = 6 * elements;
  const fem::Holding holding = fem::holding(s, frame, {0, 1, 2, 3, end, end + 1, end + 2});
  const reduction::Statics statics(s, frame, holding);
  reduction::Modes modes = reduction::vibration_modes(s, frame, holding, statics, 4);
  // EIz = 1 (v), EIy = 1.7 (w): v 1, w 1, v 2, w 2
  const int direction[] = {1, 2, 1, 2}, waves[] = {1, 1, 2, 2};
  for (int n = 0; n < 4; ++n) {
    const double top = everywhere(modes.shapes[n])[6 * (elements / (2 * waves[n])) + direction[n]];
    REQUIRE(std::abs(top) > 0.1);
    petsc::check(VecScale(modes.shapes[n], 1 / top));
    CHECK(modes.omega[n] ==
          Approx(std::pow(waves[n] * M_PI / length, 2) * std::sqrt(direction[n] == 1 ? 1 : 1.7)).epsilon(1e-5));
  }
  const auto u = [&](int i, int j, double x) {
    const double wave = M_PI / length;
    if (i == j) return -i * wave / 4 * std::sin(2 * i * wave * x);
    return -i * j * wave / 2 * (std::sin((i - j) * wave * x) / (i - j) + std::sin((i + j) * wave * x) / (i + j));
  };
  const auto pairs = reduction::all_pairs(4);
  const auto theta = reduction::static_derivatives(s, statics, modes.shapes, pairs);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto [i, j] = pairs[p];
    INFO("theta_" << i + 1 << j + 1);
    const auto found = everywhere(theta[p]);
    double error = 0, rest = 0;
    for (int node = 0; node <= elements; ++node) {
      const double exact = direction[i] == direction[j] ? u(waves[i], waves[j], length * node / elements) : 0;
      error = std::max(error, std::abs(found[6 * node] - exact));
      for (int d = 1; d < 6; ++d) rest = std::max(rest, std::abs(found[6 * node + d]));
    }
    CHECK(error < 1e-4);
    CHECK(rest < 1e-8);
  }
}
