#include "floe/mesh/inp.h"
#include "mesh_files.h"

using namespace floe;
using Catch::Matchers::Contains;

namespace {

// Quarter of a tube of radius 1 about z through (2, 0, 0), two shells of 45 degrees; its normals point outwards.
std::string tube(const std::string& more, const std::string& section) {
  const auto node = [](int label, double degrees, double z) {
    const double a = degrees * M_PI / 180;
    return std::to_string(label) + ", " + std::to_string(2 + std::cos(a)) + ", " + std::to_string(std::sin(a)) + ", " +
           std::to_string(z) + "\n";
  };
  return "*NODE\n" + node(1, 0, 0) + node(2, 45, 0) + node(3, 90, 0) + node(4, 0, 1) + node(5, 45, 1) + node(6, 90, 1) +
         "*ELEMENT, TYPE=S4, ELSET=E\n1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n*MATERIAL, NAME=Fibre\n*ELASTIC, TYPE=LAMINA\n"
         "1.3e11, 9e9, .3, 5e9, 5e9, 3e9\n*DENSITY\n1600\n*MATERIAL, NAME=Steel\n*ELASTIC\n2e11, .3\n*DENSITY\n7800\n" +
         more + section;
}

const std::string composite =
    "*SHELL SECTION, ELSET=E, COMPOSITE, ORIENTATION=cyl\n.001, , FIBRE, 0.\n.001, , fibre, 45.\n";

/// Directions of angle 0 of the elements, in the order of the file. Collective.
std::vector<Eigen::Vector3d> directions(const mesh::DeckFile& file) {
  std::vector<Eigen::Vector3d> found;
  for (const auto& cell : file.mesh.cells)
    for (const auto& section : file.deck.shell_sections)
      for (const auto& orientation : file.deck.orientations)
        if (section.number == cell.part && section.orientation == orientation.name) found.push_back(orientation.a);
  return testing::of_all_ranks(found);
}

mesh::DeckFile read(const std::string& text) {
  return mesh::read_inp(PETSC_COMM_WORLD, testing::written("tube.inp", text));
}

std::string cylinder(const std::string& second) {
  return "*ORIENTATION, NAME=Cyl, SYSTEM=CYLINDRICAL\n2., 0., 0., 2., 0., 1.\n" + second;
}

}  // namespace

TEST_CASE("cylindrical orientations give each shell the direction at its centre") {
  const auto tangent = [](double degrees) {
    const double a = degrees * M_PI / 180;
    return Eigen::Vector3d(-std::sin(a), std::cos(a), 0);
  };
  for (const char* second : {"", "1, 0.\n"}) {  // the normal is radial: direction 1 is tangential
    const auto file = read(tube(cylinder(second), composite));
    CHECK(file.mesh.parts.size() == 3);
    const auto found = directions(file);
    REQUIRE(found.size() == 2);
    CHECK((found[0] - tangent(22.5)).norm() < 1e-5);
    CHECK((found[1] - tangent(67.5)).norm() < 1e-5);
    CHECK_THAT(file.notices.back(), Contains("cylindrical orientations have 2 different directions") &&
                                        Contains("(Abaqus), where CalculiX takes the radial one"));
  }
  const auto rotated = directions(read(tube(cylinder("1, 90.\n"), composite)));
  for (const auto& direction : rotated) CHECK((direction - Eigen::Vector3d::UnitZ()).norm() < 1e-9);
  const auto radial = directions(read(tube(cylinder("3, 0.\n"), composite)));
  CHECK((radial.at(0) - Eigen::Vector3d(std::cos(M_PI / 8), std::sin(M_PI / 8), 0)).norm() < 1e-5);
}

TEST_CASE("cylindrical orientations do not matter to isotropic shells; wrong ones are refused") {
  const auto file = read(tube(cylinder(""), "*SHELL SECTION, ELSET=E, MATERIAL=STEEL, ORIENTATION=cyl\n.001\n"));
  CHECK(file.mesh.parts.size() == 1);
  CHECK(file.deck.shell_sections.at(0).orientation.empty());
  CHECK(file.deck.shell_sections.at(0).plies.at(0).material == "Steel");  // as it is defined
  const auto said = [](const std::string& text) {
    const auto path = testing::written("bad.inp", text);
    return testing::fault_of([&] { mesh::read_inp(PETSC_COMM_WORLD, path); });
  };
  CHECK_THAT(said(tube("*ORIENTATION, NAME=cyl, SYSTEM=SPHERICAL\n2., 0., 0., 2., 0., 1.\n", composite)),
             Contains("bad.inp:21: *ORIENTATION is read with SYSTEM=RECTANGULAR or CYLINDRICAL only"));
  CHECK_THAT(said(tube("*ORIENTATION, NAME=cyl, SYSTEM=CYLINDRICAL\n2., 0., 1., 2., 0., 1.\n", composite)),
             Contains("bad.inp:22: the axis of a cylindrical orientation has no length"));
}

namespace {

// Two plies of orientations O, about the normal z of a square, and P. `elements`: in its order of nodes.
std::string plies(const std::string& p, const std::string& elements = "1, 1, 2, 3, 4\n",
                  const std::string& section = "*SHELL SECTION, ELSET=E, COMPOSITE\n.1, , FIBRE, O\n.2, , FIBRE, P\n") {
  return "*NODE\n1\n2, 1\n3, 1, 1\n4, 0, 1\n5, 0, 0, 1\n6, 1, 0, 1\n*ELEMENT, TYPE=S4, ELSET=E\n" + elements +
         "*MATERIAL, NAME=Fibre\n*ELASTIC, TYPE=LAMINA\n1.3e11, 9e9, .3, 5e9, 5e9, 3e9\n*DENSITY\n1600\n"
         "*ORIENTATION, NAME=O\n1, 0, 0, 0, 1, 0\n3, 10\n*ORIENTATION, NAME=P" +
         p + section;
}

std::string refused(const std::string& text) {
  const auto path = testing::written("bad.inp", text);
  return testing::fault_of([&] { mesh::read_inp(PETSC_COMM_WORLD, path); });
}

}  // namespace

TEST_CASE("plies of orientations of different names have the angles between them about the normal") {
  const auto angle = [](const std::string& text) {
    const auto section = read(text).deck.shell_sections.at(0);
    CHECK(section.orientation == "O");
    CHECK(section.plies.at(0).angle == Approx(0).margin(1e-12));
    CHECK(section.plies.at(1).orientation.empty());
    return section.plies.at(1).angle;
  };
  const std::string turned = "\n0, 1, 0, -1, 0, 0\n";
  CHECK(angle(plies(turned)) == Approx(80));
  CHECK(angle(plies(turned, "1, 4, 3, 2, 1\n")) == Approx(-80));        // the normal is -z
  CHECK(angle(plies("\n1, 0, 0, 0, 1, 0\n3, 55.\n")) == Approx(45));    // rotated
  CHECK(angle(plies("\n0, 1, 0, 1, 0, 0\n")) == Approx(80));            // its third axis is -z
  CHECK_THAT(refused(plies(turned, "1, 1, 2, 3, 4\n2, 1, 2, 6, 5\n")),  // at right angles
             Contains("bad.inp:21: the plies of set E have orientations of different names, and the normals of its "
                      "elements are not all along their third axis; expected one orientation, with angles"));
  CHECK_THAT(refused(plies("\n1, 0, 0, 0, 0, 1\n")), Contains("whose third axes are not parallel"));
  CHECK_THAT(refused(plies(", SYSTEM=CYLINDRICAL\n0, 0, 0, 0, 0, 1\n")), Contains("one of which is cylindrical"));
  const char* bare = "*SHELL SECTION, ELSET=E, COMPOSITE\n.1, , FIBRE, O\n.2, , FIBRE\n";
  CHECK_THAT(refused(plies(turned, "1, 1, 2, 3, 4\n", bare)),
             Contains("bad.inp:20: the plies of set E have orientations of different names, and one has none, where "
                      "the section has none; expected one orientation, with angles"));
}
