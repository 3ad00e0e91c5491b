#include "../../../src/plan/deck_sections.h"

#include <catch2/catch.hpp>

#include "floe/fem/structure.h"

using namespace floe;

namespace {

fem::SpatialBeamSection section(const mesh::BeamSection& own) {
  mesh::DeckFile file;
  file.deck.materials = {{"M", mesh::Elasticity::isotropic, {2.6, 0.3}, 1}};  // G = 1
  file.deck.beam_sections = {own};
  return std::get<fem::SpatialBeam>(plan::deck_sections(file).parts.at(0)).section;
}

mesh::BeamSection profile(mesh::Profile kind, const std::vector<double>& dimensions) {
  mesh::BeamSection own;
  own.part = "B", own.number = 0, own.material = "M", own.profile = kind, own.dimensions = dimensions;
  return own;
}

}  // namespace

TEST_CASE("an ellipse has the area, moments of inertia and torsion constant of its integrals") {
  constexpr double a = 0.3, b = 0.2, h = 5e-4;
  double A = 0, Iy = 0, Iz = 0, J = 0;  // J = 2 int phi dA, lap phi = -2, phi = 0 at the edge
  for (double y = -a + h / 2; y < a; y += h)
    for (double z = -b + h / 2; z < b; z += h) {
      const double inside = 1 - y * y / (a * a) - z * z / (b * b);
      if (inside < 0) continue;
      A += h * h, Iy += z * z * h * h, Iz += y * y * h * h;
      J += 2 * inside * a * a * b * b / (a * a + b * b) * h * h;
    }
  const auto found = section(profile(mesh::Profile::circle, {a, b}));
  CHECK(found.rhoA == Approx(A).epsilon(1e-3));
  CHECK(found.EIy == Approx(2.6 * Iy).epsilon(1e-3));
  CHECK(found.EIz == Approx(2.6 * Iz).epsilon(1e-3));
  CHECK(found.GJ == Approx(J).epsilon(1e-3));
  const auto equal = section(profile(mesh::Profile::circle, {a, a})),
             round = section(profile(mesh::Profile::circle, {a}));
  CHECK(equal.GJ == Approx(round.GJ));
  CHECK(equal.EIy == Approx(round.EIy));
}

TEST_CASE("offsets of an ellipse are parts of its diameters") {
  auto own = profile(mesh::Profile::circle, {0.3, 0.2});
  own.offset_1 = 0.5, own.offset_2 = 0.25;
  CHECK((section(own).centroid - Eigen::Vector2d(-0.3, -0.1)).norm() < 1e-15);
}

TEST_CASE("a general section without I and J is released in bending and torsion, and has no rotary inertia") {
  mesh::DeckFile file;
  mesh::BeamSection rod = profile(mesh::Profile::general, {0.01, 0, 0, 0, 0});
  rod.releases = 1;
  file.deck.materials = {{"M", mesh::Elasticity::isotropic, {2.6, 0.3}, 1}};
  file.deck.beam_sections = {rod};
  const auto beam = std::get<fem::SpatialBeam>(plan::deck_sections(file).parts.at(0));
  CHECK(beam.section.EA == Approx(0.026));
  CHECK(beam.section.rhoA == Approx(0.01));
  CHECK(beam.section.rhoIy + beam.section.rhoIz == 0);
  CHECK(beam.releases.to_string() == "111000111001");
}

TEST_CASE("shells by their stiffness, and by materials that bend apart") {
  mesh::DeckFile file;
  file.deck.materials = {{"M", mesh::Elasticity::isotropic, {2.6, 0.3}, 1},
                         {"N", mesh::Elasticity::isotropic, {5.2, 0.3}, 7}};
  mesh::ShellSection numbers;
  numbers.part = "A", numbers.number = 0;
  Eigen::Matrix3d A;
  A << 4, 1, 0, 1, 5, 0, 0, 0, 2;
  Eigen::Matrix<double, 6, 6> S;
  S << A, 0.1 * A, 0.1 * A, 3 * A;
  numbers.stiffness = mesh::ShellStiffness{S, 6.0};
  numbers.shear = 9;
  mesh::ShellSection bends;
  bends.part = "B", bends.number = 1, bends.plies = {{0.1, "M", "", 0}}, bends.offset = 0.5;
  bends.bending = mesh::ShellBending{"N", 1.5};
  file.deck.shell_sections = {numbers, bends};
  const auto deck = plan::deck_sections(file);
  const auto first = std::get<fem::ShellSection>(deck.parts.at(0));
  CHECK((first.A - A).norm() < 1e-12);
  CHECK((first.B() - 0.1 * A).norm() < 1e-12);
  CHECK((first.D() - 3 * A).norm() < 1e-12);
  CHECK(first.mass == 6);
  CHECK(first.shear == 9);
  CHECK(first.axis == Eigen::Vector3d::UnitX());
  const auto second = std::get<fem::ShellSection>(deck.parts.at(1));
  const double d = 2.6 * 0.1 / (1 - 0.09), t = 0.1;
  CHECK(second.A(0, 0) == Approx(d));
  CHECK(second.bending(0, 0) == Approx(2 * 1.5 * d * t * t / 12));
  CHECK(second.coupling(1, 1) == Approx(-0.05));
  CHECK(second.mass == Approx(0.1));
  CHECK(second.mass_centre == Approx(-0.05));
  CHECK(second.rotary_inertia() == Approx(t * t * t / 3));
}

TEST_CASE("mass per area of a section is spread over its plies") {
  mesh::DeckFile file;
  file.deck.materials = {{"M", mesh::Elasticity::isotropic, {10, 0.3}, 5}};
  mesh::ShellSection section;
  section.part = "A", section.number = 0;
  section.plies = {{0.1, "M", "", 0}, {0.3, "M", "", 0}};
  section.added_mass = 4;
  file.deck.shell_sections = {section};
  const auto shell = std::get<fem::ShellSection>(plan::deck_sections(file).parts.at(0));
  CHECK(shell.mass == Approx(5 * 0.4 + 4));
  CHECK(shell.rotary_inertia() == Approx((5 + 4 / 0.4) * 0.4 * 0.4 * 0.4 / 12));
}

TEST_CASE("plies share one orientation, from which their angles count") {
  mesh::DeckFile file;
  file.deck.materials = {{"M", mesh::Elasticity::lamina, {10, 1, 0.3, 0.5, 0.5, 0.5}, 1}};
  file.deck.orientations = {{"along", {0, 1, 0}, {-1, 0, 0}}, {"across", {1, 0, 0}, {0, 1, 0}}};
  mesh::ShellSection section;
  section.part = "A", section.number = 0;
  section.plies = {{0.1, "M", "along", 0}, {0.1, "M", "", 90}, {0.1, "M", "along", 0}};
  file.deck.shell_sections = {section};
  const auto shell = std::get<fem::ShellSection>(plan::deck_sections(file).parts.at(0));
  CHECK(shell.axis == Eigen::Vector3d::UnitY());
  CHECK(shell.A(0, 0) == Approx((10 * 0.2 + 1 * 0.1) / (1 - 0.3 * 0.03)));  // nu_21 = nu_12 E_2 / E_1
  file.deck.shell_sections[0].plies[2].orientation = "across";
  CHECK_THROWS_WITH(plan::deck_sections(file), Catch::Matchers::Contains("orientations of different names"));
}

TEST_CASE("springs of a deck are cells of two nodes, one part for each set of constants") {
  mesh::DeckFile file;
  file.mesh.comm = PETSC_COMM_SELF;
  file.mesh.node_count = 3, file.mesh.positions.resize(3);
  const mesh::NodeSpring one{{0, 1}, {1, 2, 3, 4, 5, 6}, Eigen::Matrix3d::Identity(), 0.5, 7};
  mesh::NodeSpring two = one, other = one;
  two.nodes = {1, 2}, other.stiffness[5] = 8;
  file.deck.springs = {one, two, other};
  std::map<int, fem::Section> parts;
  plan::add_springs(file.mesh, file.deck.springs, parts);
  REQUIRE(file.mesh.cells.size() == 3);
  CHECK(file.mesh.cell_count == 3);
  CHECK(file.mesh.cells[0].part == file.mesh.cells[1].part);
  CHECK(file.mesh.cells[0].part != file.mesh.cells[2].part);
  CHECK(file.mesh.cells[1].nodes[1] == 2);
  CHECK(std::get<fem::NodeSpring>(parts.at(file.mesh.cells[2].part)).stiffness[5] == 8);
}

TEST_CASE("a beam of a given centroid has its shear centre in the line between the nodes") {
  mesh::BeamSection own = profile(mesh::Profile::rectangle, {0.2, 0.1});
  CHECK(section(own).shear_centre.isZero(0));
  own.centroid = Eigen::Vector2d(0.03, -0.01);
  const auto found = section(own);
  CHECK(found.centroid == *own.centroid);
  CHECK(found.shear_centre.isZero(0));
  CHECK(found.EIz == Approx(section(profile(mesh::Profile::rectangle, {0.2, 0.1})).EIz));  // about the centroid
}

TEST_CASE("a shell of varying thickness bends, and resists rotation, by the mean of its cubes") {
  mesh::DeckFile file;
  file.deck.materials = {{"M", mesh::Elasticity::isotropic, {2.6, 0.3}, 1}};
  mesh::ShellSection own;
  own.part = "S", own.number = 0, own.offset = 0.25, own.plies = {{0.1, "M", "", 0}};
  file.deck.shell_sections = {own};
  const auto shell = [&] { return std::get<fem::ShellSection>(plan::deck_sections(file).parts.at(0)); };
  const fem::ShellSection even = shell();
  file.deck.shell_sections[0].taper = 2, file.deck.shell_sections[0].thickest = 1.5;
  const fem::ShellSection varying = shell();
  CHECK(varying.A == even.A);
  CHECK(varying.mass == even.mass);
  CHECK(varying.coupling == even.coupling);
  CHECK((varying.bending - 2 * even.bending).norm() < 1e-14 * even.bending.norm());
  CHECK(varying.mass_radius * varying.mass_radius == Approx(2 * even.mass_radius * even.mass_radius));
  const fem::StressPoints points = plan::deck_sections(file).points.at(0);
  REQUIRE(points.layers.size() == 1);
  CHECK(points.layers[0].top - points.layers[0].bottom == Approx(0.15));  // where it is thickest
}
