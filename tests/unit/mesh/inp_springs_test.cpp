#include "floe/mesh/inp.h"
#include "mesh_files.h"

using namespace floe;
using Catch::Matchers::Contains;

namespace {

mesh::DeckFile deck(const std::string& more) {
  const std::string square =
      "*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n5, 1, 0\n*ELEMENT, TYPE=S4, ELSET=E\n1, 1, 2, 3, 4\n"
      "*MATERIAL, NAME=M\n*ELASTIC\n1, 0\n*DENSITY\n1\n*SHELL SECTION, ELSET=E, MATERIAL=M\n1\n";
  return mesh::read_inp(PETSC_COMM_WORLD, testing::written("springs.inp", square + more));
}

std::string said(const std::string& more) {
  return testing::fault_of([&] { deck(more); });
}

}  // namespace

TEST_CASE("springs of a deck act along their line, or along one direction of both nodes") {
  const auto file = deck(
      "*ELEMENT, TYPE=SPRINGA, ELSET=A\n7, 1, 3\n*SPRING, ELSET=A\n\n2.5\n"
      "*ELEMENT, TYPE=SPRING2, ELSET=B\n8, 2, 5\n*SPRING, ELSET=B\n5, 5\n3.5\n"
      "*ELEMENT, TYPE=SPRING1, ELSET=C\n9, 2\n*SPRING, ELSET=C\n5\n3.5\n"
      "*ELEMENT, TYPE=DASHPOTA, ELSET=D\n10, 1, 3\n*DASHPOT, ELSET=D\n\n1.\n");
  auto springs = testing::of_all_ranks(file.deck.springs);
  REQUIRE(springs.size() == 2);
  std::sort(springs.begin(), springs.end(), [](const auto& a, const auto& b) { return a.label < b.label; });
  CHECK(springs[0].stiffness == std::array<double, 6>{2.5, 0, 0, 0, 0, 0});
  CHECK((springs[0].axes.col(0) - Eigen::Vector3d(1, 1, 0).normalized()).norm() < 1e-12);
  CHECK(springs[1].stiffness == std::array<double, 6>{0, 0, 0, 0, 3.5, 0});
  std::string notices;
  for (const auto& notice : file.notices) notices += notice + "\n";
  CHECK_THAT(notices, Contains("1 element of type SPRING1 is left out: a spring to ground resists rigid motion") &&
                          Contains("1 element of type DASHPOTA is left out: damping is that of the scene"));
}

TEST_CASE("springs of a deck that resist rigid motion are refused") {
  CHECK_THAT(said("*ELEMENT, TYPE=SPRING2, ELSET=B\n8, 2, 5\n*SPRING, ELSET=B\n1, 2\n3.5\n"),
             Contains("spring 8 joins direction 1 of one node to direction 2 of the other, and would resist"));
  CHECK_THAT(said("*ELEMENT, TYPE=SPRING2, ELSET=B\n8, 1, 2\n*SPRING, ELSET=B\n2, 2\n3.5\n"),
             Contains("spring 8 would resist rigid motion: its nodes are 1 apart across direction 2"));
  CHECK_THAT(said("*ELEMENT, TYPE=SPRINGA, ELSET=A\n7, 2, 5\n*SPRING, ELSET=A\n2.5\n"), Contains("has no length"));
  CHECK_THAT(said("*ELEMENT, TYPE=SPRINGA, ELSET=A\n7, 2, 3\n"), Contains("it is in no set of a *SPRING"));
  CHECK_THAT(said("*ELEMENT, TYPE=SPRINGA, ELSET=A\n7, 2, 3\n*SPRING, ELSET=A\n-2.5\n"),
             Contains("a stiffness must not be negative"));
  CHECK_THAT(said("*ELEMENT, TYPE=SPRINGA, ELSET=A\n7, 2, 3\n*SPRING, ELSET=A, NONLINEAR\n0., 0.\n1., 1.\n"),
             Contains("parameter 'NONLINEAR' of *SPRING is unknown"));
  CHECK_THAT(said("*ELEMENT, TYPE=SPRINGA, ELSET=A\n7, 2, 77\n*SPRING, ELSET=A\n2.5\n"), Contains("node 77"));
}

TEST_CASE("a shell section by its stiffness: 21 numbers in the order of Abaqus") {
  const std::string head = "*ELEMENT, TYPE=S4, ELSET=F\n2, 1, 2, 3, 4\n";
  const auto file = deck(
      "*SHELL GENERAL SECTION, ELSET=E, DENSITY=7\n11, 12, 22, 13, 23, 33, 14, 24\n34, 44, 15, 25, 35, 45, 55, 16\n"
      "26, 36, 46, 56, 66\n*TRANSVERSE SHEAR STIFFNESS\n4., 6., 0.\n");
  REQUIRE(file.deck.shell_sections.size() == 2);
  const auto& section = file.deck.shell_sections[1];
  REQUIRE(section.stiffness);
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i <= j; ++i) {
      CHECK(section.stiffness->values(i, j) == 10 * (i + 1) + j + 1);
      CHECK(section.stiffness->values(j, i) == 10 * (i + 1) + j + 1);
    }
  CHECK(section.stiffness->density == 7.0);
  CHECK(section.shear == 5);
  const auto massless =
      deck("*SHELL GENERAL SECTION, ELSET=E\n1., 0., 1.\n0., 1., 0., 0., 0., 0., 1.\n0., 0., 0., 0., 1.\n");
  CHECK_FALSE(massless.deck.shell_sections[1].stiffness->density);
  const auto bar = deck(
      "*ELEMENT, TYPE=B31, ELSET=B\n9, 1, 3\n*BEAM GENERAL SECTION, ELSET=B\n1., 1., 0., 1., 1.\n0., 0., 1.\n1., 1.\n");
  CHECK_FALSE(bar.deck.beam_sections.at(0).density);
  CHECK_THAT(said("*SHELL GENERAL SECTION, ELSET=E\n1, 2\n3\n"), Contains("the 21 numbers of a stiffness"));
  CHECK_THAT(said("*SHELL GENERAL SECTION, ELSET=E, OFFSET=0.5\n1, 2\n3\n4\n"), Contains("is read without OFFSET="));
  CHECK_THAT(said("*SHELL GENERAL SECTION, ELSET=E, DENSITY=-1\n1, 2\n3\n4\n"),
             Contains("0 or a positive mass per area"));
  CHECK_THAT(said("*SHELL GENERAL SECTION, ELSET=E, MATERIAL=M, DENSITY=1\n1.\n"),
             Contains("is read without DENSITY="));
  CHECK(deck("*SHELL GENERAL SECTION, ELSET=E, MATERIAL=M\n0.1\n").deck.shell_sections[1].plies.at(0).thickness == 0.1);
}

TEST_CASE("nodes may be given in cylindrical axes, and a file may begin with a mark of UTF-8") {
  const std::string text =
      "\xEF\xBB\xBF*NODE, SYSTEM=C\n1, 1., 0., 2.\n2, 1., 90., 2.\n3, 1., 180., 2.\n*ELEMENT, TYPE=S3, ELSET=E\n1, 1, "
      "2, 3\n"
      "*MATERIAL, NAME=M\n*ELASTIC\n1, 0\n*SHELL SECTION, ELSET=E, MATERIAL=M\n1\n";
  const auto file = mesh::read_inp(PETSC_COMM_WORLD, testing::written("round.inp", text));
  CHECK(testing::measure(file.mesh, 0) == Approx(1.0));
  CHECK_THAT(said("*NODE, SYSTEM=S\n9, 1., 0., 2.\n"), Contains("*NODE is read with SYSTEM=R or C"));
}
