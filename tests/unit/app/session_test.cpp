#include "../../../src/app/session.h"

#include <catch2/catch.hpp>

using floe::app::CommandLine;

namespace {

CommandLine split(std::vector<std::string> words) {
  words.insert(words.begin(), "floe");
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  return floe::app::split(static_cast<int>(pointers.size()), pointers.data());
}

using Words = std::vector<std::string>;

}  // namespace

TEST_CASE("command lines: options of PETSc with their values, and floe's own words") {
  const CommandLine all = split({"run", "arm.yaml", "-motion_ts_type", "bdf", "--estimate", "-log_view", "-o", "out"});
  CHECK(all.own == Words{"run", "arm.yaml", "--estimate", "-o", "out"});
  CHECK(all.petsc == Words{"-motion_ts_type", "bdf", "-log_view"});
}

TEST_CASE("command lines: an option without a value takes neither commands nor scenes nor options") {
  for (const char* scene : {"arm.yaml", "arm.yml"}) {
    const CommandLine line = split({"run", "-log_view", scene});
    CHECK(line.own == Words{"run", scene});
    CHECK(line.petsc == Words{"-log_view"});
  }
  CHECK(split({"-log_view", "run", "arm.yaml"}).own == Words{"run", "arm.yaml"});
  CHECK(split({"run", "-mat_type", "run"}).petsc == Words{"-mat_type", "run"});  // a value: there is a command already
  CHECK(split({"-log_view", "-malloc_debug", "check"}).petsc == Words{"-log_view", "-malloc_debug"});
  CHECK(split({"run", "a.yaml", "-log_view", "--force"}).own == Words{"run", "a.yaml", "--force"});
  CHECK(split({"run", "a.yaml", "-log_view"}).petsc == Words{"-log_view"});
  CHECK(split({"-x_y", ".yaml"}).petsc == Words{"-x_y", ".yaml"});  // a suffix is no name
}

TEST_CASE("command lines: negative numbers and -o are no options of PETSc") {
  CHECK(split({"sweep", "-0.5", "-o", "-1", "-"}).own == Words{"sweep", "-0.5", "-o", "-1", "-"});
  CHECK(split({"run", "-shift", "-0.5"}).petsc == Words{"-shift", "-0.5"});
  CHECK(split({"-.5"}).own == Words{"-.5"});
  CHECK(split({}).own.empty());
}
