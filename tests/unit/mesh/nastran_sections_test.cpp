#include "nastran_text.h"

using namespace floe;
using namespace floe::testing::nastran;
using Catch::Matchers::Contains;

TEST_CASE("shapes of PBARL have the constants of their outlines") {
  struct Case {
    const char* card;      // shape and dimensions
    double height, width;  // of the outline, whose corners are the fibres
    double area, i1, i2, i12, j;
  };
  // A, I1, I2, I12 by integrals along the outline (Green's theorem); J of thin walls by hand, to the middle of the
  // walls.
  const Case cases[] = {
      {"T\n,40.,30.,3.,2.", 30, 40, 174, 11749.81034, 16018, 0, (40 * 27 + 28.5 * 8) / 3},
      {"T2\n,40.,30.,3.,2.", 30, 40, 174, 11749.81034, 16018, 0, (40 * 27 + 28.5 * 8) / 3},
      {"T1\n,30.,20.,3.,2.", 30, 23, 130, 6763.333333, 5063.141026, 0, (30 * 27 + 21.5 * 8) / 3},
      {"CHAN\n,20.,30.,2.,3.", 30, 20, 168, 24264, 6793.142857, 0, (27 * 8 + 2 * 19 * 27) / 3.},
      {"CHAN1\n,18.,2.,24.,30.", 30, 20, 168, 24264, 6793.142857, 0, (27 * 8 + 2 * 19 * 27) / 3.},
      {"CHAN2\n,2.,3.,20.,30.", 20, 30, 158, 5578.584388, 20100.66667, 0, (28 * 27 + 2 * 18.5 * 8) / 3},
      {"CROSS\n,20.,3.,30.,2.", 30, 23, 130, 6763.333333, 2090.833333, 0, (30 * 27 + 20 * 8) / 3.},
      {"H\n,20.,4.,30.,3.", 30, 24, 180, 9045, 16560, 0, (22 * 27 + 60 * 8) / 3.},
      {"I\n,40.,20.,30.,2.,3.,4.", 40, 30, 246, 61421.57317, 11022, 0, (20 * 27 + 36.5 * 8 + 30 * 64) / 3},
      {"I1\n,18.,2.,24.,30.", 30, 20, 168, 24264, 4016, 0, (2 * 20 * 27 + 27 * 8) / 3.},
      {"Z\n,20.,2.,24.,30.", 30, 42, 180, 26460, 18540, -17820, (27 * 8 + 2 * 21 * 27) / 3.},
      {"HAT\n,30.,2.,25.,10.", 30, 45, 202, 25095.45215, 30036.83333, 0, 8 * (23 + 2 * 28 + 2 * 11) / 3.},
      {"BOX1\n,40.,30.,2.,3.,4.,5.", 30, 40, 425, 49088.35784, 97388.35784, 547.0588235,
       4 * 35.5 * 35.5 * 27.5 * 27.5 / (35.5 / 2 + 35.5 / 3 + 27.5 / 4 + 27.5 / 5)},
      {"HEXA\n,10.,40.,30.", 30, 40, 900, 56250, 75000, 0, 900. * 900 * 900 * 900 / (40 * 131250.)}};
  for (const auto& c : cases) {
    INFO(c.card);
    const auto file = read("shape.bdf", with_beam(std::string("PBARL,5,1,,") + c.card + "\n"));
    REQUIRE(file.deck.beam_sections.size() == 1);
    const auto& section = file.deck.beam_sections[0];
    REQUIRE(section.profile == mesh::Profile::general);
    const double given[] = {c.area, c.i2, c.i12, c.i1, c.j};
    for (int i = 0; i < 5; ++i) CHECK(section.dimensions.at(i) == Approx(given[i]).epsilon(1e-8).margin(1e-6));
    CHECK(section.density.value() == Approx(7800));
    Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = low;
    for (const Eigen::Vector2d& fibre : section.fibres) low = low.cwiseMin(fibre), high = high.cwiseMax(fibre);
    CHECK(high[0] - low[0] == Approx(c.height));
    CHECK(high[1] - low[1] == Approx(c.width));
  }
  CHECK_THAT(said(with_beam("PBEAML,5,1,,BOX1\n,40.,30.,2.,3.,4.,5.\n")), Contains("line of shear centres"));
  CHECK_THAT(said(with_beam("PBARL,5,1,,T\n,40.,3.,3.,2.\n")), Contains("expects walls of T that are thinner"));
  CHECK_THAT(said(with_beam("PBARL,5,1,,HEXA\n,20.,40.,3.\n")), Contains("DIM1 less than half of DIM2"));
}

// T and L: the shear centre is where the middle lines meet; I: h I_top / (I_top + I_bottom) from the lower flange.
// CHAN: b^2 h^2 t / (4 I) from the middle of the web, HAT: b (3 h^2 b + 6 h^2 c - 8 c^3) / (h^3 + 6 h^2 b + 6 h^2 c + 8
// c^3 + 12 h c^2) (Gere & Goodno, Mechanics of materials, 9th ed., ch. 6.9 and problems). CHAN2 and PBEAM: the channel
// of 11 x 2 x 1/8 of a public deck that Femap made, whose N2(A) is 0.754758.
TEST_CASE("the centroid of a PBEAML lies beside its line of shear centres, that of a PBARL in its line") {
  const auto centroid = [](const std::string& card) {
    return read("shape.bdf", with_beam(card)).deck.beam_sections.at(0).centroid;
  };
  const double t = -(180. + 891) / 174 + 1.5;
  const double second = 2 * 27 * 27 * 27 / 12. + 2 * 19 * 3 * 13.5 * 13.5;  // of the middle lines
  const double channel = 1248. / 168 - 1 + 19 * 19 * 27 * 27 * 3 / (4 * second);
  const double uneven = (60 * 1.5 + 66 * 19.5 + 120 * 38) / 246 - 1.5 - 36.5 * 9 / 11;
  const double b = 28, h = 23, c = 11;
  const double hat = b * (3 * h * h * b + 6 * h * h * c - 8 * c * c * c) /
                     (h * h * h + 6 * h * h * b + 6 * h * h * c + 8 * c * c * c + 12 * h * c * c);
  const double hat_centre = 2. * (25 * 29 + 2 * 26 * 15 + 2 * 12 * 1) / 202;
  const std::pair<const char*, Eigen::Vector2d> cases[] = {
      {"T\n,40.,30.,3.,2.", {t, 0}},
      {"T2\n,40.,30.,3.,2.", {-t, 0}},
      {"L\n,20.,30.,3.,2.", {(60 * 1.5 + 54 * 16.5) / 114 - 1.5, (60 * 10. + 54) / 114 - 1}},
      {"CHAN2\n,.125,.125,2.,11.", {0.754758, 0}},
      {"HAT\n,30.,2.,25.,10.", {hat_centre - 29 - hat, 0}},
      {"CHAN1\n,18.,2.,24.,30.", {0, channel}},
      {"CHAN\n,20.,30.,2.,3.", {0, channel}},
      {"T1\n,30.,20.,3.,2.", {0, (90 * 1.5 - 40 * 10.) / 130 - 1.5}},
      {"I\n,40.,20.,30.,2.,3.,4.", {uneven, 0}},
      {"I\n,40.,20.,20.,2.,3.,3.", {0, 0}},
      {"Z\n,20.,2.,24.,30.", {0, 0}},
      {"CROSS\n,20.,3.,30.,2.", {0, 0}},
      {"H\n,20.,4.,30.,3.", {0, 0}}};
  for (const auto& [shape, expected] : cases) {
    INFO(shape);
    CHECK(!centroid(std::string("PBARL,5,1,,") + shape + "\n"));
    const auto found = centroid(std::string("PBEAML,5,1,,") + shape + "\n");
    CHECK(found.has_value() == !expected.isZero(0));
    CHECK((found.value_or(Eigen::Vector2d::Zero()) - expected).norm() < 1e-4 * std::max(1., expected.norm()));
  }
  const std::string beam =
      "PBEAM,5,1,1.84375,27.7245,.488696,0.,.00960286\n,5.5,2.43802,-5.5,.438021\n,YESA,1.\n,,,,,,,,\n";
  const auto section = read("beam.bdf", with_beam(beam + ",,,,,,.754758\n")).deck.beam_sections.at(0);
  REQUIRE(section.centroid);
  CHECK(*section.centroid == Eigen::Vector2d(0, 0.754758));
  CHECK((section.fibres.at(1) - Eigen::Vector2d(-5.5, 0.438021 - 0.754758)).norm() < 1e-12);  // given from the axis
  CHECK(said(with_beam(beam + ",.1\n")) == "nothing was thrown");  // of no nonstructural mass
  CHECK(section.fibres.size() == 2);
  const std::string heavy = "PBEAM,5,1,1.,1.,1.,0.,1.,2.\n,YESA,1.\n,,,,,,,,\n,";
  CHECK_THAT(said(with_beam(heavy + ".1\n")), Contains("is an offset of the nonstructural mass that is not"));
  CHECK(said(with_beam(heavy + ".1,,,,.1\n")) == "nothing was thrown");
  CHECK_THAT(all_of(read("heavy.bdf", with_beam(heavy + ",,,,.1\n")).notices),
             Contains("PBEAM M1, M2 is ignored: the nonstructural mass is at the centroid"));
  CHECK_THAT(said(with_beam(beam + ",,,,,,.75,,.5\n")), Contains("another offset of the neutral axis than at end A"));
}

TEST_CASE("pieces of a PBEAML from an I of equal flanges to one of others keep their axes") {
  const auto file = read("uneven.bdf", square +
                                           "CBEAM,9,5,1,2,0.,0.,1.\nPBEAML,5,1,,I\n,40.,20.,20.,2.,3.,3.,,YES\n"
                                           ",1.,40.,20.,20.02,2.,3.,3.,5.\n");
  CHECK_THAT(all_of(file.notices), Contains("axis of the NSM of PBEAML is ignored"));
  REQUIRE(file.deck.beam_sections.size() == 4);
  for (const auto& piece : file.deck.beam_sections) {
    CHECK(!piece.quarter_turn);
    CHECK(piece.dimensions.at(3) > 4 * piece.dimensions.at(1));  // I1 in the plane of the web
    REQUIRE(piece.centroid);
    CHECK(piece.centroid->x() < 0);
  }
}

TEST_CASE("a beam with taper is pieces of the sections in their middles") {
  const auto file = read("taper.bdf", square +
                                          "CBEAM,9,5,1,2,0.,0.,1.,,\n,45,6\nPBEAM,5,1,.04,3.-6,2.-6,,1.-6,2.\n"
                                          ",YES,1.,.02,1.-6,,,,6.\n");
  const auto& sections = file.deck.beam_sections;
  REQUIRE(sections.size() == 4);
  for (int k = 0; k < 4; ++k) {
    const double x = (k + 0.5) / 4;
    const std::vector<double> given{.04 - .02 * x, 2e-6, 0, 3e-6 - 2e-6 * x, 1e-6};  // blank at end B: as at end A
    for (int i = 0; i < 5; ++i) CHECK(sections[k].dimensions[i] == Approx(given[i]));
    CHECK(sections[k].density.value() == Approx(7800 + (2 + 4 * x) / (.04 - .02 * x)));
    CHECK(sections[k].shear_factors == std::array<double, 2>{1, 1});
    CHECK(sections[k].releases == (k == 0 ? 0x18u : k == 3 ? 0x800u : 0u));  // PA: 45, PB: 6
  }
  CHECK(file.mesh.node_count == 7);
  CHECK((position(file.mesh, 6) - Eigen::Vector3d(.5, 0, 0)).norm() < 1e-12);
  CHECK_THAT(all_of(file.notices),
             Contains("divided into pieces of uniform section, with 3 nodes between them, from 5"));
  const auto shaped = read("taper.bdf", with_beam("PBEAML,5,1,,BAR\n,.02,.03,,,1.,.04\n")).deck.beam_sections;
  REQUIRE(shaped.size() == 4);
  CHECK(shaped[3].dimensions == std::vector<double>{.03, .02 + .02 * .875});
  // a station between: missing values lie between the ends
  const auto more = read("taper.bdf", with_beam("PBEAM,5,1,.04,3.-6,2.-6,,1.-6\n,NO,1.,.02\n,NO,.5,,5.-6\n"));
  REQUIRE(more.deck.beam_sections.size() == 8);
  CHECK(more.deck.beam_sections[3].dimensions[0] == Approx(.04 - .02 * .4375));
  CHECK(more.deck.beam_sections[3].dimensions[3] == Approx(3e-6 + 2e-6 * .875));
  // without torsional stiffness: end A is released, once; without I2, both ends: the nodes between have stiffness
  const auto without = read("taper.bdf", with_beam("PBEAM,5,1,.04,3.-6,0.\n,YES,1.,.02\n")).deck.beam_sections;
  REQUIRE(without.size() == 4);
  for (int k = 0; k < 4; ++k) {
    CHECK(without[k].dimensions[1] > 0);
    CHECK(without[k].dimensions[4] > 0);
    CHECK(without[k].releases == (k == 0 ? 0x18u : k == 3 ? 0x400u : 0u));
  }
  CHECK_THAT(said(with_beam("PBEAM,5,1,.04,3.-6,2.-6,,1.-6\n,NO,.5,.02\n")), Contains("expects a station at end B"));
  CHECK_THAT(said(with_beam("PBEAM,5,1,.04,3.-6,2.-6,,1.-6\n,NO,1.5,.02\n")), Contains("between 0 and 1"));
  for (const std::string values : {".02,1.-6,1.-6,,1.-6", ""})
    CHECK_THAT(said(with_beam("PBEAM,5,1,.04,3.-6,2.-6,,1.-6\n,NO,-.5," + values + "\n,NO,1.,.02\n")),
               Contains("between 0 and 1"));
  CHECK_THAT(said(with_beam("PBEAM,5,1,.04,3.-6,2.-6,,1.-6\n,NO,.5,.03,,,,0.\n,NO,1.,.02,,,,0.\n")),
             Contains("or 0 along all of it"));
  CHECK_THAT(said(with_beam("PBEAM,5,1,.04,3.-6,2.-6,,1.-6\n,NO,1.,-.02\n")), Contains("expects A greater than 0"));
}

TEST_CASE("a PSHELL without MID2 bends by its material") {
  const auto file = read("membrane.bdf", grids + "CQUAD4,1,3,1,2,3,4\nPSHELL,3,1,.01\n" + steel);
  REQUIRE(file.deck.shell_sections.size() == 1);
  CHECK(!file.deck.shell_sections[0].bending);
  CHECK_THAT(all_of(file.notices), Contains("PSHELL without MID2 (membranes) is ignored: these shells have the bending "
                                            "stiffness of MID1 and the thickness (1 card)"));
}

TEST_CASE("physically impossible moments of inertia become those of the smallest body with the largest") {
  const auto file = read("inertia.bdf", square + "CONM2,50,3,,4.,,,,,\n,,,2.\n");
  const auto masses = testing::of_all_ranks(file.deck.masses);
  REQUIRE(masses.size() == 1);
  CHECK((masses[0].inertia - Eigen::Vector3d(1, 2, 1).asDiagonal().toDenseMatrix()).norm() < 1e-12);
  CHECK_THAT(all_of(file.notices), Contains("taken as 1, 2, 1 instead of 0, 2, 0"));
  CHECK_THAT(said(square + "CONM2,50,3,,4.,,,,,\n,-1.,,2.,,,2.\n"), Contains("negative about some axis"));
}

TEST_CASE("materials of solids matter only where shells or beams name them") {
  const auto file = read("mat9.bdf", square + "MAT9,7,1.\nMAT10,8,1.\n");
  CHECK_THAT(all_of(file.notices), Contains("MAT9 is ignored: no shell or beam uses it (1 card)"));
  CHECK_THAT(said(grids + "CTRIA3,2,3,1,2,3\nPSHELL,3,7,.01,7\nMAT9,7,1.\n"),
             Contains("PSHELL3 names material 7, a MAT9, which is not read; use MAT1, MAT8 or MAT2"));
}

TEST_CASE("scalar points, gaps and the reduction of superelements are ignored") {
  const auto notices = all_of(read("points.bdf", square + "SPOINT,101,102\nQSET1,,101,102\nCGAP,70,7,1,2\nPGAP,7\n"
                                                          "RVDOF1,123,1,2,3,4,5,6,7,8\n")
                                  .notices);
  CHECK_THAT(notices, Contains("SPOINT is ignored: a point without coordinates is no node of the body (1 card)"));
  CHECK_THAT(notices, Contains("CGAP is ignored: contact is not represented (1 card)"));
  CHECK_THAT(said(square + "CELAS2,70,1.+5,101,0,1,3\nSPOINT,101\n"), Contains("scalar points are not read"));
}

TEST_CASE("cards replicate the one before") {
  const auto file = read("equal.bdf",
                         "GRID,1,,0.,0.,0.\n=,*1,=,*.5,==\n=1\nGRID,11,,0.,1.,0.\n=,*(1),=,*(.5),==\n=(1)\n"
                         "CQUAD4,1,3,1,2,12,11\n=,*1,=,*1,*1,*1,*1\n" +
                             skin);
  CHECK(file.mesh.node_count == 6);
  CHECK((position(file.mesh, 13) - Eigen::Vector3d(1, 1, 0)).norm() < 1e-15);
  CHECK(testing::labels_at(file.mesh, "PSHELL3") == std::vector<long long>{1, 2, 3, 11, 12, 13});
  const std::pair<std::string, const char*> wrong[] = {
      {"=,*1\n" + square, "bad.bdf:1: card '=' replicates a card, but there is none before it"},
      {square + "GRID,9,,0.,0.,0.\n=3\n", "bad.bdf:9: =3 repeats steps of a card with =, but there is none"},
      {square + "GRID,9,,0.,0.,0.\n=,*x,==\n", "GRID: expected a number to which '*x' adds, found '9'"},
      {square + "GRID,9,,0.,0.,0.\n=,*1,==\n=99999999\n", "replication makes more than 200000 cards"},
      {square + "GRID,9,,0.,0.,0.\n=,*1,==\n=99999\n=100001\n", "bad.bdf:11: replication makes more than"},
      {square + "GRID,9,,0.,0.,0.\n=,*1,==\n=0\n", "expects = or =n"},
      {square + "CONM2,70,1,,1.\n,1.,,1.,,,1.\n=,*1,==\n", "CONM2: replication of cards with continuations"}};
  for (const auto& [text, message] : wrong) CHECK_THAT(said(text), Contains(message));
}

// W of open thin walls is J over the thickest, of BOX1 twice its area by the thinnest.
TEST_CASE("stress points of PBAR and PBEAM are fibres, and shapes have a torsion modulus") {
  const auto section = [](const std::string& card) {
    return read("points.bdf", with_beam(card)).deck.beam_sections.at(0);
  };
  CHECK(section("PBARL,5,1,,T\n,40.,30.,3.,2.\n").torsion_modulus == Approx((40 * 27 + 28.5 * 8) / 9));
  CHECK(section("PBARL,5,1,,BOX1\n,40.,30.,2.,3.,4.,5.\n").torsion_modulus == Approx(2 * 35.5 * 27.5 * 2));
  const auto bar = section("PBAR,5,1,100.,900.,800.,700.\n,5.,1.,-5.,2.\n").fibres;
  REQUIRE(bar.size() == 2);  // of four pairs of which two are blank
  CHECK(bar[1] == Eigen::Vector2d(-5, 2));
  CHECK(section("PBAR,5,1,100.,900.,800.,700.\n,0.,0.,0.,0.,0.,0.,0.,0.\n").fibres.empty());
  CHECK(section("PBAR,5,1,100.,900.,800.,700.\n").fibres.empty());
  const auto beam = section("PBEAM,5,1,100.,900.,800.,0.,700.\n,5.,1.\n,YES,1.\n,8.,2.\n").fibres;
  REQUIRE(beam.size() == 2);  // of both ends
  CHECK(beam[0] == Eigen::Vector2d(5, 1));
  CHECK(beam[1] == Eigen::Vector2d(8, 2));
}

TEST_CASE("the scene has sections for elements without a property, and instead of one that is not read") {
  const std::string bare = grids + "CQUAD4,1,3,1,2,3,4\nCBAR,9,5,1,2,0.,0.,1.\n";
  const auto file = read("bare.bdf", bare, {{}, true, {}});
  CHECK(file.mesh.parts == std::vector<std::string>{"PSHELL3", "PBAR5"});
  CHECK(file.deck.shell_sections.empty());
  CHECK(file.deck.beam_sections.empty());
  CHECK(testing::measure(file.mesh, 0) == Approx(1.0));
  CHECK_THAT(all_of(file.notices), Contains("1 element of part PSHELL3 with the section of the scene") &&
                                       Contains("1 element of part PBAR5 with"));
  CHECK_THAT(said(bare), Contains("names property 3, which is not defined"));

  const std::string thin = bare + "PSHELL,3,,0.\n";
  const auto replaced = read("thin.bdf", thin, {{}, true, {}});
  CHECK(replaced.mesh.parts == std::vector<std::string>{"PSHELL3", "PBAR5"});
  CHECK_THAT(all_of(replaced.notices), Contains("1 shell with the section of the scene: neither elements nor PSHELL"));
  CHECK_THAT(said(thin), Contains("shell 1: neither the element nor PSHELL3 has a thickness; expected T, T1 to T4"));
  const auto by_corners =
      read("corners.bdf", grids + "CQUAD4,1,3,1,2,3,4\n,,,.1,.1,.1,.1\nPSHELL,3,1\nMAT1,1,1.,,0.\n");
  CHECK(by_corners.deck.shell_sections.at(0).plies.at(0).thickness == Approx(0.1));

  const std::string other = bare + "PSHELL,3,7,.01,7\nPBAR,5,7,1.,1.,1.,1.\n";
  const auto given = read("given.bdf", other, {{"PSHELL3", "PBAR5"}, false, {}});
  CHECK(given.mesh.parts == std::vector<std::string>{"PSHELL3", "PBAR5"});
  CHECK(given.deck.shell_sections.empty());
  CHECK(given.deck.beam_sections.empty());
  const auto fault = [](const std::string& text, const mesh::DeckRequest& request) {
    const auto path = testing::written("fault.bdf", text);
    return testing::fault_of([&] { mesh::read_nastran(PETSC_COMM_WORLD, path, request); });
  };
  CHECK_THAT(fault(other, {{"PSHELL3"}, false, {}}), Contains("PBAR5 names material 7, which is not defined"));
  for (const std::string& own :
       {std::string("CQUAD4,1,3,1,2,3,4,,0.1\n"), std::string("CQUAD4,1,3,1,2,3,4\n,,,0.1,0.1,0.1,0.1\n"),
        std::string("CBAR,1,3,1,2,0.,0.,1.\n,4\n"), std::string("CROD,1,3,1,2\n")})
    CHECK_THAT(fault(grids + own, {{}, true, {}}),
               Contains("element 1 is a rod, or has thicknesses, an offset or free ends"));
}

TEST_CASE("E and G of a MAT1 need no nu for beams") {
  const std::string soft = "MAT1,7,2.1+11,1.+9,104.,7800.\n", beam = "CBAR,9,5,1,2,0.,0.,1.\nPBAR,5,7,1.,1.,1.,1.\n";
  const auto file = read("soft.bdf", square + soft + beam);
  CHECK(file.deck.beam_sections.at(0).shear == 1e9);
  CHECK_THAT(said(square + soft + "CTRIA3,2,4,1,2,3\nPSHELL,4,7,.01\n"),
             Contains("PSHELL4 names MAT1 7, whose nu is 104; expected one between -1 and 1/2"));
}
