#include "floe/petsc/together.h"

#include <exception>
#include <limits>

#include "floe/petsc/error.h"

namespace floe::petsc {

namespace {

/// What `work` has thrown on this rank, once all ranks have come out of it. @throws  the same where they do not come
std::exception_ptr caught(MPI_Comm comm, const std::function<void()>& work) {
  constexpr double wait = 10;  // s
  std::exception_ptr fault;
  try {
    work();
  } catch (const std::exception&) {
    fault = std::current_exception();
  }
  if (!all_arrive(comm, fault ? wait : std::numeric_limits<double>::infinity())) std::rethrow_exception(fault);
  return fault;
}

}  // namespace

void together(MPI_Comm comm, const std::function<void()>& work) {
  const std::exception_ptr fault = caught(comm, work);
  agree(comm, [&] {
    if (fault) std::rethrow_exception(fault);
  });
}

std::string failed_together(MPI_Comm comm, const std::function<void()>& work) {
  const std::exception_ptr fault = caught(comm, work);
  try {
    agree(comm, [&] {
      if (fault) std::rethrow_exception(fault);
    });
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace floe::petsc
