#include <catch2/catch.hpp>

#include "scene_motion.h"

using namespace floe;
using namespace floe::test;

// What docs/paper.md says of the two cases of Wu & Tiso, by the scenes of examples/. The bounds are its numbers,
// rounded up (or down, where a basis fails); the differences are of the reduction alone: same mesh, same steps.

namespace {

History example(const std::string& name, Formulation formulation) {
  return move(scene::read_scene("examples/" + name + ".yaml").text, formulation);
}

/// 100 |a - b| / |b| over the horizon.
double percent(const std::string& column, const History& a, const History& b) {
  REQUIRE(a.t.size() == b.t.size());
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < a.t.size(); ++i) {
    difference += std::pow(a[column][i] - b[column][i], 2);
    size += std::pow(b[column][i], 2);
  }
  return 100 * std::sqrt(difference / size);
}

double greatest_distance(const History& a, const History& b) {
  REQUIRE(a.t.size() == b.t.size());
  double greatest = 0;
  for (std::size_t i = 0; i < a.t.size(); ++i)
    greatest = std::max(greatest, std::hypot(a["tip.x"][i] - b["tip.x"][i], a["tip.y"][i] - b["tip.y"][i]));
  return greatest;
}

/// Axial ones among the modes of a scene's only body, clamped and free, by the frequencies of n linear elements with
/// consistent mass: omega_k^2 = 6 (c/h)^2 (1 - cos a) / (2 + cos a), a = (2k - 1) pi / 2n, c^2 = E/rho.
int axial_modes(const std::string& name, int modes) {
  scene::Scene scene = scene::read_scene("examples/" + name + ".yaml");
  scene.bodies[0].reduction.modes.count = modes;
  const scene::Section& section = scene.bodies[0].section;
  const int n = 20;
  const double c_over_h = std::sqrt(section.EA / section.rhoA) / (100.0 / n);
  const std::vector<assembly::BodyReport> bodies = assembly::body_modes(scene, PETSC_COMM_WORLD);
  int axial = 0;
  for (double omega : bodies[0].omega)
    for (int k = 1; k <= n; ++k) {
      const double a = (2 * k - 1) * M_PI / (2 * n);
      const double exact = c_over_h * std::sqrt(6 * (1 - std::cos(a)) / (2 + std::cos(a)));
      axial += std::abs(omega / exact - 1) < 1e-7;
    }
  return axial;
}

}  // namespace

TEST_CASE("paper: cantilever in the pinned frame, 12 modes and 5 derivatives, and 17 modes") {
  const History full = example("cantilever/scene", Formulation::nlffr);
  const History few = example("cantilever/scene", Formulation::vm_md),
                modes = example("cantilever/scene", Formulation::vm);
  REQUIRE(few.model.bodies[0].columns == 17);
  REQUIRE(modes.model.bodies[0].columns == 17);
  CHECK(percent("tip.x", few, full) < 0.15);
  CHECK(percent("tip.y", few, full) < 0.08);
  CHECK(percent("tip.x", modes, full) > 30);
  CHECK(percent("tip.y", modes, full) > 12);
  const History linear = example("cantilever/scene", Formulation::lffr);
  CHECK(percent("tip.y", linear, full) > 50);

  const History all = example("cantilever/all_derivatives", Formulation::vm_md);
  CHECK(percent("tip.x", all, full) < 0.04);
  CHECK(percent("tip.y", all, full) < 0.02);

  const History hinged = example("cantilever/hinged_modes", Formulation::vm_md);
  REQUIRE(hinged.model.bodies[0].columns == 17);
  CHECK(percent("tip.x", hinged, full) > 50);
  CHECK(percent("tip.y", hinged, full) > 25);
  REQUIRE(hinged.model.warnings.size() == 1);
  CHECK(hinged.model.warnings[0].find("clamp") != std::string::npos);
}

TEST_CASE("paper: cantilever in the clamped frame, 12 modes and 5 derivatives, and 17 modes") {
  const History full = example("cantilever/clamped_frame", Formulation::nlffr);
  const History few = example("cantilever/clamped_frame", Formulation::vm_md);
  CHECK(percent("tip.x", few, full) < 0.1);
  CHECK(percent("tip.y", few, full) < 0.1);
  const History modes = example("cantilever/clamped_frame", Formulation::vm);
  CHECK(percent("tip.x", modes, full) > 70);
  CHECK(percent("tip.y", modes, full) > 50);
}

TEST_CASE("paper: cantilever in four frames agrees with corotational beams") {
  const History exact = example("cantilever/scene", Formulation::cfr);
  const History one = example("cantilever/scene", Formulation::nlffr);
  const History four = example("cantilever/four_frames", Formulation::vm_md);
  CHECK(percent("tip.x", one, exact) > 10);
  CHECK(percent("tip.x", four, exact) < 1);
  CHECK(percent("tip.y", four, exact) < 1);
}

TEST_CASE("paper: the pointwise membrane strain locks") {
  const History averaged = example("cantilever/scene", Formulation::nlffr);
  const History pointwise = example("cantilever/pointwise_strain", Formulation::nlffr);
  CHECK(percent("tip.x", pointwise, averaged) > 4);
  CHECK(percent("tip.y", pointwise, averaged) > 1.5);
}

TEST_CASE("paper: 7 of the first 17 modes are axial with rotary inertia, 8 without") {
  CHECK(axial_modes("cantilever/scene", 17) == 7);
  CHECK(axial_modes("cantilever/no_rotary_inertia", 17) == 8);
}

TEST_CASE("paper: robot arm, 3 modes and 6 derivatives, and 9 modes") {
  const History full = example("robot_arm/scene", Formulation::nlffr);
  const History few = example("robot_arm/scene", Formulation::vm_md),
                modes = example("robot_arm/scene", Formulation::vm);
  REQUIRE(few.model.bodies[0].columns == 9);
  REQUIRE(modes.model.bodies[0].columns == 9);
  CHECK(greatest_distance(few, full) < 0.003);
  CHECK(greatest_distance(modes, full) > 0.15);
  CHECK(greatest_distance(example("robot_arm/scene", Formulation::lffr), full) > 0.06);

  const History more = example("robot_arm/moment_column", Formulation::vm_md);
  REQUIRE(more.model.bodies[0].columns == 14);
  CHECK(greatest_distance(more, full) < 0.0025);
  CHECK(percent("bending.y", more, full) < 0.35);
  CHECK(percent("bending.y", few, full) < 1.2);
  CHECK(percent("bending.y", modes, full) > 40);
}
