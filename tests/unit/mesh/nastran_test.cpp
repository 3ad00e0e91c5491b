#include "nastran_text.h"

using namespace floe;
using namespace floe::testing::nastran;
using Catch::Matchers::Contains;

TEST_CASE("small, large and free field and tabs are the same deck") {
  const std::string small =
      "SOL 103\nCEND\nSPC = 7\nBEGIN BULK\n$ a comment\n"
      "GRID           1              0.      0.      0.\nGRID           2             1.0      0.      0.\n"
      "GRID           3             1.0     1.0      0.\nGRID           4              0.     1.0      0.\n"
      "CQUAD4         1       3       1       2       3       4\n"
      "PSHELL         3       1     .01       1\nMAT1           1  2.1+11              .3   7800.\n"
      "SPC1           7  123456       1       4\nENDDATA\nnonsense\n";
  const std::string large =
      "GRID*                  1                              0.              0.\n*                     0.\n"
      "GRID*                  2                             1.0              0.*A\n*A                    0.\n"
      "GRID*,3,,1.0,1.0\n*,0.\nGRID,4,,0.D0,1.0d0,0.\n"
      "CQUAD4\t1\t3\t1\t2\t3\t4\nPSHELL,3,1,1.-2,1,,,,,+X\n+X\nMAT1,1,2.1E11,,.3,7800.\nSPC,7,1,123456,,4,123456\n";
  for (const auto& text : {small, large}) {
    const auto file = read("forms.bdf", text);
    CHECK(file.mesh.node_count == 4);
    CHECK(file.mesh.parts == std::vector<std::string>{"PSHELL3"});
    CHECK(testing::measure(file.mesh, 0) == Approx(1.0));
    CHECK(testing::labels_at(file.mesh, "SPC7") == std::vector<long long>{1, 4});
    CHECK(testing::labels_at(file.mesh, "PSHELL3") == std::vector<long long>{1, 2, 3, 4});
    REQUIRE(file.deck.shell_sections.size() == 1);
    CHECK(file.deck.shell_sections[0].plies.at(0).thickness == Approx(0.01));
    REQUIRE(file.deck.materials.size() == 1);
    CHECK(file.deck.materials[0].constants[0] == Approx(2.1e11));
    CHECK(file.deck.materials[0].density == 7800);
    CHECK_THAT(all_of(file.notices), Contains("is ignored: supports are joints of the scene (1 card)"));
  }
}

TEST_CASE("files are included") {
  testing::written("grids.bdf", grids);
  const auto file = read("outer.bdf", "BEGIN BULK\nINCLUDE 'grids.bdf'\nCTRIA3,1,3,1,2,3\nCTRIAR,2,3,1,3,4\n" + skin);
  CHECK(testing::measure(file.mesh, 0) == Approx(1.0));
  const auto round = testing::written("round.bdf", "INCLUDE 'round.bdf'\n");
  CHECK_THAT(testing::fault_of([&] { mesh::read_nastran(PETSC_COMM_WORLD, round); }), Contains("20 files deep"));
}

TEST_CASE("grids have axes of every kind") {
  const std::string axes =
      "CORD2R,1,,1.,2.,3.,1.,2.,4.\n,1.,3.,3.\n"   // x along y, y along -x
      "CORD2C,2,1,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"  // in axes 1
      "CORD2S,3,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"   // radius, from z, about z
      "CORD1R,4,1,2,4,5,2,4,1\n";                  // z along x, x along y; and of grids 2, 4, 1
  const auto file =
      read("axes.bdf", square + axes +
                           "GRID,11,1,2.,0.,0.\nGRID,12,2,2.,90.,1.\nGRID,13,3,2.,90.,90.\nGRID,14,4,0.,0.,2.\n"
                           "RBE2,90,1,123456,11,12,13,14\n");
  const auto near = [&](long long label, const Eigen::Vector3d& x) {
    CHECK((position(file.mesh, label) - x).norm() < 1e-12);
  };
  near(11, {1, 4, 3});
  near(12, {-1, 2, 4});
  near(13, {0, 2, 0});
  near(14, {2, 0, 0});
  REQUIRE(file.deck.links.size() == 1);
  CHECK(testing::of_all_ranks(file.deck.links[0].nodes).size() == 4);
  CHECK_THAT(said(square + "GRID,9,77,0.,0.,0.\n"), Contains("bad.bdf:8: there are no axes 77"));
  CHECK_THAT(said(square + "CORD2R,1,2,,,,,,1.\n,1.\nCORD2R,2,1,,,,,,1.\n,1.\nGRID,9,1,0.,0.,0.\n"),
             Contains("depend on themselves"));
  CHECK_THAT(said(square + "CORD2R,1,,0.,0.,0.,0.,0.,1.\n,0.,0.,2.\nGRID,9,1,0.,0.,0.\n"), Contains("lie on one line"));
}

TEST_CASE("shell elements of one property that differ are parts of the same name") {
  const auto file = read(
      "variants.bdf",
      grids + "GRID,5,,2.,0.\nGRID,6,,2.,1.\nCQUAD4,1,3,1,2,3,4\nCQUADR,2,3,2,5,6,3,,.02\n,,,.01,.03,.01,.03\n" + skin);
  CHECK(file.mesh.parts == std::vector<std::string>{"PSHELL3", "PSHELL3"});
  REQUIRE(file.deck.shell_sections.size() == 2);
  CHECK(file.deck.shell_sections[1].number == 1);
  CHECK(file.deck.shell_sections[1].plies[0].thickness == Approx(0.02));
  CHECK(file.deck.shell_sections[1].offset == Approx(-1.0));
  CHECK(file.deck.shell_sections[1].taper == Approx(1 + 1. / 12));  // t = 1 - xy / 2
  CHECK(file.deck.shell_sections[1].thickest == Approx(1.5));
  CHECK_THAT(all_of(file.notices), Contains("1 shell of varying thickness: membrane and mass by the mean"));
  const auto edge = read("edge.bdf", grids + "CQUAD4,1,3,1,2,3,4\n,,,.04,.04\nCTRIA3,2,3,1,2,3\n,,1,0.,0.,3.\n" + skin);
  REQUIRE(edge.deck.shell_sections.size() == 2);
  CHECK(edge.deck.shell_sections[0].plies[0].thickness == Approx(0.025));  // the others have that of the PSHELL, 0.01
  CHECK(edge.deck.shell_sections[1].plies[0].thickness == Approx(0.01));
  const auto bevel = read("bevel.bdf", grids + "CQUAD4,1,3,1,2,3,4\n,,,0.,0.\n" + skin).deck.shell_sections.at(0);
  CHECK(bevel.plies[0].thickness == Approx(0.005));
  CHECK(bevel.taper == Approx(2));
  const auto none = read("zeros.bdf", grids + "CQUAD4,1,3,1,2,3,4\n,,,0.,0.,0.,0.\n" + skin).deck.shell_sections.at(0);
  CHECK(none.plies[0].thickness == Approx(0.01));
  CHECK(edge.deck.shell_sections[1].taper == Approx(2.7));  // t^3 / 10 of a third
}

TEST_CASE("shells of second order without grids between corners are of first order") {
  const auto file = read("none.bdf", grids + "CQUAD8,1,3,1,2,3,4\n,,,.01,.01,.01,.03\nCTRIA6,2,3,1,2,3\n" + skin);
  std::vector<mesh::CellKind> kinds;
  for (const auto& cell : testing::of_all_ranks(file.mesh.cells)) kinds.push_back(cell.kind);
  CHECK(kinds == std::vector{mesh::CellKind::quadrilateral, mesh::CellKind::triangle});
  CHECK(file.deck.shell_sections.at(0).plies[0].thickness == Approx(0.015));
  CHECK_THAT(all_of(file.notices),
             Contains("second order of CTRIA6 without grids between corners is ignored: read as CTRIA3 (1 card)"));
  CHECK_THAT(said(square + "CQUAD8,2,3,1,2,3,4,5\n"), Contains("CQUAD8: field 9 expects a grid between two corners"));
}

TEST_CASE("laminates of PCOMP and PCOMPG, and their axes") {
  const std::string cards =
      "PCOMP,5,-.001,2.,,,,,SYM\n,8,.0005,0.,,,,45.\nPCOMPG,6\n,1,8,.0005,30.\n,2,2,.001,\n"
      "MAT8,8,1.3+11,9.+9,.3,5.+9,4.+9,3.+9,1600.\nMAT2,2,2.1978+11,6.5934+10,,2.1978+11,,7.6923+10,7800.\n"
      "CORD2R,1,,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\n";
  const auto file = read("plies.bdf", grids + "CTRIA3,1,5,1,2,3,1\nCTRIA3,2,6,1,3,4,90.\n" + cards);
  REQUIRE(file.deck.shell_sections.size() == 2);
  const auto& first = file.deck.shell_sections[0];
  REQUIRE(first.plies.size() == 4);
  CHECK(first.plies[1].angle == 45);
  CHECK(first.plies[2].angle == 45);
  CHECK(first.plies[3].material == first.plies[0].material);
  CHECK(first.offset == Approx(0).margin(1e-12));
  const auto named = [&](const std::string& name) {
    for (const auto& material : file.deck.materials)
      if (material.name == name) return material;
    FAIL("no material " << name);
    return mesh::Material{};
  };
  CHECK(named(first.plies[0].material).density == Approx(1600 + 2 / .002));
  CHECK(named("MAT8_8").constants == std::vector<double>{1.3e11, 9e9, .3, 5e9, 4e9, 3e9});
  CHECK(named("MAT2_2").constants[0] == Approx(2e11).epsilon(1e-4));
  CHECK(named("MAT2_2").constants[2] == Approx(0.3).epsilon(1e-4));
  REQUIRE(file.deck.orientations.size() == 2);
  CHECK((file.deck.orientations[0].a - Eigen::Vector3d(0, 1, 0)).norm() < 1e-9);                  // x of axes 1
  CHECK((file.deck.orientations[1].a - Eigen::Vector3d(-1, 1, 0) / std::sqrt(2)).norm() < 1e-9);  // 90 degrees from 1-3
}

TEST_CASE("beams have sections by numbers and by shapes") {
  const auto section = [](const std::string& cards) {
    const auto file = read("beam.bdf", with_beam(cards));
    CHECK(file.mesh.parts.at(1) == cards.substr(0, cards.find(',')) + "5");
    REQUIRE(file.deck.beam_sections.size() == 1);
    return file.deck.beam_sections[0];
  };
  const auto bar = section("PBAR,5,1,.01,3.-6,2.-6,1.-6,2.\n\n,\n,.8,.7,1.-7\n");
  CHECK(bar.profile == mesh::Profile::general);
  CHECK(bar.dimensions == std::vector<double>{.01, 2e-6, 1e-7, 3e-6, 1e-6});
  CHECK(bar.shear_factors == std::array<double, 2>{.8, .7});
  CHECK(bar.direction_1 == Eigen::Vector3d(0, 0, 1));
  CHECK(bar.youngs == Approx(2.1e11));
  CHECK(bar.shear == Approx(2.1e11 / 2.6));
  CHECK(bar.density.value() == Approx(7800 + 2 / .01));
  CHECK(section("PBARL,5,1,,BAR\n,.02,.03\n").dimensions == std::vector<double>{.03, .02});
  CHECK(section("PBARL,5,1,,ROD\n,.02\n").dimensions == std::vector<double>{.02});
  CHECK(section("PBARL,5,1,,TUBE\n,.02,.015\n").dimensions[1] == Approx(.005));
  CHECK(section("PBEAML,5,1,,TUBE2\n,.02,.005\n").dimensions[1] == Approx(.005));
  CHECK(section("PBARL,5,1,,BOX\n,.02,.03,.001,.002\n").dimensions ==
        std::vector<double>{.03, .02, .001, .002, .001, .002});
  const auto i = section("PBARL,5,1,,I\n,.04,.02,.02,.001,.002,.002\n");
  CHECK(i.quarter_turn);
  CHECK(i.dimensions == std::vector<double>{.02, .04, .02, .02, .002, .002, .001});
  const auto beam = section("PBEAM,5,1,.01,3.-6,2.-6,,1.-6\n,YES,1.,.01,3.-6\n");
  CHECK(beam.shear_factors == std::array<double, 2>{1, 1});
}

TEST_CASE("beams have orientations by grid, in displacement axes, and by default") {
  const std::string bar = "PBAR,5,1,.01,3.-6,2.-6,1.-6\n", rotated = "CORD2R,1,,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\n";
  const auto direction = [&](const std::string& cards) {
    const auto file = read("orient.bdf", square + bar + rotated + cards);
    REQUIRE(file.deck.beam_sections.size() == 1);
    return file.deck.beam_sections[0].direction_1;
  };
  CHECK((direction("GRID,8,,3.,0.,5.\nCBAR,9,5,1,2,8\n") - Eigen::Vector3d(0, 0, 1)).norm() < 1e-9);
  CHECK((direction("GRID,8,,0.,0.,0.,1\nCBEAM,9,5,8,2,1.,0.,0.\nRBAR,77,1,8,123456\n") - Eigen::Vector3d(0, 1, 0))
            .norm() < 1e-9);
  CHECK((direction("BAROR,,5,,,0.,1.,0.\nCBAR,9,,1,2\n") - Eigen::Vector3d(0, 1, 0)).norm() < 1e-9);
}

TEST_CASE("offsets of beams are rigid links") {
  const auto file =
      read("offset.bdf", with_beam("PBAR,5,1,.01,3.-6,2.-6,1.-6\n") +
                             "CBAR,10,5,2,3,0.,0.,1.\n,,,0.,0.,.1,0.,0.,.1\nCBAR,11,5,3,4,0.,0.,1.\n,,,0.,0.,.1\n");
  CHECK(file.mesh.node_count == 6);
  CHECK(position(file.mesh, 5) == Eigen::Vector3d(1, 0, .1));
  CHECK(position(file.mesh, 6) == Eigen::Vector3d(1, 1, .1));
  REQUIRE(file.deck.links.size() == 2);
  CHECK(file.deck.links[0].reference == 1);
  CHECK(testing::of_all_ranks(file.deck.links[0].nodes) == std::vector<PetscInt>{4});
  CHECK_THAT(all_of(file.notices), Contains("2 nodes of beams with offsets, from 5 on, rigidly linked"));
}

TEST_CASE("masses have a centre and moments of inertia, in axes") {
  const auto file = read("mass.bdf", square +
                                         "CORD2R,1,,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\nPARAM,WTMASS,.5\n"
                                         "CONM2,50,3,1,4.,.1,.2,.3\n,1.,.1,2.,,,2.5\nCONM2,51,4,-1,2.,1.,1.,1.\n");
  const auto masses = testing::of_all_ranks(file.deck.masses);
  REQUIRE(masses.size() == 2);
  CHECK(masses[0].mass == 2);
  CHECK((masses[0].offset - Eigen::Vector3d(-.2, .1, .3)).norm() < 1e-12);
  CHECK(masses[0].inertia(0, 0) == Approx(1));
  CHECK(masses[0].inertia(1, 1) == Approx(.5));
  CHECK(masses[0].inertia(0, 1) == Approx(.05));
  CHECK((masses[1].offset - Eigen::Vector3d(1, 0, 1)).norm() < 1e-12);
  CHECK(file.deck.materials.at(0).density == 3900);
}

TEST_CASE("rigid links of RBE2 and RBAR hold all six directions") {
  const auto file = read("links.bdf", square + "GRID,7,,5.,0.,0.\nRBE2,90,7,123456,1,2\nRBAR,91,3,7,,123456,123456\n");
  REQUIRE(file.deck.links.size() == 2);
  CHECK(file.deck.links[1].reference == 4);
  CHECK(testing::of_all_ranks(file.deck.links[1].nodes) == std::vector<PetscInt>{2});
  CHECK_THAT(said(square + "RBAR,90,1,2,123,456\n"), Contains("RBAR: field 5 and 6 expect 123456"));
}

TEST_CASE("what is not taken over is counted") {
  const auto notices =
      all_of(read("counts.bdf", "SOL 101\nCEND\nBEGIN BULK\n" + square +
                                    "FORCE,1,3,,1.,0.,0.,1.\nFORCE,1,4,,1.,0.,0.,1.\nMPCADD,5,1,2\nPARAM,POST,-1\n"
                                    "MAT1,9,1.,,.3\nPBAR,8,9,1.,1.,1.,1.\nGRID,9,,0.,0.,0.,,123456\n")
                 .notices);
  CHECK_THAT(notices, Contains("counts.bdf:1: 2 lines before BEGIN BULK ignored"));
  CHECK_THAT(notices, Contains("FORCE is ignored: loads are those of the scene (2 cards)"));
  CHECK_THAT(notices, Contains("MPCADD is ignored: the nodes are not tied by it (1 card)"));
  CHECK_THAT(notices, Contains("PARAM is ignored (1 card)"));
  CHECK_THAT(notices, Contains("GRID PS is ignored: supports are joints of the scene (1 card)"));
  CHECK_THAT(notices, Contains("not used by any element: PBAR8, MAT1_9"));
}

TEST_CASE("supports of grids, of GRDSET and of SPC are places") {
  const auto file = read("supports.bdf", "SPC1,7,123456,2,THRU,4\nSPC1,7,123,1,THRU,2\n" + square);
  CHECK(testing::labels_at(file.mesh, "SPC7") == std::vector<long long>{1, 2, 3, 4});
  const auto zeros = read("zeros.bdf", "DEBUG,200,1\nSPC,0,1,1,0.,0\n" + square);
  CHECK(testing::labels_at(zeros.mesh, "SPC0") == std::vector<long long>{1});
  const auto own = read("own.bdf", "SPC1,8,123456,3,THRU,9\nGRDSET,,,,,,,345\n" + square +
                                       "GRID,5,,2.,0.,0.,,0\nGRID,6,,2.,1.,0.,,12\nCQUAD4,2,3,2,5,6,3\n");
  CHECK(testing::labels_at(own.mesh, "SPC8") == std::vector<long long>{3, 4, 5, 6});
  CHECK(testing::labels_at(own.mesh, "PS") == std::vector<long long>{1, 2, 3, 4, 6});
  const auto notices = all_of(own.notices);
  CHECK_THAT(notices, Contains("own.bdf:2: GRDSET PS is ignored: supports are joints of the scene (1 card)"));
  CHECK_THAT(notices, Contains("GRID PS is ignored: supports are joints of the scene (1 card)"));
}

TEST_CASE("nonstructural mass follows the thicknesses of elements") {
  const auto file =
      read("nsm.bdf", grids + "CTRIA3,1,3,1,2,3\nCTRIA3,2,3,1,3,4\n,,,.02,.02,.02\nPSHELL,3,1,.01,1,,,,5.\n" + steel);
  REQUIRE(file.deck.shell_sections.size() == 2);
  for (const auto& section : file.deck.shell_sections) {  // 7800 t + 5 by area
    const auto& ply = section.plies.at(0);
    const auto material = std::find_if(file.deck.materials.begin(), file.deck.materials.end(),
                                       [&](const auto& one) { return one.name == ply.material; });
    REQUIRE(material != file.deck.materials.end());
    CHECK(material->density * ply.thickness == Approx(7800 * ply.thickness + 5));
  }
}

TEST_CASE("fields of beams and materials that are not read are counted") {
  const auto notices =
      all_of(read("extras.bdf", square + "CBEAM,9,5,1,2,0.,0.,1.\n,\n,101,102\nMAT1,7,2.+11,,.3,7800.,,,.02\n"
                                         "PBEAM,5,7,.01,3.-6,2.-6,,1.-6\n,YES,1.,.01\n,\n"
                                         ",.8,.8,.1,.1,2.,2.,1.-9,1.-9\n")
                 .notices);
  CHECK_THAT(notices, Contains("extras.bdf:8: CBEAM SA, SB is ignored: beams have no warping stiffness (1 card)"));
  CHECK_THAT(notices, Contains("PBEAM S1, S2 is ignored: shear forces of beams are not relieved by taper (1 card)"));
  CHECK_THAT(notices, Contains("PBEAM NSI is ignored: the nonstructural mass is spread over the section (1 card)"));
  CHECK_THAT(notices, Contains("PBEAM CW is ignored: beams have no warping stiffness (1 card)"));
  CHECK_THAT(notices, Contains("GE is ignored: damping is that of the scene (1 card)"));
}
