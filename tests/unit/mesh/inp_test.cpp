#include "floe/mesh/inp.h"

#include "mesh_files.h"

using namespace floe;
using Catch::Matchers::Contains;
using mesh::Elasticity;

namespace {

mesh::DeckFile read(const std::string& path) { return mesh::read_inp(PETSC_COMM_WORLD, path); }

// Square of side 1 with its section; `more` comes after.
std::string square(const std::string& more) {
  return "*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n*ELEMENT, TYPE=S4, ELSET=E\n1, 1, 2, 3, 4\n"
         "*MATERIAL, NAME=M\n*ELASTIC\n1, 0\n*SHELL SECTION, ELSET=E, MATERIAL=M\n1\n" +
         more;
}

}  // namespace

TEST_CASE("a deck's mesh is read") {
  const auto file = read("tests/unit/mesh/files/frame.inp");
  const auto& raw = file.mesh;
  CHECK(raw.node_count == 7);  // without 99
  CHECK(raw.cell_count == 5);
  CHECK(raw.parts == std::vector<std::string>{"SHELLS", "THICK", "STIFF"});
  CHECK(testing::measure(raw, 0) == Approx(1.0));
  CHECK(testing::measure(raw, 1) == Approx(1.0));
  CHECK(testing::measure(raw, 2) == Approx(2.0));
  CHECK(testing::of_all_ranks(raw.cell_labels) == std::vector<long long>{1, 2, 5, 7, 8});
  CHECK(testing::labels_at(raw, "both") == std::vector<long long>{10, 30, 40, 60});
  CHECK(testing::labels_at(raw, "All") == std::vector<long long>{10, 20, 30, 40, 50, 60, 70});
  CHECK(testing::labels_at(raw, "every") == std::vector<long long>{10, 30, 50, 70});
}

TEST_CASE("a deck's sections, materials, masses and links are read") {
  const auto deck = read("tests/unit/mesh/files/frame.inp").deck;
  REQUIRE(deck.materials.size() == 2);
  CHECK(deck.materials[0].elasticity == Elasticity::isotropic);
  CHECK(deck.materials[0].constants == std::vector<double>{2.1e11, 0.3});
  CHECK(deck.materials[0].density == 7800);
  CHECK(deck.materials[1].constants == std::vector<double>{1.3e11, 9e9, 9e9, .3, .3, .4, 5e9, 5e9, 3e9});
  REQUIRE(deck.shell_sections.size() == 2);
  CHECK(deck.shell_sections[0].offset == 0.5);
  CHECK(deck.shell_sections[0].plies.at(0).thickness == 0.01);
  CHECK(deck.shell_sections[1].orientation == "Or1");
  REQUIRE(deck.shell_sections[1].plies.size() == 2);
  CHECK(deck.shell_sections[1].plies[0].orientation == "Or1");
  CHECK(deck.shell_sections[1].plies[1].angle == -45);
  REQUIRE(deck.orientations.size() == 1);
  CHECK(deck.orientations[0].axis == 3);
  CHECK(deck.orientations[0].angle == 30);
  REQUIRE(deck.beam_sections.size() == 1);
  CHECK(deck.beam_sections[0].profile == mesh::Profile::pipe);
  CHECK(deck.beam_sections[0].dimensions == std::vector<double>{0.02, 0.002});
  CHECK(deck.beam_sections[0].direction_1 == Eigen::Vector3d(0, 0, 1));
  const auto masses = testing::of_all_ranks(deck.masses);
  REQUIRE(masses.size() == 1);
  CHECK(masses[0].node == 6);  // 70
  CHECK(masses[0].mass == 2.5);
  REQUIRE(deck.links.size() == 1);
  CHECK(deck.links[0].reference == 6);
  auto slaves = testing::of_all_ranks(deck.links[0].nodes);
  std::sort(slaves.begin(), slaves.end());
  CHECK(slaves == std::vector<PetscInt>{2, 5});
}

TEST_CASE("what a deck has and a body does not need is named") {
  const auto notices = read("tests/unit/mesh/files/frame.inp").notices;
  REQUIRE(notices.size() == 4);
  CHECK_THAT(notices[0], Contains("frame.inp:43: *EXPANSION is ignored"));
  CHECK_THAT(notices[1], Contains("*BOUNDARY is ignored: supports are joints"));
  CHECK_THAT(notices[2], Contains("*STEP and *END STEP (line 72) is ignored (*FREQUENCY, *NODE FILE)"));
  CHECK_THAT(notices[3], Contains("1 unused nodes are ignored"));
}

TEST_CASE("includes, also of data, and Windows line ends are read") {
  testing::written("nodes.inp", "1, 0, 0\r\n2, 1, 0\r\n");
  testing::written("rest.inp", "4, 0, 1\n*ELEMENT, TYPE=S4, ELSET=E\n1, 1, 2, 3, 4\n");
  const auto path = testing::written(
      "deck.inp",
      "*NODE\r\n*INCLUDE, INPUT=nodes.inp\r\n3, 1, 1\r\n*INCLUDE, INPUT=\"rest.inp\"\r\n*MATERIAL, NAME=M\r\n"
      "*ELASTIC\r\n1, 0\r\n*SHELL SECTION, ELSET=E, MATERIAL=M\r\n1\r\n");
  CHECK(testing::measure(read(path).mesh, 0) == Approx(1.0));
  const auto round = testing::written("round.inp", "*INCLUDE, INPUT=round.inp\n");
  CHECK_THAT(testing::fault_of([&] { read(round); }), Contains("20 files deep"));
  const auto outer = testing::written("outer.inp", "*HEADING\n*INCLUDE, INPUT=missing.inp\n");
  CHECK_THAT(testing::fault_of([&] { read(outer); }), Contains("missing.inp: cannot be opened") &&
                                                          Contains("(included from ") && Contains("outer.inp:2)") &&
                                                          !Contains("\n"));
}

TEST_CASE("one part and one instance of Abaqus are looked through") {
  const std::string body = square("");
  const std::string assembly =
      "*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I-1, PART=P\n*END INSTANCE\n"
      "*NSET, NSET=tip, INSTANCE=I-1\n3\n*NSET, NSET=again\nI-1.tip\n*END ASSEMBLY\n";
  const auto raw = read(testing::written("abaqus.inp", "*PART, NAME=P\n" + body + assembly)).mesh;
  CHECK(testing::labels_at(raw, "again") == std::vector<long long>{3});
}

TEST_CASE("names of a part are others than those of the assembly") {
  const std::string part =
      "*PART, NAME=P\n*NODE, NSET=X\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n*ELEMENT, TYPE=S4, ELSET=X\n1, 1, 2, 3, 4\n"
      "*ELEMENT, TYPE=B31, ELSET=B\n2, 1, 2\n*ORIENTATION, NAME=X\n0, 1, 0, -1, 0, 0\n"
      "*SHELL SECTION, ELSET=X, MATERIAL=M, ORIENTATION=X\n1\n"
      "*BEAM SECTION, ELSET=B, MATERIAL=M, SECTION=RECT\n0.1, 0.2\n0, 1, 0\n*SURFACE, NAME=X, TYPE=NODE\n1\n2\n"
      "*NSET, NSET=of_part\nX\n*END PART\n";
  const std::string assembly =
      "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n*END INSTANCE\n*NSET, NSET=X, INSTANCE=I\n3, 4\n"
      "*ELSET, ELSET=X, INSTANCE=I\n2\n*NSET, NSET=both\nX, I.X\n*NSET, NSET=again\nI.of_part\n"
      "*RIGID BODY, REF NODE=4, TIE NSET=X\n*END ASSEMBLY\n*ORIENTATION, NAME=X\n1, 0, 0, 0, 1, 0\n"
      "*MATERIAL, NAME=M\n*ELASTIC\n1, 0\n*DENSITY\n1\n";
  const auto file = read(testing::written("scopes.inp", part + assembly));
  const auto& raw = file.mesh;
  CHECK(testing::labels_at(raw, "X") == std::vector<long long>{3, 4});
  CHECK(testing::labels_at(raw, "I.X") == std::vector<long long>{1, 2, 3, 4});
  CHECK(testing::labels_at(raw, "X (surface)") == std::vector<long long>{1, 2});
  CHECK(testing::labels_at(raw, "both") == std::vector<long long>{1, 2, 3, 4});
  CHECK(testing::labels_at(raw, "again") == std::vector<long long>{1, 2, 3, 4});
  CHECK(raw.parts == std::vector<std::string>{"I.X", "B"});
  REQUIRE(file.deck.links.size() == 1);
  CHECK(testing::of_all_ranks(file.deck.links[0].nodes).size() == 1);
  CHECK(file.deck.shell_sections.at(0).orientation == "I.X");
  CHECK_THAT(testing::fault_of([&] {
               const std::string other = assembly;
               read(testing::written("scopes.inp", "*PART, NAME=Q\n" + part.substr(part.find('\n') + 1) + other));
             }),
             Contains("*INSTANCE of part 'P', which is not defined; the deck has 'Q'"));
}

TEST_CASE("a surface is another set than the node set of its name") {
  const std::string sets =
      "*NSET, NSET=edge\n2, 3\n*SURFACE, NAME=EDGE, TYPE=NODE\n1\n4\n*SURFACE, NAME=alone, TYPE=NODE\nedge\n"
      "*NODE\n9, 2, 0\n*RIGID BODY, REF NODE=9, NSET=edge\n";
  const auto file = read(testing::written("surface.inp", square(sets)));
  CHECK(testing::labels_at(file.mesh, "edge") == std::vector<long long>{2, 3});
  CHECK(testing::labels_at(file.mesh, "EDGE (surface)") == std::vector<long long>{1, 4});
  CHECK(testing::labels_at(file.mesh, "alone") == std::vector<long long>{2, 3});
  REQUIRE(file.deck.links.size() == 1);
}

TEST_CASE("an instance moves its part, its orientations and the directions of its beams") {
  const std::string part =
      "*ELEMENT, TYPE=B31, ELSET=B\n2, 1, 2\n*BEAM SECTION, ELSET=B, MATERIAL=M, SECTION=RECT\n0.1, 0.2\n"
      "0, 1, 0\n*ORIENTATION, NAME=O\n1, 0, 0, 0, 1, 0\n*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, "
      "NAME=I, PART=P\n";
  const auto path = [&](const std::string& motion) {
    return testing::written("moved.inp", "*PART, NAME=P\n" + square(part + motion + "*END INSTANCE\n*END ASSEMBLY\n"));
  };
  const auto file = read(path("1., 0., 0.\n0., 0., 0., 0., 0., 2., 90.\n"));  // x to y, y to -x
  const auto positions = testing::of_all_ranks(file.mesh.positions);
  CHECK((positions.at(0) - Eigen::Vector3d(0, 1, 0)).norm() < 1e-12);
  CHECK((positions.at(2) - Eigen::Vector3d(-1, 2, 0)).norm() < 1e-12);
  CHECK((file.deck.beam_sections.at(0).direction_1 - Eigen::Vector3d(-1, 0, 0)).norm() < 1e-12);
  CHECK((file.deck.orientations.at(0).a - Eigen::Vector3d(0, 1, 0)).norm() < 1e-12);
  for (const auto& [motion, text] :
       {std::pair("1.,\n0., 0., 0., 0., 0., 0., 90.\n", "axis of an *INSTANCE has no length"),
        {"1., 2., 3., 4.\n", "a translation"}}) {
    const auto wrong = path(motion);
    CHECK_THAT(testing::fault_of([&] { read(wrong); }), Contains("moved.inp:") && Contains(text));
  }
}

TEST_CASE("directions in a part whose instance is rotated are refused, numbers of its nodes read") {
  const auto path = [](const std::string& more, const std::string& motion, const std::string& after) {
    return testing::written("turned.inp", "*PART, NAME=P\n" + square(more) +
                                              "*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n" + motion +
                                              "*END INSTANCE\n" + after + "*END ASSEMBLY\n");
  };
  const std::string link = "*NSET, NSET=N\n1\n*SURFACE, NAME=T, TYPE=NODE\n3\n*COUPLING, REF NODE=N, SURFACE=T\n",
                    free = "*KINEMATIC\n1, 5\n", turn = "0., 0., 0.\n0., 0., 0., 0., 0., 1., 90.\n";
  CHECK(read(path(link + free, "", "")).deck.links.size() == 1);
  CHECK(read(path(link + "*KINEMATIC\n", turn, "")).deck.links.size() == 1);
  const auto wrong = path(link + free, turn, "");
  CHECK_THAT(testing::fault_of([&] { read(wrong); }),
             Contains("*KINEMATIC with one or two of the rotations in a part whose *INSTANCE is rotated is not read"));
  CHECK(read(path("", "", "*MPC\nBEAM, I.3, I.1\n")).deck.links.size() == 1);
}

TEST_CASE("keywords that do not make a linear elastic body are ignored with one line each") {
  const auto path = testing::written(
      "ignored.inp",
      square("*SURFACE, NAME=S, TYPE=CUTTING SURFACE\nE, SPOS\n*CONTACT PAIR, INTERACTION=I\nS, S\n*AMPLITUDE, "
             "NAME=A\n0,0\n"
             "*Initial Conditions, TYPE=TEMPERATURE\nN, 20\n*EQUATION\n2\n1,3,1.,2,3,-1.\n*amplitude, NAME=B\n0,0\n"
             "*PLASTIC\n1, 0\n*STEP\n*STATIC\n*CLOAD\n1,1,1.\n2,1,1.\n*NODE PRINT\nU\n*END STEP\n"));
  const auto notices = read(path).notices;
  REQUIRE(notices.size() == 7);
  CHECK_THAT(notices[0],
             Contains("ignored.inp:13: *SURFACE is ignored: only surfaces of nodes and of elements are read"));
  CHECK_THAT(notices[1], Contains("ignored.inp:15: *CONTACT PAIR is ignored: contact is not represented (1 line)"));
  CHECK_THAT(notices[2], Contains("ignored.inp:17: *AMPLITUDE is ignored, 2 times"));
  CHECK_THAT(notices[3], Contains("*Initial Conditions is ignored: the body is at rest"));
  CHECK_THAT(notices[4], Contains("*PLASTIC is ignored: the material is linear elastic (1 line)"));
  CHECK_THAT(notices[6], Contains("ignored.inp:22: *EQUATION: 1 equation is ignored: it resists rigid motion"));
  CHECK_THAT(notices[5],
             Contains("(*STATIC, *CLOAD, *NODE PRINT): supports and loads are those of the scene; not taken "
                      "over: *CLOAD 2 lines"));
}

TEST_CASE("numbers have the forms that the format allows") {
  const auto path = testing::written(
      "forms.inp",
      "*NODE\n1,,,\n2, 1.d0, ,\n3, 1.0D+00, 10.0d-1\n4, , 1.\n*ELEMENT, TYPE=S4, ELSET=E\n1, 1, 2, 3, 4\n"
      "*MATERIAL, NAME=M\n*ELASTIC\n2.1d5, 0.3, 20.\n1.9d5, 0.3, 100.\n*SHELL SECTION, ELSET=E, MATERIAL=M\n1.d-1, "
      "5\n");
  const auto file = read(path);
  CHECK(testing::measure(file.mesh, 0) == Approx(1.0));
  CHECK(file.deck.materials.at(0).constants == std::vector<double>{2.1e5, 0.3});
  CHECK(file.deck.shell_sections.at(0).plies.at(0).thickness == 0.1);
  CHECK_THAT(file.notices.at(0), Contains("*ELASTIC is given at 2 temperatures: the first is used"));
}

TEST_CASE("coordinates at the end of a line may be missing, and lines may begin with blanks") {
  const auto file = read(testing::written(
      "short.inp",
      " ** a comment\n*NODE\n1\n2, 1\n ** another\n3, 1, 1\n4, , 1\n *ELEMENT, TYPE=S4, ELSET=E\n1, 1, 2, 3, "
      "4\n*MATERIAL, NAME=M\n*ELASTIC\n1, 0\n*SHELL SECTION, ELSET=E, MATERIAL=M\n1\n"));
  CHECK(file.mesh.node_count == 4);
  CHECK(testing::measure(file.mesh, 0) == Approx(1.0));
}

TEST_CASE("the nine engineering constants may be split over lines anywhere") {
  const std::vector<double> all{9e9, 8e9, 7e9, .1, .2, .3, 6e9, 5e9, 4e9};
  for (const std::string text :
       {"9e9, 8e9, 7e9, .1, .2, .3, 6e9, 5e9,\n4e9\n", "9e9, 8e9, 7e9, .1, .2, .3, 6e9\n5e9, 4e9\n",
        "9e9, 8e9, 7e9,\n.1, .2, .3,\n6e9, 5e9, 4e9, 20\n",
        "9e9, 8e9, 7e9, .1, .2, .3, 6e9, 5e9,\n4e9, 20\n1, 1, 1, .1, .2, .3, 1, 1\n1, 90\n"}) {
    INFO(text);
    const auto file =
        read(testing::written("nine.inp", square("*MATERIAL, NAME=N\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n" + text)));
    CHECK(file.deck.materials.at(1).constants == all);
    CHECK((file.notices.front().find("at 2 temperatures") != std::string::npos) ==
          (text.find("90") != std::string::npos));
  }
}

TEST_CASE("parameters of masses and shells, and keywords that do not concern a body") {
  const auto file = read(testing::written(
      "more.inp",
      "*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n*ELEMENT, TYPE=S4, ELSET=E\n1, 1, 2, 3, 4\n"
      "*MATERIAL, NAME=M\n*ELASTIC\n1, 0\n*EXPANSION TYPE=ISO\n1e-5\n*EXPANSION, TYPE=ANISO\n1, 1, 1, 0, 0, 0\n"
      "*SHELL SECTION, ELSET=E, MATERIAL=M, DENSITY=3.5, STACK DIRECTION=3\n1\n"
      "*ELEMENT, TYPE=MASS, ELSET=P\n9, 3\n*MASS, ELSET=P, TYPE=ISOTROPIC\n2\n*FILM PROPERTY, NAME=F\n1\n"
      "*DISTRIBUTION, NAME=D\n, 1\n*SUBMODEL\nN\n*HOURGLASS STIFFNESS\n1\n"));
  CHECK(file.deck.shell_sections.at(0).added_mass == 3.5);
  CHECK(testing::of_all_ranks(file.deck.masses).at(0).mass == 2);
  std::string all;
  for (const std::string& notice : file.notices) all += notice + "\n";
  for (const char* text :
       {"*EXPANSION TYPE=ISO is ignored: heat", "*EXPANSION is ignored: heat", "*FILM PROPERTY is ignored: heat",
        "*DISTRIBUTION is ignored: nothing that is read varies by it", "*SUBMODEL is ignored: supports",
        "*HOURGLASS STIFFNESS is ignored: elements have no hourglass modes"})
    CHECK_THAT(all, Contains(text));
}

TEST_CASE("a later section overrides an earlier one") {
  const std::string more =
      "*ELEMENT, TYPE=S4, ELSET=E\n2, 1, 2, 3, 4\n*ELSET, ELSET=F\n2\n*SHELL SECTION, ELSET=F, MATERIAL=M\n2\n"
      "*ELEMENT, TYPE=B31, ELSET=E\n3, 1, 2\n*BEAM SECTION, ELSET=E, MATERIAL=M, SECTION=RECT\n0.1\n";
  const auto file = read(testing::written("override.inp", square(more)));
  CHECK(file.mesh.parts == std::vector<std::string>{"E", "F", "E"});
  CHECK(testing::measure(file.mesh, 0) == Approx(1.0));
  CHECK(testing::measure(file.mesh, 1) == Approx(1.0));
  CHECK(testing::measure(file.mesh, 2) == Approx(1.0));  // the beam takes the section of its kind
  CHECK(file.deck.shell_sections.at(1).number == 1);
  CHECK(file.deck.beam_sections.at(0).number == 2);
  CHECK(file.deck.beam_sections.at(0).dimensions == std::vector<double>{0.1, 0.1});
  const std::string all = file.notices.at(0) + file.notices.at(1);
  CHECK_THAT(all, Contains("override.inp:17: set F overrides an earlier section of 1 element"));
  CHECK_THAT(all, Contains("has one dimension: it is read as a square"));
}

TEST_CASE("shells whose section asks for it take the mean of nodal thicknesses") {
  const std::string text = square(
      "*NODE\n5, 2, 0\n6, 2, 1\n*ELEMENT, TYPE=S4, ELSET=E\n2, 2, 5, 6, 3\n*NSET, NSET=R\n5, 6\n"
      "*NODAL THICKNESS\nR, 3\n6, 5\n");
  const auto plain = read(testing::written("nodal.inp", text));  // as in CalculiX and Abaqus
  CHECK(plain.deck.shell_sections.size() == 1);
  CHECK_THAT(plain.notices.at(0), Contains("*NODAL THICKNESS is ignored: no *SHELL SECTION has NODAL THICKNESS"));
  const std::string section = "*SHELL SECTION";
  const auto file = read(testing::written(
      "nodal.inp", std::string(text).replace(text.find(section), section.size(), section + ", NODAL THICKNESS")));
  CHECK(file.mesh.parts == std::vector<std::string>{"E", "E"});
  CHECK(testing::measure(file.mesh, 0) == Approx(1.0));
  CHECK(testing::measure(file.mesh, 1) == Approx(1.0));
  REQUIRE(file.deck.shell_sections.size() == 2);
  CHECK(file.deck.shell_sections[1].number == 1);
  CHECK(file.deck.shell_sections[1].plies.at(0).thickness == Approx((1 + 1 + 3 + 5) / 4.));
  // t = 2.5 + 1.5 x + 0.5 y + 0.5 xy: m^3 + m (a^2 + b^2 + c^2 / 3) + 2 abc / 3
  CHECK(file.deck.shell_sections[1].taper == Approx(1 + (2.5 * (2.25 + 0.25 + 0.25 / 3) + 0.25) / 15.625));
  CHECK_THAT(file.notices.at(0), Contains("nodal.inp:21: *NODAL THICKNESS: 1 shell with the mean thickness"));
  for (const std::string wrong : {", 3", "6", "6, 0", "6, thick"})
    CHECK_THAT(testing::fault_of([&] { read(testing::written("nodal.inp", text + wrong + "\n")); }),
               Contains("expected a node or node set and a thickness, found '" + wrong + "'"));
}

TEST_CASE("elements that have a twin are read as it, with a notice") {
  const auto file = read(testing::written(
      "twins.inp",
      square("*ELEMENT, TYPE=B31R, ELSET=B\n2, 1, 2\n*BEAM GENERAL SECTION, ELSET=B, MATERIAL=M, SECTION=PIPE\n"
             ".11, .01\n1.d0, 0., 0.\n")));
  CHECK_THAT(file.notices.at(0), Contains("twins.inp:13: elements of type B31R are read as B31"));
  REQUIRE(file.deck.beam_sections.size() == 1);
  CHECK(file.deck.beam_sections[0].profile == mesh::Profile::pipe);
  const auto planar = read(testing::written(
      "planar.inp",
      "*NODE\n1, 0, 0\n2, 1, 0\n*ELEMENT, TYPE=B21, ELSET=B\n1, 1, 2\n*MATERIAL, NAME=M\n*ELASTIC\n1, 0\n"
      "*BEAM SECTION, ELSET=B, MATERIAL=M, SECTION=THICK PIPE\n.11, .01\n"));
  CHECK_THAT(planar.notices.at(0), Contains("planar.inp:4: elements of type B21 are read as B31: beams in space"));
  CHECK(planar.mesh.cell_count == 1);
  REQUIRE(planar.deck.beam_sections.size() == 1);
  CHECK(planar.deck.beam_sections[0].profile == mesh::Profile::pipe);
  CHECK(planar.deck.beam_sections[0].direction_1 == Eigen::Vector3d(0, 0, -1));
}

TEST_CASE("a circle of two diameters is an ellipse; keywords of a step may stand outside of one") {
  const auto file = read(testing::written(
      "ellipse.inp", square("*ELEMENT, TYPE=B31, ELSET=B\n2, 1, 2\n*ELEMENT, TYPE=B31, ELSET=C\n3, 2, 3\n"
                            "*BEAM SECTION, ELSET=B, MATERIAL=M, SECTION=CIRC\n.06, .04\n"
                            "*BEAM SECTION, ELSET=C, MATERIAL=M, SECTION=CIRC\n.06, .06\n*STATIC\n1., 1.\n")));
  CHECK(file.deck.beam_sections.at(0).dimensions == std::vector<double>{.03, .02});
  CHECK(file.deck.beam_sections.at(1).dimensions == std::vector<double>{.03});
  CHECK_THAT(file.notices.at(0), Contains("ellipse.inp:21: *STATIC is ignored: it is outside of a *STEP"));
}

TEST_CASE("elements of second order are read, of beams the ends before the middle") {
  const std::string head =
      "*NODE\n1, 0, 0\n2, 2, 0\n3, 2, 2\n4, 0, 2\n5, 1, 0\n6, 2, 1\n7, 1, 2\n8, 0, 1\n9, 3, 0\n10, 4, 0\n"
      "11, 1, 1\n";
  const auto file = read(testing::written(
      "second.inp",
      head + "*ELEMENT, TYPE=S8R, ELSET=Q\n1, 1, 2, 3, 4, 5, 6, 7,\n8\n*ELEMENT, TYPE=B32R, ELSET=L\n2, 2, 9, 10\n"
             "*ELEMENT, TYPE=STRI65, ELSET=Q\n3, 1, 2, 3, 5, 6, 11\n*MATERIAL, NAME=M\n*ELASTIC\n1, 0.3\n"
             "*DENSITY\n1\n*SHELL SECTION, ELSET=Q, MATERIAL=M\n0.1\n*BEAM SECTION, ELSET=L, MATERIAL=M, "
             "SECTION=RECT\n1, 1\n0, 0, 1\n"));
  const auto cells = testing::of_all_ranks(file.mesh.cells);
  REQUIRE(cells.size() == 3);
  CHECK(cells[0].kind == mesh::CellKind::quadrilateral8);
  CHECK(cells[0].nodes == std::array<PetscInt, mesh::most_nodes>{0, 1, 2, 3, 4, 5, 6, 7});
  CHECK(cells[1].kind == mesh::CellKind::line3);
  CHECK(cells[1].nodes[0] == 1);
  CHECK(cells[1].nodes[1] == 9);
  CHECK(cells[1].nodes[2] == 8);
  CHECK(cells[2].kind == mesh::CellKind::triangle6);
  CHECK_THAT(file.notices.at(0), Contains("elements of type STRI65 are read as S6"));
}

TEST_CASE("a scene may give sections to a deck without any, and leave out solids") {
  const std::string deck =
      "*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n5, 0, 0, 1\n6, 2, 0\n7, 2, 1\n*ELEMENT, TYPE=S4, ELSET=E\n1, 1, 2, "
      "3, 4\n"
      "2, 2, 6, 7, 3\n*ELEMENT, TYPE=C3D4, ELSET=V\n8, 1, 2, 3, 5\n*ELSET, ELSET=F\n2, 8\n*SOLID SECTION, ELSET=V, "
      "MATERIAL=M\n";
  const auto path = testing::written("bare.inp", deck);
  CHECK_THAT(testing::fault_of([&] { read(path); }),
             Contains("bare.inp:12: elements of type 'C3D4' are not read") && Contains("file: {ignore: [C3D4]}"));
  mesh::DeckRequest request;
  request.ignore = {"c3d4"};
  CHECK_THAT(testing::fault_of([&] { mesh::read_inp(PETSC_COMM_WORLD, path, request); }),
             Contains("bare.inp:10: element 1 has no section"));
  request.parts = {"F"};
  const auto file = mesh::read_inp(PETSC_COMM_WORLD, path, request);
  CHECK(file.mesh.parts == std::vector<std::string>{"F", "E"});
  CHECK(testing::measure(file.mesh, 0) == Approx(1.0));
  CHECK(testing::measure(file.mesh, 1) == Approx(1.0));
  CHECK(file.mesh.node_count == 6);  // without 5
  CHECK_THAT(file.notices.at(0), Contains("*SOLID SECTION is ignored"));
  CHECK_THAT(file.notices.at(1), Contains("bare.inp:12: 1 element of type C3D4 is left out, as the scene asks"));
}

TEST_CASE("materials that no section uses are reported") {
  const auto file = read(testing::written("unused.inp", square("*MATERIAL, NAME=FOAM\n*ELASTIC\n1, 0\n")));
  CHECK_THAT(file.notices.at(0), Contains("unused.inp: material FOAM is not used by any section"));
}
