#include "floe/scene/places.h"

#include <catch2/catch.hpp>

#include "floe/error.h"

using namespace floe::scene;
using Catch::Matchers::Contains;

namespace {

Place named(const std::string& name) { return {"beam", name, {}, {"scene.yaml", 3, 4, "probes.tip.at"}}; }
Place at(double x, double y) { return {"beam", "", Point{x, y, 0}, {"scene.yaml", 3, 4, "probes.tip.at"}}; }

MeshSpec line(int elements) { return {{}, {}, {{0, 0, 0}, {3, 4, 0}}, {{0, 1}}, {elements}, {}}; }
MeshSpec corner() { return {{}, {}, {{0, 0, 0}, {1, 0, 0}, {1, 3, 0}}, {{0, 1}, {1, 2}}, {2, 6}, {}}; }
MeshSpec forked() {
  return {{}, {}, {{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {2, -1, 0}}, {{0, 1}, {1, 2}, {1, 3}}, {3, 2, 2}, {}};
}

}  // namespace

TEST_CASE("nodes at shared points count once") {
  CHECK(node_count(line(20)) == 21);
  CHECK(node_count(corner()) == 9);
  CHECK(node_count(forked()) == 8);
  CHECK(total_length(corner()) == 4);
  CHECK(unbranched(corner()));
  CHECK_FALSE(unbranched(forked()));
}

TEST_CASE("names lead to nodes") {
  CHECK(place_point(corner(), named("start")) == Point{0, 0, 0});
  CHECK(place_point(corner(), named("end")) == Point{1, 3, 0});
  CHECK(place_point(corner(), named("p2")) == Point{1, 0, 0});
  CHECK(place_point(forked(), named("end")) == Point{2, -1, 0});
}

TEST_CASE("the middle is the node at half the length or the last before it") {
  CHECK(place_point(line(2), named("middle")) == Point{1.5, 2, 0});
  CHECK(place_point(line(5), named("middle")) == Point{3 * 0.4, 4 * 0.4, 0});
  CHECK(short_of_middle(line(2)) < 1e-11 * total_length(line(2)));
  CHECK(short_of_middle(line(5)) == Approx(0.1 * total_length(line(5))));
  CHECK_FALSE(has_middle(line(1)));
  CHECK_THROWS_WITH(place_point(line(1), named("middle")), Contains("expected a mesh of an even number of elements"));
  CHECK(place_point(corner(), named("middle")) == Point{1, 1, 0});
  const MeshSpec halves{{}, {}, {{0, 0, 0}, {0.3, 0, 0}, {0.6, 0, 0}}, {{0, 1}, {1, 2}}, {3, 7}, {}};
  CHECK(place_point(halves, named("middle")) == Point{0.3, 0, 0});
}

TEST_CASE("coordinates lead to the node within a millionth of its element") {
  CHECK(place_point(corner(), at(1, 0.5)) == Point{1, 0.5, 0});
  CHECK(place_point(corner(), at(1 + 4e-7, 0.5)) == Point{1, 0.5, 0});
  CHECK_THROWS_WITH(place_point(corner(), at(1 + 6e-7, 0.5)), Contains("the nearest node is at (1, 0.5)"));
  CHECK_THROWS_WITH(place_point(corner(), at(1, 0.7)),
                    "scene.yaml:3:4: probes.tip.at: no node of beam at (1, 0.7); "
                    "the nearest node is at (1, 0.5)");
  CHECK(nearest_node(corner(), {9, 9, 0}) == Point{1, 3, 0});
  const MeshSpec fine{{}, {}, {{0, 0, 0}, {1, 0, 0}}, {{0, 1}}, {100000000}, {}};
  CHECK(place_point(fine, at(0.33, 0))[0] == Approx(0.33).epsilon(1e-14));
}

TEST_CASE("names that the mesh has not are refused") {
  for (const char* name : {"p0", "p4", "p", "p1x", "p01", "p-1", "p99999999999999999999", "tip", ""}) {
    INFO(name);
    CHECK_THROWS_AS(place_point(corner(), named(name)), floe::InputError);
  }
  CHECK_THROWS_WITH(place_point(forked(), named("middle")), Contains("has no place \"middle\""));
  CHECK_THROWS_WITH(place_point(corner(), named("strat")), Contains("did you mean \"start\"?"));
}
