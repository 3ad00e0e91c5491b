#include <catch2/catch.hpp>

#include "../../src/app/campbell.h"
#include "space_twin.h"

using namespace floe;
using namespace floe::test;

// A shell's edge that is joined to another body is one rigid piece: clamped to a rigid hub that stands, or is heavy,
// the shell vibrates as if the ground clamped it.

namespace {

/// A plate of 1 m x 0.5 m on a rod of which nothing bends, beside its left edge.
std::string on_hub(const std::string& joints, const std::string& density = "1000", const std::string& rest = "",
                   const std::string& bodies = "") {
  return fill(R"yaml(
bodies:$bodies
  hub:
    rigid: true
    mesh: {line: {from: [-0.2, 0.25, 0], to: [0, 0.25, 0], elements: 1}}
    section: {shape: rectangle, width: 0.5, height: 0.5, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: $rho}
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.5, 0], elements: [4, 3], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 8e9, nu: 0.3, rho: 1000}
    reduction: {modes: 8}
joints: {$joints}
$rest
)yaml",
              {{"rho", density}, {"joints", joints}, {"rest", rest}, {"bodies", bodies}});
}
const std::string held = "post: {type: driven, between: [ground, hub.end], axis: [0, 0, 1], angle: \"t\"}, ",
                  clamp = "root: {type: fixed, between: [hub.end, plate.left]}";

/// Frequencies at rest; those of rigid motions are zero but for round-off.
std::vector<double> frequencies(const std::string& text, Formulation formulation) {
  app::CampbellRequest request;
  request.speeds = "0", request.modes = 40;
  request.about = "0,0,1", request.through = "0,0.25,0";
  std::exception_ptr fault;
  const app::CampbellDiagram found =
      app::campbell(scene::parse_scene(text, "scene"), formulation, PETSC_COMM_WORLD, request, fault);
  if (fault) std::rethrow_exception(fault);
  REQUIRE(found.points.at(0).fault == "");
  std::vector<double> all;
  for (const auto& vibration : found.points[0].vibrations)
    if (vibration.omega > 10) all.push_back(vibration.omega);
  REQUIRE(all.size() >= 4);
  all.resize(4);
  return all;
}

/// Greatest relative difference of the lowest frequencies.
double off(const std::vector<double>& found, const std::vector<double>& expected) {
  double worst = 0;
  for (std::size_t i = 0; i < found.size(); ++i) worst = std::max(worst, std::abs(found[i] / expected[i] - 1));
  return worst;
}

}  // namespace

TEST_CASE("edges in space: a shell clamped to a hub by its edge vibrates as one that the ground clamps") {
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    const std::string ground = "root: {type: driven, between: [ground, plate.left], axis: [0, 0, 1], angle: \"t\"}";
    const std::vector<double> clamped = frequencies(on_hub(held + ground), formulation);
    const double tolerance = formulation == Formulation::nlffr ? 1e-6 : 5e-3;
    CHECK(off(frequencies(on_hub(held + clamp), formulation), clamped) < tolerance);
    const std::string driven = "root: {type: driven, between: [hub.end, plate.left], axis: [1, 2, 3], angle: \"t\"}";
    CHECK(off(frequencies(on_hub(held + driven), formulation), clamped) < tolerance);
    const std::string mean = "root: {type: fixed, between: [hub.end, plate.left], edges: mean}";
    CHECK(off(frequencies(on_hub(held + mean), formulation), clamped) > 0.02);  // what the mean alone would leave
  }
}

// A free hub of 5e7 kg stands as the ground does, and the shell of 5 kg moves as if clamped to it.
TEST_CASE("edges in space: a shell on a free and heavy hub") {
  const auto pushed = [](const std::string& joints, Formulation formulation) {
    return move(on_hub(joints, "1e9", R"yaml(
loads: {f: {type: force, at: plate.p3, force: [0, 0, "0.2*t"]}}
motion: {end: 0.3, step: 3e-3}
probes: {tip: {at: plate.p3}, side: {at: plate.p2}}
)yaml"),
                formulation);
  };
  for (const Formulation formulation : {Formulation::nlffr, Formulation::vm_md}) {
    const History ground = pushed("root: {type: fixed, between: [ground, plate.left]}", formulation),
                  free = pushed(clamp, formulation);
    for (const std::string probe : {"tip", "side"})
      CHECK(apart(free, ground, probe) < (formulation == Formulation::nlffr ? 1e-3 : 1e-2));
  }
}

// The left edge is clamped to a rigid hub and the bottom edge to a rigid bar: they share p1, and are one piece. Loads
// and probes at nodes of the piece act on it and move with it.
TEST_CASE("edges in space: two edges with a common corner, loads and probes on what follows") {
  const auto moved = [](const std::string& load, Formulation formulation) {
    return move(on_hub("post: {type: revolute, between: [ground, hub.start], axis: [0, 1, 0]}, " + clamp +
                           ", bar: {type: fixed, between: [plate.bottom, bar.middle]}",
                       "1000", R"yaml(
motion: {end: 0.1, step: 2e-3}
probes: {corner: {at: plate.p1}, edge: {at: plate.left}, far: {at: plate.p2}, tip: {at: plate.p3}}
)yaml" + load,
                       R"yaml(
  bar:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 2}}
    section: {shape: rectangle, width: 0.02, height: 0.02, orientation: [0, 1, 0]}
    material: {E: 1, nu: 0.3, rho: 1000}
)yaml"),
                formulation);
  };
  const std::string at_corner = "loads: {f: {type: force, at: plate.p2, force: [0, 0, 800]}}",
                    at_bar = "loads: {f: {type: force, at: bar.end, force: [0, 0, 800]}}";
  const History full = moved(at_corner, Formulation::nlffr), bar = moved(at_bar, Formulation::nlffr),
                reduced = moved(at_corner, Formulation::vm_md);
  for (const std::string probe : {"corner", "edge", "far", "tip"}) {
    INFO(probe);
    CHECK(apart(full, bar, probe) < 1e-3);  // one point of one rigid piece, to second order in its turn in the frame
    CHECK(apart(reduced, full, probe) < 1e-2);
  }
  // the piece keeps its lengths, to second order in its turn
  const std::size_t end = full.t.size() - 1;
  const Eigen::Vector3d p1 = vector_at(full, "corner", end), p2 = vector_at(full, "far", end);
  CHECK(p2.norm() > 1e-3);
  CHECK((Eigen::Vector3d(1, 0, 0) + p2 - p1).norm() == Approx(1).epsilon(1e-3));
}

// Two panels that unfold by a driven hinge along their common edge: reduced against full order.
TEST_CASE("edges in space: panels on driven hinges, reduced as at full order") {
  const std::string text = R"yaml(
bodies:
  inner:
    mesh: {plate: {along: [0.8, 0, 0], across: [0, 0.5, 0], elements: [4, 3]}}
    section: {thickness: 6e-3}
    material: {E: 2e9, nu: 0.3, rho: 600}
    reduction: {modes: 4}
  outer:
    mesh: {plate: {along: [0.8, 0, 0], across: [0, 0.5, 0], elements: [4, 3]}}
    section: {thickness: 6e-3}
    material: {E: 2e9, nu: 0.3, rho: 600}
    reduction: {modes: 4}
    initial: {position: [0, 0.5, 0]}
joints:
  root: {type: driven, between: [ground, inner.bottom], angle: "0.3*(1 - cos(4*t))"}
  fold: {type: driven, between: [inner.top, outer.bottom], angle: "-0.8*(1 - cos(4*t))"}
motion: {end: 0.4, step: 2e-3}
probes: {tip: {at: outer.p3, quantity: position}, bent: {at: outer.p3, quantity: deflection}}
)yaml";
  const History full = move(text, Formulation::nlffr), reduced = move(text, Formulation::vm_md);
  CHECK(apart(reduced, full, "tip") < 1e-3);
  CHECK(apart(reduced, full, "bent") < 2e-2);
}
