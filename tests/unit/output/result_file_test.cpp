#include "floe/output/result_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "floe/error.h"
#include "floe/petsc/error.h"
#include "read_back.h"
#include "scratch.h"
#include "small_files.h"

using namespace floe;
using namespace floe::output;
using Catch::Matchers::Contains;

namespace {

/// Rank r has r + 1 rows (rank 1 none) of a matrix with entries 10 row + column.
struct Part {
  std::int64_t first = 0, rows = 0, global = 0;
};

Part part() {
  int rank = 0, size = 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  Part mine;
  for (int r = 0; r < size; ++r) {
    const std::int64_t rows = r == 1 ? 0 : r + 1;
    if (r < rank) mine.first += rows;
    if (r == rank) mine.rows = rows;
    mine.global += rows;
  }
  return mine;
}

std::vector<double> entries(const Part& mine, std::int64_t columns) {
  std::vector<double> all;
  for (std::int64_t i = 0; i < mine.rows; ++i)
    for (std::int64_t j = 0; j < columns; ++j) all.push_back(10.0 * (mine.first + i) + j);
  return all;
}

}  // namespace

TEST_CASE("texts, arrays and distributed rows come back with their labels") {
  Scratch scratch;
  const Part mine = part();
  ResultFile file(PETSC_COMM_WORLD, scratch / "result.h5");
  file.write_text("scene", "bodies: ...");
  file.write_text("scene", "bodies: [ärm]\n");
  file.write_text("empty", "");
  file.write_array("arm/frequencies", {2}, std::vector<double>{1.5, 2.5}, {"Hz", "of the body as its joints hold it"});
  file.write_array("arm/number", {}, std::vector<double>{7});
  file.write_array("arm/none", {0, 3}, {});
  file.write_distributed_rows("arm/basis", mine.global, 3, mine.first, entries(mine, 3), {"m", ""});
  meet();
  CHECK_FALSE(std::filesystem::exists(scratch / "result.h5"));
  meet();
  file.publish();
  const Hid plain = open_plain(scratch / "result.h5");
  CHECK(read_text(plain, "scene", false) == "bodies: [ärm]\n");
  CHECK(read_text(plain, "empty", false) == std::string(1, '\0'));
  const auto frequencies = read_back(plain, "arm/frequencies");
  CHECK((frequencies.shape == std::vector<hsize_t>{2} && frequencies.data == std::vector<double>{1.5, 2.5}));
  CHECK(read_back(plain, "arm/number").data == std::vector<double>{7});
  CHECK(read_back(plain, "arm/none").shape == std::vector<hsize_t>{0, 3});
  const auto basis = read_back(plain, "arm/basis");
  CHECK(basis.shape == std::vector<hsize_t>{hsize_t(mine.global), 3});
  CHECK(basis.data == entries({0, mine.global, mine.global}, 3));
  const Hid dataset(H5Dopen2(plain, "arm/frequencies", H5P_DEFAULT), H5Dclose);
  CHECK(read_text(dataset, "unit", true) == "Hz");
  CHECK(read_text(dataset, "description", true) == "of the body as its joints hold it");
}

TEST_CASE("series grow over their room, replicated and distributed, and end with their rows") {
  Scratch scratch;
  const Part mine = part();
  ResultFile file(PETSC_COMM_WORLD, scratch / "result.h5");
  file.add_series("t", 1, {"s", ""}, 4);
  file.add_series("motion/q", 3);
  file.add_series("motion/u", mine.global, {"m", "nodal"}, 2);
  file.publish();
  std::vector<double> expected, expected_u;
  for (int i = 0; i < 137; ++i) {
    const std::vector<double> row{i + 0.1, i + 0.2, i + 0.3};
    file.append("t", std::span(row).first(1));
    file.append("motion/q", row);
    std::vector<double> u(mine.rows);
    for (std::int64_t j = 0; j < mine.rows; ++j) u[j] = 1000.0 * i + mine.first + j;
    file.append_distributed("motion/u", mine.first, u);
    for (std::int64_t j = 0; j < mine.global; ++j) expected_u.push_back(1000.0 * i + j);
    expected.insert(expected.end(), row.begin(), row.end());
    if (i % 10 == 9) file.flush();
    if (i == 70) {
      file.write_text("note", "half");
      file.publish();
    }
  }
  file.finish();
  const Hid plain = open_plain(scratch / "result.h5");
  CHECK(read_back(plain, "t").shape == std::vector<hsize_t>{137, 1});
  CHECK(read_back(plain, "motion/q").data == expected);
  CHECK(read_back(plain, "motion/u").shape == std::vector<hsize_t>{137, hsize_t(mine.global)});
  CHECK(read_back(plain, "motion/u").data == expected_u);
  CHECK(read_text(plain, "note", false) == "half");
  CHECK_FALSE(std::filesystem::exists(scratch / ".result.h5.partial"));
}

TEST_CASE("rows that wait are in the file once it is saved, for a run that is killed then") {
  Scratch scratch;
  const bool alone = GENERATE(false, true);
  const Part mine = part();
  ResultFile file(PETSC_COMM_WORLD, scratch / "result.h5");
  file.add_series("t", 1, {}, 8);
  if (!alone) file.add_series("motion/u", mine.global, {}, 8);
  file.publish();
  std::vector<double> expected, expected_u;
  for (int i = 0; i < 3; ++i) {
    file.append("t", std::vector<double>{i + 0.5});
    expected.push_back(i + 0.5);
    if (alone) continue;
    std::vector<double> u(mine.rows, 100.0 + i);
    file.append_distributed("motion/u", mine.first, u);
    expected_u.insert(expected_u.end(), mine.global, 100.0 + i);
  }
  file.save(alone);
  meet();
  const auto begin_of = [](const std::vector<double>& all, const std::vector<double>& part) {
    return std::vector<double>(all.begin(),
                               all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), part.size())));
  };
  const Hid plain = open_plain(scratch / "result.h5");
  CHECK(begin_of(read_back(plain, "t").data, expected) == expected);
  if (!alone) CHECK(begin_of(read_back(plain, "motion/u").data, expected_u) == expected_u);
}

TEST_CASE("a reader that holds the file open does not stop the run") {
  Scratch scratch;
  ResultFile file(PETSC_COMM_WORLD, scratch / "result.h5");
  file.add_series("q", 1, {}, 8);
  file.publish();
  const int reader = open((scratch / "result.h5").c_str(), O_RDONLY);
  REQUIRE(flock(reader, LOCK_SH) == 0);  // as HDF5 locks what it opens to read
  for (int i = 0; i < 8; ++i) file.append("q", std::vector<double>{1.0 * i});
  CHECK_NOTHROW(file.flush());
  close(reader);
}

TEST_CASE("a disk that fills up is told with the path, and what was written stays") {
  Scratch scratch;
  ResultFile file(PETSC_COMM_WORLD, scratch / "result.h5");
  file.add_series("q", 100, {}, 16);
  file.publish();
  const std::vector<double> row(100, 1.25);
  for (int i = 0; i < 16; ++i) file.append("q", row);
  file.flush();
  const auto size = std::filesystem::file_size(scratch / "result.h5");
  {
    SmallFiles full(size + 4096);
    file.append("q", row);
    CHECK_THROWS_WITH(file.flush(), Contains("cannot write") && Contains("result.h5") && Contains("File too large"));
  }
  {
    const Hid plain = open_plain(scratch / "result.h5");
    CHECK(read_back(plain, "q").data == std::vector<double>(1600, 1.25));
  }
  meet();
  file.finish();
  const Hid plain = open_plain(scratch / "result.h5");
  CHECK(read_back(plain, "q").data == std::vector<double>(1700, 1.25));
}

TEST_CASE("a result file refuses what does not fit") {
  Scratch scratch;
  CHECK_THROWS_WITH(ResultFile(PETSC_COMM_WORLD, "/nowhere/result.h5"), Contains("cannot write /nowhere/result.h5"));
  ResultFile file(PETSC_COMM_WORLD, scratch / "result.h5");
  CHECK_THROWS_AS(file.write_array("a", {2, 2}, std::vector<double>(3)), std::invalid_argument);
  CHECK_THROWS_AS(file.write_distributed_rows("b", 1, 3, 1, std::vector<double>(3)), RunError);
  CHECK_THROWS_AS(file.add_series("c", 0), std::invalid_argument);
  file.add_series("q", 2);
  if (scratch.rank() == 0) CHECK_THROWS_AS(file.append("q", std::vector<double>(2)), std::logic_error);
  file.publish();
  if (scratch.rank() == 0) CHECK_THROWS_AS(file.append("q", std::vector<double>(3)), std::invalid_argument);
  if (scratch.rank() == 0) CHECK_THROWS_AS(file.append("p", std::vector<double>(2)), std::invalid_argument);
}
