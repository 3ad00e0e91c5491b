#include "nastran_text.h"

using namespace floe;
using namespace floe::testing::nastran;
using Catch::Matchers::Contains;

TEST_CASE("cards that are not read are refused by name and line, or left out on request") {
  const std::string other = "CELAS4,70,1.+5,1,1\nCELAS4,71,1.+5,2,1\nCSHEAR,72,1,1,2,3,4\n";
  CHECK_THAT(said(square + other),
             Contains("bad.bdf:8: CELAS4 (a spring of another kind; use CBUSH or CELAS2 between grids, 2 cards) is not "
                      "read; to leave them out: file: {ignore: [CELAS4]}") &&
                 Contains("bad.bdf:10: CSHEAR (a shear panel"));
  CHECK_THAT(said(square + "CQUAD44,7,3,1,2,3,4\n"),
             Contains("bad.bdf:8: card 'CQUAD44' is not known, did you mean CQUAD4?"));
  CHECK_THAT(all_of(read("left.bdf", square + other, {{}, false, {"celas4", "CSHEAR"}}).notices),
             Contains("2 cards CELAS4 left out, as the scene asks"));
  const std::string spring = "CELAS2,70,1.+5,1,1,2,2\nCELAS2,71,1.+5,2,1,3,1\nRBE3,72,,1,123,1.,123,2,3\n";
  CHECK_THAT(all_of(read("left.bdf", square + spring, {{}, false, {"celas2", "RBE3"}}).notices),
             Contains("2 cards CELAS2 left out, as the scene asks") && Contains("1 card RBE3 left out"));
}

TEST_CASE("equations of displacements are refused, or left out on request") {
  const std::string tie = "MPC,5,3,3,1.,4,3,-1.\nMPCADD,6,5\n";
  CHECK(said(square + tie) ==
        "bad.bdf:8: MPC (an equation of displacements, which ties nodes; use RBE2 or RBAR, 1 card) is not read; to "
        "leave them out: file: {ignore: [MPC]}");
  CHECK_THAT(all_of(read("left.bdf", square + tie, {{}, false, {"MPC"}}).notices),
             Contains("1 card MPC left out, as the scene asks") && Contains("MPCADD is ignored"));
}

TEST_CASE("wrong cards of Nastran are refused with line and field") {
  CHECK(said(square) == "nothing was thrown");
  CHECK(said("") == "bad.bdf: is empty");
  CHECK_THAT(said("garbage\n"), Contains("card 'GARBAGE' is not known") && Contains("has no GRID"));
  CHECK_THAT(said(",1,2\n"), Contains("a continuation without a card"));
  CHECK_THAT(said(grids + "CTRIA3,2,3,1,2,3\nPSHELL,3,7,.01,7\n"),
             Contains("PSHELL3 names material 7, which is not defined"));
  const std::pair<std::string, const char*> after_square[] = {
      {"GRID,x,,0.,0.,0.\n",
       "bad.bdf:8: GRID: field 2 expects the grid's number (an integer greater than 0), found 'x'"},
      {"GRID,9,,0.,1.2.3,0.\n", "bad.bdf:8: GRID: field 5 expects a coordinate (a real number), found '1.2.3'"},
      {"GRID,9,,0.,0.,0.,,,,7\n", "expected at most 8 fields after the name, found '7'"},
      {"GRID,4,,0.,0.,0.\n", "bad.bdf:8: node 4 is defined a second time"},
      {"CTRIA3,1,3,1,2,3\n", "bad.bdf:8: element 1 is defined a second time"},
      {"CTRIA3,2,3,1,2,77\n", "element 2 names node 77, which is not defined"},
      {"CTRIA3,2,33,1,2,3\n", "shell 2 names property 33, which is not defined (3 are)"},
      {skin, "bad.bdf:8: PSHELL 3 defines property 3 a second time"},
      {"PSHELL,4,1,.01,-1\n", "PSHELL: field 5 (MID2: -1, plane strain) is not read"},
      {"PSHELL,4,1,.01,1,0.\n", "PSHELL: field 6 (12 I / T^3) expects a number greater than 0"},
      {"CELAS2,70,1.+5,1,1,2,2\n",
       "spring 70 would resist rigid motion: it joins direction 1 of one grid to direction 2"},
      {"CELAS2,70,1.+5,1,2,2,2\n", "spring 70 would resist rigid motion: its grids are 1 apart across direction 2"},
      {"CELAS2,70,-1.,1,1,2,1\n", "CELAS2: field 3 expects a stiffness that is not negative"},
      {"CELAS2,70,1.,1,7,2,7\n", "CELAS2: field 5 expects a component from 1 to 6"},
      {"CELAS1,70,9,1,1,2,1\n", "spring 70 names PELAS 9, which is not defined"},
      {"CELAS2,70,1.,1,1,77,1\n", "grid 77"},
      {"CBUSH,70,9,1,2\n", "CBUSH 70 names PBUSH 9, which is not defined"},
      {"CBUSH,70,9,1,2\nPBUSH,9,K,1.,2.\n", "CBUSH 70 has stiffnesses across its line; expected an orientation vector"},
      {"CBUSH,70,9,1,2,,,,0\n,,0\nPBUSH,9,K,1.,2.\n", "CBUSH: field 13 (OCID"},
      {"GRID,5,,0.,0.,0.\nCBUSH,70,9,1,5\nPBUSH,9,K,1.,2.\n", "CBUSH 70 has grids at one point; expected axes (CID)"},
      {"CBAR,70,3,1,2,0.,0.,1.\n", "beam 70 names property 3, a property of shells; expected one of beams"},
      {"CROD,70,9,1,2\n", "beam 70 names property 9, which is not defined"},
      {"CONROD,70,1,2,1,0.\n", "CONROD: field 6 expects the area greater than 0"},
      {"CROD,70,9,1,2\nPTUBE,9,1,.1,.06\n", "PTUBE: field 5 expects a wall of at most half the diameter"},
      {"RBE3,70,,1,123,1.,123,2,3\n",
       "RBE3 70: reference grid 1 has an element, a mass or a link, which a mean of grids does not carry; expected "
       "RBE2, "
       "or for a mass a rigid body of the scene, fixed to the place RBE3_70 by a joint"},
      {"RBE3,70,,1,123\n", "RBE3 70 has no grids"},
      {"GRID,5,,.5,0.,0.\nRBE3,70,,5,123456,1.,123,1,2\nRBE3,70,,5,123456,1.,123,1,2\n",
       "bad.bdf:10: RBE3 70: there is another RBE3 of this number"},
      {"GRID,5,,.5,0.,0.\nGRID,6,,1.,0.,0.\nRBE3,70,,5,123456,1.,123,1,6\n",
       "bad.bdf:10: RBE3 70: grid 6 has no element, mass or link"},
      {"GRID,5,,.5,0.,0.\nRBE3,70,,5,123456,0.,123,1,2\n", "RBE3: field 6 expects a weight greater than 0"},
      {"GRID,5,,.5,0.,0.\nRBE3,70,,5,123456,1.,12,1,2\n",
       "RBE3: field 7 expects the components 123 of all grids, found '12'"},
      {"GRID,5,,.5,0.,0.\nRBE3,70,,5,123456,1.,1237,1,2\n", "RBE3: field 7 expects the components 123 of all grids"},
      {"GRID,5,,.5,.1,0.\nRBE3,70,,5,123456,1.,123,1,2\n",
       "bad.bdf:9: RBE3 70: reference grid 5 is 0.1 away from the mean of its grids, (0.5, 0, 0)"},
      {"GRID,5,,.5,0.,0.\nRBE3,70,,5,123456,1.,123,1,\n,,3.,123,2\n",
       "bad.bdf:9: RBE3 70: reference grid 5 is 0.25 away from the mean of its grids, (0.75, 0, 0)"},
      {"PSHELL,4,1,-1.,1\n", "PSHELL: field 4 expects a thickness that is not negative"},
      {"MAT1,4,0.,,.3\nPSHELL,9,4,.1\nCQUAD4,9,9,1,2,3,4\n", "names material 4, a MAT1 without E and G"},
      {"PCOMP,4\n", "PCOMP 4 has no plies"},
      {"SPC1,1,123,88\n", "bad.bdf:8: supports SPC1 name grid 88, which is not defined"},
      {"CONM2,1,88,,1.\n", "grid 88, which is not defined"}};
  for (const auto& [cards, text] : after_square) CHECK_THAT(said(square + cards), Contains(text));
}

TEST_CASE("wrong beams of Nastran are refused with line and field") {
  const std::pair<std::string, const char*> sections[] = {
      {"PBEAML,5,1,,BAR\n,.02,.03,,,1.,.02,x\n", "PBEAML: field 18 expects a dimension (a real number), found 'x'"},
      {"PBEAML,5,1,,BAR\n,.02,.03,2.,,.5,,,3.\n", "PBEAML 5 expects a station at end B (X/XB = 1)"},
      {"PBARL,5,1,,BXO\n,.02,.03,.001,.002\n", "found 'BXO', did you mean BOX?"},
      {"PBEAML,5,1,,BOX1\n,.04,.02,.001,.002,.001,.001\n", "expected equal walls"},
      {"PBARL,5,1,,BOX\n,.02,.03,.02,.002\n", "walls thinner"},
      {"PBAR,5,1,.01,3.-6,2.-6,-1.\n", "PBAR 5 expects A greater than 0, I1, I2 and J not negative"},
      {"PBAR,5,1,.01,0.,2.-6,1.\n,,,,,,,,\n,,,1.-6\n", "PBAR 5 expects A greater than 0"}};
  for (const auto& [cards, text] : sections) CHECK_THAT(said(with_beam(cards)), Contains(text));
  const std::string bar = square + "PBAR,5,1,.01,3.-6,2.-6,1.-6\n";
  const std::pair<std::string, const char*> elements[] = {
      {"CBAR,9,5,1,2,1.,0.,0.\n", "parallel to the beam"},
      {"CBAR,9,5,1,2\n", "CBAR: field 6 expects an orientation vector"},
      {"CBAR,9,5,1,2,0.,0.,1.\n,47\n", "CBAR: field 12 expects pin flags from 1 to 6, found '47'"},
      {"CBAR,9,5,1,2,0.,0.,1.,GGB\n", "CBAR: field 9 expects G or B, and twice G or O (OFFT"},
      {"BAROR,,5,,,0.,0.,1.,XGO\nCBAR,9,,1,2\n", "as GGG; found 'XGO' of BAROR"}};
  for (const auto& [cards, text] : elements) CHECK_THAT(said(bar + cards), Contains(text));
  CHECK(said(bar + "BAROR,,5,,,0.,0.,1.,XGO\nCBAR,9,,1,2,,,,GGG\n") == "nothing was thrown");
}

TEST_CASE("constants of Nastran outside their range are refused with field and range") {
  const std::pair<std::string, const char*> after_square[] = {
      {"MAT1,4,,,.3\nPBAR,9,4,1.,1.,1.,1.\nCBAR,9,9,1,2,0.,0.,1.\n", "names material 4, a MAT1 without E and G"},
      {"MAT1,4,,1.\n", "expect two of E, G and nu"},
      {"MAT1,4,-1.,,.3\n", "expect E and G greater than 0"},
      {"MAT1,4,1.,-1.\n", "expect E and G greater than 0"},
      {"MAT1,4,1.,,.6\n", "MAT1: field 5 expects nu between -1 and 1/2, found 0.6"},
      {"MAT1,4,1.,,.3,-1.\n", "MAT1: field 6 expects a density that is not negative"},
      {"MAT8,4,1.,1.,1.,1.\n", "MAT8: field 5 expects nu12^2 < E1 / E2"},
      {"MAT8,4,0.,1.,.3,1.\n", "MAT8: field 3"},
      {"MAT8,4,1.,1.,.3,1.,,,-1.\n", "expects a density that is not negative"},
      {"MAT2,4,1.,2.,0.,1.,0.,1.\n", "MAT2: field 4 expects G12^2 < G11 G22"},
      {"MAT2,4,1.,0.,1.,1.,0.,1.\n", "MAT2: field 5 is not 0: materials are orthotropic in their own axes"},
      {"MAT2,4,1.,0.,0.,1.,1.,1.\n", "MAT2: field 7 is not 0"},
      {"MAT2,4,1.,0.,0.,1.,0.,1.,-1.\n", "expects a density that is not negative"},
      {"PELAS,9,-1.\n", "expects a stiffness that is not negative"},
      {"PBUSH,9,K,-1.\n", "expects a stiffness that is not negative"},
      {"PROD,9,1,.1,-1.\n", "expects J that is not negative"},
      {"CONROD,70,1,2,1,.1,-1.\n", "expects J that is not negative"},
      {"PROD,9,1,0.\n", "the area"},
      {"PTUBE,9,1,.1,-.01\n", "expects a wall of at most half the diameter"},
      {"PTUBE,9,1,.1,.01,,.2\n", "PTUBE: field 7 differs from field 4: tubes with taper are not read"},
      {"CONM2,9,1,,-1.\n", "expects a mass that is not negative"},
      {"CQUAD4,2,3,1,2,3,4\n,,,.01,-.01\n", "CQUAD4: field 15 expects a thickness that is not negative"},
      {"RBE2,70,1,12,3\n", "rigid links constrain all three translations"},
      {"RBE2,70,1,1237,3\n", "rigid links constrain all three translations"}};
  for (const auto& [cards, text] : after_square) {
    INFO(cards);
    CHECK_THAT(said(square + cards), Contains(text));
  }
  CHECK(said(square + "MAT1,4,1.,1.,-.5\nMAT1,5,,1.,.5\nMAT1,6,1.,.4\nMAT8,7,1.,1.,.99,1.\nPTUBE,9,1,.1,.05,,.1\n") ==
        "nothing was thrown");
  CHECK_THAT(all_of(read("counted.bdf", square + "MAT1,4,1.,1.,.3,,,,.1\nMAT8,5,1.,1.,.3,1.\n,,,,,,,,\n,.1\n").notices),
             Contains("MAT1 G") && Contains("GE"));
}

TEST_CASE("bulk data that ends early is refused, or lacks what follows") {
  for (std::size_t size = 1; size < square.size(); size += 3) {
    INFO("size " << size);
    const std::string text = said(square.substr(0, size));
    CHECK((text.find("bad.bdf") != std::string::npos || text == "nothing was thrown"));
  }
}
