#include "floe/mesh/inp.h"
#include "mesh_files.h"

using namespace floe;
using Catch::Matchers::Contains;

namespace {

std::string said(const std::string& content) {
  const auto path = testing::written("bad.inp", content);
  return testing::fault_of([&] { mesh::read_inp(PETSC_COMM_WORLD, path); });
}

const std::string nodes = "*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n";              // lines 1 to 5
const std::string elements = "*ELEMENT, TYPE=S3, ELSET=E\n1, 1, 2, 3\n2, 1, 3, 4\n";  // 6 to 8
const std::string section = "*MATERIAL, NAME=M\n*ELASTIC\n1, 0\n*SHELL SECTION, ELSET=E, MATERIAL=M\n1\n";  // 9 to 13

}  // namespace

TEST_CASE("files that are no deck are refused") {
  CHECK_THAT(testing::fault_of([] { mesh::read_inp(PETSC_COMM_WORLD, "no/such.inp"); }), Contains("cannot be opened"));
  CHECK(said("") == "bad.inp: is empty");
  CHECK_THAT(said("\x7f"
                  "ELF\x01\x02 garbage\n\x80\x81"),
             Contains("bad.inp:1: expected a keyword"));
  CHECK_THAT(said("*HEADING\n"), Contains("the deck has no *NODE") && Contains("the deck has no *ELEMENT"));
}

TEST_CASE("the parts of the deck that these tests spoil are good") {
  CHECK(said(nodes + elements + section) == "nothing was thrown");
}

TEST_CASE("keywords, parameters and types that are not read are reported, all of them") {
  const std::string text = said(nodes + elements + section +
                                "*ELEMNT, TYPE=S3\n3, 1, 2, 4\n*NSET, NST=a\n1\n*ELEMENT, TYPE=S9R5\n"
                                "9, 1, 2, 3, 4, 1, 2, 3, 4, 1\n*SYSTEM\n1, 0\n*STEP\n*END\n");
  CHECK_THAT(text, Contains("bad.inp:14: keyword '*ELEMNT' is not read, did you mean *ELEMENT?"));
  CHECK_THAT(text, Contains("bad.inp:16: parameter 'NST' of *NSET is unknown, did you mean NSET?"));
  CHECK_THAT(text, Contains("bad.inp:18: elements of type 'S9R5' are not read (B31, B32, B32R, B33, MASS, S3,"));
  CHECK_THAT(text, Contains("bad.inp:20: *SYSTEM is read without data lines"));
  CHECK_THAT(text, Contains("bad.inp:22: *STEP has no *END STEP"));
}

TEST_CASE("nodes and elements that are wrong are refused with their lines") {
  CHECK(said(nodes + "2, 5, 5\n" + elements + section) == "bad.inp:6: node 2 is defined a second time");
  CHECK(said(nodes + elements + "2, 2, 3, 4\n" + section) == "bad.inp:9: element 2 is defined a second time");
  CHECK(said(nodes + elements + "3, 1, 2, 7\n" + section) == "bad.inp:9: element 3 names node 7, which is not defined");
  CHECK_THAT(said(nodes + "5, a\n" + elements + section), Contains("bad.inp:6: expected a node number and its"));
  CHECK_THAT(said(nodes + "5, 1, 1e999\n" + elements + section), Contains("bad.inp:6: expected"));
  CHECK_THAT(said(nodes + elements + "3, 1, 2\n" + section),
             Contains("bad.inp:9: expected an element number and 3 nodes, found '3, 1, 2'"));
  CHECK_THAT(said(nodes + elements + "*NSET, NSET=n\n1, 77\n" + section),
             Contains("bad.inp:9: node set n names node 77"));
  CHECK_THAT(said(nodes + elements + "*NSET, NSET=n\nm\n" + section), Contains("holds 'm', which is not a set"));
}

TEST_CASE("orientations turn about axis 1, 2 or 3") {
  for (const std::string axis : {"0", "4", "1.5", "-1", "3e9", "1e300"})
    CHECK_THAT(said(nodes + elements + section + "*ORIENTATION, NAME=O\n1, 0, 0, 0, 1, 0\n" + axis + ", 30\n"),
               Contains("bad.inp:16: expected an axis (1, 2, 3) and an angle, found '" + axis));
}

TEST_CASE("masses that are none are refused with their lines") {
  const auto with_masses = [](const std::string& list, const std::string& mass) {  // line 14 on
    return said(nodes + elements + section + "*ELEMENT, TYPE=MASS, ELSET=P\n" + list + "*MASS, ELSET=P\n" + mass +
                "\n");
  };
  for (const char* mass : {"0", "-1", "1e300"})
    CHECK(with_masses("9, 3\n", mass) == "bad.inp:17: a mass must be greater than 0 and at most 1e100");
  CHECK(with_masses("9, 3\n9, 4\n", "1") == "bad.inp:16: element 9 is defined a second time");
  CHECK_THAT(with_masses("2, 3\n", "1"), Contains("element 2 is defined a second time"));
  CHECK(with_masses("8, 3\n9, 3\n", "1") == "nothing was thrown");
}

TEST_CASE("materials without mass or stiffness are refused with their lines and keywords") {
  for (const std::string density : {"0", "-7.8e-9"})
    CHECK(said(nodes + elements + section + "*MATERIAL, NAME=N\n*ELASTIC\n1, 0.3\n*DENSITY\n" + density + "\n") ==
          "bad.inp:18: *DENSITY: a density must be greater than 0, found '" + density + "'");
  CHECK(said(nodes + elements + section + "*MATERIAL, NAME=N\n*ELASTIC\n0, 0.3\n") ==
        "bad.inp:16: *ELASTIC: moduli among E, nu must be greater than 0, found '0, 0.3'");
  CHECK_THAT(said(nodes + elements + section +
                  "*BEAM GENERAL SECTION, ELSET=E, SECTION=GENERAL, MATERIAL=M, DENSITY=-1\n1, 1, 0, 1, 1\n1, 0, 0\n"),
             Contains("bad.inp:14: *BEAM GENERAL SECTION expects 0 or a positive number after DENSITY=, found '-1'"));
}

TEST_CASE("sections that do not fit the elements are refused") {
  CHECK_THAT(said(nodes + elements), Contains("bad.inp:7: element 1 has no section"));
  CHECK_THAT(said(nodes + elements + "*ELEMENT, TYPE=B31, ELSET=E\n3, 1, 3\n" + section),
             Contains("bad.inp:10: element 3 needs a *BEAM SECTION, set 'E' has another section"));
  CHECK_THAT(said(nodes + elements + "*SHELL SECTION, ELSET=EE, MATERIAL=N\n1\n" + section),
             Contains("there is no material 'N'"));
  CHECK_THAT(said(nodes + elements + section + "*ELSET, ELSET=F\n8\n*SHELL SECTION, ELSET=F, MATERIAL=M\n2\n"),
             Contains("element set F names element 8, which is not defined"));
  CHECK_THAT(said(nodes + elements + section + "*SHELL SECTION, ELSET=E, MATERIAL=M\n0\n"),
             Contains("bad.inp:15: a thickness must be greater than 0"));
  CHECK_THAT(
      said(nodes + elements + section + "*BEAM SECTION, ELSET=B, MATERIAL=M, SECTION=BOX\n1, 1, .6, .6, .6, .6\n"),
      Contains("bad.inp:15: the dimensions are inconsistent"));
}

TEST_CASE("forms of masses and sections that are not read are refused") {
  CHECK_THAT(
      said(nodes + elements + section + "*ELEMENT, TYPE=MASS, ELSET=P\n9, 3\n*MASS, ELSET=P, TYPE=ANISOTROPIC\n1\n"),
      Contains("bad.inp:16: *MASS is read with TYPE=ISOTROPIC, not 'ANISOTROPIC'"));
  const auto shell = [](const std::string& more) {
    return said(nodes + elements + section + "*SHELL SECTION, ELSET=E, MATERIAL=M, " + more + "\n1\n");
  };
  CHECK_THAT(shell("STACK DIRECTION=1"),
             Contains("bad.inp:14: *SHELL SECTION is read with STACK DIRECTION=3, not '1'"));
  CHECK_THAT(shell("DENSITY=-1"), Contains("bad.inp:14: *SHELL SECTION expects 0 or a positive mass per area"));
  CHECK_THAT(
      said(nodes + elements + section + "*BEAM SECTION, ELSET=B, MATERIAL=M, SECTION=RECT, NODAL THICKNESS\n1, 1\n"),
      Contains("bad.inp:14: *BEAM SECTION is read without NODAL THICKNESS"));
  CHECK_THAT(said(nodes + elements + section + "*MATERIAL, NAME=N\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n1, 1, 1\n"),
             Contains("bad.inp:15: *ELASTIC expects E1 E2 E3 nu12 nu13 nu23 G12 G13 G23"));
}

TEST_CASE("an ellipse is a circle with two diameters") {
  CHECK_THAT(said(nodes + elements + "*BEAM SECTION, ELSET=E, MATERIAL=M, SECTION=ELLIPTICAL\n1, 2\n"),
             Contains("SECTION=RECT, CIRC, PIPE, BOX or I; an ellipse is CIRC with two diameters"));
}

TEST_CASE("links that are not rigid in all directions are refused") {
  const std::string good = nodes + elements + section + "*NSET, NSET=n\n1, 2\n";
  CHECK_THAT(said(good + "*RIGID BODY, ANALYTICAL SURFACE=n, REF NODE=3\n"), Contains("not with ANALYTICAL"));
  CHECK_THAT(said(good + "*RIGID BODY, NSET=n, REF NODE=n\n"), Contains("a node set of one node, found 'n'"));
  CHECK_THAT(said(good + "*COUPLING, REF NODE=3, SURFACE=n\n*KINEMATIC\n1, 2\n"),
             Contains("directions 1, 2, 3 and any of 4, 5, 6"));
  CHECK_THAT(said(good + "*COUPLING, REF NODE=3, SURFACE=n\n*MPC\nLINK, 1, 2\n"),
             Contains("bad.inp:16: *COUPLING is read with *KINEMATIC or *DISTRIBUTING after it") &&
                 Contains("bad.inp:18: *MPC expects BEAM"));
}

TEST_CASE("a deck that ends early is refused, or lacks what follows") {
  const std::string good = nodes + elements + section;
  for (std::size_t size = 1; size + 3 < good.size(); size += 3) {
    INFO("size " << size);
    CHECK_THAT(said(good.substr(0, size)), Contains("bad.inp:"));
  }
  CHECK(said(nodes + "*ELEMENT, TYPE=S3\n") == "bad.inp: the deck has no beams or shells");
}

TEST_CASE("a byte 0 in a name does no harm") {
  const std::string zero(1, '\0');
  CHECK_THAT(said(nodes + elements + section + "*NSET, NSET=n\na" + zero + "b\n"),
             Contains("holds 'a', which is not a set"));
}

TEST_CASE("at most twenty faults are reported") {
  std::string text = nodes + elements + section;
  for (int i = 0; i < 50; ++i) text += "*NONSENSE\n";
  CHECK_THAT(said(text),
             Contains("bad.inp:33: keyword") && !Contains("bad.inp:34:") && Contains("the first 20 are listed"));
}

TEST_CASE("orientations and elasticities of a deck are given once") {
  const std::string orientation = "*ORIENTATION, NAME=O\n1, 0, 0, 0, 1, 0\n";
  CHECK(said(nodes + elements + section + orientation + orientation) ==
        "bad.inp:16: orientation 'O' is defined a second time");
  CHECK(said(nodes + elements +
             "*MATERIAL, NAME=M\n*ELASTIC\n1, 0\n*ELASTIC\n2, 0\n*SHELL SECTION, ELSET=E, "
             "MATERIAL=M\n1\n") == "bad.inp:12: material 'M' has a second *ELASTIC");
}
