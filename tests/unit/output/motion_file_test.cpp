#include "floe/output/motion_file.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "floe/error.h"
#include "floe/output/reduced_file.h"
#include "floe/output/result_file.h"
#include "read_back.h"
#include "scratch.h"
#include "small_files.h"

using namespace floe;
using namespace floe::output;
using Catch::Contains;
using Eigen::Vector3d;

namespace {

constexpr int nodes = 7;

Vector3d undeformed(int n) { return {1.0 * n, 0.1 * n * n, n % 2 ? 0.5 : -0.5}; }
/// Dof d of node n in column j of the basis.
double basis(int j, int n, int d) { return 0.01 * (1 + j) * std::sin(1.0 + n + 3 * d + j); }

/// Nodes dealt to the ranks in turn, a line of cells on the last one.
ReducedShapes dealt() {
  int rank = 0, size = 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  ReducedShapes shapes;
  shapes.dofs_per_node = 6;
  shapes.parts = {"skin"};
  for (int n = nodes - 1; n >= 0; --n) {
    if (n % size != rank) continue;
    shapes.nodes.push_back(n);
    shapes.positions.push_back(undeformed(n));
  }
  for (int n = 0; rank == size - 1 && n + 1 < nodes; ++n)
    shapes.cells.push_back({ReducedShapes::Kind::line, 0, {n, n + 1, -1, -1}});
  shapes.column = [own = shapes.nodes](int j, std::span<double> values) {
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = basis(j, static_cast<int>(own[i / 6]), static_cast<int>(i % 6));
  };
  return shapes;
}

/// States of a run in space: (R, x, two coordinates of `arm`), then six dofs of each node of `full`, which stands
/// still.
std::vector<double> state(double t) {
  std::vector<double> U = {t, 2 * t, 3 * t, 0, 0, 0, std::sin(t), std::cos(t)};
  for (int i = 0; i < 6 * nodes; ++i) U.push_back(0.001 * t * i);
  return U;
}

Eigen::Quaterniond attitude(double t) { return Eigen::Quaterniond(Eigen::AngleAxisd(t, Vector3d(1, 2, 2) / 3)); }

/// Node 6 of `full` follows node 2.
int mover(int n) { return n == 6 ? 2 : n; }

/// Instants 0, 0.1 ... 1 of bodies `arm` (reduced) and `full` (of full order).
void write_run(const std::filesystem::path& folder) {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank == 0) std::filesystem::create_directories(folder);
  meet();
  ResultFile file(PETSC_COMM_WORLD, folder / "result.h5");
  file.write_text("summary",
                  R"({"formulation": "vm+md", "bodies": [{"name": "arm"}, {"name": "lost"}, {"name": "full"}]})");
  file.write_array("motion/dimension", {}, std::vector<double>{3});
  const ReducedShapes shapes = dealt();
  const std::vector<double> start = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, still = {5, 6, 7, 0, 1, 0, -1, 0, 0, 0, 0, 1};
  file.write_array("bodies/arm/columns_of_motion", {2}, std::vector<double>{0, 6});
  file.write_array("bodies/arm/frame_at_start", {4, 3}, start);
  file.write_shapes("bodies/arm/shapes", nodes, 2, shapes);
  file.write_array("bodies/lost/columns_of_motion", {2}, std::vector<double>{-1, -1});
  file.write_link("bodies/lost/shapes", folder / "nowhere.h5", "/shapes");
  file.write_array("bodies/full/columns_of_motion", {2}, std::vector<double>{-1, -1});
  file.write_array("bodies/full/frame_at_start", {4, 3}, still);
  file.write_shapes("bodies/full/shapes", nodes, 0, shapes);
  std::vector<double> rows;
  for (const std::int64_t n : shapes.nodes) {
    const int by = mover(static_cast<int>(n));
    const Vector3d arm = undeformed(static_cast<int>(n)) - undeformed(by);
    rows.insert(rows.end(), {8.0 + 6 * by, arm.x(), arm.y(), arm.z()});
  }
  file.write_of_nodes("bodies/full/nodes_of_motion", nodes, 4, shapes, rows);
  file.add_series("motion/t", 1, {}, 20);
  file.add_series("motion/U", 8 + 6 * nodes, {}, 20);
  file.add_series("motion/attitude", 4, {}, 20);
  file.publish();
  for (int i = 0; i <= 10; ++i) {
    const double t = 0.1 * i;
    const Eigen::Quaterniond q = attitude(t);
    file.append("motion/t", std::vector<double>{t});
    file.append("motion/U", state(t));
    file.append("motion/attitude", std::vector<double>{q.w(), q.x(), q.y(), q.z()});
  }
  file.finish();
}

Vector3d deformation_of_arm(int n, double t) {
  Vector3d u = Vector3d::Zero();
  for (int d = 0; d < 3; ++d) u[d] = basis(0, n, d) * std::sin(t) + basis(1, n, d) * std::cos(t);
  return attitude(t) * u;
}

Vector3d deformation_of_full(int n, double t) {
  const std::vector<double> U = state(t);
  const double* q = U.data() + 8 + 6 * mover(n);
  const Vector3d arm = undeformed(n) - undeformed(mover(n));
  const Vector3d u = Vector3d(q[0], q[1], q[2]) + Vector3d(q[3], q[4], q[5]).cross(arm);
  return {-u.y(), u.x(), u.z()};  // its axes: x is the world's y
}

void check(const Hid& file, const std::string& name, const std::function<Vector3d(int)>& expected) {
  const auto found = read_back(file, name);
  REQUIRE(found.shape == std::vector<hsize_t>{nodes, 3});
  for (int n = 0; n < nodes; ++n) CHECK((Eigen::Map<const Vector3d>(&found.data[3 * n]) - expected(n)).norm() < 1e-12);
}

}  // namespace

TEST_CASE("the motion of reduced bodies and of full order stands where its definition says") {
  const Scratch scratch;
  write_run(scratch / "run");
  MotionRequest request{scratch / "run", scratch / "m.xdmf", 3, 5, false};
  const MotionWritten written = write_motion(PETSC_COMM_WORLD, request);
  CHECK(written.bodies == std::vector<std::string>{"arm", "full"});
  CHECK(written.without == std::vector<std::string>{"lost"});
  CHECK(written.nodes == 2 * nodes);
  REQUIRE(written.t.size() == 5);
  CHECK(written.t.front() == 0);
  CHECK(written.t.back() == Approx(1));
  meet();
  const Hid file = open_plain((scratch / "m.h5").string());
  for (std::size_t f = 0; f < written.t.size(); ++f) {
    const double t = written.t[f];
    const std::string frame = "/frame_" + std::to_string(f + 1);
    check(file, "arm" + frame + "/deformation", [&](int n) { return deformation_of_arm(n, t); });
    check(file, "arm" + frame + "/positions", [&](int n) {
      return Vector3d(Vector3d(t, 2 * t, 3 * t) + attitude(t) * undeformed(n) + 3 * deformation_of_arm(n, t));
    });
    check(file, "full" + frame + "/positions", [&](int n) {
      const Vector3d X = undeformed(n);
      return Vector3d(Vector3d(5, 6, 7) + Vector3d(-X.y(), X.x(), X.z()) + 3 * deformation_of_full(n, t));
    });
  }
  CHECK(read_back(file, "arm/cells").data.size() == 4 * (nodes - 1));
  const std::string text = text_of(scratch / "m.xdmf");
  CHECK(text.find("CollectionType=\"Temporal\"") != std::string::npos);
  CHECK(text.find(">m.h5:/full/frame_5/positions<") != std::string::npos);
}

TEST_CASE("a motion replaces nothing unasked, and tells what it cannot read") {
  const Scratch scratch;
  write_run(scratch / "run");
  MotionRequest request{scratch / "run", scratch / "m.xdmf", 1, 2, false};
  write_motion(PETSC_COMM_WORLD, request);
  meet();
  CHECK_THROWS_WITH(write_motion(PETSC_COMM_WORLD, request), Contains("exists; use another name"));
  request.overwrite = true;
  CHECK(write_motion(PETSC_COMM_WORLD, request).t.size() == 2);
  request.frames = 0;
  CHECK(write_motion(PETSC_COMM_WORLD, request).t.size() == 11);
  request.results = scratch / "none";
  CHECK_THROWS_WITH(write_motion(PETSC_COMM_WORLD, request), Contains("none': is not there"));
  request.results = scratch / "run", request.xdmf = scratch / "m.vtu";
  CHECK_THROWS_WITH(write_motion(PETSC_COMM_WORLD, request), Contains("expected a name that ends in .xdmf"));
}
