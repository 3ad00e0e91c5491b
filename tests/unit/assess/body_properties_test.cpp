#include "floe/assess/body_properties.h"

#include <catch2/catch.hpp>

#include "floe/scene/places.h"
#include "scene_motion.h"
#include "spatial_scene.h"

using namespace floe;
using namespace floe::test;
using assess::BodyProperties;

namespace {

BodyProperties properties(const std::string& text, int frequencies = 0) {
  const auto all = assess::body_properties(scene::parse_scene(text, "scene.yaml"), PETSC_COMM_WORLD, frequencies);
  REQUIRE(all.size() == 1);
  return all[0];
}

void check_near(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected) {
  INFO(found << "\nexpected\n" << expected);
  CHECK((found - expected).norm() <= 1e-9 * expected.norm());
}

// 40 by 60 mm, 2 m long, along x, 60 mm along z.
constexpr double width = 0.04, height = 0.06, length = 2, E = 2e11, rho = 8000;

std::string bar(const std::string& rest) {
  return "bodies:\n  bar:\n    mesh: {line: {from: [1, 2, 3], to: [3, 2, 3], elements: 40}}\n"
         "    section: {shape: rectangle, width: 0.04, height: 0.06, orientation: [0, 1, 0]}\n"
         "    material: {E: 2e11, nu: 0.3, rho: 8000}\n" +
         rest;
}

}  // namespace

TEST_CASE("mass, centre, inertia and frequencies of a bar are those of its formulas") {
  const double m = rho * width * height * length;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  inertia.diagonal() << m * (width * width + height * height) / 12, m * (length * length + height * height) / 12,
      m * (length * length + width * width) / 12;
  const double bending = width * width * std::sqrt(E / (12 * rho)) / (length * length) / width;  // about z
  // roots of cos b cosh b = 1 and -1
  constexpr double free = 4.730040744862704, cantilever = 1.875104068711961;
  for (const std::string frame : {"mean-axis", "{type: clamped, at: start}"}) {
    const auto own = properties(bar("    frame: " + frame + "\n"), 2);
    CHECK(own.mass == Approx(m).epsilon(1e-12));
    check_near(own.centre, Eigen::Vector3d(2, 2, 3));
    check_near(own.inertia, inertia);
    REQUIRE(own.box);
    check_near(own.box->low, Eigen::Vector3d(1, 2, 3));
    check_near(own.box->high, Eigen::Vector3d(3, 2, 3));
    REQUIRE(own.free.size() == 2);  // rotary inertia: less by 1e-3
    CHECK(own.free[0] == Approx(free * free * bending).epsilon(2e-3));
    CHECK(own.free[1] == Approx(free * free * bending * height / width).epsilon(4e-3));
  }
  const auto constrained = properties(bar("joints: {root: {type: fixed, between: [ground, bar.start]}}\n"), 1);
  CHECK(constrained.free.at(0) == Approx(free * free * bending).epsilon(2e-3));
  CHECK(constrained.constrained.at(0) == Approx(cantilever * cantilever * bending).epsilon(1e-3));
  CHECK(properties(bar("    frame: mean-axis\n"), 1).constrained.empty());
}

TEST_CASE("mass, centre and inertia of an oblique plate are those of its formulas, rigid or not") {
  const Eigen::Vector3d origin(0.5, -1, 2), a = Eigen::Vector3d(2, 1, 0).normalized() * 1.5,
                                            b = Eigen::Vector3d(-1, 2, 1).normalized() * 0.8;
  const double t = 0.03, m = rho * 1.5 * 0.8 * t;
  const auto text = [](const Eigen::Vector3d& x) {
    return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", x[0], x[1], x[2]);
  };
  const Eigen::Vector3d n = a.cross(b).normalized();
  const Eigen::Matrix3d moments = m / 12 * (a * a.transpose() + b * b.transpose() + t * t * n * n.transpose());
  for (const char* rest : {"frame: mean-axis", "rigid: true"}) {
    const auto own =
        properties("bodies:\n  plate:\n    mesh: {plate: {origin: " + text(origin) + ", along: " + text(a) +
                   ", across: " + text(b) +
                   ", elements: [6, 4]}}\n    section: {thickness: 0.03}\n    material: {E: 2e11, nu: 0.3, "
                   "rho: 8000}\n    " +
                   rest + "\n");
    CHECK(own.mass == Approx(m).epsilon(1e-12));
    check_near(own.centre, origin + (a + b) / 2);
    check_near(own.inertia, moments.trace() * Eigen::Matrix3d::Identity() - moments);
    CHECK(own.free.empty());
  }
}

TEST_CASE("a planar beam has its moment of inertia and its frequencies") {
  const auto own = properties(
      "bodies:\n  beam:\n    mesh: {line: {from: [1, 1], to: [1, 3], elements: 16}}\n"
      "    section: {EA: 1e5, EI: 10, rhoA: 3}\n    frame: mean-axis\n",
      1);
  CHECK(own.mass == Approx(6));
  check_near(own.centre, Eigen::Vector3d(1, 2, 0));
  CHECK(own.inertia(2, 2) == Approx(6 * 4 / 12.));
  CHECK(own.free.at(0) == Approx(22.373285 * std::sqrt(10 / 3.) / 4).epsilon(1e-4));
}

TEST_CASE("point masses and what they are linked to count with their places") {
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  inertia.diagonal() << 4, 4, 8;  // 2 kg at (+-1, 0), (0, +-1) about the centre, and nothing else
  const testing::Folder folder;
  const std::string path = folder.write(
      "masses.inp",
      "*NODE\n1, 1, 0, 0\n2, -1, 0, 0\n3, 0, 1, 0\n4, 0, -1, 0\n*ELEMENT, TYPE=B31, ELSET=B\n1, 1, 3\n2, 3, 2\n3, 2, "
      "4\n4, 4, 1\n*ELEMENT, TYPE=MASS, ELSET=M\n5, 1\n6, 2\n7, 3\n8, 4\n*MASS, ELSET=M\n2\n*MATERIAL, NAME=S\n"
      "*ELASTIC\n2e11, 0.3\n*BEAM SECTION, ELSET=B, MATERIAL=S, SECTION=CIRC\n0.01\n0, 0, 1\n");
  const auto own = properties("bodies: {b: {frame: mean-axis, mesh: {file: {path: '" + path + "'}}}}\n");
  CHECK(own.mass == Approx(8));
  CHECK(own.centre.norm() < 1e-12);
  check_near(own.inertia, inertia);
}

TEST_CASE("a mass at the middle of a line is at its middle node") {
  const auto own = properties(bar("    masses: {m: {at: middle, mass: 5}}\n")),
             same = properties(bar("    masses: {m: {at: [2, 2, 3], mass: 5}}\n"));
  CHECK(own.mass == Approx(width * height * length * rho + 5));
  check_near(own.inertia, same.inertia);
  check_near(own.centre, Eigen::Vector3d(2, 2, 3));
  std::string odd = bar("    masses: {m: {at: middle, mass: 5}}\n");
  CHECK(scene::middles_beside_nodes(scene::parse_scene(odd, "scene.yaml")).empty());
  odd.replace(odd.find("elements: 40"), 12, "elements: 5");
  const std::vector<std::string> words = scene::middles_beside_nodes(scene::parse_scene(odd, "scene.yaml"));
  REQUIRE(words.size() == 1);
  CHECK_THAT(words[0],
             Catch::Contains("place bar.middle: no node at half of the length") && Catch::Contains("0.2 m, 10 %"));
}
