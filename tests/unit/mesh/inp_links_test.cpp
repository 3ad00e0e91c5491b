#include "floe/mesh/inp.h"
#include "floe/mesh/links.h"
#include "mesh_files.h"

using namespace floe;
using Catch::Matchers::Contains;

namespace {

// Two squares of side 1 beside each other, 1 2 3 4 and 2 5 6 3, and node 9 apart.
const std::string squares =
    "*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n5, 2, 0\n6, 2, 1\n9, 5, 5\n*ELEMENT, TYPE=S4, ELSET=E\n1, 1, 2, 3, 4\n"
    "*ELEMENT, TYPE=S4, ELSET=F\n2, 2, 5, 6, 3\n*ELSET, ELSET=ALL\nE, F\n*MATERIAL, NAME=M\n*ELASTIC\n1, 0\n"
    "*SHELL SECTION, ELSET=ALL, MATERIAL=M\n1\n";

mesh::DeckFile read(const std::string& more) {
  return mesh::read_inp(PETSC_COMM_WORLD, testing::written("links.inp", squares + more));
}

std::string said(const std::string& more) {
  return testing::fault_of([&] { read(more); });
}

/// The file's numbers of the nodes of a link, ascending, after its reference node. Collective.
std::vector<long long> link_of(const mesh::DeckFile& file, std::size_t i) {
  const auto labels = testing::of_all_ranks(file.mesh.node_labels);
  std::vector<long long> found;
  for (const PetscInt node : testing::of_all_ranks(file.deck.links.at(i).nodes)) found.push_back(labels.at(node));
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  found.insert(found.begin(), labels.at(file.deck.links[i].reference));
  return found;
}

using Labels = std::vector<long long>;

}  // namespace

TEST_CASE("*MPC BEAM, *COUPLING and *RIGID BODY are rigid links") {
  const auto file = read(
      "*NODE\n10, 5, 6\n11, 6, 6\n*NSET, NSET=ref\n9\n*SURFACE, NAME=S, TYPE=NODE\n1, 1.\n4\n*MPC\nBEAM, 2, 10\n"
      "*COUPLING, CONSTRAINT NAME=c, REF NODE=ref, SURFACE=S\n*KINEMATIC\n1, 6\n*RIGID BODY, ELSET=F, REF NODE=11\n");
  REQUIRE(file.deck.links.size() == 3);
  CHECK(link_of(file, 0) == Labels{10, 2});
  CHECK(link_of(file, 1) == Labels{9, 1, 4});
  CHECK(link_of(file, 2) == Labels{11, 2, 3, 5, 6});
  CHECK(testing::labels_at(file.mesh, "elements of F") == Labels{2, 3, 5, 6});
  CHECK_THAT(said("*RIGID BODY, PIN NSET=x, REF NODE=9\n"), Contains("links.inp:20: *RIGID BODY is read with NSET="));
  CHECK_THAT(said("*MPC\nPIN, 1, 9\n"),
             Contains("links.inp:21: *MPC expects BEAM or TIE") && Contains("use two bodies and a joint"));
  CHECK_THAT(said("*COUPLING, CONSTRAINT NAME=c, REF NODE=9, SURFACE=S\n*KINEMATIC\n"),
             Contains("there is no node set or surface 'S'"));
}

TEST_CASE("rigid links that hang on others compose, and none leads back to itself") {
  const auto nodes_of = [](const mesh::DeckFile& file) {
    const auto labels = testing::of_all_ranks(file.mesh.node_labels);
    std::vector<std::array<long long, 2>> pairs;
    for (const mesh::DependentNode& link : mesh::dependent_nodes(file.mesh, file.deck.links))
      pairs.push_back({labels.at(link.node), labels.at(link.independent_node)});
    return pairs;
  };
  using Pairs = std::vector<std::array<long long, 2>>;
  CHECK(nodes_of(read("*NODE\n10, 5, 6\n11, 6, 6\n*MPC\nBEAM, 2, 10\nBEAM, 10, 11\nBEAM, 11, 1\n")) ==
        Pairs{{2, 1}, {10, 1}, {11, 1}});
  const auto round = read("*NODE\n10, 5, 6\n*MPC\nBEAM, 2, 10\nBEAM, 10, 2\n");
  CHECK_THAT(testing::fault_of([&] { nodes_of(round); }), Contains("rigid links lead from node 2 back to it"));
  const auto two = read("*NODE\n10, 5, 6\n*MPC\nBEAM, 2, 10\nBEAM, 2, 1\n");
  CHECK_THAT(testing::fault_of([&] { nodes_of(two); }), Contains("node 2 is in rigid links to two nodes"));
}

TEST_CASE("surfaces of elements are places: faces and edges") {
  const auto file = read(
      "*SURFACE, NAME=top\nE, SPOS\n*SURFACE, NAME=abaqus, TYPE=ELEMENT\n1, E4\n*SURFACE, NAME=calculix\n2, S4\nE, S3\n"
      "*COUPLING, CONSTRAINT NAME=c, REF NODE=9, SURFACE=abaqus\n*KINEMATIC\n");
  CHECK(testing::labels_at(file.mesh, "top") == Labels{1, 2, 3, 4});
  CHECK(testing::labels_at(file.mesh, "abaqus") == Labels{1, 4});
  CHECK(testing::labels_at(file.mesh, "calculix") == Labels{1, 2, 5, 6});
  CHECK(link_of(file, 0) == Labels{9, 1, 4});
  CHECK_THAT(said("*SURFACE, NAME=s\nG, SPOS\n"), Contains("links.inp:21: there is no element set 'G'"));
  CHECK_THAT(said("*SURFACE, NAME=s\n77, S1\n"), Contains("links.inp:21: surface s names element 77"));
}

TEST_CASE("edges of shells of second order have their middle nodes") {
  const auto file = mesh::read_inp(
      PETSC_COMM_WORLD,
      testing::written("curved_links.inp",
                       "*NODE\n1, 0, 0\n2, 2, 0\n3, 2, 2\n4, 0, 2\n5, 1, 0\n6, 2, 1\n7, 1, 2\n8, 0, 1\n9, 3, 0\n"
                       "10, 4, 0\n11, 3, 1\n*ELEMENT, TYPE=S8R, ELSET=Q\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"
                       "*ELEMENT, TYPE=S6, ELSET=Q\n2, 2, 10, 3, 9, 11, 6\n*MATERIAL, NAME=M\n*ELASTIC\n1, 0.3\n"
                       "*SHELL SECTION, ELSET=Q, MATERIAL=M\n0.1\n*SURFACE, NAME=left\n1, S6\n"
                       "*SURFACE, NAME=abaqus\n2, E2\n*SURFACE, NAME=face\n2, SNEG\n"));
  CHECK(testing::labels_at(file.mesh, "left") == Labels{1, 4, 8});
  CHECK(testing::labels_at(file.mesh, "abaqus") == Labels{3, 10, 11});
  CHECK(testing::labels_at(file.mesh, "face") == Labels{2, 3, 6, 9, 10, 11});
}

TEST_CASE("*DISTRIBUTING is the mean of a place where its reference node carries nothing else") {
  const std::string coupling =
      "*SURFACE, NAME=edge\n2, S4\n*COUPLING, CONSTRAINT NAME=c, REF NODE=9, SURFACE=edge\n*DISTRIBUTING\n1, 3\n";
  const auto file = read(coupling);
  CHECK(file.deck.links.empty());
  CHECK(file.mesh.node_count == 6);  // without 9
  CHECK_THAT(file.notices.at(0),
             Contains("links.inp:22: *COUPLING with *DISTRIBUTING is ignored: reference node 9 has no "
                      "element; its motion is the mean of the place edge"));
  CHECK_THAT(said(coupling + "*ELEMENT, TYPE=MASS, ELSET=P\n7, 9\n*MASS, ELSET=P\n1.\n"),
             Contains("links.inp:22: *COUPLING with *DISTRIBUTING: reference node 9 has an element, a mass or a link"));
  CHECK_THAT(said("*SURFACE, NAME=edge\n2, S4\n*COUPLING, REF NODE=99, SURFACE=edge\n*DISTRIBUTING\n"),
             Contains("links.inp:22: this line names node 99, which is not defined"));
  CHECK_THAT(said("*COUPLING, CONSTRAINT NAME=c, REF NODE=9, SURFACE=E\n*NSET, NSET=n\n1\n"),
             Contains("*COUPLING is read with *KINEMATIC or *DISTRIBUTING after it"));
}

TEST_CASE("*TIE and *MPC TIE link nodes at the same points, and no others") {
  const std::string third =
      "*NODE\n21, 2, 0\n22, 3, 0\n23, 3, 1\n24, 2, 1\n*ELEMENT, TYPE=S4, ELSET=G\n3, 21, 22, 23, 24\n*SHELL SECTION, "
      "ELSET=G, MATERIAL=M\n1\n*SURFACE, NAME=left\n2, E2\n*SURFACE, NAME=right\n3, E4\n";
  const auto file = read(third + "*TIE, NAME=t, POSITION TOLERANCE=0.1\nright, left\n");
  REQUIRE(file.deck.links.size() == 2);
  CHECK(link_of(file, 0) == Labels{5, 21});
  CHECK(link_of(file, 1) == Labels{6, 24});
  CHECK_THAT(file.notices.at(0), Contains("*TIE of right to left: 2 nodes rigidly linked"));
  const auto apart = read(third + "*SURFACE, NAME=far\n3, E3\n*TIE, NAME=t\nfar, left\n");
  CHECK(apart.deck.links.empty());
  CHECK_THAT(apart.notices.at(0), Contains("*TIE of far to left is ignored: 1 of 2 nodes coincide with no node"));
  // one node beside another by less than 1e-6 of the surface's length, and by more
  const auto single = [&](const char* x) {
    return read(third + "*NODE\n31, " + x + ", 1\n*SURFACE, NAME=one, TYPE=NODE\n31, 1.\n*TIE, NAME=t\none, left\n");
  };
  REQUIRE(single("2.0000005").deck.links.size() == 1);
  CHECK(link_of(single("2.0000005"), 0) == Labels{6, 31});
  CHECK(single("2.000002").deck.links.empty());
  const auto pair = read(third + "*MPC\nTIE, 21, 5\n");
  REQUIRE(pair.deck.links.size() == 1);
  CHECK(link_of(pair, 0) == Labels{5, 21});
  CHECK_THAT(said("*MPC\nTIE, 1, 5\n"), Contains("links.inp:21: *MPC TIE of nodes 1 and 5 at different points"));
  CHECK_THAT(said("*TIE, NAME=t, NO ROTATION\nE, F\n"), Contains("links.inp:20: *TIE is read without NO ROTATION"));
}
