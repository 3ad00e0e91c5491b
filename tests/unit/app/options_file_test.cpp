#include "../../../src/app/options_file.h"

#include <cstdlib>

#include "../../../src/app/options.h"
#include "command_tests.h"
#include "floe/petsc/error.h"

namespace {

using OptionWords = std::vector<std::string>;

/// The only fault of the words; they are changed.
std::string fault_of(OptionWords& words) {
  const OptionWords faults = app::take_bad_option_files(words);
  REQUIRE(faults.size() == 1);
  return faults.front();
}

/// PETSc's own table has these while this lives.
class Given {
 public:
  explicit Given(const OptionWords& options) : options_(options) {
    for (const std::string& option : options) {
      const auto space = option.find(' ');
      petsc::check(PetscOptionsSetValue(nullptr, option.substr(0, space).c_str(),
                                        space == std::string::npos ? nullptr : option.substr(space + 1).c_str()));
    }
  }
  ~Given() {
    for (const std::string& option : options_)
      PetscOptionsClearValue(nullptr, option.substr(0, option.find(' ')).c_str());
  }

 private:
  OptionWords options_;
};

}  // namespace

TEST_CASE("options files: what PETSc would abort at is named with file and line, and taken out") {
  const OwnFolder own;
  const std::string well =
      own.write("well", "# a comment\n-motion_ts_dt 0.1 # behind\n\n-log_view \"a b\"\nalias -a -b\n");
  OptionWords words = {"floe", "-options_file", well, "-motion_snes_monitor"};
  const OptionWords before = words;
  CHECK(app::take_bad_option_files(words).empty());
  CHECK(words == before);
  const std::vector<std::pair<std::string, std::string>> lines = {
      {"foo 1", "\"foo\" is not an option; expected -NAME VALUE"},
      {"-1 2", "\"-1\" is not an option"},
      {"-", "\"-\" is not an option"},
      {"-a 1 2", "\"2\" follows option and value"},
      {"-a \"1 2\" 3", "\"3\" follows option and value"},
      {"alias -a", "alias has no two options after it"},
      {"ALIAS a -b", "alias has no two options after it"}};
  for (const auto& [line, says] : lines) {
    const std::string file = own.write("bad", "-fine\n" + line + "\nalso bad\n");
    words = {"floe", "-options_file", file, "-log_view"};
    CHECK_THAT(fault_of(words), Contains(file + ":2: " + says));
    CHECK(words == OptionWords{"floe", "-log_view"});
  }
}

TEST_CASE("options files that cannot be read, and options in YAML, are refused") {
  const OwnFolder own;
  OptionWords words = {"floe", "-options_file"};
  CHECK_THAT(fault_of(words), Contains("-options_file: has no file after it"));
  words = {"floe", "-options_file", "-log_view"};
  CHECK_THAT(fault_of(words), Contains("-options_file: has no file after it"));
  CHECK(words == OptionWords{"floe", "-log_view"});
  for (const std::string& file : {std::string(own.path / "none"), own.write("empty", "")}) {
    words = {"floe", "-options_file", file};
    CHECK_THAT(fault_of(words), Contains(file + " cannot be read, or is empty"));
    CHECK(words == OptionWords{"floe"});
  }
  for (const char* option : {"-options_file_yaml", "-options_string_yaml"}) {
    words = {"floe", option, "a: 1"};
    CHECK_THAT(fault_of(words), Contains(std::string(option) + ": is not read; expected -options_file FILE"));
  }
}

TEST_CASE("options files: PETSc's own of the user is judged, unless it is skipped, and skipped where it is bad") {
  const OwnFolder own;
  const char* given = std::getenv("HOME");
  const std::string home = given ? given : "";
  setenv("HOME", own.path.c_str(), 1);
  own.write(".petscrc", "-log_view\nbad\n");
  OptionWords words = {"floe"};
  CHECK_THAT(fault_of(words), Contains(".petscrc:2: \"bad\" is not an option"));
  CHECK(words == OptionWords{"floe", "-skip_petscrc"});
  CHECK(app::take_bad_option_files(words).empty());
  setenv("HOME", home.c_str(), 1);
}

TEST_CASE("options of a command line: faults before the work, a fault of the work, and what was not used") {
  {
    const Given given({"-motion_snes_monitorr", "-modes_eps_nve 3"});
    CHECK_THROWS_WITH(app::check_options("run"),
                      Contains("did you mean -motion_snes_monitor?") && Contains("did you mean -modes_eps_nev?"));
  }
  {
    const Given given({"-campbell_pep_nev 3", "-foo_bar", "-motion_ts_dt -1"});
    CHECK_THROWS_WITH(app::check_options("run"),
                      Contains("option -campbell_pep_nev 3: floe run has no solver with this prefix; expected it with "
                               "campbell") &&
                          Contains("option -foo_bar: unknown prefix") && Contains("is not a positive number"));
  }
  const Given given({"-motion_ts_max_reject 3", "-static_snes_max_it 5", "-mesh_mat_partitioning_type current"});
  CHECK_NOTHROW(app::check_options("run"));
  CHECK_THROWS_WITH(app::check_options("modes"), Contains("-static_snes_max_it 5: floe modes has no solver"));
  app::check_options("run");
  CHECK_THAT(app::with_options("it failed"),
             Contains("it failed (options given: -") && Contains("-static_snes_max_it 5"));
  CHECK(app::with_options("option -motion_ts_... failed") == "option -motion_ts_... failed");
  CHECK_THROWS_WITH(app::check_unused(),
                    Contains("-static_snes_max_it 5: not used in this run; its results are complete"));
}

TEST_CASE("a fault lists eight of the options at most") {
  OptionWords many;
  for (int i = 1; i <= 9; ++i)
    many.push_back("-derivatives_mat_mumps_icntl_" + std::to_string(i > 4 ? i + 5 : i) + " 1");
  const Given given(many);
  try {
    app::check_options("run");
  } catch (const InputError&) {
    // some are unknown to MUMPS
  }
  const std::string text = app::with_options("no");
  CHECK_THAT(text, Contains(", ...)"));
  CHECK(std::count(text.begin(), text.end(), '-') == 8);
}
