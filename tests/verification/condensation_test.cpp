#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <tuple>

#include "floe/solve/start.h"
#include "spatial_scenes.h"

using namespace floe;
using namespace floe::test;
using scene::Formulation;

namespace {

/// Of the displacement of place t, relative to full order.
double error_of(const scene::Scene& parsed) {
  Eigen::Vector3d ends[2];
  for (const auto formulation : {Formulation::nlffr, Formulation::vm_md}) {
    const assembly::Model model = assembly::build(parsed, formulation, PETSC_COMM_WORLD);
    for (int i = 1; i <= 4; ++i) solve::equilibrium(*model.system, i / 4., model.U, model.V);
    const std::vector<double> values = assembly::probe_values(model, 1, model.U, model.V);
    ends[formulation == Formulation::vm_md] = Eigen::Vector3d::Map(values.data());
  }
  CHECK(ends[0].norm() > 0.05);
  return (ends[1] - ends[0]).norm() / ends[0].norm();
}

}  // namespace

// Slopes of rotated nodes and of the deflection between them agree to the second order; what remains, of third order,
// weighs as 12 EI/h^2, and full order has displacements for it. Without condensed strains the reduced error is 0.13,
// 1.5 and 9.7 % with 16, 64 and 256 elements on each leg. Attachment modes and few derivatives: 29 % where the strains
// of products with derivatives alone are condensed (3.9 % where none are).
TEST_CASE("beams of second order: an L reduced as its full-order model, however fine the mesh") {
  for (const auto& [elements, reduction, gravity, force] :
       {std::tuple(16, "{modes: 6}", 60, 0),
        {64, "{modes: 6}", 60, 0},
        {256, "{modes: 6}", 60, 0},
        {24, "{modes: 6, derivatives: 10, attachment: all}", 40, 20}}) {
    INFO(elements << " elements on each leg");
    CHECK(error_of(scene::parse_scene(fmt::format(R"yaml(
gravity: ["{2}*t", 0, "{2}*t"]
bodies:
  b:
    mesh: {{polyline: {{points: [[0, 0, 0], [0, 1, 0], [1, 1, 0]], elements: [{0}, {0}]}}}}
    section: {{A: 4e-4, Iy: 1e-8, Iz: 2e-8, J: 2e-8, orientation: [0, 0, 1]}}
    material: {{E: 7e10, nu: 0.3, rho: 2700}}
    strains: second_order
    frame: {{type: clamped, at: start}}
    reduction: {1}
joints: {{root: {{type: fixed, between: [ground, b.start]}}}}
loads: {{tip: {{type: force, at: b.end, force: ["{3}*t", "-2*{3}*t", "2*{3}*t"]}}}}
motion: {{end: 1, step: 1e-2}}
probes: {{t: {{at: b.end, quantity: displacement}}}}
)yaml",
                                                  elements, reduction, gravity, force),
                                      "scene")) < 1e-3);
  }
}

// A quarter of a cylinder, clamped at one end, pushed at the other. With products with derivatives alone condensed 45 %
// (10 derivatives) and 9.7 % (all).
TEST_CASE("second order: a curved strip of shells with attachment modes as its full-order model") {
  constexpr int along = 16, across = 3;
  std::string nodes, elements, root, tip;
  for (int i = 0, count = 0; i <= along; ++i)
    for (int j = 0; j <= across; ++j) {
      const double a = M_PI / 2 * i / along;
      const int node = i * (across + 1) + j + 1;
      nodes += fmt::format("{}, {}, {}, {}\n", node, std::sin(a), 0.2 * j / across, 1 - std::cos(a));
      if (i == 0) root += fmt::format("{}\n", node);
      if (i == along) tip += fmt::format("{}\n", node);
      if (i < along && j < across)
        elements += fmt::format("{}, {}, {}, {}, {}\n", ++count, node, node + across + 1, node + across + 2, node + 1);
    }
  const test::Scratch scratch;
  write_text(
      (scratch.path / "arc.inp").string(),
      "*NODE\n" + nodes + "*ELEMENT, TYPE=S4, ELSET=ALL\n" + elements + "*NSET, NSET=ROOT\n" + root +
          "*NSET, NSET=TIP\n" + tip +
          "*MATERIAL, NAME=M\n*ELASTIC\n7e10, 0.3\n*DENSITY\n2700\n*SHELL SECTION, ELSET=ALL, MATERIAL=M\n0.005\n");
  for (const auto& [derivatives, most] : {std::pair("10", 0.01), {"all", 0.004}}) {
    INFO(derivatives << " derivatives");
    CHECK(error_of(scene::parse_scene(fmt::format(R"yaml(
bodies:
  b:
    mesh: {{file: {{path: arc.inp}}}}
    strains: second_order
    reduction: {{modes: 6, derivatives: {}, attachment: all}}
joints: {{root: {{type: fixed, between: [ground, b.ROOT]}}}}
loads: {{f: {{type: force, at: b.TIP, force: ["20*t", "10*t", "-20*t"]}}}}
motion: {{end: 1, step: 1e-2}}
probes: {{t: {{at: b.TIP, quantity: displacement}}}}
)yaml",
                                                  derivatives),
                                      (scratch.path / "scene.yaml").string())) < most);
  }
}
