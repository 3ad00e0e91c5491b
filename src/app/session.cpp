#include "session.h"

#include <fmt/format.h>
#include <slepcsys.h>

#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "floe/output/provenance.h"
#include "floe/petsc/error.h"
#include "floe/petsc/factorisation.h"
#include "floe/solve/generalized_alpha.h"
#include "options.h"
#include "options_file.h"

namespace floe::app {

namespace {

bool petsc_option(const std::string& word) {
  return word.size() > 2 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])) && word.find('.') != 1;
}
bool scene_file(const std::string& word) {
  const auto ends = [&](const std::string& tail) {
    return word.size() > tail.size() && word.compare(word.size() - tail.size(), tail.size(), tail) == 0;
  };
  return ends(".yaml") || ends(".yml");
}

void say(const std::string& text) {
  std::string line;
  for (const char c : text + "\n") {
    if (c != '\n') {
      line += c;
      continue;
    }
    std::fprintf(stderr, "floe: %s\n", line.c_str());
    line.clear();
  }
}

int report(int code, const std::string& text) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0) say(text);
  if (petsc::all_arrive(MPI_COMM_WORLD, 10)) return code;
  if (rank != 0) say(text);
  MPI_Abort(MPI_COMM_WORLD, code);
  return code;
}

int guarded(const std::function<void()>& work) {
  try {
    work();
    return 0;
  } catch (const InputError& error) {
    const std::string text = error.what();
    return report(2, text.find("is rejected: PETSc") == std::string::npos ? text : with_options(text));
  } catch (const std::exception& error) {
    return report(1, with_options(error.what()));
  }
}

/// 1 where standard output did not take all that was printed, else 0.
int flushed() {
  errno = 0;
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return 0;
  say(std::string("cannot write to standard output") + (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
  return 1;
}

bool is_command(const std::string& word) {
  for (const char* name : {"run", "compare", "tradeoff", "sweep", "static", "campbell", "modes", "reduce", "info",
                           "motion", "stress", "plot", "report", "export", "check", "schema"})
    if (word == name) return true;
  return false;
}

}  // namespace

CommandLine split(int argc, char** argv) {
  CommandLine line;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (!petsc_option(word)) {
      line.own.push_back(word);
      continue;
    }
    line.petsc.push_back(word);
    if (i + 1 < argc && !petsc_option(argv[i + 1]) && std::string(argv[i + 1]).rfind("--", 0) != 0 &&
        std::string(argv[i + 1]) != "-o" && !scene_file(argv[i + 1]) && !(line.own.empty() && is_command(argv[i + 1])))
      line.petsc.push_back(argv[++i]);
  }
  return line;
}

int in_session(const CommandLine& line, const std::string& command, const std::function<void()>& work) {
  std::vector<std::string> words = {"floe"};
  words.insert(words.end(), line.petsc.begin(), line.petsc.end());
  const std::vector<std::string> bad_files = take_bad_option_files(words);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  int count = static_cast<int>(words.size());
  char** arguments = pointers.data();
  setenv("OMPI_MCA_sharedfp", "^sm", 0);  // runs without mpirun share its file in /tmp: opening ours failed once
  if (SlepcInitialize(&count, &arguments, nullptr, nullptr)) return 1;
  for (const int number : {SIGTERM, SIGHUP, SIGPIPE})
    std::signal(number, SIG_DFL);  // PETSc's handler prints a page, aborts
  const int code = guarded([&] {
    petsc::collect_errors();
    petsc::prepare_mumps();
    solve::register_generalized_alpha();
    if (!bad_files.empty()) throw InputError(bad_files);
    check_options(command);
    int rank = 0;
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    if (rank == 0 && output::provenance(PETSC_COMM_WORLD)["blas"]["name"] == "reference")
      say("the reference BLAS is in use, which makes factorisations 5 to 7 times slower: install libopenblas0-serial");
    work();
    check_unused();
  });
  silence_options_left();
  std::fflush(
      stdout);  // mpirun ends the others when one rank has ended with a code: none ends before all are through here
  SlepcFinalize();
  return code != 0 ? code : flushed();
}

}  // namespace floe::app
