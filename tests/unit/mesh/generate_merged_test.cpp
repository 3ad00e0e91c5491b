#include "generated.h"

using namespace floe;
using Catch::Matchers::Contains;
using mesh::RawMesh;

namespace {

const generate::Plate unit{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 8, 4};

RawMesh frame(MPI_Comm comm, double shift, PetscInt elements = 8) {
  return generate::polyline(comm, {{{0, 0.5 + shift, 0}, {2, 0.5 + shift, 0}, {2, 0.5 + shift, 1}},
                                   {{0, 1}, {1, 2}},
                                   {elements, 3},
                                   {"stiffener", "post"}});
}

}  // namespace

TEST_CASE("a beam joins the nodes of a plate that it runs along") {
  for (const double shift : {0., 0.9e-3}) {
    const auto make = [&](MPI_Comm comm) {
      return generate::merged(generate::plate(comm, unit), frame(comm, shift), {{"plate", "stiffener"}}, 1e-3);
    };
    const auto all = testing::sound(make);
    CHECK(all.positions.size() == 9 * 5 + 3);  // only the post has nodes of its own
    CHECK(all.cells.size() == 8 * 4 * 2 + 11);
    CHECK(all.parts == std::vector<std::string>{"plate", "stiffener", "post"});
    const auto raw = make(PETSC_COMM_WORLD);
    CHECK(testing::measure(raw, 0) == Approx(2));
    CHECK(testing::measure(raw, 1) == Approx(2));
    CHECK(testing::measure(raw, 2) == Approx(1).epsilon(1e-5));
    CHECK(all.at(*all.places.at("start").begin()) == Eigen::Vector3d(0, 0.5, 0));
    CHECK(all.places.at("p1") == std::set<PetscInt>{0, *all.places.at("start").begin()});  // of both meshes
    CHECK(all.at(*all.places.at("end").begin())[2] == 1);
  }
}

TEST_CASE("nodes outside the seam or the tolerance stay apart") {
  const auto ends =
      generate::merged(generate::plate(PETSC_COMM_WORLD, unit), frame(PETSC_COMM_WORLD, 0), {{"left", "start"}}, 1e-9);
  CHECK(ends.node_count == 45 + 12 - 1);
  const auto half = generate::merged(generate::plate(PETSC_COMM_WORLD, unit), frame(PETSC_COMM_WORLD, 0, 5),
                                     {{"plate", "stiffener"}}, 1e-9);
  CHECK(half.node_count == 45 + 9 - 2);
  const auto apart = generate::merged(generate::plate(PETSC_COMM_WORLD, unit), frame(PETSC_COMM_WORLD, 0), {}, 1e-9);
  CHECK(mesh::inspect(apart).component_count == 2);
}

TEST_CASE("of several nodes within the tolerance the nearest is joined, wherever the boxes of the grid lie") {
  for (const double offset : {0., -7.3, 1e3}) {
    for (const double tolerance : {0.02, 0.1, 0.12}) {  // cells are 0.25 long
      generate::Plate moved = unit;
      moved.origin = {offset + 0.01, offset - 0.01, offset};
      generate::Plate there = unit;
      there.origin = Eigen::Vector3d::Constant(offset);
      const auto all =
          testing::whole(generate::merged(generate::plate(PETSC_COMM_WORLD, there),
                                          generate::prefixed(generate::plate(PETSC_COMM_WORLD, moved), "second."),
                                          {{"plate", "second.plate"}}, tolerance));
      CHECK(all.positions.size() == 45);
      CHECK(all.places.at("second.left") == all.places.at("left"));
      CHECK(all.places.at("second.p3") == all.places.at("p3"));
    }
  }
}

TEST_CASE("a scaled mesh has its lengths times the factor") {
  const auto raw = generate::scaled(generate::plate(PETSC_COMM_WORLD, unit), 1e-3);
  CHECK(testing::measure(raw, 0) == Approx(2e-6));
  for (const double factor : {0., -1., std::nan("")})
    CHECK_THAT(testing::fault_of([&] { generate::scaled(raw, factor); }), Contains("scaled: factor"));
}

TEST_CASE("meshes that cannot be merged are refused") {
  const auto fault = [](const generate::Seam& seam, double tolerance, PetscInt elements = 8) {
    return testing::fault_of([&] {
      generate::merged(generate::plate(PETSC_COMM_WORLD, unit), frame(PETSC_COMM_WORLD, 0, elements), {seam},
                       tolerance);
    });
  };
  CHECK_THAT(fault({"plat", "stiffener"}, 1e-6), Contains("plate: there is no place or part 'plat'"));
  CHECK_THAT(fault({"plate", "beam"}, 1e-6), Contains("polyline: there is no place or part 'beam'"));
  CHECK_THAT(fault({"left", "end"}, 1e-6), Contains("no node of 'end' is within the tolerance"));
  CHECK_THAT(fault({"plate", "stiffener"}, 0), Contains("tolerance = 0"));
  CHECK(fault({"plate", "stiffener"}, 0.1, 40) ==
        "merged: two nodes are within the tolerance of node 19 of plate: choose a smaller one");
}
