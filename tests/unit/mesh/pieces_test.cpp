#include "floe/mesh/pieces.h"

#include <catch2/catch.hpp>

#include "floe/error.h"

using namespace floe::mesh;
using Pairs = std::vector<std::array<PetscInt, 2>>;

namespace {

Pairs joined(const std::vector<DependentNode>& links, const std::vector<std::vector<PetscInt>>& pieces) {
  Pairs pairs;
  for (const DependentNode& f : with_pieces(links, pieces)) pairs.push_back({f.node, f.independent_node});
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
  const std::vector<DependentNode> links{{4, 20}, {5, 20}, {6, 21}};
  CHECK(joined(links, {}) == Pairs{{4, 20}, {5, 20}, {6, 21}});
  CHECK(joined(links, {{1, 2, 4}}) == Pairs{{1, 20}, {2, 20}, {4, 20}, {5, 20}, {6, 21}});
  CHECK(joined(links, {{5, 6}}) == Pairs{{4, 20}, {5, 20}, {6, 20}, {21, 20}});
}

TEST_CASE("a hinge line is led by what it touches, else by a node that is preferred, else by one of its middle") {
  const std::array<double, 3> x{1, 0, 0}, y{0, 1, 0};
  const auto led = [](const std::vector<DependentNode>& links, const std::vector<HingeLine>& lines,
                      const std::vector<PetscInt>& preferred) {
    Pairs rotating;
    for (const DependentNode& f : with_lines(links, lines, preferred))
      if (f.spins()) rotating.push_back({f.node, f.independent_node});
    return rotating;
  };
  CHECK(led({}, {{{9, 3, 5}, x}}, {}) == Pairs{{3, 5}, {9, 5}});
  CHECK(led({}, {{{9, 3, 5}, x}}, {9, 11}) == Pairs{{3, 9}, {5, 9}});
  CHECK(led({}, {{{1, 2, 3}, x}, {{3, 4, 5}, y}}, {}) == Pairs{{1, 3}, {2, 3}, {4, 3}, {5, 3}});
  CHECK(led({}, {{{1, 2, 3}, x}, {{2, 3, 4}, x}}, {}) == Pairs{{1, 3}, {2, 3}, {4, 3}});
  const std::vector<DependentNode> links{{4, 20}, {5, 20}, {6, 21}};
  CHECK(with_lines(links, {}).size() == 3);
  CHECK(led(links, {{{1, 2, 4}, x}}, {1}) == Pairs{{1, 20}, {2, 20}});
  CHECK(led(links, {{{1, 20, 4}, x}}, {}) == Pairs{{1, 20}});
  CHECK_THROWS_WITH(led(links, {{{1, 4, 6}, x, "s.yaml:3: joints.a"}}, {}),
                    Catch::StartsWith("s.yaml:3: joints.a: its edge has nodes in common with two others"));
  CHECK_THROWS_AS(led({}, {{{1, 2, 3}, x}, {{3, 4, 5}, y}, {{5, 6, 7}, x}}, {}), floe::InputError);
  const HingeLine constrained{{3, 4, 5}, y, "", true}, apart{{8, 9}, x, "", true};  // by the ground
  CHECK(led({}, {{{1, 2, 3}, x}, constrained, {{5, 6, 7}, x}, apart}, {}) ==
        Pairs{{1, 2}, {3, 2}, {5, 6}, {7, 6}, {8, 9}});
  CHECK(led({}, {{{1, 2, 3}, x}, constrained}, {}) == Pairs{{1, 3}, {2, 3}, {4, 3}, {5, 3}});
}

TEST_CASE("hinge lines of one holder that meet are one rigid rim, led by a corner") {
  const std::array<double, 3> x{1, 0, 0}, y{0, 1, 0};
  // nodes 1 2 3 below, 7 8 9 above, 4 and 6 between them
  const HingeLine bottom{{1, 2, 3}, x, "s.yaml:3: joints.a", true, "ground"},
      right{{3, 6, 9}, y, "s.yaml:4: joints.b", true, "ground"},
      top{{7, 8, 9}, x, "s.yaml:5: joints.c", true, "ground"}, left{{1, 4, 7}, y, "s.yaml:6: joints.d", true, "ground"};
  const auto led = [](const std::vector<DependentNode>& links, const std::vector<HingeLine>& lines,
                      const std::vector<PetscInt>& preferred, bool spins) {
    Pairs dependent_nodes;
    for (const DependentNode& f : with_lines(links, lines, preferred))
      if (f.spins() == spins) dependent_nodes.push_back({f.node, f.independent_node});
    return dependent_nodes;
  };
  CHECK(led({}, {bottom, right}, {}, true) == Pairs{{1, 3}, {2, 3}, {6, 3}, {9, 3}});
  CHECK(led({}, {bottom, right}, {}, false).empty());
  CHECK(led({}, {bottom, right, top}, {}, true) == Pairs{{1, 3}, {2, 3}, {6, 3}, {7, 3}, {8, 3}});
  CHECK(led({}, {bottom, right, top}, {}, false) == Pairs{{9, 3}});
  CHECK(led({}, {top, bottom, right, left}, {7, 8}, true) == Pairs{{2, 7}, {4, 7}, {6, 7}, {8, 7}});
  CHECK(led({}, {top, bottom, right, left}, {7, 8}, false) == Pairs{{1, 7}, {3, 7}, {9, 7}});
  // a piece on the left leads the three others; its own nodes do not rotate by themselves
  const std::vector<DependentNode> piece{{1, 4}, {7, 4}};
  CHECK(led(piece, {bottom, right, top}, {}, true) == Pairs{{2, 4}, {6, 4}, {8, 4}});
  CHECK(led(piece, {bottom, right, top}, {}, false) == Pairs{{1, 4}, {3, 4}, {7, 4}, {9, 4}});
  // parts of one line
  const HingeLine more{{9, 10}, y, "s.yaml:7: joints.e", true, "ground"};
  CHECK(led({}, {right, more}, {}, true) == Pairs{{3, 9}, {6, 9}, {10, 9}});
  // a line of another holder pivots about a node of the rim, which has no such rotation
  const HingeLine flap{{1, 4, 7}, y, "s.yaml:8: joints.f", false, "body flap"};
  std::vector<std::string> left_out;
  CHECK(with_lines({}, {bottom, right, flap}, {}, &left_out).size() == 2);
  CHECK(left_out == std::vector<std::string>{right.where, bottom.where});
  HingeLine lower = bottom, side = right;
  lower.constrained = side.constrained = false, lower.holder = side.holder = "body hub";
  CHECK_THROWS_AS(with_lines({}, {lower, side, flap}, {}), floe::InputError);
}
