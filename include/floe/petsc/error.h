#pragma once
#include <petscsys.h>

#include <exception>
#include <functional>
#include <string>
#include <utility>

#include "floe/error.h"

namespace floe::petsc {

/// A PETSc call failed; what() holds one line: the first of PETSc's own message, the function that failed and the one
/// that was called.
class Error : public RunError {
 public:
  Error(PetscErrorCode code, const std::string& text) : RunError(text), code_(code) {}
  PetscErrorCode code() const { return code_; }

 private:
  PetscErrorCode code_;
};

/// Makes PETSc keep its message instead of printing it with a traceback: check() throws with it. Call after
/// PetscInitialize.
void collect_errors();

/// Throws Error when a PETSc call returned one.
void check(PetscErrorCode code);

/// check() for the ...SetFromOptions of solvers: an option with a value that it cannot have is the user's fault.
/// @param prefix  of the solver's options
/// @throws InputError  with PETSc's message
void check_options(PetscErrorCode code, const std::string& prefix);

/// Throws on every rank what was thrown on one of them: same kind (InputError or RunError), text of the lowest failing
/// rank.
///
/// `work` is rank-local; no rank is left waiting in a later collective call. Collective: one all-reduce when all is
/// well.
void agree(MPI_Comm comm, const std::function<void()>& work);

/// agree() where several ranks take part; `alone` says that this rank works for itself and may simply throw.
template <class Work>
void agree_if_parallel(MPI_Comm comm, bool alone, Work&& work) {
  if (alone)
    work();
  else
    agree(comm, work);
}

/// Whether every rank comes here within some seconds: false where one of them waits elsewhere. Collective for those
/// that come.
bool all_arrive(MPI_Comm comm, double seconds);

/// Carries a C++ exception across PETSc's C frames.
///
/// A callback returns `guard.run([&]{ ... })`; the one who called TSSolve, SNESSolve or EPSSolve then calls
/// `guard.check(code)`, which throws the original.
class Guard {
 public:
  template <class Work>
  PetscErrorCode run(Work&& work) noexcept {
    try {
      work();
      return 0;
    } catch (...) {
      if (!thrown_) thrown_ = std::current_exception();
      return PETSC_ERR_USER;
    }
  }
  void check(PetscErrorCode code) {
    if (auto thrown = std::exchange(thrown_, nullptr)) std::rethrow_exception(thrown);
    petsc::check(code);
  }

 private:
  std::exception_ptr thrown_;
};

}  // namespace floe::petsc
