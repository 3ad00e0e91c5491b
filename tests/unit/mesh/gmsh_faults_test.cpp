#include "floe/mesh/gmsh.h"
#include "gmsh_text.h"
#include "mesh_files.h"

using namespace floe;
using Catch::Matchers::Contains;
using testing::gmsh_grid;

namespace {

// What is said about a file of this content; the same on every rank.
std::string said(const std::string& content) {
  const auto path = testing::written("bad.msh", content);
  return testing::fault_of([&] { mesh::read_gmsh(PETSC_COMM_WORLD, path); });
}

std::string with(std::string text, const std::string& old, const std::string& fresh) {
  const auto at = text.find(old);
  REQUIRE(at != std::string::npos);
  return text.replace(at, old.size(), fresh);
}

}  // namespace

TEST_CASE("files that are no mesh are refused") {
  CHECK_THAT(testing::fault_of([] { mesh::read_gmsh(PETSC_COMM_WORLD, "no/such.msh"); }),
             Contains("no/such.msh: cannot be opened: No such file"));
  CHECK_THAT(testing::fault_of([] { mesh::read_gmsh(PETSC_COMM_WORLD, "tests"); }), Contains("tests: is not a file"));
  CHECK(said("") == "bad.msh: is empty");
  std::string garbage;
  for (int i = 0; i < 4096; ++i) garbage += static_cast<char>((i * 2654435761u) >> 13);
  CHECK_THAT(said(garbage), Contains("expected '$MeshFormat'"));
  CHECK_THAT(said("$MeshFormat\n3 0 8\n$EndMeshFormat\n"), Contains("bad.msh:2: format '3'") && Contains("msh41"));
  CHECK_THAT(said("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"), Contains("it has no nodes"));
}

TEST_CASE("a text that is wrong is refused with its line") {
  const std::string good = gmsh_grid(1, 1, false);
  CHECK_THAT(said(with(good, "1 4 1 4 ", "1 -4 1 4 ")), Contains("bad.msh:16: the number of nodes is negative: -4"));
  CHECK_THAT(said(with(good, "2 1 0 4 ", "2 1 0 1000000000000000000 ")),
             Contains("expected 1000000000000000000 lines of node numbers, found 9 before the section ends"));
  CHECK_THAT(said(with(good, "1 4 1 4 ", "1 5 1 4 ")), Contains("announces 5 nodes, its blocks have 4"));
  CHECK_THAT(said(with(good, "\n3 \n", "\n2 \n")),
             Contains("bad.msh:20: node 2 is defined a second time\nbad.msh:33: element 2 names node 3"));
  CHECK(said(with(good, "2 1 2 4 3 ", "2 1 2 4 77 ")) == "bad.msh:33: element 2 names node 77, which is not defined");
  CHECK_THAT(said(with(good, "2 1 2 4 3 ", "1 1 2 4 3 ")), !Contains("second time"));  // one cell: the line is none
  CHECK_THAT(said(with(good, "2 1 3 1 ", "2 1 777 1 ")), Contains("bad.msh:32: element type 777 is unknown"));
  CHECK_THAT(said(with(good, "1.000000 1.000000 0", "1.000000 x 0")),
             Contains("bad.msh:25: expected 3 coordinates of a node, found '1.000000 x 0"));
  CHECK_THAT(said(with(good, "2 1 2 4 3 ", "2 1 2 4 ")), Contains("expected an element number and 4 nodes"));
  CHECK_THAT(said(with(good, "$EndElements", "$EndElement")), Contains("expected '$EndElements', found '$EndElement'"));
}

TEST_CASE("elements that are defined twice are refused") {
  CHECK(said(with(gmsh_grid(2, 1, false), "\n3 2 3 ", "\n2 2 3 ")) == "bad.msh:38: element 2 is defined a second time");
}

TEST_CASE("a file that ends early is refused wherever it ends") {
  for (const auto& format : {testing::GmshFormat{}, testing::GmshFormat{true, false, 8}}) {
    const std::string good = gmsh_grid(3, 2, true, 1, format);
    const std::size_t last = good.find("$EndElements") + 11;
    for (std::size_t size = 1; size < last; size += 1 + last / 60) {
      INFO("size " << size);
      CHECK_THAT(said(good.substr(0, size)), Contains("bad.msh:") && !Contains("nothing was thrown"));
    }
  }
}

TEST_CASE("a binary file with changed bytes gives a fault or a mesh, never more") {
  const std::string good = gmsh_grid(3, 2, true, 1, {true, false, 8});
  int refused = 0;
  for (std::size_t at = 60; at < good.size(); at += 1 + good.size() / 80) {
    std::string bad = good;
    bad[at] = static_cast<char>(0xff);
    refused += said(bad) != "nothing was thrown";
  }
  CHECK(refused > 20);
}
