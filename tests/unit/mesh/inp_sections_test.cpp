#include "floe/mesh/inp.h"
#include "mesh_files.h"

using namespace floe;
using Catch::Matchers::Contains;

namespace {

/// Two triangles with a section, lines 1 to 13, and more.
mesh::DeckFile deck(const std::string& more) {
  const std::string good =
      "*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n*ELEMENT, TYPE=S3, ELSET=E\n1, 1, 2, 3\n2, 1, 3, 4\n"
      "*MATERIAL, NAME=M\n*ELASTIC\n1, 0\n*SHELL SECTION, ELSET=E, MATERIAL=M\n1\n";
  return mesh::read_inp(PETSC_COMM_WORLD, testing::written("sections.inp", good + more));
}

std::string said(const std::string& more) {
  return testing::fault_of([&] { deck(more); });
}

/// The square with a beam of it, and a section.
std::string beam(const std::string& section) { return "*ELEMENT, TYPE=B31, ELSET=B\n3, 1, 2\n" + section; }
std::string profile(const std::string& name, const std::string& lines) {
  return beam("*BEAM SECTION, ELSET=B, MATERIAL=M, SECTION=" + name + "\n" + lines + "\n");
}

std::string notices_of(const mesh::DeckFile& file) {
  std::string all;
  for (const auto& notice : file.notices) all += notice + "\n";
  return all;
}

}  // namespace

TEST_CASE("dimensions of profiles are positive, and walls fit into them") {
  const std::pair<const char*, const char*> wrong[] = {{"RECT", "0, 1"},
                                                       {"RECT", "1, -1"},
                                                       {"CIRC", "0"},
                                                       {"PIPE", "1, 2"},
                                                       {"PIPE", "1, 0"},
                                                       {"BOX", "1, 1, .1, .1, .1, 0"},
                                                       {"BOX", "1, 1, .1, .5, .1, .5"},
                                                       {"BOX", "1, 1, .5, .1, .5, .1"},
                                                       {"I", "0, 1, .1, .1, .5, .5, .1"},
                                                       {"I", "0, 1, .1, -.1, .1, .1, .1"}};
  for (const auto& [name, dimensions] : wrong) {
    INFO(name << " " << dimensions);
    CHECK_THAT(said(profile(name, dimensions)), Contains("sections.inp:17: the dimensions are inconsistent"));
  }
  for (const auto& [name, dimensions] : {std::pair{"PIPE", "1, 1"}, std::pair{"BOX", "1, 2, .4, .9, .4, .9"},
                                         std::pair{"I", "0, 1, .1, .1, .4, .4, .1"}, std::pair{"RECTANGULAR", "1, 2"}})
    CHECK(said(profile(name, dimensions)) == "nothing was thrown");
  CHECK_THAT(said(profile("BOX", "1, 1, .1")), Contains("a, b, t1, t2, t3, t4"));
  CHECK_THAT(said(profile("RECT", "1, 1\n0, 0, 0")), Contains("18: the direction of the local 1-axis has no length"));
  CHECK_THAT(said(profile("RECT", "1, 1\nx, 0, 0")), Contains("the direction of the local 1-axis"));
  CHECK_THAT(said(beam("*BEAM GENERAL SECTION, ELSET=B, MATERIAL=M, SECTION=L\n1, 1\n")),
             Contains("SECTION=RECT, CIRC, PIPE, BOX or I, or GENERAL"));
}

TEST_CASE("one dimension of a profile is a square's side or a circle's radius, and said so") {
  const auto square = deck(profile("RECT", "2")), circle = deck(profile("CIRC", "2")),
             ellipse = deck(profile("CIRC", "2, 3"));
  CHECK(square.deck.beam_sections.at(0).dimensions == std::vector<double>{2, 2});
  CHECK_THAT(notices_of(square), Contains("has one dimension: it is read as a square"));
  CHECK(circle.deck.beam_sections.at(0).dimensions == std::vector<double>{2});
  CHECK_THAT(notices_of(circle), Contains("it is read as the radius (Abaqus)"));
  CHECK(ellipse.deck.beam_sections.at(0).dimensions == std::vector<double>{1, 1.5});
  CHECK_THAT(notices_of(ellipse), !Contains("one dimension"));
}

TEST_CASE("a general beam section has positive constants, and moduli of its own without a material") {
  const std::string of_material = "*BEAM GENERAL SECTION, ELSET=B, SECTION=GENERAL, MATERIAL=M\n",
                    of_its_own = "*BEAM GENERAL SECTION, ELSET=B\n";
  for (const char* constants : {"0, 1, 0, 1, 1", "1, 0, 0, 1, 1", "1, 1, 0, 0, 1", "1, 1, 0, 1, 0", "1, 1, 2, 1, 1"})
    CHECK_THAT(said(beam(of_material + constants + "\n")),
               Contains("sections.inp:17: A, I11, I22, J and I11 I22 - I12^2 must be greater than 0"));
  CHECK_THAT(said(beam(of_material + "1, 1, 0, 1\n")), Contains("A, I11, I12, I22, J"));
  for (const char* moduli : {"0, 1", "1, 0", "-1, 1"})
    CHECK_THAT(said(beam(of_its_own + "1, 1, 0, 1, 1\n1, 0, 0\n" + moduli + "\n")),
               Contains("sections.inp:19: E and G must be greater than 0"));
  CHECK_THAT(said(beam(of_its_own + "1, 1, 0, 1, 1\n1, 0, 0\n5\n")), Contains("E, G"));
  CHECK_THAT(said(beam(of_its_own + "1, 1, 0, 1, 1\n1, 0, 0\n")), Contains("a direction, and E G"));
  const auto file = deck(beam(of_its_own + "1, 2, 0, 3, 4\n1, 0, 0\n5, 6\n"));
  REQUIRE(file.deck.beam_sections.size() == 1);
  CHECK(file.deck.beam_sections[0].youngs == 5);
  CHECK(file.deck.beam_sections[0].shear == 6);
}

TEST_CASE("a general section of a shape has a material, or moduli and a density of its own") {
  const std::string shape = "*BEAM GENERAL SECTION, ELSET=B, SECTION=RECT";
  const auto own = deck(beam(shape + ", DENSITY=7\n1, 2\n1, 0, 0\n5, 6\n")).deck.beam_sections.at(0);
  CHECK(own.dimensions == std::vector<double>{1, 2});
  CHECK(own.youngs == 5);
  CHECK(own.shear == 6);
  CHECK(own.density.value() == 7);
  CHECK(deck(beam(shape + ", MATERIAL=M\n1, 2\n")).deck.beam_sections.at(0).material == "M");
  CHECK_THAT(said(beam(shape + "\n1, 2\n1, 0, 0\n")), Contains("dimensions, a direction, and E G"));
}

TEST_CASE("plies: each has a thickness and a material; symmetric ones follow in reverse") {
  const std::string laminate = "*SHELL SECTION, ELSET=E, COMPOSITE";
  for (const char* ply : {"0, , M", "x, , M", ".1, , ", ".1, , M, 0, 1, 2", "-1, , M"})
    CHECK_THAT(said(laminate + "\n" + ply + "\n"),
               Contains("sections.inp:15: a ply is: thickness, (points), material[, angle or orientation]"));
  const auto file = deck(laminate + ", SYMMETRIC\n.1, , M, 0.\n.2, , M, 90.\n");
  const auto& plies = file.deck.shell_sections.back().plies;
  REQUIRE(plies.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(plies[i].thickness == plies[3 - i].thickness);
    CHECK(plies[i].angle == plies[3 - i].angle);
  }
  CHECK(plies[1].angle == 90);
  CHECK_THAT(said(laminate + "\n.1, , N\n"), Contains("there is no material 'N'"));
  CHECK_THAT(said(laminate + "\n.1, , M, turned\n"), Contains("'turned'"));
}

TEST_CASE("offsets of shells are numbers or sides") {
  const auto offset = [](const std::string& text) {
    return "*SHELL SECTION, ELSET=E, MATERIAL=M, OFFSET=" + text + "\n1\n";
  };
  CHECK(deck(offset("SPOS")).deck.shell_sections.back().offset == 0.5);
  CHECK(deck(offset("sneg")).deck.shell_sections.back().offset == -0.5);
  CHECK(deck(offset("2.5D-1")).deck.shell_sections.back().offset == 0.25);
  for (const char* text : {"top", "1e999"})
    CHECK_THAT(said(offset(text)), Contains("expects a number after OFFSET=, found '" + std::string(text) + "'"));
}

TEST_CASE("stiffnesses of shells: 21 numbers without a thickness, or a material with its density") {
  const std::string own = "*SHELL GENERAL SECTION, ELSET=E",
                    numbers = "\n1, 0, 1, 0, 0, 1, 0, 0\n0, 1, 0, 0, 0, 0, 1, 0\n0, 0, 0, 0, 1\n";
  CHECK(said(own + numbers) == "nothing was thrown");
  CHECK_THAT(said(own + ", OFFSET=.5" + numbers),
             Contains("by its stiffness has no thickness, and is read without OFFSET="));
  CHECK_THAT(said(own + "\n1, 0, x\n0\n0\n"), Contains("the 21 numbers of a stiffness"));
  CHECK_THAT(said(own + "\n1, 0\n"), Contains("the 21 numbers of a stiffness"));
  CHECK_THAT(said(own + ", MATERIAL=M, DENSITY=1\n1\n"),
             Contains("with a material is read without DENSITY=: expected *DENSITY"));
  CHECK(said(own + ", MATERIAL=M\n1\n") == "nothing was thrown");
  CHECK_THAT(notices_of(deck(own + numbers + "1, 2, 3\n")), Contains("thermal forces are ignored"));
}

TEST_CASE("transverse shear stiffnesses belong to the shell section before them") {
  const std::string shear = "*TRANSVERSE SHEAR STIFFNESS\n";
  for (const char* bad : {"0, 1", "1, -1"})
    CHECK_THAT(said(shear + bad + "\n"),
               Contains("sections.inp:15: *TRANSVERSE SHEAR STIFFNESS expects K11 and K22 greater than 0"));
  CHECK_THAT(said(shear + "x\n"), Contains("K11, K22, K12"));
  const std::pair<const char*, const char*> means[] = {{"4", "shear by K11,"},
                                                       {"4, 4", "shear by K11,"},
                                                       {"4, 8, 0", "the mean of K11 and K22"},
                                                       {"6, 6, 1", "the mean of"}};
  for (const auto& [values, says] : means) CHECK_THAT(notices_of(deck(shear + values + "\n")), Contains(says));
  CHECK(deck(shear + "4, 8\n").deck.shell_sections.back().shear == 6);
  CHECK_THAT(notices_of(deck(profile("RECT", "1, 1") + shear + "4\n")), Contains("beams have no shear deformation"));
}

TEST_CASE("*TRANSFORM: types, points and nodes that have axes") {
  const std::string more =
      "*NODE\n5, 1, 0\n6, 2, 0\n7, 2, 1\n*ELEMENT, TYPE=S3, ELSET=E\n3, 5, 6, 7\n*NSET, NSET=h\n2, 5\n";
  const std::string pin = "*EQUATION\n2\n2,1,1.,5,1,-1.\n2\n2,2,1.,5,2,-1.\n2\n2,3,1.,5,3,-1.\n";
  CHECK(said(more + pin) == "nothing was thrown");
  CHECK(said(more + "*TRANSFORM, NSET=h\n0, 1, 0, -1, 0, 0\n" + pin) == "nothing was thrown");
  CHECK_THAT(said(more + "*TRANSFORM, NSET=h, TYPE=X\n1, 0, 0, 0, 1, 0\n"),
             Contains("*TRANSFORM expects TYPE=R, C or S, found 'X'"));
  CHECK_THAT(said(more + "*TRANSFORM, NSET=h, TYPE=S\n1, 0, 0, 0, 1, 0\n" + pin),
             Contains("*TRANSFORM of nodes of an *EQUATION is read with TYPE=R or C"));
  for (const char* line : {"\n1, 0, 0, 2, 0, 0\n", ", TYPE=C\n0, 0, 0, 1, 0, 0\n"})
    CHECK_THAT(said(more + "*TRANSFORM, NSET=h" + line + pin),
               Contains("*TRANSFORM: its points and a node of an *EQUATION lie on one line"));
  CHECK_THAT(said(more + "*TRANSFORM, NSET=none\n1, 0, 0, 0, 1, 0\n" + pin), Contains("there is no node set 'none'"));
  CHECK_THAT(said(more + "*TRANSFORM, NSET=h\n1, 0, x\n" + pin), Contains("two points"));
}
