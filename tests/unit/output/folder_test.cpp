#include "floe/output/folder.h"

#include <catch2/catch.hpp>

#include "floe/error.h"
#include "floe/output/summary.h"
#include "scratch.h"
#include "small_files.h"

using namespace floe;
using namespace floe::output;
using Catch::Matchers::Contains;

namespace {

void put(const Scratch& scratch, const std::filesystem::path& path, const std::string& text) {
  if (scratch.rank() == 0) std::ofstream(path) << text;
  meet();
}

}  // namespace

TEST_CASE("a result folder is made with its parents") {
  Scratch scratch;
  {
    const auto folder = prepare_folder(PETSC_COMM_WORLD, scratch / "a/b/c", false);
    CHECK(std::filesystem::is_directory(scratch / "a/b/c"));
    CHECK(std::filesystem::exists(scratch / "a/b/c/.floe.lock"));  // its claim, and nothing else
    CHECK(std::distance(std::filesystem::directory_iterator(scratch / "a/b/c"), {}) == 1);
    CHECK(folder.result() == scratch / "a/b/c/result.h5");
    meet();
    CHECK_NOTHROW(prepare_folder(PETSC_COMM_WORLD, scratch / "a/b/c", false));  // this process has it already
    meet();
  }
  meet();
  CHECK(std::filesystem::is_empty(scratch / "a/b/c"));
  meet();
  CHECK_NOTHROW(prepare_folder(PETSC_COMM_WORLD, scratch / "a/b/c", false));
}

TEST_CASE("a folder that holds something is replaced only when asked, only what is ours in it, and not at once") {
  Scratch scratch;
  const std::string own = R"({"provenance": {"floe": {"version": "1"}}})";
  put(scratch, scratch / "summary.json", own);
  put(scratch, scratch / "probes.csv", "t [s],tip.x [m]\n");
  put(scratch, scratch / ".result.h5.partial", "old");
  put(scratch, scratch / "notes.txt", "mine");
  put(scratch, scratch / "photo.png", "mine");
  CHECK_THROWS_WITH(prepare_folder(PETSC_COMM_WORLD, scratch, false), Contains("not empty") && Contains("--force"));
  meet();
  const ResultFolder folder = prepare_folder(PETSC_COMM_WORLD, scratch, true);
  CHECK(text_of(scratch / "summary.json") == own);
  meet();
  remove_replaced(PETSC_COMM_WORLD, folder);
  for (const char* name : {"summary.json", "probes.csv", ".result.h5.partial"}) {
    INFO(name);
    CHECK_FALSE(std::filesystem::exists(scratch / name));
  }
  CHECK(text_of(scratch / "notes.txt") == "mine");
  CHECK(text_of(scratch / "photo.png") == "mine");
}

TEST_CASE("drafts of a killed run go when it is taken up, not when its folder is opened; other files stay") {
  Scratch scratch;
  // of MPI's files beside an open one, too
  const std::vector<const char*> drafts = {".result.h5.partial",
                                           ".motion.xdmf.partial",
                                           "..motion.xdmf.partial.partial",
                                           ".result.h5.partial-1954938881-6268.lock",
                                           "result.h5-1954938881-6268.lock",
                                           ".result.h5.partial.locktest.1"};
  const std::vector<const char*> others = {"result.h5", ".notes.partial", ".tradeoff.png.partial",
                                           "result.h5-mine.lock", "result.h5.lock"};
  for (const char* name : drafts) put(scratch, scratch / name, "draft");
  for (const char* name : others) put(scratch, scratch / name, "mine");
  const ResultFolder folder = reopen_folder(PETSC_COMM_WORLD, scratch);
  for (const char* name : drafts) CHECK(std::filesystem::exists(scratch / name));
  meet();
  remove_drafts(PETSC_COMM_WORLD, folder);
  meet();
  for (const char* name : drafts) CHECK_FALSE(std::filesystem::exists(scratch / name));
  for (const char* name : others) CHECK(std::filesystem::exists(scratch / name));
}

TEST_CASE("a file that is called like a result and is none of floe's is not replaced") {
  const std::string own = R"({"provenance": {"floe": {"version": "1"}}})";
  using Files = std::vector<std::pair<std::string, std::string>>;
  for (const Files& files : {Files{{"summary.json", R"({"title": "mine"})"}}, Files{{"summary.json", "mine"}},
                             Files{{"probes.csv", "t [s],x\n"}}, Files{{"compare.png", "mine"}},
                             Files{{"summary.json", own}, {"probes.csv", "a,b\n"}}}) {
    Scratch scratch;
    for (const auto& [name, text] : files) put(scratch, scratch / name, text);
    const std::string& last = files.back().first;
    INFO(last);
    CHECK_THROWS_WITH(prepare_folder(PETSC_COMM_WORLD, scratch, true),
                      Contains(last + " in it is not a result of floe"));
    CHECK(text_of(scratch / last) == files.back().second);
    meet();
  }
}

TEST_CASE("what cannot be a result folder is an input error of one line on every rank") {
  Scratch scratch;
  put(scratch, scratch / "file", "");
  for (const std::filesystem::path& path :
       {scratch / "file", scratch / "file/below", std::filesystem::path("/proc/floe/x"),
        std::filesystem::path("/proc/self"), std::filesystem::path()}) {
    INFO(path);
    try {
      prepare_folder(PETSC_COMM_WORLD, path, true);
      FAIL("accepted");
    } catch (const InputError& error) {
      CHECK_THAT(error.what(), Contains("output folder '" + path.string() + "'") && !Contains("\n"));
    }
  }
}

TEST_CASE("a file is replaced whole or not at all") {
  Scratch scratch;
  if (scratch.rank() != 0) return;
  const std::string old(1000, 'o'), fresh(100000, 'n');
  write_file_atomically(scratch / "file", old);
  CHECK(text_of(scratch / "file") == old);
  {
    SmallFiles full(4096);
    CHECK_THROWS_AS(write_file_atomically(scratch / "file", fresh), RunError);
    CHECK_THROWS_WITH(write_file_atomically(scratch / "file", fresh), Contains("File too large") && Contains("file"));
  }
  CHECK(text_of(scratch / "file") == old);
  CHECK_FALSE(std::filesystem::exists(scratch / ".file.partial"));
  write_file_atomically(scratch / "file", fresh);
  CHECK(text_of(scratch / "file") == fresh);
}

TEST_CASE("a summary keeps the order of its keys, and its failure is every rank's") {
  Scratch scratch;
  write_summary(PETSC_COMM_WORLD, {scratch}, {{"status", "running"}, {"basis", 17}, {"a", 0.1}});
  meet();
  CHECK(text_of(scratch / "summary.json") == "{\n  \"status\": \"running\",\n  \"basis\": 17,\n  \"a\": 0.1\n}\n");
  CHECK_THROWS_AS(write_summary(PETSC_COMM_WORLD, {scratch / "missing"}, {}), RunError);
}

TEST_CASE("a folder that nothing was written into is removed with the parents made for it, and nothing else") {
  Scratch scratch;
  discard_if_empty(prepare_folder(PETSC_COMM_WORLD, scratch / "new/a/b", false));
  MPI_Barrier(PETSC_COMM_WORLD);
  CHECK_FALSE(std::filesystem::exists(scratch / "new"));
  MPI_Barrier(PETSC_COMM_WORLD);  // all have looked before it is made again
  const auto kept = prepare_folder(PETSC_COMM_WORLD, scratch / "new/c/", false);
  if (scratch.rank() == 0) write_file_atomically(kept.summary(), "text");
  discard_if_empty(kept);
  discard_if_empty(prepare_folder(PETSC_COMM_WORLD, scratch / "new/d", false));
  MPI_Barrier(PETSC_COMM_WORLD);
  CHECK(std::filesystem::exists(scratch / "new/c/summary.json"));
  CHECK_FALSE(std::filesystem::exists(scratch / "new/d"));
}
