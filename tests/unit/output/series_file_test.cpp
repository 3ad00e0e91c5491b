#include "floe/output/series_file.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "floe/error.h"
#include "scratch.h"
#include "small_files.h"

using namespace floe;
using namespace floe::output;
using Catch::Matchers::Contains;

TEST_CASE("a series file has units in its header and numbers that read back exactly") {
  Scratch scratch;
  const std::vector<double> values{1.0 / 3.0, -0.1, 1e-300, 6.02214076e23, std::nextafter(1.0, 2.0)};
  SeriesFile file(PETSC_COMM_WORLD, scratch / "probes.csv",
                  {{"a.x", "m"}, {"b", "rad"}, {"c", "N"}, {"d", "1"}, {"e", ""}});
  for (int i = 0; i < 3; ++i) file.row(0.1 * i, values);
  file.finish();
  std::istringstream lines(text_of(scratch / "probes.csv"));
  std::string line;
  std::getline(lines, line);
  CHECK(line == "t [s],a.x [m],b [rad],c [N],d [1],e []");
  for (int i = 0; i < 3; ++i) {
    std::getline(lines, line);
    std::istringstream cells(line);
    std::string cell;
    std::getline(cells, cell, ',');
    CHECK(std::strtod(cell.c_str(), nullptr) == 0.1 * i);
    for (const double value : values) {
      std::getline(cells, cell, ',');
      CHECK(std::strtod(cell.c_str(), nullptr) == value);
    }
  }
  CHECK_FALSE(std::getline(lines, line));
}

TEST_CASE("a series file holds whole lines before it is finished") {
  Scratch scratch;
  SeriesFile file(PETSC_COMM_WORLD, scratch / "probes.csv", {{"x", "m"}});
  for (int i = 0; i < 2500; ++i) file.row(i, std::vector<double>{1.5});
  meet();
  const std::string text = text_of(scratch / "probes.csv");
  CHECK(std::count(text.begin(), text.end(), '\n') == 2001);
  CHECK(text.back() == '\n');
  meet();
}

TEST_CASE("a series file says where the disk is full, and which row has the wrong length") {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  CHECK_THROWS_WITH(SeriesFile(PETSC_COMM_WORLD, "/dev/full", {{"x", "m"}}),
                    Contains("cannot write /dev/full: No space left on device"));
  CHECK_THROWS_AS(SeriesFile(PETSC_COMM_WORLD, "/nowhere/probes.csv", {{"x", "m"}}), RunError);
  Scratch scratch;
  SeriesFile file(PETSC_COMM_WORLD, scratch / "probes.csv", {{"x", "m"}});
  if (rank == 0) CHECK_THROWS_AS(file.row(0, std::vector<double>{1, 2}), std::invalid_argument);
}

TEST_CASE("a series file ends with a whole line when the disk is full") {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  Scratch scratch;
  SeriesFile file(PETSC_COMM_WORLD, scratch / "probes.csv", {{"x", "m"}});
  if (rank == 0) {
    const SmallFiles full(1003);
    const auto fill = [&] {
      for (int i = 0; i < 1000; ++i) file.row(i, std::vector<double>{1.5});
    };
    CHECK_THROWS_WITH(fill(), Contains("File too large"));
  }
  meet();
  const std::string text = text_of(scratch / "probes.csv");
  CHECK(text.size() > 980);
  CHECK(text.size() <= 1003);
  CHECK(text.back() == '\n');
  meet();
}
