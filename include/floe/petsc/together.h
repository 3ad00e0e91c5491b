#pragma once
#include <mpi.h>

#include <functional>
#include <string>

namespace floe::petsc {

/// Runs collective work that may fail: all ranks throw the error of the first one that failed, as `agree` does.
///
/// A rank that fails alone leaves the others waiting within the work. Where they do not come within ten seconds it
/// throws what it has caught: nobody can go on then.
/// @throws RunError, InputError  what the first rank that failed threw
/// Collective.
void together(MPI_Comm comm, const std::function<void()>& work);

/// As `together`, with the message of the error, the same on every rank, instead of the error; empty without one.
/// Collective.
std::string failed_together(MPI_Comm comm, const std::function<void()>& work);

}  // namespace floe::petsc
