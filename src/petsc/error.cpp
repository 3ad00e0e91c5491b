#include "floe/petsc/error.h"

#include <chrono>
#include <thread>
#include <utility>

namespace floe::petsc {
namespace {

/// Of the error under way; one PETSc call passes it to the next, outwards.
struct Trace {
  std::string message, innermost, outermost;
};
Trace& trace() {
  static Trace one;
  return one;
}

std::string meaning_of(PetscErrorCode code) {
  const char* meaning = nullptr;
  PetscErrorMessage(code, &meaning, nullptr);
  return "PETSc error " + std::to_string(code) + (meaning ? std::string(", ") + meaning : "");
}

PetscErrorCode collect(MPI_Comm, int, const char* function, const char*, PetscErrorCode code, PetscErrorType type,
                       const char* message, void*) {
  if (type == PETSC_ERROR_INITIAL) {
    trace() = {meaning_of(code), "", ""};
    const std::string text = message ? message : "";
    if (code == PETSC_ERR_MAT_LU_ZRPVT || code == PETSC_ERR_MAT_CH_ZRPVT)
      trace().message = "a matrix is singular (PETSc error " + std::to_string(code) + ", zero pivot)";
    else if (!text.empty())
      trace().message += ": " + text.substr(0, text.find('\n'));
  }
  if (!function || std::string(function) == "User provided function") return code;
  if (trace().innermost.empty()) trace().innermost = function;
  trace().outermost = function;
  return code;
}

}  // namespace

void collect_errors() { check(PetscPushErrorHandler(collect, nullptr)); }

void check(PetscErrorCode code) {
  if (code == 0) return;
  const Trace last = std::exchange(trace(), {});
  std::string text = last.message.empty() ? meaning_of(code) : last.message;
  if (!last.innermost.empty()) text += " (in " + last.innermost;
  if (last.outermost != last.innermost) text += ", called by " + last.outermost;
  throw Error(code, last.innermost.empty() ? text : text + ")");
}

void check_options(PetscErrorCode code, const std::string& prefix) {
  try {
    check(code);
  } catch (const Error& error) {
    throw InputError("an option -" + prefix + "... is rejected: " + error.what());
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
