#include <catch2/catch.hpp>

#include "floe/generate/generate.h"
#include "floe/mesh/write_gmsh.h"
#include "spatial_scenes.h"

using namespace floe;
using namespace floe::test;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

Matrix3d rotated_by(int orientation) {
  const Vector3d axes[] = {{0, 0, 1}, {0.3, -0.7, 1.1}, {1, 1, 0.2}, {-0.4, 0.9, 0.6}};
  const double angles[] = {0, 1.3, 0.7, 2.4};
  return Eigen::AngleAxisd(angles[orientation], axes[orientation].normalized()).toRotationMatrix();
}

std::string text(const Vector3d& x) { return fmt::format("[{}, {}, {}]", number(x[0]), number(x[1]), number(x[2])); }

std::string growing(const Vector3d& force) {
  return fmt::format("[\"{}*t\", \"{}*t\", \"{}*t\"]", number(force[0]), number(force[1]), number(force[2]));
}

/// Greatest difference of the probes of reduced and full order, over the greatest displacement.
double error(const std::string& scene, int steps, const std::string& name = "scene") {
  const auto at_rest = [&](Formulation formulation) {
    const assembly::Model model = assembly::build(scene::parse_scene(scene, name), formulation, PETSC_COMM_WORLD);
    for (int i = 1; i <= steps; ++i) solve::equilibrium(*model.system, double(i) / steps, model.U, model.V);
    return assembly::probe_values(model, 1, model.U, model.V);
  };
  const std::vector<double> full = at_rest(Formulation::nlffr), reduced = at_rest(Formulation::vm_md);
  double difference = 0, greatest = 0;
  for (std::size_t i = 0; i < full.size(); ++i) {
    difference = std::max(difference, std::abs(reduced[i] - full[i]));
    greatest = std::max(greatest, std::abs(full[i]));
  }
  return difference / greatest;
}

/// Three members, clamped at the foot of the first; `force` at its end, in the axes of the frame.
std::string members(const Matrix3d& R, double radius, const Vector3d& force) {
  const Vector3d a(1, 0, 0), b = a + Vector3d(std::cos(0.5), std::sin(0.5), 0), c = b + Vector3d(0, 0, 0.7);
  return fill(R"yaml(
bodies:
  f:
    mesh: {polyline: {points: [[0, 0, 0], $a, $b, $c], elements: [4, 4, 4]}}
    section: {shape: circle, radius: $r, orientation: $o}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    frame: {type: clamped, at: start}
    reduction: {modes: 6, attachment: loads}
joints: {root: {type: fixed, between: [ground, f.start]}}
loads: {pull: {type: force, at: f.p2, force: $force}}
motion: {end: 1, step: 1e-2}
probes: {p: {at: f.p2}, end: {at: f.end}}
)yaml",
              {{"a", text(R * a)},
               {"b", text(R * b)},
               {"c", text(R * c)},
               {"r", number(radius)},
               {"o", text(R * Vector3d(0.2, 0.5, 1))},
               {"force", growing(R * force)}});
}

}  // namespace

// u = F L / (E A) along the first member, 1e7 ... 1e8 times as stiff as across it: the three unit loads along the axes
// of an oblique body all bend it.
TEST_CASE("an oblique frame of slender beams is pulled along a member: reduced as full-order") {
  const int orientation = GENERATE(0, 1, 2, 3);
  const Matrix3d R = rotated_by(orientation);
  for (const double radius : {1e-3, 1e-4}) {
    INFO("orientation " << orientation << ", radius " << radius);
    const double EA = 7e10 * M_PI * radius * radius, EI = EA * radius * radius / 4;
    CHECK(error(members(R, radius, {1e-6 * EA, 0, 0}), 1) < 1e-6);
    CHECK(error(members(R, radius, {0.5 * EI, 0.2 * EI, 0.3 * EI}), 4) < 1e-3);  // bends by a tenth
  }
}

TEST_CASE("an oblique load that no basis vector represents is reported, although its components are represented") {
  const auto notes = [](const std::string& scene) {
    const assembly::Model model =
        assembly::build(scene::parse_scene(scene, "scene"), Formulation::vm_md, PETSC_COMM_WORLD);
    return std::count_if(model.warnings.begin(), model.warnings.end(), [](const std::string& warning) {
      return warning.find("of the work of load pull on its static response") != std::string::npos;
    });
  };
  const std::string with = members(rotated_by(1), 1e-3, {1, 0, 0});
  std::string without = with;
  without.replace(without.find("attachment: loads"), 17, "attachment: none, derivatives: none");
  CHECK(notes(with) == 0);
  CHECK(notes(without) == 1);
}

// K's factor misses 1e-4 of a static response there, and even the forces of its elements round it to 1e-5.
TEST_CASE("an oblique frame at the limit of double precision, r/L = 4e-6") {
  const double r = 1e-5, EA = 7e10 * M_PI * r * r;
  CHECK(error(members(rotated_by(1), r, {1e-6 * EA, 0, 0}), 1) < 1e-3);
}

// The same at the corner of a fold, along the edge of the plate that is clamped.
TEST_CASE("an oblique folded plate is pulled in the plane of a panel: reduced as full-order") {
  const int orientation = GENERATE(0, 1, 3);
  const Matrix3d R = rotated_by(orientation);
  const Scratch scratch;
  generate::Plate floor{{0, 0, 0}, R * Vector3d(1, 0, 0), R * Vector3d(0, 1, 0), 6, 6},
      wall{R * Vector3d(1, 0, 0), R * Vector3d(0, 0, 1), R * Vector3d(0, 1, 0), 6, 6};
  mesh::write_gmsh((scratch.path / "fold.msh").string(),
                   generate::folded_plates(PETSC_COMM_WORLD, {{"floor", floor}, {"wall", wall}}));
  const auto pulled = [&](double thickness, const Vector3d& force) {
    return fill(R"yaml(
bodies:
  f:
    mesh: {file: {path: fold.msh}}
    section: {thickness: $t}
    parts: {floor: {}, wall: {}}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 6, attachment: loads}
joints: {root: {type: fixed, between: [ground, f.floor.left]}}
loads: {pull: {type: force, at: f.floor.p2, force: $force}}
motion: {end: 1, step: 1e-2}
probes: {p: {at: f.floor.p2}, q: {at: f.floor.p3}, r: {at: f.wall.p3}}
)yaml",
                {{"t", number(thickness)}, {"force", growing(R * force)}});
  };
  const std::string name = (scratch.path / "scene.yaml").string();
  for (const double t : {1e-2, 3e-4, 1e-4}) {
    INFO("orientation " << orientation << ", thickness " << t);
    const double D = 7e10 * std::pow(t, 3) / 12;
    CHECK(error(pulled(t, {1e-9 * 7e10 * t, 0, 0}), 1, name) < 1e-3);
    CHECK(error(pulled(t, {5 * D * t, 0, 3 * D * t}), 1, name) < 1e-3);  // deflects by its thickness
  }
}

// In the plane.
TEST_CASE("an oblique planar frame is pulled along a member: reduced as full-order") {
  const double angle = GENERATE(0., 0.4, 2.1), radius = 1e-4, EA = 7e10 * M_PI * radius * radius;
  const Eigen::Rotation2Dd R(angle);
  const auto text = [&](double x, double y) {
    const Eigen::Vector2d rotated = R * Eigen::Vector2d(x, y);
    return fmt::format("[{}, {}]", number(rotated[0]), number(rotated[1]));
  };
  const Eigen::Vector2d force = R * Eigen::Vector2d(1e-6 * EA, 0);
  CHECK(error(fill(R"yaml(
bodies:
  f:
    frame: {type: clamped, at: start}
    mesh: {polyline: {points: [[0, 0], $a, $b], elements: [4, 4]}}
    section: {A: pi*1e-8, I: pi*1e-16/4}
    material: {E: 7e10, rho: 2700}
    reduction: {modes: 6, attachment: loads}
joints: {root: {type: fixed, between: [ground, f.start]}}
loads: {pull: {type: force, at: f.p2, force: ["$x*t", "$y*t"]}}
motion: {end: 1, step: 1e-2}
probes: {p: {at: f.p2}, end: {at: f.end}}
)yaml",
                   {{"a", text(1, 0)}, {"b", text(1.8, 0.5)}, {"x", number(force[0])}, {"y", number(force[1])}}),
              1) < 1e-6);
}
