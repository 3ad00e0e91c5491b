// Files that are not, or not wholly, a reduced body: one line, the same on every rank.
#include <cmath>
#include <functional>

#include "floe/error.h"
#include "floe/output/reduced_file.h"
#include "floe/output/result_file.h"
#include "read_back.h"
#include "reduced_file_sample.h"
#include "scratch.h"

using namespace floe;
using namespace floe::output;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

void check_refused(const fs::path& path, const std::string& why) {
  INFO(why);
  try {
    read_reduced_body(PETSC_COMM_WORLD, path);
    FAIL("accepted");
  } catch (const InputError& error) {
    CHECK_THAT(error.what(), Contains("reduced body '" + path.string() + "'") && Contains(why) && !Contains("\n"));
  }
}

void put(const Scratch& scratch, const fs::path& path, const std::string& text) {
  meet();
  if (scratch.rank() == 0) std::ofstream(path, std::ios::binary) << text;
  meet();
}

using Change = std::function<void(hid_t)>;

/// Rank 0 changes the file by hand.
void tamper(const Scratch& scratch, const fs::path& path, const Change& change) {
  meet();
  if (scratch.rank() == 0) {
    const Hid file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    change(file);
  }
  meet();
}

template <class Number>
void set_first(hid_t file, const char* name, std::vector<Number> first) {
  const hid_t type = std::is_same_v<Number, double> ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
  const Hid dataset(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose), space(H5Dget_space(dataset), H5Sclose);
  std::vector<Number> all(H5Sget_simple_extent_npoints(space));
  check_hdf5(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()));
  std::copy(first.begin(), first.end(), all.begin());
  check_hdf5(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()));
}

void set_flag(hid_t file, const char* name, std::int64_t value) {
  const Hid flag(H5Aopen(file, name, H5P_DEFAULT), H5Aclose);
  check_hdf5(H5Awrite(flag, H5T_NATIVE_INT64, &value));
}

void replace(hid_t file, const char* name, std::vector<hsize_t> shape, hid_t type) {
  check_hdf5(H5Ldelete(file, name, H5P_DEFAULT));
  const Hid space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  const Hid how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  check_hdf5(H5Pset_alloc_time(how, H5D_ALLOC_TIME_EARLY));
  Hid(H5Dcreate2(file, name, type, space, H5P_DEFAULT, how, H5P_DEFAULT), H5Dclose);
}

const std::vector<std::pair<Change, std::string>>& changes() {
  using Integers = std::vector<std::int64_t>;
  using Doubles = std::vector<double>;
  static const std::vector<std::pair<Change, std::string>> all = {
      {[](hid_t f) {
         set_first<double>(f, "elasticity/F", {1, NAN});
       },
       "dataset 'elasticity/F': expected any x 11 finite numbers, found nan at entry 1"},
      {[](hid_t f) { set_first<double>(f, "places/S", {INFINITY}); }, "'places/S': expected 3 x 2 x 5 finite numbers"},
      {[](hid_t f) {
         set_first(f, "elasticity/pairs", Integers{0, 5});
       },
       "expected pairs 0 <= a <= b < 5, found (0, 5)"},
      {[](hid_t f) {
         set_first(f, "elasticity/pairs", Integers{-1, 2});
       },
       "found (-1, 2) at row 0"},
      {[](hid_t f) {
         set_first(f, "elasticity/pairs", Integers{2, 0});
       },
       "found (2, 0) at row 0"},
      {[](hid_t f) {
         set_first(f, "elasticity/pairs", Integers{0, 2, 0, 0});
       },
       "ascending order, each once"},
      {[](hid_t f) {
         set_first(f, "elasticity/pairs", Integers{0, 0, 0, 0});
       },
       "(0, 0) before (0, 0)"},
      {[](hid_t f) { set_first(f, "columns/kept", Integers{0}); },
       "'columns/kept': expected 5 candidate vectors kept, found 4"},
      {[](hid_t f) { set_first(f, "body/dimension", Integers{4}); }, "'body/dimension': expected a number from 2 to 3"},
      {[](hid_t f) { set_first(f, "frame/axes", Doubles{1}); }, "'frame/axes': expected a rotation"},
      {[](hid_t f) { set_first(f, "inertia/m", Doubles{-1}); }, "'inertia/m': expected a positive mass, found -1"},
      {[](hid_t f) { check_hdf5(H5Ldelete(f, "line/h", H5P_DEFAULT)); }, "'line/h': expected a dataset, found none"},
      {[](hid_t f) { check_hdf5(H5Ldelete(f, "made", H5P_DEFAULT)); }, "dataset 'made/version': expected a dataset"},
      {[](hid_t f) {
         replace(f, "inertia/S", {2, 4}, H5T_IEEE_F64LE);
       },
       "'inertia/S': expected 2 x 5 finite numbers, found 2 x 4"},
      {[](hid_t f) {
         replace(f, "inertia/S", {2, 5}, H5T_STD_I64LE);
       },
       "'inertia/S': expected 2 x 5 finite numbers"},
      {[](hid_t f) {
         replace(f, "damping", {2, 2}, H5T_IEEE_F64LE);
       },
       "'damping': expected 5 x 5 numbers or none"},
      {[](hid_t f) { replace(f, "places/names", {3}, H5T_IEEE_F64LE); }, "'places/names': expected texts"},
      {[](hid_t f) { replace(f, "frequencies/residual", {2}, H5T_IEEE_F64LE); }, "found 2"},
      {[](hid_t f) { set_first(f, "elasticity/F", Doubles{1.5}); }, "the file is damaged"},
      {[](hid_t f) { set_first(f, "made/ranks", Integers{7}); }, "the file is damaged"},
      {[](hid_t f) { set_first(f, "strain_rate_damping", Doubles{-1}); },
       "'strain_rate_damping': expected 0, or a positive number with a damping matrix, found -1"},
      {[](hid_t f) { set_flag(f, "version", 6); }, "expected version 1 to 5 of the format, found version 6"},
      {[](hid_t f) { set_flag(f, "complete", 0); }, "whose writing was broken off"},
      {[](hid_t f) { check_hdf5(H5Adelete(f, "format")); }, "found an HDF5 file of another kind"},
  };
  return all;
}

}  // namespace

TEST_CASE("a reduced body that was changed by hand is refused by the dataset's name") {
  Scratch scratch;
  const auto path = scratch / "arm.h5";
  for (const auto& [change, why] : changes()) {
    write_reduced_body(PETSC_COMM_WORLD, path, sample_body(2, 5), true);
    tamper(scratch, path, change);
    check_refused(path, why);
  }
}

TEST_CASE("line ends in what a reduced body holds do not break the message") {
  Scratch scratch;
  const auto path = scratch / "arm.h5";
  ReducedBodyFile file = sample_body(2, 5);
  file.columns.front().kind = "mode\n=";
  CHECK_THROWS_WITH(write_reduced_body(PETSC_COMM_WORLD, path, file, true),
                    Catch::EndsWith("expected mode, derivative or attachment, found 'mode?='"));
}

TEST_CASE("files of another kind are refused") {
  Scratch scratch;
  check_refused(scratch / "missing.h5", "does not exist");
  const fs::path folder = scratch;
  check_refused(folder, "is not a file");
  put(scratch, scratch / "text", "bodies: {}\n");
  check_refused(scratch / "text", "expected a complete HDF5 file");
  put(scratch, scratch / "empty", "");
  check_refused(scratch / "empty", "expected a complete HDF5 file");
  ResultFile result(PETSC_COMM_WORLD, scratch / "result.h5");
  result.write_array("q", {1}, std::vector<double>{1});
  result.publish();
  check_refused(scratch / "result.h5", "expected a reduced body (attribute 'format' = 'floe reduced body')");
}

TEST_CASE("a reduced body that was cut off anywhere is refused") {
  Scratch scratch;
  write_reduced_body(PETSC_COMM_WORLD, scratch / "whole.h5", sample_body(3, 3), false);
  const std::string whole = text_of(scratch / "whole.h5");
  for (std::size_t size = 1; size < whole.size(); size += whole.size() / 37) {
    put(scratch, scratch / "cut.h5", whole.substr(0, size));
    check_refused(scratch / "cut.h5", "expected a complete HDF5 file");
  }
  put(scratch, scratch / "cut.h5", whole.substr(0, whole.size() - 1));
  check_refused(scratch / "cut.h5", "expected a complete HDF5 file");
}
