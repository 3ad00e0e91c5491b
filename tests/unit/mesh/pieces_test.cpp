#include "floe/mesh/pieces.h"

#include <catch2/catch.hpp>

using namespace floe::mesh;
using Pairs = std::vector<std::array<PetscInt, 2>>;

namespace {

Pairs joined(const std::vector<Follower>& links, const std::vector<std::vector<PetscInt>>& pieces) {
  Pairs pairs;
  for (const Follower& f : with_pieces(links, pieces)) pairs.push_back({f.node, f.leader});
  return pairs;
}

}  // namespace

TEST_CASE("a piece is led by a node of its middle, pieces with a common node are one") {
  CHECK(joined({}, {}) == Pairs{});
  CHECK(joined({}, {{9, 3, 5}}) == Pairs{{3, 5}, {9, 5}});
  CHECK(joined({}, {{1, 2, 3}, {7, 8}}) == Pairs{{1, 2}, {3, 2}, {7, 8}});
  CHECK(joined({}, {{1, 2, 3}, {7, 8}, {3, 7}}) == Pairs{{1, 3}, {2, 3}, {7, 3}, {8, 3}});
}

TEST_CASE("a piece that touches a rigid link is led by the link's reference") {
  const std::vector<Follower> links{{4, 20}, {5, 20}, {6, 21}};
  CHECK(joined(links, {}) == Pairs{{4, 20}, {5, 20}, {6, 21}});
  CHECK(joined(links, {{1, 2, 4}}) == Pairs{{1, 20}, {2, 20}, {4, 20}, {5, 20}, {6, 21}});
  CHECK(joined(links, {{5, 6}}) == Pairs{{4, 20}, {5, 20}, {6, 20}, {21, 20}});
}
