#include "nastran_text.h"

using namespace floe;
using namespace floe::testing::nastran;
using Catch::Matchers::Contains;

TEST_CASE("scalar springs of Nastran act along a direction of both grids") {
  const auto file = read("celas.bdf", square +
                                          "CORD2R,7,,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\n"  // x along y
                                          "GRID,5,,1.,0.,0.,7\nGRID,6,,1.,0.,0.,7\n"
                                          "RBE2,80,2,123456,5\nRBE2,81,3,123456,6\n"
                                          "CELAS2,70,1.+5,1,1,2,1\nCELAS1,71,8,5,4,6,4\nPELAS,7,1.,,,8,3.+2\n"
                                          "CELAS2,72,5.,3,2\nCELAS2,73,6.,,,4,3\n");
  const auto springs = testing::of_all_ranks(file.deck.springs);
  REQUIRE(springs.size() == 2);
  CHECK(springs[0].stiffness == std::array<double, 6>{1e5, 0, 0, 0, 0, 0});
  CHECK((springs[0].axes.col(0) - Eigen::Vector3d::UnitX()).norm() < 1e-12);
  CHECK(springs[1].stiffness == std::array<double, 6>{0, 0, 0, 300, 0, 0});
  CHECK((springs[1].axes.col(0) - Eigen::Vector3d::UnitY()).norm() < 1e-12);
  CHECK_THAT(all_of(file.notices),
             Contains("2 springs to ground left out (spring 72 at grid 3, direction 2, spring 73 at grid 4, direction "
                      "3): a spring to ground resists rigid motion"));
}

TEST_CASE("bushes of Nastran have axes of their own, of their line, or given ones") {
  const std::string property = "PBUSH,9,K,1.,2.,3.,4.,5.,6.\n,,B,7.\nPBUSH,10,K,1.,,,4.\n";
  const auto file = read("cbush.bdf", square + property +
                                          "CBUSH,70,9,1,2,0.,0.,1.\n,.25\nCBUSH,71,9,1,3,4\nCBUSH,72,10,1,3\n"
                                          "CBUSH,73,9,2,,,,,0\nCBUSH,74,9,3,4,,,,0\n");
  const auto springs = testing::of_all_ranks(file.deck.springs);
  REQUIRE(springs.size() == 4);
  Eigen::Matrix3d axes;
  axes << 1, 0, 0, 0, 0, -1, 0, 1, 0;  // y along z
  CHECK((springs[0].axes - axes).norm() < 1e-12);
  CHECK(springs[0].at == 0.25);
  CHECK(springs[0].stiffness == std::array<double, 6>{1, 2, 3, 4, 5, 6});
  const double r = std::sqrt(0.5);
  axes << r, -r, 0, r, r, 0, 0, 0, 1;  // from 1 to 3, y on the side of 4
  CHECK((springs[1].axes - axes).norm() < 1e-12);
  CHECK((springs[2].axes.col(0) - Eigen::Vector3d(r, r, 0)).norm() < 1e-12);
  CHECK((springs[3].axes - Eigen::Matrix3d::Identity()).norm() < 1e-12);
  CHECK_THAT(all_of(file.notices), Contains("1 spring to ground left out (CBUSH 73 at grid 2)") &&
                                       Contains("PBUSH B, GE is ignored: damping is that of the scene"));
}

TEST_CASE("cylindrical axes of a bush are those at its first grid") {
  const auto file = read("cbush.bdf", square +
                                          "CORD2C,5,,1.,0.,0.,1.,0.,1.\n,2.,0.,0.\nPBUSH,9,K,1.,2.,3.,4.,5.,6.\n"
                                          "CBUSH,70,9,1,3,,,,5\nCBUSH,71,9,3,1,,,,5\n");
  const auto springs = testing::of_all_ranks(file.deck.springs);
  REQUIRE(springs.size() == 2);  // from (1, 0, 0) grid 1 lies along -x, grid 3 along y
  CHECK((springs[0].axes.col(0) + Eigen::Vector3d::UnitX()).norm() < 1e-12);
  CHECK((springs[1].axes.col(0) - Eigen::Vector3d::UnitY()).norm() < 1e-12);
}

TEST_CASE("rods and tubes of Nastran are beams without bending") {
  const auto file = read("rods.bdf", square +
                                         "CROD,70,9,1,3\nPROD,9,1,.01,2.-6,,3.\nCTUBE,71,10,2,4\nPTUBE,10,1,.1,.01\n"
                                         "CONROD,72,1,2,1,.02\n");
  REQUIRE(file.deck.beam_sections.size() == 3);
  const auto& rod = file.deck.beam_sections[0];
  CHECK(rod.dimensions == std::vector<double>{0.01, 0, 0, 0, 2e-6});
  CHECK(*rod.density == Approx(7800 + 300));
  const auto& tube = file.deck.beam_sections[1];
  CHECK(tube.dimensions[0] == Approx(M_PI / 4 * (0.01 - 0.0064)));
  CHECK(tube.dimensions[4] == Approx(M_PI / 32 * (1e-4 - 4.096e-5)));
  CHECK(file.deck.beam_sections[2].dimensions[0] == 0.02);
  for (const mesh::BeamSection& section : file.deck.beam_sections) CHECK(section.alone == 0);  // grids of a shell
  CHECK(file.mesh.parts == std::vector<std::string>{"PSHELL3", "PROD9", "PTUBE10", "CONROD72"});
}

// Grid 5 has rods alone; 6 is held by a link but for its rotations, 7 wholly; 8 has a spring against rotation.
TEST_CASE("ends of rods at grids of Nastran that rods alone hold") {
  const auto file = read("alone.bdf", square +
                                          "GRID,5,,0.,0.,1.\nGRID,6,,1.,0.,1.\nGRID,7,,1.,1.,1.\nGRID,8,,0.,1.,1.\n"
                                          "CONROD,71,1,5,1,1.-4\nCONROD,72,5,6,1,1.-4\nCONROD,73,6,7,1,1.-4\n"
                                          "CONROD,74,7,8,1,1.-4\nCONROD,75,8,5,1,1.-4\nCELAS2,76,9.,8,4,4,4\n"
                                          "RBE2,80,2,123,6\nRBE2,81,3,123456,7\n");
  REQUIRE(file.deck.beam_sections.size() == 5);
  std::vector<unsigned> alone;
  for (const mesh::BeamSection& section : file.deck.beam_sections) alone.push_back(section.alone);
  CHECK(alone == std::vector<unsigned>{2, 3, 1, 0, 2});
  CHECK(file.notices.empty());
  const std::string rods =
      square + "GRID,5,,0.,0.,1.\nCONROD,71,1,5,1,1.-4\nCONROD,72,2,5,1,1.-4\nCONROD,73,3,5,1,1.-4\n";
  CHECK(read("alone.bdf", rods + "CONM2,90,5,,1.5\n").notices.empty());
  CHECK_THAT(read("alone.bdf", rods + "CONM2,90,5,,1.5,.1,0.,0.\n").notices.at(0),
             Contains("grid 5: rods alone hold a mass with an offset or moments of inertia"));
}

TEST_CASE("pin flags release the ends of a beam, and distinguish parts of one property") {
  const std::string bar = "PBAR,5,1,.01,3.-6,2.-6,1.-6\n";
  const auto file = read("pins.bdf", square + bar + "CBAR,9,5,1,2,0.,0.,1.\n,56\nCBAR,10,5,2,3,0.,0.,1.\n,,456\n");
  REQUIRE(file.deck.beam_sections.size() == 2);
  CHECK(file.deck.beam_sections[0].releases == (1u << 4 | 1u << 5));
  CHECK(file.deck.beam_sections[1].releases == (1u << 9 | 1u << 10 | 1u << 11));
  CHECK(file.mesh.parts == std::vector<std::string>{"PSHELL3", "PBAR5", "PBAR5"});
}

TEST_CASE("orientation vectors are in displacement axes or basic ones, offsets in these or those of the element") {
  const std::string bar = "PBAR,5,1,.01,3.-6,2.-6,1.-6\nCORD2R,7,,0.,0.,0.,1.,0.,0.\n,0.,0.,1.\nGRID,5,,2.,0.,0.,7\n";
  const auto file = read("offt.bdf", square + bar +
                                         "CBAR,9,5,5,2,0.,0.,1.,BGG\nCBAR,10,5,5,3,0.,0.,1.\n"
                                         "CBAR,11,5,1,2,0.,1.,0.,GOG\n,,,.1,.2,.3,0.,0.,1.\n");
  REQUIRE(file.deck.beam_sections.size() == 3);
  CHECK((file.deck.beam_sections[0].direction_1 - Eigen::Vector3d(0, 0, 1)).norm() < 1e-9);
  CHECK((file.deck.beam_sections[1].direction_1 - Eigen::Vector3d(1, 0, 0)).norm() < 1e-9);
  CHECK((position(file.mesh, 6) - Eigen::Vector3d(0.1, 0.2, 0.3)).norm() < 1e-12);  // axes of the beam: x, y, z
  CHECK((position(file.mesh, 7) - Eigen::Vector3d(1, 0, 1)).norm() < 1e-12);
}

TEST_CASE("a PSHELL may bend by another material, or by other fibres") {
  const auto file =
      read("bends.bdf", grids + "CQUAD4,1,3,1,2,3,4\nPSHELL,3,1,.01,2,1.5\n" + steel + "MAT1,2,7.+10,,.3\n");
  REQUIRE(file.deck.shell_sections.size() == 1);
  REQUIRE(file.deck.shell_sections[0].bending);
  CHECK(file.deck.shell_sections[0].bending->material == "MAT1_2");
  CHECK(file.deck.shell_sections[0].bending->factor == 1.5);
  CHECK(file.deck.shell_sections[0].orientation.empty());
  const auto fibres = read("fibres.bdf", grids + "CQUAD4,1,3,1,2,3,4\nPSHELL,3,1,.01,8\n" + steel +
                                             "MAT8,8,1.4+11,9.+9,.3,5.+9,5.+9,5.+9\n");
  REQUIRE(fibres.deck.shell_sections.size() == 1);
  CHECK(!fibres.deck.shell_sections[0].orientation.empty());
}

TEST_CASE("links leave rotations of shells and beams free, in displacement axes") {
  const std::string axes = "CORD2R,7,,0.,0.,0.,0.,1.,0.,\n,0.,0.,1.\n";  // 1: z, 2: x, 3: y
  const auto file =
      read("free.bdf", square + axes +
                           "GRID,5,,.5,.5,1.\nGRID,6,,2.,0.,0.,7\nGRID,8,,3.,0.,0.\nPBAR,5,1,1.-4,1.-9,1.-9,1.-9\n"
                           "CBAR,9,5,2,6,0.,0.,1.\nCBAR,10,5,6,8,0.,0.,1.\n"
                           "RBE2,80,5,123,1,2\nRBE2,81,5,1234,6\nRBAR,82,5,3,123456,,,12356\nRBE2,83,5,123456,4\n");
  CHECK(file.mesh.node_count == 7);
  CHECK(file.deck.springs.empty());
  REQUIRE(file.deck.links.size() == 4);
  const std::pair<bool, std::array<double, 3>> expected[] = {
      {true, {}}, {true, {0, 0, 1}}, {false, {1, 0, 0}}, {false, {}}};
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(file.deck.links[i].others == expected[i].first);
    CHECK((Eigen::Vector3d::Map(file.deck.links[i].axis.data()) - Eigen::Vector3d::Map(expected[i].second.data()))
              .norm() < 1e-12);
  }
}

namespace {

/// By labels, of all ranks. Collective.
std::map<long long, double> weights_at(const mesh::RawMesh& raw, const std::string& place) {
  const auto labels = testing::of_all_ranks(raw.node_labels);
  std::map<long long, double> weights;
  for (const mesh::NodeWeight& at : testing::of_all_ranks(raw.place_weights.at(place)))
    weights[labels.at(at.node)] = at.weight;
  return weights;
}

}  // namespace

TEST_CASE("an RBE3 whose reference grid carries nothing is a place") {
  const auto file = read("mean.bdf", square + "GRID,5,,.5,.5,0.\nRBE3,70,,5,123456,1.,123,1,2,\n,3,1.,123456,4\n");
  CHECK(testing::labels_at(file.mesh, "RBE3_70") == std::vector<long long>{1, 2, 3, 4});
  CHECK(file.mesh.node_count == 4);
  CHECK(weights_at(file.mesh, "RBE3_70") == std::map<long long, double>{{1, 1}, {2, 1}, {3, 1}, {4, 1}});
  CHECK_THAT(all_of(file.notices),
             Contains("1 RBE3 without element at the reference grid") && Contains("RBE3 456 of the grids"));
}

TEST_CASE("grids of an RBE3 have weights, those named twice their sum") {
  const auto file = read("weights.bdf", square + "GRID,5,,.75,.125,0.\nRBE3,70,,5,123456,1.,123,1,4\n,2,5.,123,2\n");
  CHECK(weights_at(file.mesh, "RBE3_70") == std::map<long long, double>{{1, 1}, {2, 6}, {4, 1}});
}

TEST_CASE("masses by components, or by their matrix, are those of rigid bodies") {
  const auto file =
      read("cmass.bdf", square +
                            "CORD2R,7,,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\n"  // x along y
                            "GRID,5,,1.,0.,0.,7\nRBE2,80,2,123456,5\nPMASS,9,2.5,10,.5\n"
                            "CMASS1,70,9,5,1\nCMASS1,71,9,5,2\nCMASS1,72,9,,,5,3\nCMASS1,73,10,5,4\n"
                            "CMASS2,74,.6,5,5\nCMASS2,75,.7,5,6\n"
                            // 2 at (.1, .2, .3) with moments 1, 2, 2.5 about its centre
                            "CONM1,76,3,,2.,,2.,,\n,2.,,-.6,.4,1.26,.6,,-.2\n,-.04,2.2,-.4,.2,,-.06,-.12,2.6\n"
                            "PARAM,WTMASS,2.\n");
  const auto masses = testing::of_all_ranks(file.deck.masses);
  REQUIRE(masses.size() == 2);
  const auto& given = masses[masses[0].mass == 5 ? 0 : 1];
  CHECK(given.mass == Approx(5));
  CHECK(given.offset.norm() == 0);
  CHECK((given.inertia - Eigen::Vector3d(1.2, 1, 1.4).asDiagonal().toDenseMatrix()).norm() < 1e-12);
  const auto& matrix = masses[masses[0].mass == 5 ? 1 : 0];
  CHECK(matrix.mass == Approx(4));
  CHECK((matrix.offset - Eigen::Vector3d(.1, .2, .3)).norm() < 1e-12);
  CHECK((matrix.inertia - Eigen::Vector3d(2, 4, 5).asDiagonal().toDenseMatrix()).norm() < 1e-12);
  CHECK_THAT(said(square + "CMASS2,70,1.,3,1\nCMASS2,71,1.,3,2\n"),
             Contains("bad.bdf:8: CMASS2 70: the masses at grid 3 are 1, 1, 0 along the directions 1, 2, 3; expected"));
  CHECK_THAT(said(square + "CMASS2,70,1.,3,1,4,1\n"), Contains("CMASS2 70 couples two degrees of freedom"));
  CHECK_THAT(said(square + "CMASS2,70,1.,101\nSPOINT,101\n"), Contains("scalar points are not read"));
  CHECK_THAT(said(square + "CMASS2,70,1.,3,5\n"),
             Contains("bad.bdf:8: CMASS2 70: grid 3 has moments of inertia without a mass"));
  CHECK_THAT(said(square + "CONM2,70,3,,1.,,,,\n,-1.,,1.,,,1.\n"),
             Contains("bad.bdf:8: CONM2 70: its moments of inertia are physically impossible: one is negative"));
  CHECK_THAT(said(square + "CMASS1,70,9,3,1\n"), Contains("CMASS1 70 names PMASS 9, which is not defined"));
  CHECK_THAT(said(square + "CONM1,70,3,,1.,,1.,,\n,1.,,.5\n"), Contains("with terms between directions"));
  CHECK(testing::of_all_ranks(read("left.bdf", square + "CMASS2,70,1.,3,1\n", {{}, false, {"CMASS2"}}).deck.masses)
            .empty());
}

TEST_CASE("moments of inertia without a mass are added to the mass that another card gives the grid") {
  const std::string inertia = "CMASS2,71,.5,3,4\nCMASS2,72,.6,3,5\nCMASS2,73,.7,3,6\n";
  for (const std::string& text :
       {inertia + "CONM2,70,3,,2.,.1,,,\n,.25,,.5,,,.5\n", "CONM2,70,3,,2.,.1,,,\n,.25,,.5,,,.5\n" + inertia}) {
    const auto masses = testing::of_all_ranks(read("sum.bdf", square + text).deck.masses);
    REQUIRE(masses.size() == 1);
    CHECK(masses[0].mass == 2);
    CHECK((masses[0].offset - Eigen::Vector3d(.1, 0, 0)).norm() < 1e-12);
    CHECK((masses[0].inertia - Eigen::Vector3d(.75, 1.1, 1.2).asDiagonal().toDenseMatrix()).norm() < 1e-12);
  }
}

TEST_CASE("links that leave rotations free to grids without these, or to the end of one beam") {
  const std::string bar = "GRID,5,,1.,1.,1.\nGRID,6,,1.,1.,2.\nPBAR,5,1,.01,3.-6,2.-6,1.-6\nCBAR,9,5,6,5,0.,1.,0.\n";
  for (const std::string link : {"RBE2,80,3,123,5\n", "RBE2,80,3,321,5\n", "RBAR,80,3,5,123456,,,123\n"}) {
    const auto file = read("ball.bdf", square + bar + link);
    REQUIRE(file.deck.beam_sections.size() == 1);
    CHECK(file.deck.beam_sections[0].releases == 0x38u << 6);  // rotations of end B
    CHECK(file.deck.links.size() == 1);
  }
  // of a spring of translations alone, nothing acts on the rotations
  const auto spring = read("spring.bdf", square +
                                             "GRID,5,,1.,1.,0.\nGRID,6,,0.,1.,0.\nRBE2,80,3,1235,5,6\n"
                                             "CELAS2,70,1.,5,3,3,3\n");
  CHECK(spring.deck.beam_sections.empty());
  const std::pair<std::string, const char*> wrong[] = {
      {"RBE2,80,3,12,4\n",
       "RBE2: field 4 expects 123456, or 123: rigid links constrain all three translations; found '12'"},
      {"RBAR,80,3,4,123456,,,12\n", "expects 123456, or 123"},
      {bar + "RBE2,80,3,123,5\nRBE2,81,2,123,5\n",
       "RBE2 80: constrains 123 of grid 5, whose other rotations are also dofs of another link; expected 123456, or a "
       "grid of shells or beams that is in no other link"},
      {"GRID,5,,1.,1.,0.\nCONROD,9,3,5,1,1.-4\nCONROD,10,2,5,1,1.-4\nRBE2,80,1,1234,5\n",
       "are also dofs of rods alone"},
      {bar + "GRID,7,,0.,0.,0.\nGRID,8,,0.,0.,9.\nCBAR,11,5,7,8,0.,1.,0.,GGG\n,,,0.,0.,.3\nRBE2,80,3,123,7\n",
       "RBE2 80: constrains 123 of grid 7, at the end of beam 11 with the offset (0, 0, 0.3); expected 123456, or "
       "no offset"}};
  for (const auto& [text, message] : wrong) CHECK_THAT(said(square + text), Contains(message));
}
