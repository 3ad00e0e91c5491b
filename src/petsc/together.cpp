#include "floe/petsc/together.h"

#include <exception>
#include <limits>

#include "floe/petsc/error.h"

namespace floe::petsc {

std::string failed_together(MPI_Comm comm, const std::function<void()>& work) {
  constexpr double wait = 10;  // s
  std::exception_ptr fault;
  try {
    work();
  } catch (const std::exception&) {
    fault = std::current_exception();
  }
  if (!all_arrive(comm, fault ? wait : std::numeric_limits<double>::infinity())) std::rethrow_exception(fault);
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
