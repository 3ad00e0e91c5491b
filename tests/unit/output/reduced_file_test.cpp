#include "floe/output/reduced_file.h"

#include <fmt/format.h>

#include <cstdlib>

#include "floe/body/elasticity.h"
#include "floe/error.h"
#include "floe/petsc/error.h"
#include "read_back.h"
#include "reduced_file_sample.h"
#include "scratch.h"
#include "small_files.h"

using namespace floe;
using namespace floe::output;
using Catch::Matchers::Contains;

TEST_CASE("a reduced body comes back to the bit on every rank") {
  const int d = GENERATE(2, 3), k = GENERATE(0, 1, 5);
  Scratch scratch;
  const auto path = scratch / "arm.h5";
  const ReducedBodyFile file = sample_body(d, k);
  write_reduced_body(PETSC_COMM_WORLD, path, file, false);
  check_same(read_reduced_body(PETSC_COMM_WORLD, path), file);
  CHECK_FALSE(std::filesystem::exists(scratch / ".arm.h5.partial"));
}

TEST_CASE("a reduced body without damping, places, columns and times") {
  Scratch scratch;
  ReducedBodyFile file = sample_body(2, 0);
  file.damping.resize(0, 0);
  file.places.clear(), file.columns.clear(), file.omega.clear(), file.residual.clear(), file.made = {};
  file.held = GENERATE(std::optional<std::vector<std::string>>(), std::vector<std::string>());  // older files; nothing
  write_reduced_body(PETSC_COMM_WORLD, scratch / "arm.h5", file, false);
  check_same(read_reduced_body(PETSC_COMM_WORLD, scratch / "arm.h5"), file);
}

TEST_CASE("a reduced body of the first version of the format, which has no W, is read") {
  Scratch scratch;
  ReducedBodyFile file = sample_body(3, 4);
  for (body::Inertia* inertia : {&file.body.inertia, &file.body.line}) inertia->W.clear(), inertia->Q.clear();
  file.places[1].map.Q.clear(), file.places[1].map.H.clear();
  file.version = 1, file.strain_rate_damping = 0;
  write_reduced_body(PETSC_COMM_WORLD, scratch / "arm.h5", file, false);
  check_same(read_reduced_body(PETSC_COMM_WORLD, scratch / "arm.h5"), file);
}

TEST_CASE("a reduced body of the second or third version of the format, without strain_rate_damping or Q, is read") {
  Scratch scratch;
  ReducedBodyFile file = sample_body(3, 4);
  for (body::Inertia* inertia : {&file.body.inertia, &file.body.line}) inertia->Q.clear();
  file.places[1].map.Q.clear(), file.places[1].map.H.clear();
  file.version = GENERATE(2, 3);
  if (file.version == 2) file.strain_rate_damping = 0;
  write_reduced_body(PETSC_COMM_WORLD, scratch / "arm.h5", file, false);
  check_same(read_reduced_body(PETSC_COMM_WORLD, scratch / "arm.h5"), file);
}

TEST_CASE("a reduced body with places whose displacements of second order are zero is read") {
  Scratch scratch;
  ReducedBodyFile file = sample_body(3, 4);
  if (GENERATE(false, true)) file.places[1].map.Q.clear();
  file.places[0].map.Q.assign(3, Eigen::MatrixXd::Constant(4, 4, GENERATE(0.0, -0.0)));
  write_reduced_body(PETSC_COMM_WORLD, scratch / "arm.h5", file, false);
  file.places[0].map.Q.clear();
  check_same(read_reduced_body(PETSC_COMM_WORLD, scratch / "arm.h5"), file);
}

TEST_CASE("what is written twice is the same file") {
  Scratch scratch;
  for (const char* name : {"a.h5", "b.h5"})
    write_reduced_body(PETSC_COMM_WORLD, scratch / name, sample_body(3, 4), false);
  CHECK(text_of(scratch / "a.h5") == text_of(scratch / "b.h5"));
}

TEST_CASE("datasets carry their units and the file its format") {
  Scratch scratch;
  write_reduced_body(PETSC_COMM_WORLD, scratch / "arm.h5", sample_body(2, 3), false);
  const Hid plain = open_plain(scratch / "arm.h5");
  CHECK(read_text(plain, "format", true) == "floe reduced body");
  for (const auto& [name, unit] : {std::pair("inertia/m", "kg"), std::pair("inertia/h", "kg^1/2 m"),
                                   std::pair("places/x", "m"), std::pair("frequencies/omega", "rad/s")}) {
    const Hid dataset(H5Dopen2(plain, name, H5P_DEFAULT), H5Dclose);
    CHECK(read_text(dataset, "unit", true) == unit);
  }
  CHECK(read_back(plain, "inertia/M").shape == std::vector<hsize_t>{2, 2, 3, 3});
}

// The example of the header, with the energy that body::energy gives.
TEST_CASE("NumPy reads a reduced body with h5py") {
  Scratch scratch;
  const ReducedBodyFile file = sample_body(3, 4);
  write_reduced_body(PETSC_COMM_WORLD, scratch / "arm.h5", file, false);
  if (scratch.rank() != 0) return;
  const Eigen::VectorXd q = Eigen::VectorXd::LinSpaced(4, 0.25, 1);
  Eigen::Vector3d u = file.places[1].map.S * q;
  REQUIRE(!file.places[1].map.Q.empty());  // a place at an arm
  Eigen::Vector3d b = file.places[1].map.psi * q;
  const Eigen::Vector3d first = b;
  for (int a = 0; a < 3; ++a) {
    u[a] += 0.5 * q.dot(file.places[1].map.Q[a] * q);
    b[a] += 0.5 * first.dot(file.places[1].map.H[a] * first);
  }
  std::ofstream(scratch / "read.py") << fmt::format(R"(import h5py, numpy as np
q = np.linspace(0.25, 1, 4)
f = h5py.File("{}"); F = f["elasticity/F"][:]; pairs = f["elasticity/pairs"][:]
s = np.array([q[a] * q[b] * (0.5 if a == b else 1) for a, b in pairs])
U = 0.5 * q @ f["elasticity/bending"][:] @ q + 0.5 * np.sum((F @ np.r_[q, s])**2)
place = list(f["places/names"].asstr()).index("root/left")
u = f["places/S"][place] @ q
if "places/Q" in f: u += 0.5 * q @ f["places/Q"][place] @ q
b = f["places/psi"][place] @ q
if "places/H" in f: b = b + 0.5 * b @ f["places/H"][place] @ b
assert np.allclose(b, [{:.17g}, {:.17g}, {:.17g}], rtol=1e-12), b
assert abs(U / {:.17g} - 1) < 1e-12 and np.allclose(u, [{:.17g}, {:.17g}, {:.17g}], rtol=1e-12), (U, u)
assert f["body/name"].asstr()[()] == "ärm" and f.attrs["version"] == 5 and f.attrs["complete"] == 1
)",
                                                    (scratch / "arm.h5").string(), b[0], b[1], b[2],
                                                    body::energy(file.body.elasticity, q), u[0], u[1], u[2]);
  CHECK(std::system(("/usr/bin/python3 " + (scratch / "read.py").string()).c_str()) == 0);
}

TEST_CASE("a reduced body is told in a page") {
  const ReducedBodyFile file = sample_body(2, 5);
  const std::string text = describe(file);
  for (const char* part : {"ärm, 2 dimensions", "36 dofs, 12 nodes, 11 elements", "x along (0.6, 0.8)",
                           "modes       constrained by fixed at tip, revolute about z at root/left",
                           "5 coordinates of 7 candidate vectors", "8 squares of 5 coordinates and 6 of 13 products",
                           "damping     yes", "floe 0.1.0 (abc123)", "3 ranks", "1.25 s modes",
                           "dropped     attachment root.moment (repeats tip.moment)", "root/left"})
    CHECK_THAT(text, Contains(part));
  CHECK_THAT(text, Contains("1.59155"));  // 10 rad/s over 2 pi
  // numbers: twice 1+2+4+10+4(5+25) inertia, 25 + 8*11 elastic, 25 damping, 3(2+10+5) places; 6 pairs of two int
  CHECK(online_bytes(file) == 8 * (2 * (137 + 100 + 50) + 25 + 88 + 25 + 51 + 50) + 48);
}

TEST_CASE("what is not to be replaced is refused, and replaced when asked") {
  Scratch scratch;
  const auto path = scratch / "arm.h5";
  write_reduced_body(PETSC_COMM_WORLD, path, sample_body(2, 2), false);
  const auto again = [&](bool overwrite) { write_reduced_body(PETSC_COMM_WORLD, path, sample_body(2, 3), overwrite); };
  CHECK_THROWS_WITH(again(false), Contains("reduced body '" + path.string() + "': exists") && Contains("--force"));
  CHECK_THROWS_AS(again(false), InputError);
  CHECK_THROWS_AS(check_reduced_path(PETSC_COMM_WORLD, path, false), InputError);
  CHECK_NOTHROW(check_reduced_path(PETSC_COMM_WORLD, path, true));
  check_same(read_reduced_body(PETSC_COMM_WORLD, path), sample_body(2, 2));
  again(true);
  check_same(read_reduced_body(PETSC_COMM_WORLD, path), sample_body(2, 3));
  const std::filesystem::path folder = scratch;
  CHECK_THROWS_WITH(write_reduced_body(PETSC_COMM_WORLD, folder, sample_body(2, 2), true), Contains("not a file"));
  CHECK_THROWS_AS(check_reduced_path(PETSC_COMM_WORLD, scratch / "missing/arm.h5", false), InputError);
}

TEST_CASE("a file that is no reduced body is never replaced") {
  Scratch scratch;
  const auto path = scratch / "scene.yaml";
  floe::petsc::agree(PETSC_COMM_WORLD, [&] {
    int rank = 0;
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    if (rank == 0) std::ofstream(path) << "mine";
  });
  CHECK_THROWS_WITH(check_reduced_path(PETSC_COMM_WORLD, path, true),
                    Contains("is not a reduced body written by floe"));
  CHECK_THROWS_AS(write_reduced_body(PETSC_COMM_WORLD, path, sample_body(2, 2), true), InputError);
  CHECK(text_of(path) == "mine");
}

TEST_CASE("a reduced body that cannot be written leaves what was there") {
  Scratch scratch;
  const auto path = scratch / "arm.h5";
  write_reduced_body(PETSC_COMM_WORLD, path, sample_body(2, 2), false);
  const std::string before = text_of(path);
  const auto write = [&](const ReducedBodyFile& file) { write_reduced_body(PETSC_COMM_WORLD, path, file, true); };
  {
    SmallFiles full(4096);
    CHECK_THROWS_WITH(write(sample_body(3, 9)), Contains("cannot write " + path.string() + ": File too large"));
    CHECK_THROWS_AS(write(sample_body(3, 9)), RunError);
  }
  ReducedBodyFile bad = sample_body(2, 2);
  bad.body.inertia.M[0][1](1, 0) = NAN;
  CHECK_THROWS_WITH(write(bad),
                    Contains("cannot write " + path.string()) && Contains("'inertia/M'") && Contains("nan"));
  bad = sample_body(2, 2);
  bad.places[1].map.S.resize(2, 3);
  CHECK_THROWS_WITH(write(bad), Contains("places/S"));
  bad = sample_body(2, 2);
  bad.columns[0].kept = false;
  CHECK_THROWS_AS(write(bad), RunError);
  CHECK_THROWS_WITH(write_reduced_body(PETSC_COMM_WORLD, "/proc/self/arm.h5", sample_body(2, 2), false),
                    Contains("cannot write /proc/self/arm.h5: "));
  meet();
  CHECK(text_of(path) == before);
  CHECK(std::distance(std::filesystem::directory_iterator(scratch), {}) == 1);
}
