#include "floe/output/checkpoint_file.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "floe/error.h"
#include "scratch.h"

using namespace floe;

namespace {

int rank() {
  int number = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &number);
  return number;
}

output::Checkpoint sample() {
  output::Checkpoint checkpoint;
  checkpoint.words = {{"t", 0.1}, {"step", 7}};
  checkpoint.shared["numbers"] = {1.0 / 3, -0.0, 1e-300};
  checkpoint.shared["none"] = {};
  checkpoint.own["part"] = std::vector<double>(rank(), 1.5 + rank());  // none on rank 0
  checkpoint.own["all"] = {10.0 + rank(), 1.0 / 7};
  return checkpoint;
}

void change(const std::filesystem::path& path, std::streamoff at, char to) {
  if (rank() == 0) {
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(at, at < 0 ? std::ios::end : std::ios::beg);
    file.put(to);
  }
  MPI_Barrier(PETSC_COMM_WORLD);
}

}  // namespace

TEST_CASE("a checkpoint gives every rank its numbers back, to the bit") {
  const Scratch scratch;
  const auto path = scratch / "checkpoint.h5";
  const output::Checkpoint written = sample();
  for (int twice = 0; twice < 2; ++twice) output::write_checkpoint(PETSC_COMM_WORLD, path, written);
  const output::Checkpoint read = output::read_checkpoint(PETSC_COMM_WORLD, path);
  CHECK(read.words == written.words);
  CHECK(read.shared == written.shared);
  CHECK(read.own == written.own);
}

TEST_CASE("a checkpoint that one rank wrote is everybody's") {
  const Scratch scratch;
  const auto path = scratch / "checkpoint.h5";
  if (rank() == 0) output::write_checkpoint(PETSC_COMM_SELF, path, sample());
  MPI_Barrier(PETSC_COMM_WORLD);
  CHECK(output::read_checkpoint(PETSC_COMM_WORLD, path).own.at("all").front() == 10);
}

TEST_CASE("what is no whole checkpoint is refused") {
  const Scratch scratch;
  const auto path = scratch / "checkpoint.h5";
  const auto read = [&] { return output::read_checkpoint(PETSC_COMM_WORLD, path); };
  CHECK_THROWS_WITH(read(), Catch::Contains("does not exist"));
  output::write_checkpoint(PETSC_COMM_WORLD, path, sample());
  std::uintmax_t size = std::filesystem::file_size(path);
  MPI_Barrier(PETSC_COMM_WORLD);
  SECTION("cut") {
    if (rank() == 0) std::filesystem::resize_file(path, size / 2);
    MPI_Barrier(PETSC_COMM_WORLD);
    CHECK_THROWS_AS(read(), InputError);
  }
  SECTION("changed") {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    const double third = 1.0 / 3;
    const auto at = bytes.find(std::string(reinterpret_cast<const char*>(&third), sizeof third));
    REQUIRE(at != std::string::npos);
    MPI_Barrier(PETSC_COMM_WORLD);
    change(path, static_cast<std::streamoff>(at), 'x');
    CHECK_THROWS_WITH(read(), Catch::Contains("damaged"));
  }
  SECTION("something else") {
    change(path, 0, 'x');
    CHECK_THROWS_WITH(read(), Catch::Contains("is not a checkpoint"));
  }
}
