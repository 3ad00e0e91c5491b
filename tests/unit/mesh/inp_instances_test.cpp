#include "floe/mesh/inp.h"
#include "mesh_files.h"

using namespace floe;
using Catch::Matchers::Contains;

namespace {

/// A square of side `a` as a part.
std::string part(const std::string& name, const std::string& a) {
  return "*PART, NAME=" + name + "\n*NODE, NSET=all\n1, 0, 0\n2, " + a + ", 0\n3, " + a + ", " + a + "\n4, 0, " + a +
         "\n*ELEMENT, TYPE=S4, ELSET=E\n1, 1, 2, 3, 4\n*SHELL SECTION, ELSET=E, MATERIAL=M\n1\n*END PART\n";
}

const std::string material = "*MATERIAL, NAME=M\n*ELASTIC\n1, 0\n";

/// A wide part once and a narrow one twice, joined, with a reference point for each.
const std::string mechanism =
    part("wide", "2") + part("narrow", "1") +
    "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=wide-1, PART=wide\n*END INSTANCE\n"
    "*INSTANCE, NAME=narrow-1, PART=narrow\n5, 0, 0\n*END INSTANCE\n"
    "*INSTANCE, NAME=narrow-2, PART=narrow\n0, 7, 0\n*END INSTANCE\n"
    "*NODE\n1, 2, 3, 4\n** a comment\n2, 9, 9, 9\n*NSET, NSET=hub\n1\n*NSET, NSET=other_hub\n2\n"
    "*NSET, NSET=rim, INSTANCE=narrow-2\n3, 4\n*NSET, NSET=rim, INSTANCE=wide-1\n1\n"
    "*NSET, NSET=foot, INSTANCE=wide-1\n1, 2\n*NSET, NSET=both\nfoot, rim\n"
    "*ELSET, ELSET=_top, INSTANCE=narrow-2\n1\n*SURFACE, NAME=top, TYPE=ELEMENT\n_top, SPOS\n"
    "*ELSET, ELSET=_low, INSTANCE=wide-1\n1\n*SURFACE, NAME=low, TYPE=ELEMENT\n_low, SPOS\n"
    "*COUPLING, CONSTRAINT NAME=c1, REF NODE=hub, SURFACE=top\n*KINEMATIC\n"
    "*COUPLING, CONSTRAINT NAME=c2, REF NODE=2, SURFACE=low\n*KINEMATIC\n"
    "*TIE, NAME=t\ntop, low\n*END ASSEMBLY\n" +
    material;

mesh::DeckFile read(const std::string& text, const std::string& instance) {
  return mesh::read_inp(PETSC_COMM_WORLD, testing::written("assembly.inp", text), {{}, false, {}, instance});
}

std::string said(const std::string& text, const std::string& instance) {
  return testing::fault_of([&] { read(text, instance); });
}

}  // namespace

TEST_CASE("one instance of an assembly is read, without what joins it to others") {
  const auto file = read(mechanism, "NARROW-2");
  CHECK(testing::measure(file.mesh, 0) == Approx(1));
  CHECK(testing::labels_at(file.mesh, "rim") == std::vector<long long>{3, 4});
  CHECK(testing::labels_at(file.mesh, "all").size() == 4);
  const auto x = testing::of_all_ranks(file.mesh.positions);
  CHECK(std::count(x.begin(), x.end(), Eigen::Vector3d(1, 8, 0)) == 1);  // moved as the instance
  CHECK(std::count(x.begin(), x.end(), Eigen::Vector3d(2, 3, 4)) == 1);  // the reference point is not
  const std::string& notice = file.notices.at(0);
  CHECK_THAT(notice, Contains("*INSTANCE narrow-2 is read; left out: wide-1, narrow-1"));
  CHECK_THAT(notice, Contains("1 *COUPLING, 1 *TIE"));
  REQUIRE(file.deck.links.size() == 1);
  CHECK(testing::of_all_ranks(file.mesh.node_labels).at(file.deck.links[0].reference) == 1000000001);

  const auto wide = read(mechanism, "wide-1");
  CHECK(testing::measure(wide.mesh, 0) == Approx(4));
  CHECK(testing::labels_at(wide.mesh, "foot") == std::vector<long long>{1, 2});
  REQUIRE(wide.deck.links.size() == 1);
  CHECK(testing::of_all_ranks(wide.mesh.node_labels).at(wide.deck.links[0].reference) == 1000000002);
}

TEST_CASE("what names several instances is kept line by line") {
  const std::string head = mechanism.substr(0, mechanism.find("*NODE\n1, 2, 3, 4")),
                    own = "*NSET, NSET=own, INSTANCE=narrow-2\n1, 2\n",
                    of_wide = "*NSET, NSET=wide_edge, INSTANCE=wide-1\n1, 2\n*NSET, NSET=BEAM, INSTANCE=wide-1\n3\n",
                    point = "*NODE\n1, 2, 3, 4\n3, 9, 9, 9\n", end = "*END ASSEMBLY\n" + material;
  const auto of = [&](const std::string& more) { return read(head + own + of_wide + point + more + end, "narrow-2"); };
  const auto links = of("*MPC\nBEAM, own, 1\nBEAM, wide_edge, 3\n");
  REQUIRE(links.deck.links.size() == 1);
  CHECK(testing::of_all_ranks(links.mesh.node_labels).at(links.deck.links[0].reference) == 1000000001);
  CHECK_THAT(links.notices.at(0), Contains("what names them: 1 *MPC"));
  CHECK(testing::labels_at(of("*NSET, NSET=all_of\nown, wide_edge\n").mesh, "all_of") == std::vector<long long>{1, 2});
  CHECK(testing::labels_at(of("*MPC\nBEAM, own, 1\n*NSET, NSET=points, GENERATE\n1, 3, 2\n").mesh, "points") ==
        std::vector<long long>{1000000001});
  // a surface of another instance has the name of a set of this one
  const auto surface =
      of("*ELSET, ELSET=_e, INSTANCE=wide-1\n1\n*SURFACE, NAME=own, TYPE=ELEMENT\n_e, SPOS\n"
         "*COUPLING, REF NODE=1, SURFACE=own\n*KINEMATIC\n");
  CHECK(surface.deck.links.empty());
  // the name of a set of another instance is a word of other keywords
  const auto words =
      of("*ELSET, ELSET=S1, INSTANCE=wide-1\n1\n*ELSET, ELSET=_e, INSTANCE=narrow-2\n1\n"
         "*SURFACE, NAME=edge, TYPE=ELEMENT\n_e, S1\n*COUPLING, REF NODE=1, SURFACE=edge\n*KINEMATIC\n");
  CHECK(words.deck.links.size() == 1);
  const auto equations = of("*EQUATION\n2\nwide-1.1, 1, 1., narrow-2.1, 1, -1.\n");
  CHECK_THAT(equations.notices.at(0), Contains("1 *EQUATION"));
  CHECK_THAT(said(head + "*NSET, NSET=x, INSTANCE=narrow-3\n1\n" + end, "narrow-2"),
             Contains("no instance 'narrow-3'"));
  const std::string mass = "*ELEMENT, TYPE=MASS, ELSET=M\n7, 1\n";
  CHECK_THAT(said(head + point + mass + end, "narrow-2"), Contains("*ELEMENT of the *ASSEMBLY is not read"));
  CHECK(mesh::read_inp(PETSC_COMM_WORLD, testing::written("assembly.inp", head + point + mass + end),
                       {{}, false, {"MASS"}, "narrow-2"})
            .mesh.cell_count == 1);
}

TEST_CASE("of several instances one is to be named") {
  CHECK_THAT(said(mechanism, ""), Contains("a second *INSTANCE: one is read, for one body; expected one of wide-1, "
                                           "narrow-1, narrow-2, as in file: {path: assembly.inp, ") &&
                                      Contains("instance: wide-1}") && !Contains("\n"));
  CHECK_THAT(said(mechanism, "wide"),
             Contains("there is no *INSTANCE 'wide'; the deck has wide-1, narrow-1, narrow-2") && !Contains("\n"));
  CHECK_THAT(said(part("P", "1") + material, "P-1"), Contains("there is no *INSTANCE 'P-1'"));
}

TEST_CASE("nodes of the assembly come after its instance, and are others than those of the part") {
  const std::string head = part("P", "1") + "*ASSEMBLY, NAME=A\n",
                    instance = "*INSTANCE, NAME=I, PART=P\n*END INSTANCE\n", point = "*NODE\n1, 0, 0, 5\n",
                    rest =
                        "*NSET, NSET=hub\n1\n*NSET, NSET=rim, INSTANCE=I\n1, 2\n*SURFACE, NAME=S, TYPE=NODE\nrim\n"
                        "*COUPLING, REF NODE=hub, SURFACE=S\n*KINEMATIC\n*END ASSEMBLY\n" +
                        material;
  const auto file = read(head + instance + point + rest, "");
  CHECK(file.mesh.node_count == 5);
  CHECK(testing::labels_at(file.mesh, "hub") == std::vector<long long>{1000000001});
  CHECK(testing::labels_at(file.mesh, "rim") == std::vector<long long>{1, 2});
  CHECK(read(head + instance + "*SYSTEM\n" + point + rest, "").mesh.node_count == 5);
  CHECK_THAT(said(head + instance + "*SYSTEM\n1, 0, 0\n" + point + rest, ""),
             Contains("*SYSTEM is read without data lines"));
  CHECK_THAT(said(head + point + instance + rest, ""),
             Contains("*NODE of the *ASSEMBLY is not read before its *INSTANCE"));
  CHECK_THAT(said(head + instance + "*ELEMENT, TYPE=MASS, ELSET=X\n1, 1\n" + rest, ""),
             Contains("*ELEMENT of the *ASSEMBLY is not read: define it in the *PART"));
}
