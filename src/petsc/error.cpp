#include "floe/petsc/error.h"

#include <chrono>
#include <thread>
#include <utility>

namespace floe::petsc {
namespace {

std::string& traceback() {
  static std::string text;
  return text;
}

PetscErrorCode collect(MPI_Comm, int line, const char* function, const char* file, PetscErrorCode code,
                       PetscErrorType type, const char* message, void*) {
  if (type == PETSC_ERROR_INITIAL) {
    const char* meaning = nullptr;
    PetscErrorMessage(code, &meaning, nullptr);
    traceback() = "PETSc error " + std::to_string(code) + (meaning ? std::string(", ") + meaning : "");
    if (message && *message) traceback() += std::string(": ") + message;
  }
  if (function && std::string(function) != "User provided function")
    traceback() += std::string("\n    in ") + function + "() at " + (file ? file : "?") + ":" + std::to_string(line);
  return code;
}

}  // namespace

void collect_errors() { check(PetscPushErrorHandler(collect, nullptr)); }

void check(PetscErrorCode code) {
  if (code == 0) return;
  std::string text = std::exchange(traceback(), {});
  if (text.empty()) {
    const char* meaning = nullptr;
    PetscErrorMessage(code, &meaning, nullptr);
    text = "PETSc error " + std::to_string(code) + (meaning ? std::string(", ") + meaning : "");
  }
  throw Error(code, text);
}

void check_options(PetscErrorCode code, const std::string& prefix) {
  try {
    check(code);
  } catch (const Error& error) {
    const std::string text = error.what();
    throw InputError("an option -" + prefix + "... cannot be taken: " + text.substr(0, text.find('\n')));
  }
}

void agree(MPI_Comm comm, const std::function<void()>& work) {
  enum : int { well = 0, run = 1, input = 2 };
  int mine = well;
  std::string text;
  try {
    work();
  } catch (const InputError& error) {
    mine = input;
    text = error.what();
  } catch (const std::exception& error) {
    mine = run;
    text = error.what();
  }
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  const int candidate = mine == well ? size : rank;
  int first = size;
  MPI_Allreduce(&candidate, &first, 1, MPI_INT, MPI_MIN, comm);
  if (first == size) return;
  int header[2] = {mine, static_cast<int>(text.size())};
  MPI_Bcast(header, 2, MPI_INT, first, comm);
  text.resize(header[1]);
  MPI_Bcast(text.data(), header[1], MPI_CHAR, first, comm);
  if (header[0] == input) throw InputError(text);
  throw RunError(text);
}

bool all_arrive(MPI_Comm comm, double seconds) {
  MPI_Request request;
  int done = 0;
  MPI_Ibarrier(comm, &request);
  const double begin = MPI_Wtime();
  while (!done && MPI_Wtime() - begin < seconds) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (!done) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return done;
}

}  // namespace floe::petsc
