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

/// A third square beside the others, 21 22 23 24, with 21 and 24 at the points of 5 and 6.
const std::string third =
    "*NODE\n21, 2, 0\n22, 3, 0\n23, 3, 1\n24, 2, 1\n*ELEMENT, TYPE=S4, ELSET=G\n3, 21, 22, 23, 24\n*SHELL SECTION, "
    "ELSET=G, MATERIAL=M\n1\n*SURFACE, NAME=left\n2, E2\n*SURFACE, NAME=right\n3, E4\n";

/// Rotations that a link leaves free: about all axes (normal to one, where it is not zero), or about one.
using Freedom = std::pair<bool, std::array<double, 3>>;
const Freedom all_free{true, {}}, none_free{false, {}};

Freedom free_of(const mesh::DeckFile& file, std::size_t i) {
  const mesh::RigidLink& link = file.deck.links.at(i);
  return {link.others, link.axis};
}

/// Pairs of the file's numbers, and whether the first has rotations of its own. Collective.
std::vector<std::tuple<long long, long long, bool>> followers(const mesh::DeckFile& file) {
  const auto labels = testing::of_all_ranks(file.mesh.node_labels);
  std::vector<std::tuple<long long, long long, bool>> all;
  for (const mesh::DependentNode& f : mesh::dependent_nodes(file.mesh, file.deck))
    all.emplace_back(labels.at(f.node), labels.at(f.independent_node), f.spins());
  return all;
}
using Followers = std::vector<std::tuple<long long, long long, bool>>;

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
  CHECK_THAT(said("*MPC\nLINK, 1, 9\n"), Contains("links.inp:21: *MPC expects BEAM, TIE or PIN"));
  CHECK_THAT(said("*COUPLING, CONSTRAINT NAME=c, REF NODE=9, SURFACE=S\n*KINEMATIC\n"),
             Contains("there is no node set or surface 'S'"));
}

TEST_CASE("rigid links that hang on others compose, and none leads back to itself") {
  const auto nodes_of = [](const mesh::DeckFile& file) {
    const auto labels = testing::of_all_ranks(file.mesh.node_labels);
    std::vector<std::array<long long, 2>> pairs;
    for (const mesh::DependentNode& link : mesh::dependent_nodes(file.mesh, file.deck))
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

TEST_CASE(
    "a node with elements is the independent one of a rigid region that has no others, unless another is to stay") {
  const auto file = read("*NODE\n10, 5, 6\n11, 6, 6\n*MPC\nBEAM, 2, 10\nBEAM, 11, 10\nBEAM, 1, 9\nBEAM, 4, 9\n");
  const auto labels = testing::of_all_ranks(file.mesh.node_labels);
  const auto number = [&](long long label) {
    return static_cast<PetscInt>(std::find(labels.begin(), labels.end(), label) - labels.begin());
  };
  const auto pairs_of = [&](const std::vector<PetscInt>& kept) {
    std::vector<std::array<long long, 2>> pairs;
    const auto all = mesh::dependent_nodes(file.mesh, file.deck);
    for (const mesh::DependentNode& link : mesh::with_independent_elements(file.mesh, all, kept))
      pairs.push_back({labels.at(link.node), labels.at(link.independent_node)});
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  };
  using Pairs = std::vector<std::array<long long, 2>>;
  CHECK(pairs_of({}) == Pairs{{1, 9}, {4, 9}, {10, 2}, {11, 2}});
  CHECK(pairs_of({number(10)}) == Pairs{{1, 9}, {2, 10}, {4, 9}, {11, 10}});
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
                      "element; it is 5.41 away from the mean of the nodes of the place edge: a force there is one on "
                      "this place, with its moment about the mean"));
  const std::string amid =
      "*NODE\n8, 2, 0.5\n*SURFACE, NAME=edge\n2, S4\n*COUPLING, REF NODE=8, SURFACE=edge\n*DISTRIBUTING\n";
  CHECK_THAT(read(amid).notices.at(0),
             Contains("reference node 8 has no element; its motion is the mean of the place edge"));
  CHECK_THAT(said(coupling + "*ELEMENT, TYPE=MASS, ELSET=P\n7, 9\n*MASS, ELSET=P\n1.\n"),
             Contains("links.inp:22: *COUPLING with *DISTRIBUTING: reference node 9 has an element, a mass or a link"));
  CHECK_THAT(said("*SURFACE, NAME=edge\n2, S4\n*COUPLING, REF NODE=99, SURFACE=edge\n*DISTRIBUTING\n"),
             Contains("links.inp:22: this line names node 99, which is not defined"));
  CHECK_THAT(said("*COUPLING, CONSTRAINT NAME=c, REF NODE=9, SURFACE=E\n*NSET, NSET=n\n1\n"),
             Contains("*COUPLING is read with *KINEMATIC or *DISTRIBUTING after it"));
}

TEST_CASE("*TIE and *MPC TIE link nodes at the same points, and no others") {
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
  const auto loose = read(third + "*TIE, NAME=t, NO ROTATION\nright, left\n");
  REQUIRE(loose.deck.links.size() == 2);
  CHECK(free_of(loose, 0) == all_free);
}

TEST_CASE("links leave rotations free: *MPC PIN, PIN NSET, *KINEMATIC") {
  const auto file =
      read(third +
           "*NSET, NSET=p\n22, 23\n*NSET, NSET=q\n24\n*SURFACE, NAME=n, TYPE=NODE\n1, 1.\n*MPC\nPIN, 21, 5\n"
           "*RIGID BODY, PIN NSET=p, TIE NSET=q, REF NODE=9\n");
  REQUIRE(file.deck.links.size() == 3);
  CHECK(link_of(file, 0) == Labels{5, 21});
  CHECK(free_of(file, 0) == all_free);
  CHECK(link_of(file, 1) == Labels{9, 24});
  CHECK(free_of(file, 1) == none_free);
  CHECK(link_of(file, 2) == Labels{9, 22, 23});
  CHECK(free_of(file, 2) == all_free);
  CHECK_THAT(said("*MPC\nPIN, 1, 5\n"), Contains("links.inp:21: *MPC PIN of nodes 1 and 5 at different points"));
  const std::pair<std::string, Freedom> couplings[] = {
      {"1, 6", none_free}, {"1, 3", all_free}, {"1, 3\n6", {true, {0, 0, 1}}}, {"1, 4\n6, 6", {false, {0, 1, 0}}}};
  for (const auto& [directions, free] : couplings)
    CHECK(free_of(read("*SURFACE, NAME=S, TYPE=NODE\n1, 1.\n*COUPLING, CONSTRAINT NAME=c, REF NODE=9, "
                       "SURFACE=S\n*KINEMATIC\n" +
                       directions + "\n"),
                  0) == free);
}

TEST_CASE("*EQUATION between nodes at one point is a link") {
  const std::string pin = third + "*EQUATION\n2\n21,1,1.,5,1,-1.\n2\n21,2,2.,5,2,-2.\n2\n5,3,1.,21,3,-1.\n";
  const auto rotation = [](int i) { return "2\n21," + std::to_string(i) + ",1.,5," + std::to_string(i) + ",-1.\n"; };
  const std::pair<std::string, Freedom> cases[] = {{"", all_free},
                                                   {rotation(4), {true, {1, 0, 0}}},
                                                   {rotation(4) + rotation(5), {false, {0, 0, 1}}},
                                                   {rotation(4) + rotation(6) + rotation(5), none_free}};
  for (const auto& [more, free] : cases) {
    const auto file = read(pin + more);
    REQUIRE(file.deck.links.size() == 1);
    CHECK(link_of(file, 0) == Labels{5, 21});
    const auto [others, axis] = free_of(file, 0);
    CHECK(others == free.first);
    CHECK(std::abs(Eigen::Vector3d::Map(axis.data()).dot(Eigen::Vector3d::Map(free.second.data()))) ==
          Approx(Eigen::Vector3d::Map(free.second.data()).norm()));
  }
  const auto radial = read(third + "*NSET, NSET=h\n5, 21\n*TRANSFORM, NSET=h, TYPE=C\n1, -1, 0, 1, -1, 4\n" +
                           pin.substr(third.size()) + rotation(4));
  const auto [others, axis] = free_of(radial, 0);
  CHECK(others);
  CHECK(Eigen::Vector3d::Map(axis.data()).cwiseAbs().isApprox(Eigen::Vector3d(1, 1, 0).normalized(), 1e-12));
  CHECK_THAT(radial.notices.at(0), Contains("*TRANSFORM is ignored: only *EQUATION uses its directions"));
  CHECK_THAT(radial.notices.at(1), Contains("links.inp:38: *EQUATION: 4 equations read as 1 link between nodes at"));
}

TEST_CASE("*EQUATION otherwise: supports are ignored, other ties refused") {
  const auto file = read("*EQUATION\n2\n1,3,1.,2,3,-1.\n1\n1,1,1.\n3\n1,3,1.,2,3,-1.,4,3,1.\n");
  CHECK(file.deck.links.empty());
  CHECK_THAT(file.notices.at(0),
             Contains("links.inp:21: *EQUATION: 3 equations are ignored: they resist rigid motion"));
  const std::pair<std::string, const char*> wrong[] = {
      {"2\n1,1,1.,2,1,-1.\n", "links.inp:34: this equation joins nodes otherwise than two at one point"},
      {"3\n1,3,1.,2,3,-1.,1,5,-1.\n", "joins nodes otherwise"},
      {"2\n21,1,1.,5,1,-1.\n2\n21,2,1.,5,2,-1.\n", "leave displacements of nodes 21 and 5 free of each other"},
      {"2\n21,4,1.,5,4,-1.\n", "leave displacements of nodes 21 and 5 free"},
      {"2\n99,1,1.,5,1,-1.\n", "this equation names node 99, which is not defined"},
      {"2\nleft,1,1.,5,1,-1.\n", "node numbers, not with the set 'left'"},
      {"2\n1,1,1.\n", "*EQUATION has fewer terms than it says"},
      {"2\n1,1\n", "*EQUATION expects terms of node, direction, factor"},
      {"1,1,1.\n", "*EQUATION expects its number of terms"}};
  for (const auto& [text, message] : wrong) CHECK_THAT(said(third + "*EQUATION\n" + text), Contains(message));
  const auto outside = read(third + "*NODE\n31, 2, 0\n*EQUATION\n3\n31,1,1.,5,1,-.5,21,1,-.5\n");
  CHECK_THAT(outside.notices.at(0), Contains("*EQUATION: 1 equation is ignored") && Contains("nodes without elements"));
  const auto left_out = mesh::read_inp(
      PETSC_COMM_WORLD, testing::written("links.inp", squares + third + "*EQUATION\n2\n1,1,1.,2,1,-1.\n"),
      {{}, false, {"equation"}});
  CHECK_THAT(left_out.notices.at(0), Contains("*EQUATION is ignored: left out, as the scene asks"));
}

TEST_CASE("free rotations follow a link where nothing resists them, and links compose where they can") {
  CHECK(followers(read(third + "*MPC\nPIN, 21, 5\n")) == Followers{{21, 5, true}});
  const std::string lone = "*NODE\n31, 2, 0\n32, 2, 0\n";
  CHECK(followers(read(lone + "*MPC\nPIN, 31, 5\n")) == Followers{{31, 5, false}});
  CHECK(followers(read(third + lone + "*MPC\nPIN, 5, 31\nPIN, 21, 31\n")) == Followers{{5, 31, false}, {21, 31, true}});
  CHECK(followers(read(third + lone + "*MPC\nPIN, 31, 21\nPIN, 21, 5\nBEAM, 9, 1\n")) ==
        Followers{{9, 1, false}, {21, 5, true}, {31, 5, false}});
  // a lone node whose dependent nodes are on a line, and on none; with a mass
  const std::string pin = "*NSET, NSET=p\n22, 23\n*RIGID BODY, PIN NSET=p, REF NODE=9\n",
                    mass = "*ELEMENT, TYPE=MASS, ELSET=P\n7, 9\n*MASS, ELSET=P\n1.\n";
  const auto on_line = read(third + pin), on_none = read(third + pin + "*NSET, NSET=p\n21\n"),
             heavy = read(third + mass + pin);
  const auto locked = [](const mesh::DeckFile& file) {
    double sum = 0;
    for (const mesh::DependentNode& f : mesh::dependent_nodes(file.mesh, file.deck))
      sum += f.others ? Eigen::Vector3d::Map(f.axis.data()).cwiseAbs()[1] : 10;
    return sum;
  };
  CHECK(locked(on_line) == Approx(1));
  CHECK(locked(on_none) == 0);
  CHECK(locked(heavy) == 0);
  const auto chain = read(third + "*MPC\nBEAM, 9, 21\nPIN, 21, 5\n");
  CHECK_THAT(testing::fault_of([&] { followers(chain); }),
             Contains("node 9 depends on a node whose rotations another link leaves free"));
}
