#include <catch2/catch.hpp>

#include "spatial_scenes.h"

using namespace floe;
using namespace floe::test;

namespace {

/// A plate of 2 m x 1 m x 2 mm with n elements across.
struct PlateCase {
  std::string cells = "triangles", section = "{thickness: 0.002}", material = "{E: 7e10, nu: 0.3, rho: 2700}";
};

std::vector<double> frequencies(const PlateCase& plate, const std::string& joints, int n) {
  return omega_of(fill(R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [2, 0, 0], across: [0, 1, 0], elements: [$along, $n], cells: $cells}}
    section: $section
    material: $material
    reduction: {modes: 5}
joints: {$joints}
)yaml",
                       {{"along", std::to_string(2 * n)},
                        {"n", std::to_string(n)},
                        {"cells", plate.cells},
                        {"section", plate.section},
                        {"material", plate.material},
                        {"joints", joints}}));
}

std::string on_edges(const std::string& type, const std::vector<std::string>& edges) {
  std::string all;
  for (const std::string& edge : edges) all += edge + ": {type: " + type + ", between: [ground, plate." + edge + "]}, ";
  return all.substr(0, all.size() - 2);
}

struct Bending {
  double D11, D12, D22, D66, mass;
};

/// Lowest frequencies of a simply supported orthotropic plate a x b (Navier).
std::vector<double> navier(const Bending& p, double a, double b) {
  std::vector<double> all;
  for (int m = 1; m < 9; ++m)
    for (int n = 1; n < 9; ++n) {
      const double x = m * m / (a * a), y = n * n / (b * b);
      all.push_back(M_PI * M_PI *
                    std::sqrt((p.D11 * x * x + 2 * (p.D12 + 2 * p.D66) * x * y + p.D22 * y * y) / p.mass));
    }
  std::sort(all.begin(), all.end());
  all.resize(5);
  return all;
}

/// Supported on all edges: the error is of order 2 in the cell, and the limit is Navier's.
void check_supported(const PlateCase& plate, const Bending& bending) {
  const std::string joints = on_edges("revolute, edges: mean", {"left", "right", "bottom", "top"});
  const auto exact = navier(bending, 2, 1), coarse = frequencies(plate, joints, 8),
             fine = frequencies(plate, joints, 16);
  for (int i = 0; i < 5; ++i) {
    INFO(plate.cells << ", mode " << i + 1);
    CHECK(std::abs(fine[i] / exact[i] - 1) < 5e-3);
    CHECK((4 * fine[i] - coarse[i]) / 3 == Approx(exact[i]).epsilon(3e-4));
  }
}

}  // namespace

// omega a^2 sqrt(rho h / D) of the Kirchhoff plate, nu = 0.3, a/b = 2: limit of refinement of other thin shell
// elements, to the digits shown (also tests/convergence).
TEST_CASE("cantilever plate") {
  const double exact[] = {3.4392, 14.801, 21.434, 48.178, 60.159};
  const double D = 7e10 * 8e-9 / (12 * 0.91), scale = 4 * std::sqrt(2700 * 0.002 / D);
  for (const std::string cells : {"triangles", "quadrilaterals"}) {
    const auto omega = frequencies({cells}, on_edges("fixed", {"left"}), 16);
    for (int i = 0; i < 5; ++i) {
      INFO(cells << ", mode " << i + 1);
      CHECK(omega[i] * scale == Approx(exact[i]).epsilon(1.3e-3));
    }
    CHECK(omega[0] / (2 * M_PI) == Approx(0.42170).epsilon(3e-4));
  }
}

TEST_CASE("simply supported plate (Navier)") {
  const double D = 7e10 * 8e-9 / (12 * 0.91);
  for (const std::string cells : {"triangles", "quadrilaterals"})
    check_supported({cells}, {D, 0.3 * D, D, 0.35 * D, 2700 * 0.002});
}

// Symmetric cross-ply: B = 0, D by classical lamination theory (Jones, ch. 4).
TEST_CASE("simply supported cross-ply plate (Navier)") {
  const double E1 = 100e9, E2 = 10e9, nu = 0.25, G = 5e9, of_one = E1 / (1 - nu * nu * E2 / E1),
               across = of_one * E2 / E1, h = 2e-3, inner = std::pow(h / 3, 3) / 12, outer = h * h * h / 12 - inner;
  const Bending bending{outer * of_one + inner * across, nu * across * (outer + inner), outer * across + inner * of_one,
                        G * (outer + inner), 1600 * h};
  for (const std::string cells : {"triangles", "quadrilaterals"})
    check_supported({cells, "{plies: [[0.002/3, 0], [0.002/3, 90], [0.002/3, 0]], axis: [1, 0, 0]}",
                     "{E1: 100e9, E2: 10e9, nu12: 0.25, G12: 5e9, rho: 1600}"},
                    bending);
}

// Plies rotated by 90 degrees and the axis rotated back are the same plate.
TEST_CASE("ply angles and the section axis rotate together") {
  const std::string material = "{E1: 100e9, E2: 10e9, nu12: 0.25, G12: 5e9, rho: 1600}",
                    root = on_edges("fixed", {"left"});
  const auto rotated = [&](const std::string& section) {
    return frequencies({"triangles", section, material}, root, 6);
  };
  const auto along = rotated("{plies: [[0.001, 30], [0.001, -30]], axis: [1, 0, 0]}"),
             across = rotated("{plies: [[0.001, -60], [0.001, -120]], axis: [0, 1, 0]}"),
             mirrored = rotated("{plies: [[0.001, -30], [0.001, 30]], axis: [1, 0, 0]}");
  for (int i = 0; i < 5; ++i) CHECK(along[i] == Approx(across[i]).epsilon(1e-9));
  CHECK(std::abs(along[0] / mirrored[0] - 1) < 0.05);
  CHECK(std::abs(rotated("{plies: [[0.002, 0]], axis: [0, 1, 0]}")[0] / along[0] - 1) > 0.2);
}
