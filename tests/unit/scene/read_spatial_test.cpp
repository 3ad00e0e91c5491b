#include <catch2/catch.hpp>

#include "spatial_scene.h"

using namespace floe;
using testing::body_of;
using testing::one_body;

namespace {

const fem::ShellSection& shell(const scene::Body& body, std::size_t part = 0) {
  return std::get<fem::ShellSection>(body.parts.at(part).section);
}
const fem::SpatialBeam& beam(const scene::Body& body) { return std::get<fem::SpatialBeam>(body.parts.at(0).section); }

}  // namespace

TEST_CASE("a plate is read with its defaults; the scene is in space") {
  const auto scene = scene::parse_scene(one_body(testing::plate, testing::thickness + testing::metal), "s.yaml");
  CHECK(scene.dimension == 3);
  CHECK(scene.motion.end == 0);
  const scene::PlateSpec& plate = *scene.bodies.at(0).mesh.plate;
  CHECK(plate.origin == scene::Point{0, 0, 0});
  CHECK((plate.along == scene::Point{2, 0, 0} && plate.across == scene::Point{0, 1, 0}));
  CHECK(plate.elements == std::array{4, 2});
  CHECK(plate.cells == scene::PlateSpec::Cells::triangles);
  const auto body =
      body_of(one_body("plate: {origin: [1, 2, 3], along: [2, 0, 0], across: [0, 1, 0], elements: [4, 2], "
                       "cells: quadrilaterals}",
                       testing::thickness + testing::metal));
  CHECK(body.mesh.plate->origin == scene::Point{1, 2, 3});
  CHECK(body.mesh.plate->cells == scene::PlateSpec::Cells::quadrilaterals);
  CHECK_FALSE(body.frame.given);
}

TEST_CASE("strains are those that the body names; without a name they are left to its elements") {
  using fem::Strains;
  const std::string beams = testing::tube + testing::metal;
  CHECK_FALSE(body_of(one_body(testing::line, beams)).strains);
  CHECK(body_of(one_body(testing::line, beams + "    strains: von_karman\n")).strains == Strains::von_karman);
  CHECK(body_of(one_body(testing::line, beams + "    strains: second_order\n")).strains == Strains::second_order);
  CHECK(testing::faults_of(one_body(testing::line, beams + "    strains: linear\n")) ==
        std::vector<std::string>{
            "s.yaml:6:14: bodies.b.strains: is \"linear\"; expected one of von_karman, second_order"});
  CHECK(testing::faults_of(one_body("line: {from: [0, 0], to: [2, 0], elements: 4}",
                                    "    section: {EA: 1, EI: 1, rhoA: 1}\n    strains: second_order\n")) ==
        std::vector<std::string>{"s.yaml:5:14: bodies.b.strains: is second_order in the plane; expected von_karman, or "
                                 "a scene in space (points of three coordinates)"});
}

TEST_CASE("a mesh file stands relative to the folder of the scene, with a factor of 1 where none is given") {
  const auto file = [](const std::string& keys) {
    return *scene::parse_scene(one_body("file: {" + keys + "}", testing::thickness + testing::metal), "cases/a/s.yaml")
                .bodies.at(0)
                .mesh.file;
  };
  CHECK(file("path: ../wing.msh").path == "cases/wing.msh");
  CHECK(file("path: wing.msh").scale == 1);
  CHECK(file("path: wing.inp, scale: 1e-3").scale == 1e-3);
  CHECK(file("path: /data/wing.msh").path == "/data/wing.msh");
}

TEST_CASE("lines with three coordinates make a scene in space, with two one in the plane") {
  CHECK(scene::parse_scene(one_body(testing::line, testing::tube + testing::metal), "s").dimension == 3);
  CHECK(scene::parse_scene(
            one_body("line: {from: [0, 0], to: [2, 0], elements: 4}", "    section: {EA: 1, EI: 1, rhoA: 1}\n"), "s")
            .dimension == 2);
  const auto frame = one_body(
      "segments: {points: [[0, 0, 0], [1, 0, 0], [1, 1, 2]], join: [[1, 2], [2, 3]], "
      "elements: 2}",
      "    section: {shape: circle, radius: 0.1, orientation: [0.1, 1, 0.3]}\n" + testing::metal);
  CHECK(scene::parse_scene(frame, "s").dimension == 3);
}

TEST_CASE("a shell of one thickness: E t / (1 - nu^2) and rho t; offset moves its middle") {
  const auto body = body_of(one_body(testing::plate, "    section: {thickness: 0.01, offset: 0.1}\n" + testing::metal));
  REQUIRE(body.parts.size() == 1);
  CHECK(body.parts[0].part.empty());
  CHECK(shell(body).A(0, 0) == Approx(7e10 * 0.01 / (1 - 0.09)));
  CHECK(shell(body).mass == Approx(27));
  CHECK(shell(body).mass_centre == Approx(0.1));
  CHECK(shell(body_of(one_body(testing::plate, testing::thickness + testing::metal))).mass_centre == 0);
}

TEST_CASE("plies stand from below, their angles in degrees") {
  const auto body = body_of(one_body(
      testing::plate,
      "    section: {plies: [[0.01, 0], [0.03, 90]], axis: [1, 0, 0]}\n    material: {E1: 100, E2: 10, nu12: 0.25, "
      "G12: 5, rho: 3}\n"));
  const double of_one = 100 / (1 - 0.25 * 0.25 * 0.1), across = of_one * 0.1;
  CHECK(shell(body).A(0, 0) == Approx(0.01 * of_one + 0.03 * across));
  CHECK(shell(body).A(1, 1) == Approx(0.01 * across + 0.03 * of_one));
  CHECK(shell(body).mass == Approx(0.12));
  // int z: the ply of 0.01 lies below the middle by 0.015, that of 0.03 above by 0.005
  CHECK(shell(body).B()(0, 0) == Approx(-0.015 * 0.01 * of_one + 0.005 * 0.03 * across));
  CHECK(shell(body).axis == Eigen::Vector3d(1, 0, 0));
}

TEST_CASE("shapes of beams with their measures, and constants instead of a shape") {
  const auto of = [](const std::string& section) {
    return beam(body_of(one_body(testing::line, "    section: {" + section + ", orientation: [0, 1, 0]}\n" +
                                                    "    material: {E: 100, nu: 0.25, rho: 3}\n")))
        .section;
  };
  const auto rectangle = of("shape: rectangle, width: 0.2, height: 0.3");  // width along y
  CHECK(rectangle.EA == Approx(100 * 0.06));
  CHECK(rectangle.EIz == Approx(100 * 0.3 * 0.008 / 12));
  CHECK(rectangle.EIy == Approx(100 * 0.2 * 0.027 / 12));
  CHECK(rectangle.rhoA == Approx(0.18));
  const auto circle = of("shape: circle, radius: 0.1");
  CHECK(circle.EIy == Approx(100 * M_PI * 1e-4 / 4));
  CHECK(circle.GJ == Approx(40 * M_PI * 1e-4 / 2));  // G = E / (2 + 2 nu)
  const auto tube = of("shape: tube, radius: 0.1, wall: 0.02");
  CHECK(tube.EA == Approx(100 * M_PI * (0.01 - 0.0064)));
  const auto box = of("shape: box, width: 0.2, height: 0.3, wall: 0.01");
  CHECK(box.EA == Approx(100 * (0.06 - 0.18 * 0.28)));
  const auto profile = of("shape: i, width: 0.2, height: 0.3, flange: 0.02, wall: 0.01");
  CHECK(profile.EA == Approx(100 * (2 * 0.2 * 0.02 + 0.26 * 0.01)));
  const auto plain = of("A: 1, Iy: 2, Iz: 3, Iyz: 0.5, J: 4");
  CHECK((plain.EIy == Approx(200) && plain.EIz == Approx(300) && plain.EIyz == Approx(50) && plain.GJ == Approx(160)));
}

TEST_CASE("orientation, centroid, wagner and G of beams; centroid is on the line by default") {
  const auto of = [](const std::string& more, const std::string& material) {
    return beam(body_of(one_body(testing::line, "    section: {shape: circle, radius: 0.1, orientation: [0, 2, 1]" +
                                                    more + "}\n    material: {" + material + "}\n")));
  };
  const auto plain = of("", "E: 100, nu: 0.25, rho: 3");
  CHECK(plain.orientation == Eigen::Vector3d(0, 2, 1));
  CHECK(plain.section.centroid == Eigen::Vector2d(0, 0));
  CHECK_FALSE(plain.strain.wagner);
  const auto told = of(", centroid: [0.1, -0.2], wagner: true", "E: 100, G: 7, rho: 3");
  CHECK(told.section.centroid == Eigen::Vector2d(0.1, -0.2));
  CHECK(told.strain.wagner);
  CHECK(told.section.GJ == Approx(7 * M_PI * 1e-4 / 2));
}

TEST_CASE("parts take from the body what they do not say themselves; the body's section is for the rest") {
  const auto body = body_of(one_body(testing::plate, testing::thickness + testing::metal +
                                                         "    parts:\n      skin: {section: {thickness: 0.02}}\n"
                                                         "      core: {material: {E: 1e9, nu: 0, rho: 10}}\n"));
  REQUIRE(body.parts.size() == 3);
  CHECK((body.parts[0].part == "skin" && body.parts[1].part == "core" && body.parts[2].part.empty()));
  CHECK(shell(body, 0).mass == Approx(54));
  CHECK(shell(body, 1).mass == Approx(0.1));
  CHECK(shell(body, 2).mass == Approx(27));
  CHECK(body.parts[0].where.text() == "s.yaml:7:14: bodies.b.parts.skin.section");
}

TEST_CASE("a section in the body serves parts that bring their own materials") {
  const auto body = body_of(
      one_body(testing::plate, testing::thickness + "    parts: {plate: {material: {E: 1e9, nu: 0, rho: 10}}}\n"));
  REQUIRE(body.parts.size() == 1);
  CHECK(body.parts[0].part == "plate");
  CHECK(shell(body).mass == Approx(0.1));
}
